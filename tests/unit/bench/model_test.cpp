// SPDX-License-Identifier: MIT
// Walls so simple that what they do can be said without a model.
#include "bench/simulate/model.h"

#include <gtest/gtest.h>

namespace wall::simulate {
namespace {

constexpr double kMega = 1e6, kClose = 1e-6;
constexpr NodeIndex k0(0), k1(1), k2(2), k3(3);

/// A program on a machine of its own, and so many nodes on one each; every frame is the same.
Scene one_program(std::uint32_t nodes, Frame frame) {
    Scene scene;
    scene.hosts.resize(nodes + 1);
    scene.hosts[0].processors = 2;
    for (std::uint32_t n = 0; n < nodes; ++n) scene.nodes.push_back(n + 1);
    scene.programs.push_back({.members = {{.host = 0, .frames = {std::move(frame)}}}});
    return scene;
}

double rate_of(const Scene& scene, std::size_t program = 0) {
    const auto figures = simulate(scene);
    EXPECT_TRUE(figures.has_value()) << (figures ? "" : figures.error().message);
    return figures ? figures->programs[program].frames_per_second : 0;
}

TEST(Model, TheSlowerOfProgramAndNodeDecides) {
    EXPECT_NEAR(rate_of(one_program(1, {.pack = 0.02, .messages = {{.node = k0, .draw = 0.01}}})), 50, 1e-3);
    EXPECT_NEAR(rate_of(one_program(1, {.pack = 0.01, .messages = {{.node = k0, .draw = 0.03, .finish = 0.01}}})), 25,
                1e-3);
}

TEST(Model, OneFrameOnItsWayMeansOneAfterTheOther) {
    Scene scene = one_program(1, {.pack = 0.01, .send = 0.005, .messages = {{.node = k0, .draw = 0.02}}});
    scene.programs[0].ahead = 1;
    EXPECT_NEAR(rate_of(scene), 1 / 0.035, 1e-3);
}

TEST(Model, ALinkCarriesNoMoreThanItsRate) {
    Scene scene = one_program(4, {.messages = {{k0, kMega}, {k1, kMega}, {k2, kMega}, {k3, kMega}}});
    scene.hosts[0].up = 100 * kMega;  // 4 MB a frame
    EXPECT_NEAR(rate_of(scene), 25, 1e-3);
    scene.hosts[0].up = kUnlimited;
    scene.hosts[2].down = 10 * kMega;  // 1 MB a frame, of one of them
    EXPECT_NEAR(rate_of(scene), 10, 1e-3);
}

TEST(Model, ASwitchPassesOnWhatHasNotAllCome) {
    Scene scene = one_program(1, {.messages = {{.node = k0, .bytes = kMega}}});
    scene.programs[0].ahead = 1;
    scene.piece = 2 * kMega;  // in one piece
    scene.hosts[0].up = scene.hosts[1].down = 100 * kMega;
    scene.latency = 0.001;
    const auto figures = simulate(scene);
    ASSERT_TRUE(figures);
    EXPECT_NEAR(figures->programs[0].delay, 0.011, kClose);
    EXPECT_NEAR(figures->programs[0].frames_per_second, 1 / 0.012, 1e-3);  // the word that it is drawn goes back
}

TEST(Model, APieceGoesBeforeTheRestIsPacked) {
    Scene scene = one_program(1, {.pack = 0.01, .messages = {{.node = k0, .bytes = kMega}}});
    scene.programs[0].ahead = 1;
    scene.hosts[0].up = 100 * kMega;  // as long as it is packed
    scene.piece = kMega / 10;
    const auto figures = simulate(scene);
    ASSERT_TRUE(figures);
    EXPECT_NEAR(figures->programs[0].delay, 0.011, kClose);
}

TEST(Model, ProcessorsAreSharedEvenly) {
    Scene scene = one_program(4, {.messages = {{.node = k0, .draw = 0.01},
                                               {.node = k1, .draw = 0.01},
                                               {.node = k2, .draw = 0.01},
                                               {.node = k3, .draw = 0.01}}});
    for (auto& host : scene.nodes) host = 1;  // on one machine
    scene.hosts[1].processors = 2;
    const auto figures = simulate(scene);
    ASSERT_TRUE(figures);
    EXPECT_NEAR(figures->programs[0].frames_per_second, 50, 1e-3);
    EXPECT_NEAR(figures->hosts[1].processors, 1, 0.01);
    scene.hosts[1].processors = 8;  // more than there are nodes
    EXPECT_NEAR(rate_of(scene), 100, 1e-3);
}

TEST(Model, SeveralHostsMayRunOnOneMachine) {
    Scene scene =
        one_program(4, {.pack = 0.02, .messages = {{k0, 1, 0.02}, {k1, 1, 0.02}, {k2, 1, 0.02}, {k3, 1, 0.02}}});
    for (std::uint32_t host = 1; host <= 4; ++host) scene.hosts[host].runs_on = 0;
    EXPECT_NEAR(rate_of(scene), 20, 0.1);  // 0.1 s of work on two processors
    scene.hosts[2].down = 10;              // and each has its own link
    EXPECT_NEAR(rate_of(scene), 10, 0.1);
}

TEST(Model, ProgramsShareANodeInTurn) {
    Scene scene = one_program(1, {.messages = {{.node = k0, .draw = 0.01}}});
    scene.hosts.push_back({});
    scene.programs.push_back({.members = {{.host = 2, .frames = {{.messages = {{.node = k0, .draw = 0.01}}}}}}});
    EXPECT_NEAR(rate_of(scene, 0), 50, 1);
    EXPECT_NEAR(rate_of(scene, 1), 50, 1);
}

/// What waits at one program's slow link does not keep another's from the node.
TEST(Model, ASlowLinkIsItsOwn) {
    Scene scene = one_program(1, {.messages = {{.node = k0, .bytes = kMega}}});
    scene.hosts[0].up = kMega;
    scene.hosts[1].down = 1000 * kMega;
    scene.hosts.push_back({.processors = 1, .up = 100 * kMega});
    scene.programs.push_back({.members = {{.host = 2, .frames = {{.messages = {{.node = k0, .bytes = kMega}}}}}}});
    EXPECT_NEAR(rate_of(scene, 0), 1, 0.01);
    EXPECT_NEAR(rate_of(scene, 1), 100, 1);
}

TEST(Model, AParallelProgramIsAsFastAsItsSlowestMember) {
    Scene scene = one_program(2, {.pack = 0.01, .messages = {{.node = k0, .draw = 0.004}, {.node = k1}}});
    scene.hosts.push_back({});
    scene.programs[0].members.push_back(
        {.host = 3, .frames = {{.pack = 0.025, .messages = {{.node = k0, .draw = 0.004}, {.node = k1}}}}});
    EXPECT_NEAR(rate_of(scene), 40, 1e-3);
    scene.programs[0].members[1].frames[0].pack = 0.001;
    scene.programs[0].members[0].frames[0].pack = 0.001;
    EXPECT_NEAR(rate_of(scene), 125, 1e-3);  // both draw on node 0
    for (auto& member : scene.programs[0].members) member.frames[0].messages[0].finish = 0.002;
    EXPECT_NEAR(rate_of(scene), 100, 1e-3);  // which ends each frame once
}

TEST(Model, FramesComeAgainInTurn) {
    Scene scene = one_program(1, {.pack = 0.01, .messages = {{.node = k0, .bytes = 10}}});
    scene.programs[0].members[0].frames.push_back({.pack = 0.03, .messages = {{.node = k0, .bytes = 30}}});
    const auto figures = simulate(scene);
    ASSERT_TRUE(figures);
    EXPECT_NEAR(figures->programs[0].frames_per_second, 50, 1);
    EXPECT_NEAR(figures->programs[0].longest, 0.03, kClose);
    EXPECT_NEAR(figures->programs[0].bytes_per_frame, 20, kClose);
}

TEST(Model, TheSameSceneGivesTheSameAnswer) {
    Scene scene = one_program(64, {});
    for (std::uint32_t f = 0; f < 3; ++f) {
        Frame frame{.pack = 0.001 * (f + 1), .send = 0.001, .messages = {}};
        for (std::uint32_t n = 0; n < 64; n += f + 1)
            frame.messages.push_back({NodeIndex(n), 1000.0 * n, 1e-5 * n, 1e-4});
        scene.programs[0].members[0].frames.push_back(std::move(frame));
    }
    scene.hosts[0].up = 10 * kMega;
    const auto once = simulate(scene), again = simulate(scene);
    ASSERT_TRUE(once && again);
    EXPECT_EQ(once->time, again->time);
    EXPECT_EQ(once->events, again->events);
}

TEST(Model, SaysWhatIsOutOfRange) {
    const auto said = [](auto&& spoil) {
        Scene scene = one_program(1, {.messages = {{.node = k0}}});
        spoil(scene);
        const auto figures = simulate(scene);
        return figures ? std::string() : figures.error().message;
    };
    EXPECT_EQ(said([](Scene&) {}), "");
    EXPECT_EQ(said([](Scene& s) { s.nodes[k0] = 9; }), "node 0: there is no host 9");
    EXPECT_EQ(said([](Scene& s) { s.hosts[1].down = 0; }), "host 1: up, down: expected bytes a second, more than 0");
    EXPECT_EQ(said([](Scene& s) { s.hosts[0].processors = 0; }), "host 0: processors: expected more than 0");
    EXPECT_EQ(said([](Scene& s) { s.frames = s.warm_up; }),
              "frames: 8, expected more than warm_up, which is at least 1");
    EXPECT_EQ(said([](Scene& s) { s.programs[0].members[0].frames[0].messages[0].node = k1; }),
              "program 0: there is no node 1");
    EXPECT_EQ(said([](Scene& s) { s.programs[0].members[0].frames[0].pack = -1; }),
              "program 0: pack, send: expected seconds, at least 0");
    EXPECT_EQ(said([](Scene& s) { s.hosts[1].runs_on = 1; }),
              "host 1: runs_on: expected a host with processors of its own");
    EXPECT_EQ(said([](Scene& s) { s.programs[0].members[0].frames[0].messages[0].bytes = 1e30; }),
              "program 0: bytes: expected at most a million pieces");
    EXPECT_EQ(said([](Scene& s) { s.programs[0].members.clear(); }), "program 0: expected a member at least");
}

}  // namespace
}  // namespace wall::simulate
