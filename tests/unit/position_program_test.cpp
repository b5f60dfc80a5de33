// SPDX-License-Identifier: MIT
#include "common/glapi/position_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace wall::glapi {
namespace {

using Op = PositionOp;
using Matrix = std::array<float, 16>;

constexpr Matrix kModelview = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
constexpr Matrix kProjection = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1};

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

PositionProgram program_of(std::vector<PositionStep> steps) { return {{{"u", 0}}, "place", true, std::move(steps)}; }

std::optional<Matrix> value_of(const PositionProgram& program, std::span<const float> uniform = {}) {
    const std::span<const float> uniforms[] = {uniform};
    const auto transform = evaluate(program, {uniforms, kModelview, kProjection});
    return transform ? std::optional(transform->matrix()) : std::nullopt;
}

TEST(PositionProgram, MatricesOfFixedFunction) {
    const auto of = [](BuiltInMatrix which) {
        return value_of(program_of({{Op::built_in, 4, 4, {static_cast<std::uint32_t>(which)}},
                                    {Op::attribute, 1, 4, {}},
                                    {Op::product, 1, 4, {0, 1}}}));
    };
    EXPECT_EQ(of(BuiltInMatrix::modelview), kModelview);
    EXPECT_EQ(of(BuiltInMatrix::projection), kProjection);
    EXPECT_EQ(of(BuiltInMatrix::modelview_projection), (Matrix{2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 10, 12, 14, 1}));
}

TEST(PositionProgram, AttributesOfFewerComponentsAreFilledUp) {
    // x + 1, 0, y, 3
    const auto program = program_of({{Op::attribute, 1, 2, {}},
                                     {Op::constant, 1, 3, {bits(1), bits(0), bits(3)}},
                                     {Op::pick, 1, 2, {1, 0, 1, 1}},
                                     {Op::add, 1, 2, {0, 2}},
                                     {Op::pick, 1, 4, {3, 0, 1, 1, 0, 1, 1, 2}}});
    ASSERT_TRUE(is_valid(program));
    EXPECT_EQ(value_of(program), (Matrix{1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 3}));
}

TEST(PositionProgram, Inverse) {
    const auto program = program_of({{Op::uniform, 4, 4, {0}},
                                     {Op::inverse, 4, 4, {0}},
                                     {Op::product, 4, 4, {0, 1}},
                                     {Op::attribute, 1, 4, {}},
                                     {Op::product, 1, 4, {2, 3}}});
    ASSERT_TRUE(is_valid(program));
    Matrix uniform;
    std::iota(uniform.begin(), uniform.end(), 0.0f);
    uniform[3] = uniform[6] = uniform[9] = -20;
    const auto result = value_of(program, uniform);
    ASSERT_TRUE(result);
    for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR((*result)[i], i % 5 == 0 ? 1 : 0, 1e-4) << i;
    const Matrix singular{};
    EXPECT_FALSE(value_of(program, singular));
}

TEST(PositionProgram, UniformsMustHaveTheirSize) {
    const auto program = program_of({{Op::attribute, 1, 4, {}}, {Op::uniform, 1, 1, {0}}, {Op::divide, 1, 4, {0, 1}}});
    const float values[] = {2, 3};
    EXPECT_EQ((*value_of(program, std::span(values, 1)))[0], 0.5f);
    EXPECT_FALSE(value_of(program, values));
    EXPECT_FALSE(value_of(program));
    EXPECT_FALSE(evaluate(program, {{}, kModelview, kProjection}));
    EXPECT_FALSE(value_of({}, std::span(values, 1)));
    EXPECT_TRUE(is_valid({}));
}

TEST(PositionProgram, HomogeneousWhereFixedFunctionIsSo) {
    const PositionStep vertex{Op::attribute, 1, 4, {}}, one{Op::constant, 1, 1, {bits(1)}};
    const std::span<const float> uniforms[] = {{}};
    const PositionValues values{uniforms, kModelview, kProjection};
    EXPECT_TRUE(evaluate(program_of({vertex}), values)->homogeneous());
    const auto moved = evaluate(program_of({vertex, one, {Op::add, 1, 4, {0, 1}}}), values);
    EXPECT_FALSE(moved->homogeneous());
    EXPECT_EQ(moved->constant, (std::array<float, 4>{1, 1, 1, 1}));
    EXPECT_EQ(moved->matrix(), (Matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1, 1, 2}));
}

TEST(PositionProgram, MatricesThatNearlyCancelAreNotSteady) {
    const auto moved_twice = [](float there, float back) {
        const PositionProgram program = program_of({{Op::attribute, 1, 4, {}},
                                                    {Op::constant, 1, 4, {bits(there), 0, 0, 0}},
                                                    {Op::constant, 1, 4, {bits(back), 0, 0, 0}},
                                                    {Op::add, 1, 4, {0, 1}},
                                                    {Op::subtract, 1, 4, {3, 2}}});
        const std::span<const float> uniforms[] = {{}};
        return *evaluate(program, {uniforms, kModelview, kProjection});
    };
    EXPECT_TRUE(moved_twice(1, 2).steady());
    EXPECT_EQ(moved_twice(1, 2).sizes[12], 3);
    EXPECT_TRUE(moved_twice(1e6f, -1e6f).steady());
    EXPECT_FALSE(moved_twice(1e6f, 1e6f).steady());
    EXPECT_EQ(moved_twice(1e6f, 1e6f).constant[0], 0);
}

TEST(PositionProgram, FollowsItsUniforms) {
    PositionProgram program = program_of({{Op::attribute, 1, 4, {}},
                                          {Op::uniform, 1, 4, {0}},
                                          {Op::uniform, 1, 1, {1}},
                                          {Op::multiply, 1, 4, {0, 2}},
                                          {Op::add, 1, 4, {3, 1}}});
    program.uniforms.push_back({"f", 0});
    LinkedPosition position(program, {6, 2});
    EXPECT_EQ(position.transform(kModelview, kProjection), nullptr);  // the uniforms have no values
    const std::uint32_t scale[] = {bits(3)};
    position.set(2, 1, scale);
    const std::uint32_t shifts[] = {0, 0, 0, 0, bits(1), bits(2), bits(3), bits(4)};
    position.set(5, 4, shifts);
    const auto* transform = position.transform(kModelview, kProjection);
    ASSERT_NE(transform, nullptr);
    EXPECT_EQ(transform->constant, (std::array<float, 4>{1, 2, 3, 4}));
    EXPECT_EQ(transform->linear[5], 3);
    position.set(7, 4, shifts);  // others
    EXPECT_EQ(position.transform(kModelview, kProjection)->linear[5], 3);
    position.set(2, 1, std::span(shifts + 5, 1));
    EXPECT_EQ(position.transform(kModelview, kProjection)->linear[5], 2);
    EXPECT_EQ(LinkedPosition().transform(kModelview, kProjection), nullptr);
}

TEST(PositionProgram, FollowsTheMatricesOfFixedFunction) {
    LinkedPosition position(
        {{}, "gl_Vertex", true, {{Op::built_in, 4, 4, {2}}, {Op::attribute, 1, 4, {}}, {Op::product, 1, 4, {0, 1}}}},
        {});
    EXPECT_EQ(position.transform(kModelview, kModelview)->linear[12], 10);
    EXPECT_EQ(position.transform(kModelview, kProjection)->linear[5], 2);
    EXPECT_EQ(position.transform(kProjection, kProjection)->linear[5], 4);
}

TEST(PositionProgram, StepsWithoutMeaningAreRefused) {
    const PositionStep vertex{Op::attribute, 1, 4, {}}, uniform{Op::uniform, 4, 4, {0}}, scalar{Op::uniform, 1, 1, {0}};
    const auto valid = [](std::vector<PositionStep> steps) { return is_valid(program_of(std::move(steps))); };
    EXPECT_TRUE(valid({vertex}));
    EXPECT_TRUE(valid({vertex, scalar, {Op::multiply, 1, 4, {1, 0}}}));
    EXPECT_FALSE(valid({uniform}));                            // no vector
    EXPECT_FALSE(valid({{Op::attribute, 1, 3, {}}}));          // of four
    EXPECT_FALSE(valid({{Op::attribute, 1, 4, {0}}}));         // too many operands
    EXPECT_FALSE(valid({{Op::attribute, 4, 4, {}}, vertex}));  // a matrix
    EXPECT_FALSE(valid({{Op::attribute, 0, 4, {}}, vertex}));
    EXPECT_FALSE(valid({{Op::attribute, 1, 5, {}}, vertex}));
    EXPECT_FALSE(valid({{Op::uniform, 1, 4, {1}}}));           // no such uniform
    EXPECT_FALSE(valid({{Op::built_in, 4, 4, {3}}, vertex}));  // no such matrix
    EXPECT_FALSE(valid({{Op::built_in, 3, 3, {0}}, vertex}));
    EXPECT_FALSE(valid({{Op::constant, 1, 4, {0, 0, 0}}}));  // too few components
    EXPECT_FALSE(valid({vertex, {Op::add, 1, 4, {0, 1}}}));  // itself
    EXPECT_FALSE(valid({vertex, {Op::add, 1, 4, {0, ~0u}}}));
    EXPECT_FALSE(valid({vertex, {Op::add, 1, 4, {0}}}));
    EXPECT_FALSE(valid({vertex, uniform, {Op::add, 1, 4, {0, 1}}}));  // shapes
    EXPECT_FALSE(valid({vertex, {Op::multiply, 1, 4, {0, 0}}}));      // not affine
    EXPECT_FALSE(valid({vertex, {Op::product, 1, 1, {0, 0}}, vertex}));
    EXPECT_FALSE(valid({vertex, scalar, {Op::divide, 1, 4, {1, 0}}}));
    EXPECT_FALSE(valid({{Op::uniform, 3, 4, {0}}, vertex, {Op::product, 1, 4, {0, 1}}}));
    EXPECT_TRUE(valid({{Op::uniform, 3, 4, {0}}, {Op::attribute, 1, 3, {}}, {Op::product, 1, 4, {0, 1}}}));
    EXPECT_TRUE(valid({{Op::uniform, 4, 3, {0}}, {Op::attribute, 1, 3, {}}, {Op::product, 1, 4, {1, 0}}}));
    EXPECT_FALSE(valid({vertex, {Op::pick, 1, 4, {0, 0, 0, 1, 0, 2, 0, 4}}}));  // no such component
    EXPECT_FALSE(valid({vertex, {Op::pick, 1, 4, {0, 0, 0, 1, 0, 2, 1, 0}}}));
    EXPECT_FALSE(valid({vertex, {Op::pick, 2, 2, {0, 0, 0, 1, 0, 2, 0, 3}}, vertex}));  // a matrix of the vertex
    EXPECT_FALSE(valid({{Op::uniform, 3, 4, {0}}, {Op::inverse, 3, 4, {0}}, vertex}));
    EXPECT_FALSE(valid({vertex, {static_cast<Op>(11), 1, 4, {0, 0}}}));
    EXPECT_FALSE(valid(std::vector<PositionStep>(kMostPositionSteps + 1, vertex)));
    EXPECT_TRUE(valid(std::vector<PositionStep>(kMostPositionSteps, vertex)));
}

/// projection * (model * place), as the two are numbered.
PositionProgram chain(std::uint32_t projection, std::uint32_t model) {
    PositionProgram program = program_of({{Op::uniform, 4, 4, {projection}},
                                          {Op::uniform, 4, 4, {model}},
                                          {Op::attribute, 1, 4, {}},
                                          {Op::product, 1, 4, {1, 2}},
                                          {Op::product, 1, 4, {0, 3}}});
    program.uniforms = {{"u", 0}, {"v", 0}};
    return program;
}

TEST(LastMatrix, IsTheFirstOfAChainOfProducts) {
    EXPECT_EQ(last_matrix(chain(1, 0))->uniform, 1u);
    auto left_to_right = chain(0, 1);
    left_to_right.steps[3] = {Op::product, 4, 4, {0, 1}};
    left_to_right.steps[4] = {Op::product, 1, 4, {3, 2}};
    ASSERT_TRUE(is_valid(left_to_right));
    EXPECT_EQ(last_matrix(left_to_right)->uniform, 0u);
    for (const auto which : {BuiltInMatrix::projection, BuiltInMatrix::modelview_projection}) {
        const auto found = last_matrix(program_of({{Op::built_in, 4, 4, {static_cast<std::uint32_t>(which)}},
                                                   {Op::attribute, 1, 4, {}},
                                                   {Op::product, 1, 4, {0, 1}}}));
        EXPECT_TRUE(found && found->built_in);
    }
}

TEST(LastMatrix, TakesPartInNothingElse) {
    EXPECT_FALSE(last_matrix(chain(0, 0))) << "the same one twice";
    EXPECT_FALSE(last_matrix({}));
    auto moved = chain(0, 1);
    moved.steps.push_back({Op::constant, 1, 4, {bits(1), 0, 0, 0}});
    moved.steps.push_back({Op::add, 1, 4, {4, 5}});
    ASSERT_TRUE(is_valid(moved));
    EXPECT_FALSE(last_matrix(moved)) << "something comes after it";
    EXPECT_FALSE(last_matrix(program_of({{Op::built_in, 4, 4, {static_cast<std::uint32_t>(BuiltInMatrix::modelview)}},
                                         {Op::attribute, 1, 4, {}},
                                         {Op::product, 1, 4, {0, 1}}})));
}

TEST(LastMatrix, IsTheNamedOneWhereTheStepsShowNone) {
    PositionProgram unknown;
    unknown.uniforms = {{"other", 0}, {"camera", 1}};
    unknown.camera = 1;
    ASSERT_TRUE(is_valid(unknown));
    EXPECT_EQ(last_matrix(unknown), (LastMatrix{false, 1, true}));
    auto shown = chain(1, 0);
    shown.camera = 0;
    EXPECT_EQ(last_matrix(shown), (LastMatrix{false, 1, false})) << "what the shader does is believed first";
    LinkedPosition position(unknown, {3, 8});
    EXPECT_TRUE(position.camera_is_named());
    std::vector<std::uint32_t> words(16, bits(2));
    position.set(8, 16, words);
    EXPECT_EQ(position.uniform_camera()->location, 8u);
    EXPECT_EQ(position.transform(kModelview, kProjection), nullptr) << "where vertices lie is not known all the same";
    unknown.camera = 2;
    EXPECT_FALSE(is_valid(unknown));
}

TEST(LastMatrix, HasTheValueThatItWasGiven) {
    LinkedPosition position(chain(1, 0), {7, 9});
    EXPECT_FALSE(position.uniform_camera()) << "it has none yet";
    EXPECT_TRUE(position.camera(kProjection).empty());
    std::vector<std::uint32_t> words;
    for (const float v : kModelview) words.push_back(bits(v));
    position.set(9, 16, words);
    ASSERT_TRUE(position.uniform_camera());
    EXPECT_EQ(position.uniform_camera()->location, 9u);
    EXPECT_TRUE(std::ranges::equal(position.camera(kProjection), kModelview));
}

}  // namespace
}  // namespace wall::glapi
