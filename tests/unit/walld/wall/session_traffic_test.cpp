// SPDX-License-Identifier: MIT
#include "walld/wall/session_traffic.h"

#include <gtest/gtest.h>

#include "walld/wall/spread.h"

namespace wall::walld {
namespace {

using std::chrono::milliseconds;

proto::ClientStats report(std::uint64_t frames, std::initializer_list<SentBytes> nodes) {
    proto::ClientStats out;
    out.set_frames(frames);
    for (std::uint32_t i = 0; const auto& bytes : nodes) {
        auto& row = *out.add_nodes();
        row.set_node(i++);
        row.set_state_bytes(bytes.state);
        row.set_object_bytes(bytes.object);
        row.set_geometry_bytes(bytes.geometry);
    }
    return out;
}

class Traffic : public ::testing::Test {
protected:
    SessionTraffic::Clock::time_point at(int ms) const {
        return SessionTraffic::Clock::time_point{} + milliseconds(ms);
    }
    SessionTraffic traffic_;
};

TEST_F(Traffic, RatesAreThoseBetweenTheLastTwoReports) {
    traffic_.note(0, report(10, {{100, 5000, 0}}), 2, at(1000));
    EXPECT_EQ(traffic_.rates().state, 0) << "one report says nothing of a rate";
    traffic_.note(0, report(30, {{200, 5000, 1000}, {50, 0, 800}}), 2, at(1500));
    EXPECT_EQ(traffic_.sent(), (SentBytes{250, 5000, 1800}));
    EXPECT_DOUBLE_EQ(traffic_.rates().state, 300);
    EXPECT_DOUBLE_EQ(traffic_.rates().object, 0);
    EXPECT_DOUBLE_EQ(traffic_.rates().geometry, 3600);
    EXPECT_DOUBLE_EQ(traffic_.rates().frame_bytes, 97.5);
    traffic_.note(0, report(30, {{200, 5000, 1000}, {50, 0, 800}}), 2, at(2500));
    EXPECT_DOUBLE_EQ(traffic_.rates().geometry, 0);
    EXPECT_DOUBLE_EQ(traffic_.rates().frame_bytes, 0) << "no frame, no mean";
}

TEST_F(Traffic, VerticesOfAllProcessesCount) {
    auto first = report(1, {}), second = report(1, {});
    first.set_lossy_vertices(5);
    second.set_lossy_vertices(6);
    traffic_.note(0, first, 2, at(0));
    traffic_.note(1, second, 2, at(0));
    EXPECT_EQ(traffic_.lossy_vertices(), 11u);
}

TEST_F(Traffic, NodesThatTheWallHasNotArePassedOver) {
    traffic_.note(0, report(1, {{1, 1, 1}, {2, 2, 2}, {4, 4, 4}}), 2, at(0));
    EXPECT_EQ(traffic_.sent(), (SentBytes{3, 3, 3}));
    EXPECT_EQ(traffic_.by_node().size(), 2u);
}

TEST_F(Traffic, ACounterThatGoesBackHasNoNegativeRate) {
    traffic_.note(0, report(10, {{100, 100, 100}}), 1, at(0));
    traffic_.note(0, report(0, {{1, 1, 1}}), 1, at(1000));
    EXPECT_EQ(traffic_.rates().state, 0);
    EXPECT_EQ(traffic_.rates().frame_bytes, 0);
}

TEST_F(Traffic, TheProcessesOfAParallelProgramAreAddedUp) {
    for (std::uint32_t rank = 0; rank < 2; ++rank) traffic_.note(rank, report(10, {{100, 0, 0}}), 1, at(0));
    traffic_.note(0, report(20, {{200, 0, 1000}}), 1, at(1000));
    traffic_.note(1, report(19, {{100, 0, 3000}}), 1, at(500));
    EXPECT_EQ(traffic_.sent(), (SentBytes{300, 0, 4000}));
    EXPECT_EQ(traffic_.by_node().at(NodeIndex(0)), (SentBytes{300, 0, 4000}));
    EXPECT_EQ(traffic_.frames(), 20u) << "they draw the same frames";
    EXPECT_DOUBLE_EQ(traffic_.rates().geometry, 7000);
}

TEST(SpreadHistogram, CountsEveryFrameOnce) {
    Spread spread;
    const Spread::Clock::time_point start{};
    const int times[] = {0, 1, 5, 300};  // ms
    for (std::uint32_t frame = 1; const int ms : times) {
        spread.note(frame, 2, start);
        spread.note(frame++, 2, start + milliseconds(ms));
    }
    EXPECT_DOUBLE_EQ(spread.sum().count(), 306);
    EXPECT_EQ(spread.histogram(), (Spread::Histogram{1, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1}))
        << "a bound belongs to its bucket";
}

}  // namespace
}  // namespace wall::walld
