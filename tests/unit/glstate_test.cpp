// SPDX-License-Identifier: MIT
// The virtual context: differences, value ids, what travels, attribute groups.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "common/glapi/decoder.h"
#include "common/glstate/diff.h"
#include "common/glstate/elements.h"
#include "common/glstate/pack_sink.h"
#include "common/glstate/queries.h"

namespace wall {
namespace {

namespace el = glstate::el;
using glstate::State;

struct RecordingSink {
    std::vector<std::uint32_t> ids;
    template <class E>
    void set(unsigned i, const typename E::type&) {
        ids.push_back(E::id + i);
    }
};

/// The receiving side of a stream that holds nothing but state.
/// What the executor does with state commands.
void receive(const wire::PackBuffer& batch, State& state, glstate::ValueHistory& history, std::size_t& recalled) {
    wire::OperandReader in(batch.operands());
    for (std::size_t n = 0; n < batch.commands(); ++n) {
        const auto op = static_cast<glapi::Op>(batch.opcode_at(n));
        const auto word = in.get<std::uint32_t>();
        if (op == glapi::Op::StateSmall) {
            const std::uint32_t value = word >> 16;
            ASSERT_TRUE(glstate::apply(state, word & 0xffff, std::as_bytes(std::span(&value, 1))));
        } else if (op == glapi::Op::StateRecall) {
            ++recalled;
            ASSERT_TRUE(glstate::apply(state, word & 0xffff, history.recall(word & 0xffff, word >> 16)));
        } else {
            ASSERT_EQ(op, glapi::Op::State);
            const auto bytes = glstate::element_bytes(word);
            ASSERT_NE(bytes, 0u);
            const auto value = in.raw(bytes);
            ASSERT_TRUE(glstate::apply(state, word, value));
            if (bytes == glstate::ValueHistory::kValueBytes) history.add(word, value.data());
        }
    }
    EXPECT_TRUE(in.ok());
    EXPECT_EQ(in.remaining(), 0u);
}

/// Values that travel, but for those that mean nothing because the current colour drives them.
void expect_equal(const State& a, const State& b) {
    glstate::for_each_element([&]<class E>() {
        if (!E::sent) return;
        for (unsigned i = 0; i < E::count; ++i)
            EXPECT_TRUE(glstate::follows_color<E>(a, i) || glstate::same(E::ref(a, i), E::ref(b, i)))
                << E::name << " " << i;
    });
}

/// Sets some random elements to random values through assign().
void scramble(State& state, std::mt19937& random, unsigned percent) {
    glstate::for_each_element([&]<class E>() {
        for (unsigned i = 0; i < E::count; ++i) {
            if (random() % 100 >= percent) continue;
            typename E::type value = E::ref(state, i);
            std::uint32_t words[sizeof value / 4];
            for (auto& word : words) word = random() % 8;
            if constexpr (E::id == el::color_material::id) {
                words[0] = std::array{GL_FRONT, GL_BACK, GL_FRONT_AND_BACK}[random() % 3];
                words[1] =
                    std::array{GL_EMISSION, GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_AMBIENT_AND_DIFFUSE}[random() % 5];
            }
            if constexpr (E::id == el::color_material_enabled::id) words[0] %= 2;
            std::memcpy(&value, words, sizeof value);
            glstate::assign<E>(state, i, value);
        }
    });
}

std::vector<std::uint32_t> told_lazily(State& mirror, const State& state) {
    RecordingSink sink;
    glstate::diff_lazily(glstate::kSentCategories, mirror, state, sink);
    return sink.ids;
}

TEST(LazyDifferences, LeaveOutWhatCannotMatterUntilItCan) {
    State state, mirror;
    glstate::assign<el::blend_func>(state, 0, {GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ZERO});
    glstate::assign<el::fog_density>(state, 0, 0.5f);
    EXPECT_TRUE(told_lazily(mirror, state).empty());
    glstate::assign<el::dither>(state, 0, 0);
    EXPECT_EQ(told_lazily(mirror, state), (std::vector<std::uint32_t>{el::dither::id}));
    EXPECT_TRUE(told_lazily(mirror, state).empty()) << "once";
    glstate::assign<el::blend_enabled>(state, 0, 1);
    EXPECT_EQ(told_lazily(mirror, state), (std::vector<std::uint32_t>{el::blend_enabled::id, el::blend_func::id}));
    EXPECT_TRUE(glstate::same(mirror.color_buffer, state.color_buffer));
    EXPECT_EQ(mirror.ids[static_cast<std::size_t>(el::dither::category)],
              state.ids[static_cast<std::size_t>(el::dither::category)])
        << "nothing is left to be looked at";
}

TEST(LazyDifferences, GoByTheIndexWhereThereAreAsMany) {
    State state, mirror;
    for (const unsigned light : {1u, 2u}) glstate::assign<el::light_ambient>(state, light, {1, 1, 1, 1});
    glstate::assign<el::light_enabled>(state, 2, 1);
    EXPECT_EQ(told_lazily(mirror, state),
              (std::vector<std::uint32_t>{el::light_enabled::id + 2, el::light_ambient::id + 2}));
}

TEST(LazyDifferences, KeepNothingFromShaders) {
    State state, mirror;
    glstate::assign<el::fog_color>(state, 0, {1, 0, 0, 1});
    EXPECT_TRUE(told_lazily(mirror, state).empty());
    glstate::assign<el::current_program>(state, 0, 7);
    EXPECT_EQ(told_lazily(mirror, state), (std::vector<std::uint32_t>{el::fog_color::id, el::current_program::id}))
        << "its category has not changed since";
}

// Whatever a program does, a mirror has all that matters, and in the end, by a whole difference, everything.
TEST(LazyDifferences, HaveAllThatMatters) {
    std::mt19937 random(3);
    State state, mirror;
    std::size_t waited = 0;
    for (int step = 0; step < 2000; ++step) {
        auto number = static_cast<unsigned>(random() % 400);
        glstate::for_each_element([&]<class E>() {
            if (!E::sent || E::category == glstate::Category::material || number-- != 0) return;
            typename E::type value = E::ref(state, 0);
            auto* bytes = reinterpret_cast<unsigned char*>(&value);
            if constexpr (sizeof value == sizeof(std::uint32_t)) bytes[0] ^= 1;
            else bytes[random() % sizeof value] ^= 1;
            glstate::assign<E>(state, static_cast<unsigned>(random() % E::count), value);
        });
        told_lazily(mirror, state);
        glstate::for_each_element([&]<class E>() {
            if (!E::sent) return;
            for (unsigned i = 0; i < E::count; ++i) {
                const bool equal = glstate::same(E::ref(mirror, i), E::ref(state, i));
                if constexpr (E::waits) {
                    ASSERT_TRUE(equal || !E::matters(state, i)) << E::name << " " << i;
                    waited += !equal;
                } else {
                    ASSERT_TRUE(equal) << E::name << " " << i;
                }
            }
        });
    }
    EXPECT_GT(waited, 1000u) << "it is about something";
    glstate::diff(mirror, state, RecordingSink{});
    expect_equal(mirror, state);
}

TEST(State, IsFollowedUntilItOrItsFollowerChanges) {
    State driver, a, b;
    glstate::assign<el::fog_density>(a, 0, 0.5f);
    glstate::assign<el::fog_density>(b, 0, 0.25f);
    RecordingSink sink;
    const auto bring_to = [&](State& state) {
        glstate::diff_and_unify(driver, state, sink);
        driver.ids.follow(state.ids);
    };
    EXPECT_TRUE(driver.ids.follows(State().ids)) << "both begin with the same values";
    EXPECT_FALSE(driver.ids.follows(a.ids));
    bring_to(a);
    EXPECT_TRUE(driver.ids.follows(a.ids));
    EXPECT_FALSE(driver.ids.follows(b.ids));
    bring_to(b);
    EXPECT_FALSE(driver.ids.follows(a.ids)) << "another has come between";
    bring_to(a);
    glstate::assign<el::fog_density>(driver, 0, 1.0f);
    EXPECT_FALSE(driver.ids.follows(a.ids));
    bring_to(a);
    glstate::assign<el::fog_density>(a, 0, 1.0f);
    EXPECT_FALSE(driver.ids.follows(a.ids));
}

TEST(State, ThatWantsNothingElseIsFollowedAsWell) {
    State driver, a, b;
    for (State* state : {&a, &b}) glstate::assign<el::fog_density>(*state, 0, 0.5f);
    RecordingSink sink;
    for (State* state : {&a, &b}) {
        EXPECT_FALSE(driver.ids.follows(state->ids));
        glstate::diff_and_unify(driver, *state, sink);
        driver.ids.follow(state->ids);
    }
    EXPECT_TRUE(driver.ids.follows(a.ids));
    EXPECT_TRUE(driver.ids.follows(b.ids));
    glstate::assign<el::fog_density>(a, 0, 0.25f);
    EXPECT_FALSE(driver.ids.follows(a.ids));
    EXPECT_TRUE(driver.ids.follows(b.ids));
}

TEST(State, EqualValuesAreUnifiedAtTheFirstComparison) {
    State driver, a, b;
    for (State* state : {&a, &b}) {
        glstate::assign<el::fog_density>(*state, 0, 0.5f);
        glstate::assign<el::modelview>(*state, 0, glstate::Mat4{2});
    }
    ASSERT_FALSE(glstate::same_ids<glstate::kSentCategories>(a, b));
    RecordingSink sink;
    glstate::diff_and_unify(driver, a, sink);
    EXPECT_EQ(sink.ids.size(), 2u);
    EXPECT_TRUE(glstate::same_ids<glstate::kSentCategories>(driver, a));
    glstate::diff_and_unify(driver, b, sink);
    EXPECT_EQ(sink.ids.size(), 2u) << "nothing is told";
    EXPECT_TRUE(glstate::same_ids<glstate::kSentCategories>(a, b));
    glstate::assign<el::fog_density>(b, 0, 0.25f);
    EXPECT_FALSE(glstate::same_ids<glstate::mask_of(glstate::Category::fog)>(a, b));
    EXPECT_TRUE(glstate::same_ids<glstate::mask_of(glstate::Category::matrix)>(a, b));
    glstate::diff_and_unify(driver, b, sink);
    glstate::diff_and_unify(driver, a, sink);
    EXPECT_EQ(sink.ids.size(), 4u) << "there and back";
    EXPECT_EQ(el::fog_density::ref(driver), 0.5f);
}

TEST(State, UnifyingGivesWhatDiffGives) {
    std::mt19937 random(11);
    std::array<State, 3> states;
    State plain, unified;
    for (unsigned round = 0; round < 300; ++round) {
        State& next = states[random() % states.size()];
        scramble(next, random, round % 5 == 0 ? 30 : 1);
        if (random() % 4 == 0) next = states[random() % states.size()];
        RecordingSink told, told_unified;
        glstate::diff(plain, static_cast<const State&>(next), told);
        glstate::diff_and_unify(unified, next, told_unified);
        ASSERT_EQ(told.ids, told_unified.ids) << round;
        expect_equal(next, unified);
    }
}

TEST(State, RandomStatesTravel) {
    std::mt19937 random(7);
    State app, mirror, node;
    glstate::ValueHistory sent, received;
    std::size_t recalled = 0;
    for (unsigned round = 0; round < 300; ++round) {
        scramble(app, random, round % 3 == 0 ? 60 : 2);
        glstate::Mat4 matrix;
        matrix[12] = static_cast<float>(random() % 6);
        glstate::assign<glstate::el::projection>(app, 0, matrix);
        wire::PackBuffer batch;
        glstate::diff(mirror, app, glstate::PackSink{batch, sent});
        receive(batch, node, received, recalled);
        expect_equal(app, mirror);
        expect_equal(app, node);
        RecordingSink again;
        glstate::diff(mirror, app, again);
        EXPECT_TRUE(again.ids.empty());
    }
    EXPECT_GT(recalled, 100u);
}

TEST(State, StatesOfManyContextsMeet) {
    std::mt19937 random(11);
    std::array<State, 4> apps;
    State driver;
    for (unsigned round = 0; round < 400; ++round) {
        State& app = apps[random() % apps.size()];
        scramble(app, random, 5);
        RecordingSink sink;
        glstate::diff(driver, app, sink);
        expect_equal(app, driver);
        glstate::diff(driver, app, sink = {});
        EXPECT_TRUE(sink.ids.empty());
    }
}

TEST(State, EveryElementTravelsAloneAndOnce) {
    for (std::uint32_t id = 1; id <= glstate::kLastSentId; ++id) {
        State from, to;
        std::vector<std::byte> value(glstate::element_bytes(id), std::byte{1});
        ASSERT_TRUE(glstate::apply(to, id, value));
        RecordingSink sink;
        glstate::diff(from, to, sink);
        EXPECT_EQ(sink.ids, std::vector<std::uint32_t>{id}) << glstate::element_info(id).name;
    }
}

TEST(State, LocalElementsNeverTravel) {
    State from, to;
    glstate::assign<el::matrix_mode>(to, 0, GL_PROJECTION);
    glstate::assign<el::pack_alignment>(to, 0, 1);
    RecordingSink sink;
    glstate::diff(from, to, sink);
    EXPECT_TRUE(sink.ids.empty());
    EXPECT_EQ(glstate::element_bytes(el::matrix_mode::id), 0u);
    const std::byte value[4]{};
    EXPECT_FALSE(glstate::apply(to, el::matrix_mode::id, value));
}

TEST(State, EqualValuesAreNoChange) {
    State state;
    const auto ids = state.ids;
    EXPECT_FALSE(glstate::assign<el::fog_density>(state, 0, 1.0f));
    EXPECT_EQ(state.ids, ids);
    EXPECT_TRUE(glstate::assign<el::fog_density>(state, 0, 2.0f));
    EXPECT_NE(state.ids, ids);
}

TEST(State, EqualIdsAreNotCompared) {
    State from, to;
    to.fog.fog_density = 5;  // behind the back of the ids
    RecordingSink sink;
    glstate::diff(from, to, sink);
    EXPECT_TRUE(sink.ids.empty());
}

TEST(State, OnlyTheWantedCategoriesAreCompared) {
    State from, to;
    glstate::assign<el::scissor_enabled>(to, 0, 1);
    glstate::assign<el::blend_enabled>(to, 0, 1);
    RecordingSink sink;
    glstate::diff<glstate::kSentCategories & ~glstate::kLayerCategories>(from, to, sink);
    EXPECT_EQ(sink.ids, std::vector<std::uint32_t>{el::blend_enabled::id});
    glstate::diff_category<glstate::Category::window>(from, to, sink);
    EXPECT_EQ(sink.ids.back(), el::scissor_enabled::id);
}

TEST(State, ElementTableAgreesWithTheTags) {
    State state;
    std::uint32_t next = 1;
    glstate::for_each_element([&]<class E>() {
        const auto& info = glstate::element_info(E::id);
        EXPECT_STREQ(info.name, E::name);
        EXPECT_EQ(E::id, next);
        next += E::count;
        EXPECT_EQ(info.bytes, sizeof(typename E::type));
        for (unsigned i = 0; i < E::count; ++i)
            EXPECT_EQ(reinterpret_cast<std::byte*>(&state) + glstate::element_offset(E::id + i),
                      reinterpret_cast<std::byte*>(&E::ref(state, i)));
    });
    EXPECT_EQ(next, glstate::kLastId + 1);
}

TEST(State, RefusesWrongSizesAndIds) {
    State state;
    const std::vector<std::byte> bytes(256);
    EXPECT_EQ(glstate::element_bytes(0), 0u);
    EXPECT_EQ(glstate::element_bytes(glstate::kLastId + 1), 0u);
    EXPECT_EQ(glstate::element_bytes(~0u), 0u);
    EXPECT_FALSE(glstate::apply(state, el::fog_density::id, std::span(bytes).first(8)));
    EXPECT_FALSE(glstate::apply(state, 0, {}));
    EXPECT_FALSE(glstate::apply(state, ~0u, std::span(bytes).first(4)));
}

TEST(ColorMaterial, TrackedParametersAreNotCompared) {
    State from, to;
    glstate::assign<el::color_material_enabled>(to, 0, 1);
    glstate::assign<el::material_diffuse>(to, 0, {1, 2, 3, 4});   // driven by the colour
    glstate::assign<el::material_specular>(to, 0, {1, 2, 3, 4});  // not
    RecordingSink sink;
    glstate::diff(from, to, sink);
    EXPECT_EQ(sink.ids, (std::vector<std::uint32_t>{el::color_material_enabled::id, el::material_specular::id}));
}

TEST(ColorMaterial, EndOfTrackingLeavesTheCurrentColor) {
    State app, node;
    glstate::assign<el::color_material_enabled>(app, 0, 1);
    RecordingSink sink;
    glstate::diff(node, app, sink);
    for (State* s : {&app, &node})
        glstate::assign<el::color>(*s, 0, {0.5f, 0.25f, 0, 1});  // as a block does on both sides
    glstate::assign<el::color_material_enabled>(app, 0, 0);
    EXPECT_EQ(app.material.material_diffuse[1], (glstate::Vec4{0.5f, 0.25f, 0, 1}));
    glstate::diff(node, app, sink = {});
    EXPECT_EQ(node.material.material_ambient[0], (glstate::Vec4{0.5f, 0.25f, 0, 1}));
    expect_equal(app, node);
    EXPECT_EQ(sink.ids.back(), el::color_material_enabled::id);  // the driver has the colour already
}

TEST(ColorMaterial, MovingLeavesTheCurrentColorBehind) {
    State s;
    glstate::assign<el::color>(s, 0, {0.5f, 0.5f, 0.5f, 1});
    glstate::assign<el::color_material_enabled>(s, 0, 1);
    glstate::assign<el::color_material>(s, 0, {GL_FRONT, GL_SPECULAR});
    EXPECT_EQ(s.material.material_diffuse[0], (glstate::Vec4{0.5f, 0.5f, 0.5f, 1}));
    EXPECT_EQ(s.material.material_specular[0], (glstate::Vec4{0, 0, 0, 1}));
    EXPECT_TRUE(glstate::follows_color<el::material_specular>(s, 0));
    EXPECT_FALSE(glstate::follows_color<el::material_specular>(s, 1));
}

TEST(Groups, HoldWhatTheSpecificationSays) {
    const auto names = [](GLbitfield mask) {
        std::vector<std::string> out;
        glstate::for_each_in_group(mask, [&]<class E>(unsigned i) {
            if (i == 0) out.emplace_back(E::name);
        });
        return out;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(names(GL_DEPTH_BUFFER_BIT), (Names{"depth_test", "depth_func", "depth_mask", "clear_depth"}));
    EXPECT_EQ(names(GL_VIEWPORT_BIT), (Names{"depth_range", "depth_range_rest", "viewport", "viewport_rest"}));
    EXPECT_EQ(names(GL_LINE_BIT), (Names{"line_smooth", "line_stipple_enabled", "line_width", "line_stipple"}));
    EXPECT_EQ(names(GL_LIST_BIT), (Names{"list_base"}));
    EXPECT_EQ(names(GL_SCISSOR_BIT), (Names{"scissor", "scissor_rest", "scissor_enabled"}));
    EXPECT_EQ(names(GL_ACCUM_BUFFER_BIT), (Names{"clear_accum"}));
    EXPECT_EQ(names(GL_POLYGON_STIPPLE_BIT), (Names{"polygon_stipple"}));
    const auto enables = names(GL_ENABLE_BIT);
    glstate::for_each_element([&]<class E>() {  // every glEnable word of the server is in the enable group
        const bool is_cap = std::ranges::any_of(glstate::kCapEntries, [](const auto& e) { return e.id == E::id; });
        EXPECT_EQ(is_cap && (E::sent || E::id == glstate::el::rasterizer_discard::id), (E::groups & GL_ENABLE_BIT) != 0)
            << E::name;
    });
}

TEST(Queries, TablesAreSortedAndComplete) {
    for (std::size_t n = 1; n < glstate::kGetEntries.size(); ++n)
        EXPECT_LT(glstate::kGetEntries[n - 1].pname, glstate::kGetEntries[n].pname);
    for (std::size_t n = 1; n < glstate::kCapEntries.size(); ++n)
        EXPECT_LT(glstate::kCapEntries[n - 1].cap, glstate::kCapEntries[n].cap);
    EXPECT_EQ(glstate::find_get(GL_FOG_DENSITY)->id, el::fog_density::id);
    EXPECT_EQ(glstate::find_get(GL_STENCIL_BACK_REF)->id, el::stencil_func::id + 1);
    EXPECT_EQ(glstate::find_get(0x12345), nullptr);
    EXPECT_EQ(glstate::find_cap(GL_LIGHT5)->id, el::light_enabled::id + 5);
    EXPECT_EQ(glstate::find_cap(GL_TEXTURE_GEN_R)->id + 3 * glstate::find_cap(GL_TEXTURE_GEN_R)->unit_stride,
              el::tex_gen_enabled::id + 14);
    EXPECT_EQ(glstate::find_param(glstate::ParamFamily::TexEnv, GL_TEXTURE_ENV, GL_COMBINE_RGB)->id,
              el::combine_rgb::id);
}

}  // namespace
}  // namespace wall
