// SPDX-License-Identifier: MIT
// The client's link to walld against libprotobuf's own code for the same messages, over a real socket.
#include "client_lib/link/control.h"

#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <future>
#include <thread>

#include "client_lib/link/node_greeting.h"
#include "client_lib/process/stats.h"
#include "common/wire/limits.h"
#include "gen/glapi/wire.gen.h"
#include "proto/control.pb.h"

namespace wall::client {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

std::string framed(const proto::Envelope& envelope) {
    const auto bytes = envelope.SerializeAsString();
    const auto size = static_cast<std::uint32_t>(bytes.size());
    return std::string(reinterpret_cast<const char*>(&size), 4) + bytes;
}

proto::Envelope full_welcome() {
    proto::Envelope envelope;
    auto* welcome = envelope.mutable_client_welcome();
    welcome->set_session(7);
    welcome->set_canvas_width(2048);
    welcome->set_canvas_height(1536);
    for (std::uint32_t i = 0; i < 2; ++i) {
        auto* tile = welcome->add_tiles();
        tile->set_node(i);
        tile->set_slot(3);
        tile->mutable_rect()->set_x(-5);
        tile->mutable_rect()->set_width(1024);
        tile->mutable_rect()->set_height(768);
        tile->set_name("left");
        auto* node = welcome->add_nodes();
        node->set_node(i);
        node->set_address("unix:/run/node");
        node->set_ticket(std::string("\0\xff ticket", 9));
        node->set_incarnation(300);
    }
    auto* caps = welcome->mutable_caps();
    caps->set_vendor("Mesa");
    caps->set_renderer("llvmpipe");
    caps->set_version("4.5");
    caps->set_shading_language_version("4.50");
    caps->set_extensions("GL_ARB_a GL_ARB_b");
    auto* limit = caps->add_limits();
    limit->set_name(0x0D33);
    limit->add_values(8192);
    limit = caps->add_limits();
    limit->set_name(0x846E);
    limit->add_values(1);
    limit->add_values(255.5);
    return envelope;
}

/// walld, as far as one client sees it: a listening socket and one connection.
class FakeWalld {
public:
    FakeWalld()
        : path_(std::filesystem::temp_directory_path() /
                ("wallgl_control_" + std::to_string(getpid()) + "_" + std::to_string(++made_))) {
        listen();
    }
    ~FakeWalld() {
        stop_listening();
        hang_up();
    }
    std::string address() const { return "unix:" + path_.string(); }
    void listen() {
        std::filesystem::remove(path_);
        listener_ = UniqueFd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path_.string().copy(address.sun_path, sizeof address.sun_path - 1);
        ASSERT_EQ(::bind(listener_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
        ASSERT_EQ(::listen(listener_.get(), 8), 0);
    }
    void stop_listening() {
        listener_.reset();
        std::filesystem::remove(path_);
    }
    void accept() { peer_ = UniqueFd(::accept(listener_.get(), nullptr, nullptr)); }
    void hang_up() { peer_.reset(); }
    void send(const std::string& bytes) {
        EXPECT_EQ(::send(peer_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
    }
    void send(const proto::Envelope& envelope) { send(framed(envelope)); }
    /// The next message; what the program tells by the clock is passed over.
    proto::Envelope receive() {
        for (;;)
            if (auto envelope = receive_any(); !envelope.has_client_stats() && !envelope.has_ping()) return envelope;
    }
    proto::Envelope receive_any() {
        std::uint32_t size = 0;
        proto::Envelope envelope;
        if (::recv(peer_.get(), &size, 4, MSG_WAITALL) != 4) return envelope;
        std::string bytes(size, '\0');
        EXPECT_EQ(::recv(peer_.get(), bytes.data(), size, MSG_WAITALL), static_cast<ssize_t>(size));
        EXPECT_TRUE(envelope.ParseFromString(bytes));
        return envelope;
    }
    /// Takes one client and welcomes it; answers its hello.
    proto::ClientHello welcome() {
        accept();
        auto hello = receive().client_hello();
        send(full_welcome());
        return hello;
    }

private:
    static inline int made_ = 0;
    std::filesystem::path path_;
    UniqueFd listener_, peer_;
};

Hello some_hello() {
    Hello hello;
    hello.pid = 4711;
    hello.program = "glxgears";
    hello.name = "left gears";
    hello.rect = geom::Rect{-10, 20, 640, 480};
    return hello;
}

struct Linked {
    FakeWalld walld;
    proto::ClientHello hello;
    std::unique_ptr<ControlLink> link;

    explicit Linked(const Hello& wanted = some_hello()) {
        std::thread server([&] { hello = walld.welcome(); });
        auto opened = ControlLink::open(wanted, walld.address());
        server.join();
        EXPECT_TRUE(opened) << opened.error().message;
        if (opened) link = std::move(*opened);
    }
};

template <class Done>
ControlLink::Events collect(ControlLink& link, Done done) {
    ControlLink::Events all;
    for (int i = 0; i < 500 && !done(all); ++i) {
        auto some = link.take_events();
        for (auto& p : some.placements) all.placements.push_back(p);
        for (auto& n : some.node_changes) all.node_changes.push_back(n);
        all.lost |= some.lost;
        all.moved |= some.moved;
        all.asked_to_move |= some.asked_to_move;
        if (some.reconnected) all.reconnected = some.reconnected;
        std::this_thread::sleep_for(10ms);
    }
    return all;
}

TEST(ControlMessages, HelloIsWhatProtobufReads) {
    auto hello = some_hello();
    hello.hold = true;
    proto::Envelope envelope;
    ASSERT_TRUE(envelope.ParseFromString(encode(hello)));
    const auto& read = envelope.client_hello();
    EXPECT_EQ(read.version(), wire::kProtocolVersion);
    EXPECT_EQ(read.pid(), 4711u);
    EXPECT_EQ(read.program(), "glxgears");
    EXPECT_EQ(read.name(), "left gears");
    EXPECT_EQ(read.rect().x(), -10);
    EXPECT_EQ(read.rect().y(), 20);
    EXPECT_EQ(read.rect().width(), 640u);
    EXPECT_EQ(read.rect().height(), 480u);
    EXPECT_FALSE(read.fullscreen());
    EXPECT_TRUE(read.hold());
    EXPECT_FALSE(read.has_lossy_pixels());

    hello.rect.reset();
    hello.fullscreen = true;
    hello.lossy_pixels = 0;
    ASSERT_TRUE(envelope.ParseFromString(encode(hello)));
    EXPECT_TRUE(envelope.client_hello().has_lossy_pixels()) << "none is something else than what the wall has";
    EXPECT_FALSE(envelope.client_hello().has_rect());
    EXPECT_TRUE(envelope.client_hello().fullscreen());
}

TEST(ControlMessages, SurfacesAreWhatProtobufReads) {
    proto::Envelope envelope;
    ASSERT_TRUE(envelope.ParseFromString(
        encode_surface_open(SurfaceId(3), {300, 200, "gears", NativeWindow{":7", 0x1400003}})));
    EXPECT_EQ(envelope.surface_open().surface(), 3u);
    EXPECT_EQ(envelope.surface_open().width(), 300u);
    EXPECT_EQ(envelope.surface_open().height(), 200u);
    EXPECT_EQ(envelope.surface_open().title(), "gears");
    EXPECT_EQ(envelope.surface_open().native().display(), ":7");
    EXPECT_EQ(envelope.surface_open().native().id(), 0x1400003u);
    ASSERT_TRUE(envelope.ParseFromString(encode_surface_resize(SurfaceId(3), 301, 201)));
    EXPECT_EQ(envelope.surface_resize().width(), 301u);
    ASSERT_TRUE(envelope.ParseFromString(encode_surface_close(SurfaceId(9))));
    EXPECT_EQ(envelope.surface_close().surface(), 9u);
    proto::DataHello data;
    ASSERT_TRUE(data.ParseFromString(encode_data_hello(SessionId(7), std::string_view("\0x", 2), 3)));
    EXPECT_EQ(data.version(), glapi::kStreamVersion);  // which nodes ask for (tileserver/io/data_stream.cpp)
    EXPECT_EQ(data.session(), 7u);
    EXPECT_EQ(data.rank(), 3u);
    EXPECT_EQ(data.ticket(), std::string("\0x", 2));
}

TEST(ControlMessages, WhatAnEarlierWalldKnewIsWhatProtobufReads) {
    auto hello = some_hello();
    hello.resume = {SessionId(7), {{NodeIndex(0), "a"}, {NodeIndex(3), std::string("\0\xff", 2)}}, 2};
    proto::Envelope envelope;
    ASSERT_TRUE(envelope.ParseFromString(encode(hello)));
    const auto& resume = envelope.client_hello().resume();
    EXPECT_EQ(resume.session(), 7u);
    EXPECT_EQ(resume.windows(), 2u);
    ASSERT_EQ(resume.tickets_size(), 2);
    EXPECT_EQ(resume.tickets(1).node(), 3u);
    EXPECT_EQ(resume.tickets(1).ticket(), std::string("\0\xff", 2));
    const Restore restore{{-5, 1, 30, 40}, {5, 6, 70, 80}, 9, std::string("n\0te", 4), {}};
    ASSERT_TRUE(envelope.ParseFromString(encode_surface_open(SurfaceId(3), {300, 200, "gears", {}}, restore)));
    const auto& read = envelope.surface_open();
    EXPECT_EQ(read.title(), "gears");
    EXPECT_EQ(read.restore().drawn().x(), -5);
    EXPECT_EQ(read.restore().wanted().height(), 80u);
    EXPECT_EQ(read.restore().wanted_version(), 9u);
    EXPECT_EQ(read.restore().note(), std::string("n\0te", 4));
    ASSERT_TRUE(envelope.ParseFromString(encode_ping()));
    EXPECT_TRUE(envelope.has_ping());
    envelope.mutable_surface_note()->set_surface(4);
    envelope.mutable_surface_note()->set_note("kept");
    const auto message = decode_from_walld(envelope.SerializeAsString());
    ASSERT_TRUE(message);
    EXPECT_EQ(std::get<SurfaceNote>(*message).surface, SurfaceId(4));
    EXPECT_EQ(std::get<SurfaceNote>(*message).note, "kept");
}

TEST(ControlMessages, TrafficIsWhatProtobufReads) {
    constexpr std::uint64_t kMany = std::uint64_t{1} << 40;
    proto::Envelope envelope;
    ASSERT_TRUE(envelope.ParseFromString(encode(
        Traffic{600, 7, 9, std::chrono::nanoseconds(kMany), {{NodeIndex(0), 1, 2, 3}, {NodeIndex(4), kMany, 0, 5}}})));
    const auto& read = envelope.client_stats();
    EXPECT_EQ(read.frames(), 600u);
    EXPECT_EQ(read.round_trips(), 7u);
    EXPECT_EQ(read.lossy_vertices(), 9u);
    EXPECT_EQ(read.diff_ns(), kMany);
    ASSERT_EQ(read.nodes_size(), 2);
    EXPECT_EQ(read.nodes(0).object_bytes(), 2u);
    EXPECT_EQ(read.nodes(1).node(), 4u);
    EXPECT_EQ(read.nodes(1).state_bytes(), kMany);
    EXPECT_EQ(read.nodes(1).geometry_bytes(), 5u);
}

TEST(ControlMessages, ReadsAWholeWelcome) {
    const auto message = decode_from_walld(full_welcome().SerializeAsString());
    ASSERT_TRUE(message);
    const auto& welcome = std::get<Welcome>(*message);
    EXPECT_EQ(welcome.session, SessionId(7));
    EXPECT_EQ(welcome.canvas_width, 2048u);
    EXPECT_EQ(welcome.canvas_height, 1536u);
    ASSERT_EQ(welcome.tiles.size(), 2u);
    EXPECT_EQ(welcome.tiles[1].node, NodeIndex(1));
    EXPECT_EQ(welcome.tiles[1].slot, 3u);
    EXPECT_EQ(welcome.tiles[1].rect, (geom::Rect{-5, 0, 1024, 768}));
    EXPECT_EQ(welcome.tiles[1].name, "left");
    ASSERT_EQ(welcome.nodes.size(), 2u);
    EXPECT_EQ(welcome.nodes[1].address, "unix:/run/node");
    EXPECT_EQ(welcome.nodes[1].ticket, std::string("\0\xff ticket", 9));
    EXPECT_EQ(welcome.nodes[1].incarnation, 300u);
    EXPECT_TRUE(welcome.nodes[1].up);
    EXPECT_EQ(welcome.caps.renderer, "llvmpipe");
    EXPECT_EQ(welcome.caps.shading_language_version, "4.50");
    EXPECT_EQ(welcome.caps.extensions, "GL_ARB_a GL_ARB_b");
    EXPECT_THAT(welcome.caps.limits.at(0x0D33), ElementsAre(8192));
    EXPECT_THAT(welcome.caps.limits.at(0x846E), ElementsAre(1, 255.5));
}

TEST(ControlMessages, ReadsOtherTiles) {
    proto::Envelope envelope;
    *envelope.mutable_tiles_changed()->mutable_tiles() = full_welcome().client_welcome().tiles();
    const auto message = decode_from_walld(envelope.SerializeAsString());
    ASSERT_TRUE(message);
    const auto& tiles = std::get<TilesChanged>(*message).tiles;
    ASSERT_EQ(tiles.size(), 2u);
    EXPECT_EQ(tiles[1].rect, (geom::Rect{-5, 0, 1024, 768}));
}

TEST(ControlMessages, CutOrChangedBytesNeverCrash) {
    const auto good = full_welcome().SerializeAsString();
    for (std::size_t i = 1; i < good.size(); ++i) EXPECT_FALSE(decode_from_walld(good.substr(0, i))) << i;
    for (std::size_t i = 0; i < good.size(); ++i)
        for (const int flip : {0x01, 0x07, 0x80, 0xff}) {
            auto bad = good;
            bad[i] = static_cast<char>(bad[i] ^ flip);
            (void)decode_from_walld(bad);
        }
}

TEST(ControlMessages, UnknownMessagesAreSkipped) {
    proto::Envelope later;
    later.mutable_node_hello()->set_name("x");
    const auto message = decode_from_walld(later.SerializeAsString());
    ASSERT_TRUE(message);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(*message));
}

TEST(ControlLink, SaysHelloAndTakesTheWelcome) {
    Linked linked;
    ASSERT_TRUE(linked.link);
    EXPECT_EQ(linked.hello.program(), "glxgears");
    EXPECT_EQ(linked.link->welcome().session, SessionId(7));
    EXPECT_EQ(linked.link->welcome().nodes.size(), 2u);
}

TEST(ControlLink, TellsEverySecondWhatWasSent) {
    Linked linked;
    stats().add_node(NodeIndex(3), NodeCounter::geometry_bytes, 1000);
    const auto told = linked.walld.receive_any().client_stats();
    ASSERT_EQ(told.nodes_size(), 1);
    EXPECT_EQ(told.nodes(0).node(), 3u);
    EXPECT_EQ(told.nodes(0).geometry_bytes(), 1000u);
}

TEST(ControlLink, PlacementsAndNodesArrive) {
    Linked linked;
    linked.link->surface_open(SurfaceId(1), {300, 200, "gears", {}});
    EXPECT_EQ(linked.walld.receive().surface_open().title(), "gears");
    proto::Envelope placement, up, down;
    placement.mutable_placement()->set_surface(1);
    placement.mutable_placement()->set_layout_version(5);
    placement.mutable_placement()->mutable_rect()->set_width(300);
    up.mutable_node_up()->set_node(4);
    up.mutable_node_up()->set_address("unix:/n");
    down.mutable_node_down()->set_node(2);
    linked.walld.send(framed(placement) + framed(up) + framed(down));

    const auto placed = linked.link->wait_placement(SurfaceId(1), 2s);
    ASSERT_TRUE(placed);
    EXPECT_EQ(placed->layout_version, 5u);
    const auto events = collect(*linked.link, [](auto& e) { return e.node_changes.size() > 1; });
    ASSERT_EQ(events.placements.size(), 1u);
    EXPECT_EQ(events.placements[0].rect.width, 300);
    ASSERT_EQ(events.node_changes.size(), 2u);
    EXPECT_TRUE(events.node_changes[0].up);
    EXPECT_EQ(events.node_changes[0].address, "unix:/n");
    EXPECT_FALSE(events.node_changes[1].up);
    EXPECT_EQ(events.node_changes[1].node, NodeIndex(2));
    EXPECT_FALSE(events.lost);
    EXPECT_TRUE(linked.link->take_events().placements.empty());
}

/// What a window was told, as its counts.
struct FakeWindow {
    std::atomic<int> closed{0}, redrawn{0};
    bool has_close = true;
    WindowMessages messages() {
        return {[this] {
                    ++closed;
                    return has_close;
                },
                [this] { ++redrawn; }};
    }
    static bool reaches(const std::atomic<int>& count, int value) {
        for (int i = 0; i < 200 && count < value; ++i) std::this_thread::sleep_for(10ms);
        return count == value;
    }
};

proto::Envelope placement_of(std::uint32_t surface, std::uint32_t version) {
    proto::Envelope envelope;
    envelope.mutable_placement()->set_surface(surface);
    envelope.mutable_placement()->set_layout_version(version);
    envelope.mutable_placement()->mutable_rect()->set_width(10);
    envelope.mutable_placement()->mutable_rect()->set_height(10);
    return envelope;
}

proto::Envelope close_of(std::uint32_t surface) {
    proto::Envelope envelope;
    envelope.mutable_close_request()->set_surface(surface);
    return envelope;
}

TEST(ControlLink, APlacementLiesAmongTheTilesThatWalldSaidLast) {
    Linked linked;
    linked.link->surface_open(SurfaceId(1), {300, 200, "gears", {}});
    proto::Envelope placement, tiles;
    placement.mutable_placement()->set_surface(1);
    tiles.mutable_tiles_changed()->add_tiles()->set_node(9);
    linked.walld.send(framed(placement) + framed(tiles) + framed(placement));
    const auto events = collect(*linked.link, [](auto& e) { return e.placements.size() > 1; });
    ASSERT_EQ(events.placements.size(), 2u);
    ASSERT_TRUE(events.placements[0].tiles);
    EXPECT_EQ(events.placements[0].tiles->size(), 2u) << "the welcome's";
    ASSERT_EQ(events.placements[1].tiles->size(), 1u);
    EXPECT_EQ(events.placements[1].tiles->front().node, NodeIndex(9));
}

TEST(ControlLink, AWindowIsToldToRedrawAfterAMoveAndNotAfterItsOwnRequests) {
    FakeWindow window;
    Linked linked;
    linked.link->surface_open(SurfaceId(1), {300, 200, "", {}}, window.messages());
    linked.link->surface_resize(SurfaceId(1), 400, 200);
    linked.walld.send(framed(placement_of(1, 1)) + framed(placement_of(1, 2)));
    ASSERT_TRUE(linked.link->wait_placement(SurfaceId(1), 2s));
    std::this_thread::sleep_for(50ms);
    EXPECT_EQ(window.redrawn, 0);
    linked.walld.send(placement_of(1, 3));
    EXPECT_TRUE(FakeWindow::reaches(window.redrawn, 1));
    linked.link->ask_to_redraw(SurfaceId(1));
    EXPECT_TRUE(FakeWindow::reaches(window.redrawn, 2));
    linked.link->ask_to_redraw(SurfaceId(7));
    linked.walld.send(placement_of(7, 1));
    std::this_thread::sleep_for(50ms);
    EXPECT_EQ(window.redrawn, 2) << "of other surfaces it hears nothing";
}

TEST(ControlLink, AnAdoptionWaitsUntilWalldKnows) {
    Linked linked;
    linked.link->surface_open(SurfaceId(1), {300, 200, "", {}});
    EXPECT_TRUE(linked.walld.receive().has_surface_open());
    EXPECT_FALSE(linked.link->surface_adopted(SurfaceId(1), 3, 12, 20ms));
    const auto said = linked.walld.receive().surface_adopted();
    EXPECT_EQ(said.surface(), 1u);
    EXPECT_EQ(said.layout_version(), 3u);
    EXPECT_EQ(said.frame(), 12u);
    proto::Envelope noted;
    noted.mutable_adoption_noted()->set_surface(1);
    noted.mutable_adoption_noted()->set_layout_version(4);
    linked.walld.send(noted);
    EXPECT_TRUE(linked.link->surface_adopted(SurfaceId(1), 4, 12, 2s));
    linked.walld.hang_up();
    EXPECT_FALSE(linked.link->surface_adopted(SurfaceId(1), 5, 13, 10s)) << "nobody will answer";
}

TEST(ControlLink, AWindowIsAskedToCloseAndWalldHearsWhenItCannotBe) {
    FakeWindow window, stubborn;
    stubborn.has_close = false;
    Linked linked;
    linked.link->surface_open(SurfaceId(1), {300, 200, "", {}}, window.messages());
    linked.link->surface_open(SurfaceId(2), {300, 200, "", {}}, stubborn.messages());
    linked.link->surface_open(SurfaceId(3), {300, 200, "", {}});
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(linked.walld.receive().has_surface_open());
    linked.walld.send(framed(close_of(1)) + framed(close_of(2)) + framed(close_of(3)) + framed(close_of(99)));
    EXPECT_EQ(linked.walld.receive().close_refused().surface(), 2u);
    EXPECT_EQ(linked.walld.receive().close_refused().surface(), 3u);
    EXPECT_EQ(window.closed, 1);
}

TEST(ControlLink, AResizeWaitsForItsOwnPlacement) {
    Linked linked;
    proto::Envelope placement;
    placement.mutable_placement()->set_surface(1);
    placement.mutable_placement()->set_layout_version(1);
    linked.link->surface_open(SurfaceId(1), {300, 200, "", {}});
    linked.walld.receive();
    linked.walld.send(placement);
    ASSERT_TRUE(linked.link->wait_placement(SurfaceId(1), 2s));
    linked.link->surface_resize(SurfaceId(1), 400, 200);
    EXPECT_EQ(linked.walld.receive().surface_resize().width(), 400u);
    EXPECT_FALSE(linked.link->wait_placement(SurfaceId(1), 20ms));
    placement.mutable_placement()->set_layout_version(2);
    linked.walld.send(placement);
    EXPECT_EQ(linked.link->wait_placement(SurfaceId(1), 2s)->layout_version, 2u);
}

TEST(ControlLink, ByteByByteIsTheSame) {
    Linked linked;
    proto::Envelope placement;
    placement.mutable_placement()->set_surface(1);
    placement.mutable_placement()->set_layout_version(9);
    linked.link->surface_open(SurfaceId(1), {1, 1, "", {}});
    linked.walld.receive();
    for (const char c : framed(placement)) {
        linked.walld.send(std::string(1, c));
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ(linked.link->wait_placement(SurfaceId(1), 2s)->layout_version, 9u);
}

TEST(ControlLink, ComesBackAfterWalldWasAway) {
    Linked linked;
    linked.link->surface_open(SurfaceId(1), {300, 200, "gears", {}});
    linked.walld.receive();
    linked.walld.hang_up();
    EXPECT_TRUE(collect(*linked.link, [](auto& e) { return e.lost; }).lost);
    linked.walld.welcome();
    EXPECT_EQ(linked.walld.receive().surface_open().title(), "gears");  // announced again
    const auto events = collect(*linked.link, [](auto& e) { return e.reconnected.has_value(); });
    ASSERT_TRUE(events.reconnected);
    EXPECT_EQ(events.reconnected->session, SessionId(7));
}

proto::Envelope move_to(const std::string& address) {
    proto::Envelope envelope;
    envelope.mutable_move_request()->set_address(address);
    return envelope;
}

TEST(ControlLink, GoesToAnotherWallWhenTheProgramSaysSo) {
    Linked linked;
    FakeWalld other;
    linked.link->surface_open(SurfaceId(1), {300, 200, "gears", {}});
    linked.walld.receive();
    proto::ClientHello hello;
    std::thread server([&] { hello = other.welcome(); });
    linked.walld.send(move_to(other.address()));
    server.join();
    EXPECT_EQ(hello.program(), "glxgears");
    EXPECT_FALSE(hello.has_resume()) << "it is a new one there";
    EXPECT_FALSE(hello.has_rect()) << "a place on the first wall";
    const auto asked = collect(*linked.link, [](auto& e) { return e.asked_to_move; });
    EXPECT_TRUE(asked.asked_to_move);
    EXPECT_FALSE(asked.reconnected) << "the program has not said that it goes";
    EXPECT_TRUE(linked.link->go());
    const auto answer = linked.walld.receive();
    ASSERT_TRUE(answer.has_move_answer());
    EXPECT_EQ(answer.move_answer().refused(), "");
    const auto opened = other.receive().surface_open();
    EXPECT_EQ(opened.title(), "gears");
    EXPECT_FALSE(opened.has_restore()) << "the other wall places it";
    const auto events = collect(*linked.link, [](auto& e) { return e.reconnected.has_value(); });
    EXPECT_TRUE(events.moved);
    EXPECT_FALSE(linked.link->go()) << "there is nowhere to go";
    other.hang_up();  // from now on it comes back to this one
    EXPECT_EQ(other.welcome().program(), "glxgears");
}

TEST(ControlLink, StaysWhereTheOtherWallIsNotThere) {
    Linked linked;
    linked.walld.send(move_to("unix:/nowhere/walld.sock"));
    EXPECT_THAT(linked.walld.receive().move_answer().refused(), HasSubstr("/nowhere/walld.sock"));
    linked.walld.send(move_to(linked.walld.address()));
    EXPECT_THAT(linked.walld.receive().move_answer().refused(), HasSubstr("on that wall"));
    EXPECT_FALSE(linked.link->go());
    EXPECT_FALSE(linked.link->take_events().asked_to_move);
}

TEST(ControlLink, TellsAnotherWallNoToken) {
    auto secretive = some_hello();
    secretive.token = "secret";
    Linked linked(secretive);
    EXPECT_EQ(linked.hello.token(), "secret");
    FakeWalld other;
    proto::ClientHello hello;
    std::thread server([&] { hello = other.welcome(); });
    linked.walld.send(move_to(other.address()));
    server.join();
    EXPECT_EQ(hello.token(), "");
}

TEST(ControlLink, WhatWalldSaidBeforeItClosedIsReadThoughSomethingIsBeingWritten) {
    std::promise<void> asked, gone;
    Linked linked;
    linked.link->surface_open(SurfaceId(1), {300, 200, "gears", {}},
                              {[&] {
                                   asked.set_value();
                                   gone.get_future().wait();
                                   return false;  // so there is something to write
                               },
                               {}});
    linked.walld.receive();
    linked.walld.send(close_of(1));
    asked.get_future().wait();
    linked.walld.send(placement_of(1, 1));
    linked.walld.hang_up();
    gone.set_value();
    const auto events = collect(*linked.link, [](auto& e) { return e.lost; });
    EXPECT_TRUE(events.lost);
    EXPECT_EQ(events.placements.size(), 1u);
}

// ---- in a parallel program ----

Hello a_members_hello() {
    auto hello = some_hello();
    hello.group = Parallel{"march", 1, 2};
    return hello;
}

proto::Envelope from(proto::Envelope placement, std::uint32_t frame, bool agreed) {
    placement.mutable_placement()->set_from_frame(frame);
    placement.mutable_placement()->set_agreed(agreed);
    return placement;
}

proto::Envelope agreed(std::uint32_t surface, std::uint32_t version) {
    proto::Envelope envelope;
    envelope.mutable_placement_agreed()->set_surface(surface);
    envelope.mutable_placement_agreed()->set_layout_version(version);
    return envelope;
}

TEST(ControlLinkOfAMember, WaitsForWhereAFrameIsDrawn) {
    Linked linked(a_members_hello());
    linked.link->surface_open(SurfaceId(1), {300, 200, "", {}});
    linked.walld.receive();
    linked.walld.send(framed(from(placement_of(1, 1), 0, true)) + framed(from(placement_of(1, 2), 6, false)));
    const auto noted = linked.walld.receive().placement_noted();
    EXPECT_EQ(noted.layout_version(), 2u);
    EXPECT_EQ(noted.begun(), 0u);
    linked.link->begin_frame(SurfaceId(1), 5);
    EXPECT_EQ(collect(*linked.link, [](auto& e) { return !e.placements.empty(); }).placements.size(), 1u)
        << "the other one is not agreed";
    std::atomic<bool> begun = false;
    std::thread drawing([&] {
        linked.link->begin_frame(SurfaceId(1), 6);
        begun = true;
    });
    std::this_thread::sleep_for(50ms);
    EXPECT_FALSE(begun);
    linked.walld.send(agreed(1, 2));
    drawing.join();
    EXPECT_EQ(linked.link->take_events().placements.at(0).layout_version, 2u);
    linked.walld.send(from(placement_of(1, 3), 6, false));
    EXPECT_EQ(linked.walld.receive().placement_noted().begun(), 6u) << "too late";
    linked.link->begin_frame(SurfaceId(1), 7);
}

TEST(ControlLinkOfAMember, ComesBackToTheNextWalldWithWhatIsAgreed) {
    Linked linked(a_members_hello());
    EXPECT_FALSE(linked.hello.has_resume());
    linked.link->surface_open(SurfaceId(1), {300, 200, "", {}});
    linked.walld.receive();
    linked.walld.send(framed(from(placement_of(1, 1), 0, true)) + framed(from(placement_of(1, 2), 6, false)));
    linked.walld.receive();
    linked.walld.hang_up();
    const auto hello = linked.walld.welcome();
    EXPECT_EQ(hello.group().rank(), 1u);
    EXPECT_EQ(hello.resume().session(), 7u);
    EXPECT_EQ(hello.resume().windows(), 1u);
    const auto restore = linked.walld.receive().surface_open().restore();
    ASSERT_EQ(restore.agreed_size(), 1) << "not what was proposed only";
    EXPECT_EQ(restore.agreed(0).layout_version(), 1u);
    EXPECT_EQ(restore.agreed(0).rect().width(), 10u);
    EXPECT_EQ(restore.wanted_version(), 2u);
    // Who waits goes on waiting until the new one has said what holds.
    std::atomic<bool> begun = false;
    std::thread drawing([&] {
        linked.link->begin_frame(SurfaceId(1), 6);
        begun = true;
    });
    std::this_thread::sleep_for(20ms);
    EXPECT_FALSE(begun);
    linked.walld.send(from(placement_of(1, 2), 20, false));
    drawing.join();
    EXPECT_EQ(collect(*linked.link, [](auto& e) { return !e.placements.empty(); }).placements.size(), 1u)
        << "what was agreed before and not taken yet";
}

TEST(ControlLinkOfAMember, EndsWhenItsSessionIsNoMore) {
    Linked linked(a_members_hello());
    std::promise<std::string> ended;
    linked.link->on_end([&](const std::string& why) { ended.set_value(why); });
    linked.link->surface_open(SurfaceId(1), {300, 200, "", {}});
    linked.walld.receive();
    linked.walld.send(framed(from(placement_of(1, 1), 0, true)) + framed(from(placement_of(1, 2), 6, false)));
    linked.walld.receive();
    std::thread drawing([&] { linked.link->begin_frame(SurfaceId(1), 6); });
    linked.walld.hang_up();
    proto::Envelope not_yet, over;
    not_yet.mutable_refused()->set_reason("not yet");
    over.mutable_refused()->set_reason("no more");
    over.mutable_refused()->set_over(true);
    for (const auto& answer : {not_yet, over}) {
        linked.walld.accept();
        linked.walld.receive();
        linked.walld.send(answer);
        linked.walld.hang_up();
    }
    auto why = ended.get_future();
    ASSERT_EQ(why.wait_for(5s), std::future_status::ready);
    EXPECT_EQ(why.get(), "no more");
    drawing.join();
}

TEST(ControlLink, TellsTheNextWalldWhatThereWas) {
    Linked linked;
    linked.link->surface_open(SurfaceId(1), {300, 200, "gears", {}});
    linked.walld.receive();
    auto first = placement_of(1, 1), second = placement_of(1, 2), third = placement_of(1, 3);
    second.mutable_placement()->mutable_rect()->set_x(20);
    third.mutable_placement()->mutable_rect()->set_x(30);
    proto::Envelope up, note;
    up.mutable_node_up()->set_node(1);
    up.mutable_node_up()->set_ticket("newer");
    note.mutable_surface_note()->set_surface(1);
    note.mutable_surface_note()->set_note("note");
    linked.walld.send(framed(first) + framed(second) + framed(third) + framed(up) + framed(note));
    collect(*linked.link, [](auto& e) { return e.placements.size() == 3 && !e.node_changes.empty(); });
    linked.link->surface_adopted(SurfaceId(1), 2, 9, 1ms);  // the third one has come since the program looked
    EXPECT_EQ(linked.walld.receive().surface_adopted().layout_version(), 2u);
    linked.link->surface_open(SurfaceId(2), {10, 10, "placed nowhere yet", {}});
    linked.walld.receive();
    std::this_thread::sleep_for(50ms);  // the note is behind all that, and nobody waits for it
    linked.walld.hang_up();

    const auto hello = linked.walld.welcome();
    EXPECT_EQ(hello.resume().session(), 7u);
    EXPECT_EQ(hello.resume().windows(), 1u);
    ASSERT_EQ(hello.resume().tickets_size(), 2);
    EXPECT_EQ(hello.resume().tickets(0).ticket(), std::string("\0\xff ticket", 9));
    EXPECT_EQ(hello.resume().tickets(1).ticket(), "newer");
    const auto known = linked.walld.receive().surface_open();
    EXPECT_EQ(known.surface(), 1u);
    EXPECT_EQ(known.restore().drawn().x(), 20);
    EXPECT_EQ(known.restore().wanted().x(), 30);
    EXPECT_EQ(known.restore().note(), "note");
    EXPECT_FALSE(linked.walld.receive().surface_open().has_restore());
}

TEST(ControlLink, NobodyWaitsForASilentWalldTwice) {
    Linked linked;
    linked.link->surface_open(SurfaceId(1), {300, 200, "", {}});
    linked.walld.receive();
    EXPECT_FALSE(linked.link->wait_placement(SurfaceId(1), 10s))
        << "it has asked for a sign of life meanwhile, in vain";
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(linked.link->surface_adopted(SurfaceId(1), 1, 1, 10s));
    EXPECT_FALSE(linked.link->wait_placement(SurfaceId(1), 10s));
    EXPECT_LT(std::chrono::steady_clock::now() - start, 1s);
    linked.walld.send(placement_of(1, 4));
    collect(*linked.link, [](auto& e) { return !e.placements.empty(); });
    EXPECT_EQ(linked.link->wait_placement(SurfaceId(1), 10s)->layout_version, 4u);
    std::thread later([&] {
        std::this_thread::sleep_for(200ms);
        proto::Envelope noted;
        noted.mutable_adoption_noted()->set_surface(1);
        noted.mutable_adoption_noted()->set_layout_version(4);
        linked.walld.send(noted);
    });
    EXPECT_TRUE(linked.link->surface_adopted(SurfaceId(1), 4, 2, 10s)) << "it answers again, and is waited for";
    later.join();
}

TEST(ControlLink, SaysNothingToAnotherUsersProcess) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can be somebody else";
    FakeWalld walld;
    int told[2];
    ASSERT_EQ(::pipe(told), 0);
    const pid_t stranger = ::fork();
    if (stranger == 0) {  // it has taken walld's address, and says how many bytes it hears
        if (::setresuid(54321, 54321, 54321) != 0) ::_exit(1);
        const UniqueFd listener(::socket(AF_INET, SOCK_STREAM, 0));
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        ::bind(listener.get(), reinterpret_cast<sockaddr*>(&address), sizeof address);
        ::listen(listener.get(), 8);
        socklen_t size = sizeof address;
        ::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size);
        int said = ntohs(address.sin_port);
        [[maybe_unused]] auto n = ::write(told[1], &said, sizeof said);
        char byte;
        said = static_cast<int>(::read(::accept(listener.get(), nullptr, nullptr), &byte, 1));
        n = ::write(told[1], &said, sizeof said);
        ::_exit(0);
    }
    int port = 0, bytes = -1;
    ASSERT_EQ(::read(told[0], &port, sizeof port), static_cast<ssize_t>(sizeof port));
    const auto link = ControlLink::open(some_hello(), "127.0.0.1:" + std::to_string(port), 2s);
    ASSERT_FALSE(link);
    EXPECT_THAT(link.error().message, HasSubstr("is not walld: it is a process of user 54321"));
    ASSERT_EQ(::read(told[0], &bytes, sizeof bytes), static_cast<ssize_t>(sizeof bytes));
    EXPECT_EQ(bytes, 0) << "not even the hello, with its token";
    ::waitpid(stranger, nullptr, 0);
}

TEST(ControlLink, LosingWalldEndsWaiting) {
    Linked linked;
    linked.walld.stop_listening();
    std::thread later([&] {
        std::this_thread::sleep_for(50ms);
        linked.walld.hang_up();
    });
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(linked.link->wait_placement(SurfaceId(1), 10s));
    EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
    later.join();
}

/// Without logging as well: the program draws on, and nobody would know why it is not seen.
TEST(ControlLink, WhyWalldHasEndedItIsSaidToPeople) {
    Linked linked;
    testing::internal::CaptureStderr();
    proto::Envelope refused;
    refused.mutable_refused()->set_reason("too much\nof it");
    linked.walld.send(refused);
    collect(*linked.link, [](auto& e) { return e.lost; });
    const auto said = testing::internal::GetCapturedStderr();
    EXPECT_THAT(said, HasSubstr("wallgl: walld at " + linked.walld.address() + " has ended this program's drawing: "));
    EXPECT_THAT(said, HasSubstr(R"(too much\nof it)"));
}

TEST(ControlLink, RefusalTellsTheReason) {
    FakeWalld walld;
    std::thread server([&] {
        walld.accept();
        walld.receive();
        proto::Envelope refused;
        refused.mutable_refused()->set_reason("wrong version");
        walld.send(refused);
    });
    const auto link = ControlLink::open(some_hello(), walld.address());
    server.join();
    ASSERT_FALSE(link);
    EXPECT_THAT(link.error().message, HasSubstr("wrong version"));
    EXPECT_THAT(link.error().message, HasSubstr(walld.address()));
}

TEST(ControlLink, NobodyThereIsAnErrorWithTheAddress) {
    const auto link = ControlLink::open(some_hello(), "unix:/nonexistent/walld.sock");
    ASSERT_FALSE(link);
    EXPECT_THAT(link.error().message, HasSubstr("unix:/nonexistent/walld.sock"));
    EXPECT_FALSE(ControlLink::open(some_hello(), "127.0.0.1:1"));
    EXPECT_FALSE(ControlLink::open(some_hello(), "neither"));
}

TEST(ControlLink, ASilentPeerIsGivenUp) {
    FakeWalld walld;  // accepts in the kernel, never answers
    const auto start = std::chrono::steady_clock::now();
    const auto link = ControlLink::open(some_hello(), walld.address(), 200ms);
    ASSERT_FALSE(link);
    EXPECT_THAT(link.error().message, HasSubstr("no answer in time"));
    EXPECT_LT(std::chrono::steady_clock::now() - start, 2s);
}

TEST(ControlLink, AnotherProtocolIsRefused) {
    for (const std::string& answer : {std::string("HTTP/1.1 400 Bad Request\r\n\r\n"), std::string(8, '\xff')}) {
        FakeWalld walld;
        std::thread server([&] {
            walld.accept();
            walld.receive();
            walld.send(answer);
        });
        EXPECT_FALSE(ControlLink::open(some_hello(), walld.address(), 500ms));
        server.join();
    }
}

TEST(Hello, ComesFromTheEnvironment) {
    setenv("WALLGL_NAME", "mine", 1);
    setenv("WALLGL_RECT", "1,-2,300,400", 1);
    auto hello = Hello::from_environment();
    EXPECT_EQ(hello.name, "mine");
    EXPECT_EQ(hello.rect, (geom::Rect{1, -2, 300, 400}));
    EXPECT_TRUE(hello.invalid.empty());
    EXPECT_FALSE(hello.hold);
    setenv("WALLGL_RECT", "fullscreen", 1);
    setenv("WALLGL_HOLD", "1", 1);
    hello = Hello::from_environment();
    EXPECT_TRUE(hello.fullscreen);
    EXPECT_TRUE(hello.hold);
    for (const char* bad : {"1,2,3", "1,2,3,4,5", "a,b,c,d", "0,0,0,10", "0,0,10,-1"}) {
        setenv("WALLGL_RECT", bad, 1);
        hello = Hello::from_environment();
        EXPECT_THAT(hello.invalid, HasSubstr(bad));
        const auto link = ControlLink::open(hello, "unix:/nonexistent");
        EXPECT_THAT(link.error().message, HasSubstr("WALLGL_RECT"));
    }
    unsetenv("WALLGL_RECT");
    unsetenv("WALLGL_NAME");
    unsetenv("WALLGL_HOLD");
}

// ---- addresses ----

TEST(ConnectTo, UnderstandsAnIPv6Address) {
    UniqueFd listener(::socket(AF_INET6, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in6 address{};
    address.sin6_family = AF_INET6;
    address.sin6_addr = in6addr_loopback;
    socklen_t size = sizeof address;
    ASSERT_EQ(::bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), size), 0);
    ASSERT_EQ(::listen(listener.get(), 1), 0);
    ASSERT_EQ(::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    const auto connected = connect_to("[::1]:" + std::to_string(ntohs(address.sin6_port)), 5000);
    EXPECT_TRUE(connected) << connected.error().message;
}

TEST(ConnectTo, SaysWhatAnAddressIs) {
    for (const char* wrong : {"", "nowhere", "::1:7770", "host:port", "host:70000", "unix:"}) {
        const auto connected = connect_to(wrong, 100);
        ASSERT_FALSE(connected) << wrong;
        EXPECT_THAT(connected.error().message, HasSubstr("expected unix:PATH or HOST:PORT"));
    }
}

}  // namespace
}  // namespace wall::client
