// SPDX-License-Identifier: MIT
#include "walld/streams/snapshot_desk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/config/load_config.h"
#include "common/wire/limits.h"
#include "tests/support/small_wall.h"

namespace wall::walld {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class SnapshotRequests : public NoOutbox {
public:
    void to_node(NodeIndex node, const proto::Envelope& message) override {
        if (message.has_snapshot_request()) asked.emplace_back(node, message.snapshot_request());
    }
    std::vector<std::pair<NodeIndex, proto::SnapshotRequest>> asked;
};

class SnapshotDeskTest : public ::testing::Test {
protected:
    void SetUp() override {
        for (const char* name : {"left", "right"}) {
            proto::NodeHello hello;
            hello.set_version(wire::kProtocolVersion);
            hello.set_name(name);
            hello.set_address(std::string("unix:/tmp/") + name);
            ASSERT_TRUE(wall_.node_joins(hello, {}));
        }
    }
    struct Taken {
        std::optional<Outcome<Png>> result;
        std::string error() const { return result && !*result ? result->error().message : "(none)"; }
    };
    std::shared_ptr<Taken> take(const std::string& tile) {
        auto taken = std::make_shared<Taken>();
        SnapshotQuery query{.tile = tile, .target = {}};
        asio::co_spawn(io_, desk_.take(std::move(query)), [taken](std::exception_ptr failure, Outcome<Png> result) {
            ASSERT_FALSE(failure);
            taken->result = std::move(result);
        });
        go_on();
        return taken;
    }
    /// What a node sends for a request, from a byte on, in all of the tile's colour.
    void send(const std::pair<NodeIndex, proto::SnapshotRequest>& asked, char color, std::size_t offset = 0,
              std::size_t most = SIZE_MAX) {
        constexpr std::size_t kBytes = 640 * 480 * 3;
        proto::Snapshot snapshot;
        snapshot.set_request(asked.second.request());
        snapshot.set_width(640);
        snapshot.set_height(480);
        snapshot.set_offset(offset);
        snapshot.set_rgb(std::string(std::min(most, kBytes - offset), color));
        desk_.arrived(asked.first, snapshot);
        go_on();
    }
    /// Everything that was asked of the nodes since the last time.
    auto asked() { return std::exchange(out_.asked, {}); }
    void answer_all(char color) {
        for (const auto& request : asked()) send(request, color);
    }
    void go_on() {
        io_.restart();
        io_.poll();
    }
    /// Composing is another thread's.
    void wait_for(const Taken& taken) {
        for (const auto until = Clock::now() + 20s; !taken.result && Clock::now() < until;) {
            io_.restart();
            io_.run_for(5ms);
        }
    }
    static int first_pixel(const Taken& taken) {
        if (!taken.result || !*taken.result) return -1;
        const std::string& png = ***taken.result;
        return cv::imdecode(cv::Mat(1, static_cast<int>(png.size()), CV_8U, const_cast<char*>(png.data())),
                            cv::IMREAD_COLOR)
            .at<cv::Vec3b>(0, 0)[0];
    }

    asio::io_context io_;
    SnapshotRequests out_;
    Wall wall_{*config::parse_config(kTwoNodes, "test"), out_, [](std::size_t n) { return std::string(n, 'x'); }};
    SnapshotDesk desk_{io_.get_executor(), wall_, out_};
};

TEST_F(SnapshotDeskTest, ManyWhoWantTheSameShareAFewPictures) {
    std::vector<std::shared_ptr<Taken>> taken;
    for (int i = 0; i < 250; ++i) taken.push_back(take("l"));
    EXPECT_EQ(out_.asked.size(), 2u) << "two are made at once, and one waits for all who came after those";
    answer_all('\x40');
    wait_for(*taken[0]);
    EXPECT_EQ(out_.asked.size(), 1u);
    answer_all('\x40');
    for (const auto& one : taken) wait_for(*one);
    std::set<const std::string*> pictures;
    for (const auto& one : taken) {
        ASSERT_TRUE(one->result && *one->result) << one->error();
        pictures.insert((*one->result)->get());
    }
    EXPECT_EQ(pictures.size(), 3u) << "nor are there 250 copies";
    EXPECT_TRUE(asked().empty());
}

TEST_F(SnapshotDeskTest, WhoComesLaterDoesNotGetAnOlderPicture) {
    const auto first = take("l");
    const auto begun = asked();
    ASSERT_EQ(begun.size(), 1u);
    send(begun[0], '\x10', 0, 3);
    const auto second = take("l");
    ASSERT_EQ(out_.asked.size(), 1u) << "the node is asked anew";
    answer_all('\x20');
    send(begun[0], '\x10', 3);
    wait_for(*first);
    wait_for(*second);
    EXPECT_EQ(first_pixel(*first), 0x10);
    EXPECT_EQ(first_pixel(*second), 0x20);
}

TEST_F(SnapshotDeskTest, TheLineHasAnEndAndSaysSo) {
    // Pictures of different things: the line is not shortened by sharing. The nodes do not answer.
    take("l"), take("r");
    std::vector<std::shared_ptr<Taken>> waiting;
    for (std::size_t i = 0; i < SnapshotDesk::kMaxWaiting; ++i) waiting.push_back(take("none " + std::to_string(i)));
    const auto late = take("late");
    ASSERT_TRUE(late->result);
    EXPECT_EQ(late->result->error().kind, RefusalKind::busy);
    EXPECT_THAT(late->error(), HasSubstr("32 pictures of this wall wait to be made already"));
    EXPECT_FALSE(take("none 1")->result) << "who wants one of those can wait for it";
    EXPECT_EQ(out_.asked.size(), 2u) << "no more than two are made at once";
    answer_all('\x40');
    for (const auto& one : waiting) wait_for(*one);
    EXPECT_THAT(waiting.front()->error(), HasSubstr("there is no tile 'none 0'"));
    EXPECT_THAT(waiting.back()->error(), HasSubstr("there is no tile 'none 31'"));
}

TEST_F(SnapshotDeskTest, ATileComesInPartsInOrder) {
    const auto taken = take("l");
    const auto request = asked().at(0);
    for (std::size_t offset = 0; offset < 640 * 480 * 3; offset += 100'000) {
        EXPECT_FALSE(taken->result);
        send(request, '\x55', offset, 100'000);
    }
    wait_for(*taken);
    EXPECT_EQ(first_pixel(*taken), 0x55);
}

TEST_F(SnapshotDeskTest, ATileWhosePartsDoNotFitIsLeftOut) {
    for (const std::size_t wrong : {std::size_t{0}, std::size_t{5}, std::size_t{640 * 480 * 3}}) {
        const auto taken = take("l");
        const auto request = asked().at(0);
        send(request, '\x55', 0, 3);
        send(request, '\x55', wrong, 3);
        wait_for(*taken);
        EXPECT_EQ(first_pixel(*taken), 0) << "the background";
    }
}

TEST_F(SnapshotDeskTest, ANodeThatLeavesInTheMiddleIsLeftOut) {
    const auto taken = take("");
    const auto requests = asked();
    ASSERT_EQ(requests.size(), 2u);
    send(requests[0], '\x55', 0, 3);
    send(requests[1], '\x66');
    desk_.node_left(kLeft);
    wait_for(*taken);
    EXPECT_EQ(first_pixel(*taken), 0);
    send(requests[0], '\x55', 3);  // comes too late for anything
}

TEST_F(SnapshotDeskTest, OneTileOfANodeThatIsAwayIsRefused) {
    wall_.node_leaves(kLeft, Clock::now());
    const auto one = take("l"), all = take("");
    ASSERT_TRUE(one->result);
    EXPECT_EQ(one->result->error().kind, RefusalKind::unavailable);
    EXPECT_THAT(one->error(), HasSubstr("node left, which shows tile l, is away"));
    answer_all('\x55');
    wait_for(*all);
    EXPECT_EQ(first_pixel(*all), 0) << "of the whole wall there is a picture, without that tile";
}

}  // namespace
}  // namespace wall::walld
