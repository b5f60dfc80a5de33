// SPDX-License-Identifier: MIT
// What a node is told of an assembly program: its string once, and its local parameters as far as they have changed.
#include "client_lib/objects/assembly_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

using glapi::Op;
using Parameter = AssemblyProgram::Parameter;

/// The commands in order, and the bytes of all of them.
struct Told {
    std::vector<Op> ops;
    std::size_t bytes = 0;
};

Told told(const wire::PackBuffer& buffer) {
    Told out;
    for (const std::byte op : buffer.opcodes()) out.ops.insert(out.ops.begin(), static_cast<Op>(op));
    out.bytes = buffer.bytes();
    return out;
}

Told changes(const AssemblyProgram& program, std::uint64_t known) {
    wire::PackBuffer buffer;
    program.pack_changes(known, buffer, no_limit);
    return told(buffer);
}

void set(AssemblyProgram& program, std::size_t index, float x) {
    const Parameter value{x, 0, 0, 0};
    program.set_locals(index, {&value, 1});
}

class AssemblyProgramTest : public ::testing::Test {
protected:
    void load() { program.load("!!ARBvp1.0 END", {.compiled = true}); }
    AssemblyProgram program{7, glapi::AssemblyStage::vertex};
};

TEST_F(AssemblyProgramTest, WithoutAStringThereIsNothingToTell) {
    set(program, 3, 1);
    EXPECT_FALSE(program.loaded());
    EXPECT_EQ(program.latest(), 0u);
    load();
    EXPECT_NE(program.latest(), 0u);
    EXPECT_EQ(changes(program, 0).ops, (std::vector{Op::AssemblyDefine, Op::AssemblyLocals}));
}

TEST_F(AssemblyProgramTest, ParametersAreToldByStamp) {
    load();
    EXPECT_EQ(changes(program, 0).ops, std::vector{Op::AssemblyDefine});
    const std::uint64_t known = program.latest();
    set(program, 4, 1);
    set(program, 5, 2);
    set(program, 9, 3);
    EXPECT_EQ(changes(program, known).ops, (std::vector{Op::AssemblyLocals, Op::AssemblyLocals})) << "two in a row";
    const std::uint64_t later = program.latest();
    set(program, 5, 4);
    EXPECT_EQ(changes(program, later).ops, std::vector{Op::AssemblyLocals});
    EXPECT_EQ(changes(program, program.latest()).ops, std::vector<Op>{});
    EXPECT_LT(program.defined(), program.latest());
}

TEST_F(AssemblyProgramTest, ANewStringKeepsTheParameters) {
    load();
    set(program, 1, 5);
    const std::uint64_t known = program.latest();
    load();
    EXPECT_EQ(changes(program, known).ops, std::vector{Op::AssemblyDefine});
    EXPECT_EQ(program.local(1), (Parameter{5, 0, 0, 0}));
    EXPECT_EQ(program.local(2), Parameter{});
}

TEST_F(AssemblyProgramTest, ValuesGoWithKeptCommands) {
    load();
    set(program, 0, 1);
    wire::PackBuffer buffer;
    program.pack_values(0, buffer);
    EXPECT_EQ(told(buffer).ops, std::vector{Op::AssemblyLocals});
}

TEST_F(AssemblyProgramTest, EqualValuesAreHeld) {
    const std::vector<Parameter> values{{1, 2, 3, 4}, {0, 0, 0, 0}};
    EXPECT_FALSE(program.holds(2, values));
    EXPECT_TRUE(program.holds(2, std::span(values).last(1)));
    program.set_locals(2, values);
    EXPECT_TRUE(program.holds(2, values));
}

TEST_F(AssemblyProgramTest, ItsPositionHasItsParameters) {
    set(program, 2, 3);
    using glapi::PositionOp;
    glapi::AssemblyReflection reflection{.compiled = true};
    reflection.position = {
        {{"local", 2}},
        "gl_Vertex",
        true,
        {{PositionOp::uniform, 1, 4, {0}}, {PositionOp::attribute, 1, 4, {}}, {PositionOp::add, 1, 4, {0, 1}}}};
    program.load("!!ARBvp1.0 END", reflection);
    constexpr std::array<float, 16> kAny{};
    EXPECT_EQ(program.position().transform(kAny, kAny)->constant[0], 3);
    set(program, 2, 4);
    EXPECT_EQ(program.position().transform(kAny, kAny)->constant[0], 4);
}

}  // namespace
}  // namespace wall::client
