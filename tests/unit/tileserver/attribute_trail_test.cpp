// SPDX-License-Identifier: MIT
// What geometry leaves behind, attribute by attribute, against what its commands set.
#include "tileserver/driver/attribute_trail.h"

#include <gtest/gtest.h>

namespace wall::tileserver {
namespace {

using glstate::Attribute;
using glstate::kAttributes;
using glstate::Vec4;

constexpr std::size_t kCurrent = static_cast<std::size_t>(glstate::Category::current);

/// Different for every place; edge flags are on or off.
Vec4 value_of(std::size_t place) {
    const auto base = static_cast<float>(place + 1);
    return {base, base + 0.25f, base + 0.5f, base + 0.75f};
}

/// The state in which an attribute has the value, by the command that says all of it.
glstate::State commanded(Attribute attribute, const Vec4& value) {
    glstate::State wanted, state;
    glstate::with_attribute(attribute, value,
                            [&]<class E>(E, unsigned i, const auto& v) { glstate::assign<E>(wanted, i, v); });
    std::array<std::byte, glstate::kMostAttributeBytes> operand{};
    const glapi::Op op = glstate::write_attribute(wanted, attribute, operand.data());
    EXPECT_EQ(glstate::attribute_set_by(op, operand.data()), attribute);
    glstate::apply_attribute(state, op, operand.data());
    return state;
}

TEST(AttributeTrail, EachAttributeIsLeftAsItsCommandSetsIt) {
    for (std::size_t place = 0; place < kAttributes; ++place) {
        SCOPED_TRACE(place);
        const auto attribute = static_cast<Attribute>(place);
        const Vec4 value = attribute == Attribute::edge_flag         ? Vec4{0, 0, 0, 1}
                           : attribute == Attribute::secondary_color ? Vec4{1, 2, 3, 1}
                                                                     : value_of(place);
        AttributeTrail trail;
        EXPECT_TRUE(trail.empty());
        trail.set(attribute, value[0], value[1], value[2], value[3]);
        EXPECT_FALSE(trail.empty());
        glstate::State state;
        const std::uint64_t before = state.ids[kCurrent];
        trail.fold_into(state);
        EXPECT_TRUE(glstate::same(state.current, commanded(attribute, value).current));
        EXPECT_FALSE(glstate::same(state.current, glstate::State{}.current));
        EXPECT_NE(state.ids[kCurrent], before);
    }
}

TEST(AttributeTrail, WhatACommandLacksIsFilledIn) {
    AttributeTrail trail;
    trail.set(Attribute::texcoord + 3, 5);
    trail.set(Attribute::color, 1, 2, 3);
    glstate::State state;
    trail.fold_into(state);
    EXPECT_EQ(state.current.texcoord[3], (Vec4{5, 0, 0, 1}));
    EXPECT_EQ(state.current.color, (Vec4{1, 2, 3, 1}));
}

TEST(AttributeTrail, TheLaterOneOfTwoWinsAndTheRestStays) {
    AttributeTrail first, later;
    first.set(Attribute::color, 1, 1, 1, 1);
    first.set(Attribute::normal, 1, 2, 3);
    first.set(Attribute::vertex_attrib + 15, 4, 4, 4, 4);
    later.set(Attribute::color, 0.5f, 0.5f, 0.5f);
    later.set(Attribute::fog_coord, 7);
    first.append(later);
    glstate::State state;
    first.fold_into(state);
    EXPECT_EQ(state.current.color, (Vec4{0.5f, 0.5f, 0.5f, 1}));
    EXPECT_EQ(state.current.normal, (glstate::Vec3{1, 2, 3}));
    EXPECT_EQ(state.current.vertex_attrib[15], (Vec4{4, 4, 4, 4}));
    EXPECT_EQ(state.current.fog_coord, 7);
    first.clear();
    EXPECT_TRUE(first.empty());
}

}  // namespace
}  // namespace wall::tileserver
