// SPDX-License-Identifier: MIT
// A node with its threads and sockets, between a walld and clients that the test plays itself.
#include "tileserver/io/node_server.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <cstring>
#include <filesystem>
#include <future>
#include <random>
#include <thread>

#include "client_lib/link/node_stream.h"
#include "client_lib/link/transport.h"
#include "common/base/descriptor_message.h"
#include "common/net/sockets.h"
#include "common/wire/batch.h"
#include "common/wire/frame_reader.h"
#include "common/wire/limits.h"
#include "common/wire/parcel.h"
#include "common/wire/ring.h"
#include "gen/glapi/wire.gen.h"
#include "gen/glstate/state.gen.h"

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;
namespace pack = glapi::pack;
constexpr auto kPatience = 10s;

/// Waits for bytes; false if none come in time.
bool readable(int fd, std::chrono::milliseconds limit = kPatience) {
    pollfd wait{fd, POLLIN, 0};
    return ::poll(&wait, 1, static_cast<int>(limit.count())) > 0;
}

void write_all(int fd, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const auto n = ::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (n <= 0) return;
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
}

/// walld's end of the link.
class FakeWalld {
public:
    explicit FakeWalld(const net::Address& address) : listener_(std::move(*net::listen_on(address))) {
        ::fcntl(listener_.get(), F_SETFL, ::fcntl(listener_.get(), F_GETFL) & ~O_NONBLOCK);
    }
    void accept() {
        ASSERT_TRUE(readable(listener_.get()));
        link_.reset(::accept(listener_.get(), nullptr, nullptr));
        unframer_ = {};
    }
    void drop() { link_.reset(); }
    void send(const proto::Envelope& envelope) {
        const std::string bytes = *net::frame(envelope);
        write_all(link_.get(), std::as_bytes(std::span(bytes)));
    }
    /// A sign of life.
    void send_pong() {
        proto::Envelope pong;
        pong.mutable_pong();
        send(pong);
    }
    /// The next message of one kind; others are passed over.
    proto::Envelope wait_for(proto::Envelope::MessageCase kind) {
        for (;;) {
            auto message = unframer_.next();
            if (!message) break;
            if (*message && (*message)->message_case() == kind) return **message;
            if (*message) continue;
            if (!readable(link_.get())) break;
            const auto room = unframer_.prepare();
            const auto n = ::read(link_.get(), room.data(), room.size());
            if (n <= 0) break;
            unframer_.commit(static_cast<std::size_t>(n));
        }
        ADD_FAILURE() << "no message of kind " << static_cast<int>(kind);
        return {};
    }

private:
    UniqueFd listener_, link_;
    net::Unframer unframer_;
};

class Client {
public:
    explicit Client(const net::Address& node) : fd_(std::move(*net::connect_to(node, kPatience))) {}
    explicit Client(UniqueFd connection) : fd_(std::move(connection)) {}
    void send(wire::FrameKind kind, std::span<const std::byte> payload) {
        write_all(fd_.get(), wire::whole_frame(kind, payload));
    }
    void hello(std::uint32_t session, const std::string& ticket, std::uint32_t version = glapi::kStreamVersion) {
        proto::DataHello hello;
        hello.set_version(version);
        hello.set_session(session);
        hello.set_ticket(ticket);
        const std::string bytes = hello.SerializeAsString();
        send(wire::FrameKind::hello, std::as_bytes(std::span(bytes)));
    }
    /// As a library says it, with a descriptor.
    void hello_with(int descriptor, std::uint32_t session, const std::string& ticket) {
        proto::DataHello hello;
        hello.set_version(glapi::kStreamVersion);
        hello.set_session(session);
        hello.set_ticket(ticket);
        const std::string text = hello.SerializeAsString();
        const auto bytes = wire::whole_frame(wire::FrameKind::hello, std::as_bytes(std::span(text)));
        ASSERT_EQ(send_with_descriptor(fd_.get(), bytes, descriptor), static_cast<ssize_t>(bytes.size()));
    }
    static std::vector<std::byte> batch_frame(const wire::PackBuffer& buffer) {
        std::vector<std::byte> payload;
        wire::append_batch(payload, {ContextId(1), buffer.opcodes(), buffer.operands()});
        return wire::whole_frame(wire::FrameKind::batch, payload);
    }
    void batch(const wire::PackBuffer& buffer) { write_all(fd_.get(), batch_frame(buffer)); }
    /// There is something in the ring.
    void sign() {
        const std::byte one{};
        write_all(fd_.get(), std::span(&one, 1));
    }
    /// The next frame; nothing at the connection's end.
    std::optional<wire::Frame> next() {
        for (;;) {
            auto frame = reader_.next();
            if (!frame) return std::nullopt;
            if (*frame) return std::move(**frame);
            if (!readable(fd_.get())) return std::nullopt;
            const auto room = reader_.prepare();
            const auto n = ::read(fd_.get(), room.data(), room.size());
            if (n <= 0) return std::nullopt;
            reader_.commit(static_cast<std::size_t>(n));
        }
    }
    void expect(wire::FrameKind kind) {
        const auto frame = next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->kind, kind) << std::string(reinterpret_cast<const char*>(frame->payload.data()),
                                                    frame->payload.size());
    }
    std::string expect_error() {
        const auto frame = next();
        if (!frame || frame->kind != wire::FrameKind::error) return "no error frame";
        EXPECT_FALSE(next());
        return {reinterpret_cast<const char*>(frame->payload.data()), frame->payload.size()};
    }

private:
    UniqueFd fd_;
    wire::FrameReader reader_{wire::kMaxFramePayload};
};

class NodeServerTest : public ::testing::Test {
protected:
    void SetUp() override {
        char name[] = "/tmp/wallgl-node-test-XXXXXX";
        folder_ = ::mkdtemp(name);
        config_.control_listen = {*net::Address::parse("unix:" + folder_ + "/walld.sock")};
        config_.nodes = {{"n", config::Backend::egl, *net::Address::parse(listen_at()), {{"t", 0, {0, 0, 64, 48}}}}};
        walld_.emplace(config_.control_listen.front());
        auto server = NodeServer::open(io_.get_executor(), config_, config_.nodes.front());
        ASSERT_TRUE(server) << server.error().message;
        server_ = std::move(*server);
        server_->set_longest_turn(longest_turn_);
        server_->set_most_strangers(kStrangers);
        server_->start();
        thread_ = std::thread([this] { io_.run(); });
        address_ = *net::Address::parse(introduce().address());
    }
    void TearDown() override {
        if (server_) boost::asio::post(io_, [this] { server_->stop(); });
        if (thread_.joinable()) thread_.join();
        server_.reset();
        std::filesystem::remove_all(folder_);
    }
    /// The node finds walld and learns of its tile and of sessions 1 and 2. Gives its hello.
    proto::NodeHello introduce() {
        walld_->accept();
        const auto hello = walld_->wait_for(proto::Envelope::kNodeHello).node_hello();
        EXPECT_EQ(hello.name(), "n");
        EXPECT_GT(hello.started_us(), 0u);
        EXPECT_GT(hello.caps().limits_size(), 50);
        proto::Envelope welcome;
        auto& tile = *welcome.mutable_node_welcome()->add_tiles();
        tile.set_name("t");
        tile.mutable_rect()->set_width(64);
        tile.mutable_rect()->set_height(48);
        welcome.mutable_node_welcome()->set_background(0x102030);
        walld_->send(welcome);
        for (std::uint32_t session : {1u, 2u}) {
            proto::Envelope ticket;
            ticket.mutable_ticket()->set_session(session);
            ticket.mutable_ticket()->set_ticket("secret" + std::to_string(session));
            walld_->send(ticket);
        }
        return hello;
    }
    virtual std::string listen_at() const { return "unix:" + folder_ + "/n.sock"; }
    const net::Address& node_address() const { return address_; }
    /// A surface over the whole tile, one frame all in `color`.
    static wire::PackBuffer one_frame(const glstate::Vec4& color, std::uint32_t frame) {
        wire::PackBuffer buffer, body;
        pack::SurfaceCreate(buffer, SurfaceId(1), 1, 0, 24, 8, 0, 0, 1, 0);
        pack::SurfacePlace(buffer, SurfaceId(1), 1, 64, 48, 0, 0, 64, 48, 0);
        pack::Bind(buffer, SurfaceId(1), SurfaceId(1));
        glapi::pack_state(buffer, glstate::el::clear_color::id, &color, sizeof color);
        pack::Clear(body, GL_COLOR_BUFFER_BIT);
        pack::Block(buffer, 1, 0, static_cast<std::uint32_t>(body.commands()),
                    static_cast<std::uint32_t>(body.operand_bytes()));
        buffer.append(body, {}, body.mark());
        pack::Swap(buffer, SurfaceId(1), frame);
        return buffer;
    }
    /// So many commands that do nothing much.
    static void say_much(wire::PackBuffer& buffer, std::size_t commands) {
        const glstate::Vec4 any{0, 0, 1, 0};
        for (std::size_t i = 0; i < commands; ++i)
            glapi::pack_state(buffer, glstate::el::clear_color::id, &any, sizeof any);
    }
    /// The tile's first pixel as it is shown now.
    std::vector<int> shown() {
        proto::Envelope request;
        request.mutable_snapshot_request()->set_request(++last_request_);
        walld_->send(request);
        const auto snapshot = walld_->wait_for(proto::Envelope::kSnapshot).snapshot();
        if (snapshot.request() != last_request_ || snapshot.rgb().size() != 64 * 48 * 3) return {};
        return {static_cast<unsigned char>(snapshot.rgb()[0]), static_cast<unsigned char>(snapshot.rgb()[1]),
                static_cast<unsigned char>(snapshot.rgb()[2])};
    }
    void stack_session(std::uint32_t session, bool held = false) {
        proto::Envelope stacking;
        auto& entry = *stacking.mutable_stacking()->add_entries();
        entry.set_session(session);
        entry.set_surface(1);
        entry.set_held(held);
        walld_->send(stacking);
    }
    /// Session 1 comes with a window, which walld stacks, and draws it in that colour.
    void draw_first_frame(Client& client, const glstate::Vec4& color, bool held = false) {
        client.hello(1, "secret1");
        client.expect(wire::FrameKind::welcome);
        stack_session(1, held);
        client.batch(one_frame(color, 1));
        client.expect(wire::FrameKind::swap_done);
    }
    /// What walld does as long as it lives; for `time`.
    void answer_pings(std::chrono::milliseconds time) {
        for (const auto end = std::chrono::steady_clock::now() + time; std::chrono::steady_clock::now() < end;) {
            walld_->wait_for(proto::Envelope::kPing);
            walld_->send_pong();
        }
    }
    /// Until the tile's first pixel is that one.
    void expect_shown(const std::vector<int>& pixel) {
        auto now = shown();
        for (int tries = 0; tries < 100 && now != pixel; ++tries, now = shown()) std::this_thread::sleep_for(20ms);
        EXPECT_EQ(now, pixel);
    }
    void present(std::uint32_t session, std::uint32_t frame) {
        proto::Envelope present;
        present.mutable_present()->set_session(session);
        present.mutable_present()->set_surface(1);
        present.mutable_present()->set_frame(frame);
        walld_->send(present);
    }

    static constexpr std::size_t kStrangers = 4;
    std::chrono::milliseconds longest_turn_ = 60s;
    std::string folder_;
    config::WallConfig config_;
    net::Address address_;
    std::optional<FakeWalld> walld_;
    boost::asio::io_context io_{1};
    std::unique_ptr<NodeServer> server_;
    std::thread thread_;
    std::uint32_t last_request_ = 0;
};

TEST_F(NodeServerTest, ShowsAFrameWhenItIsPresented) {
    EXPECT_EQ(shown(), (std::vector{0x10, 0x20, 0x30}));
    Client client(node_address());
    draw_first_frame(client, {1, 0, 0, 0});
    const auto rendered = walld_->wait_for(proto::Envelope::kRendered).rendered();
    EXPECT_EQ(rendered.session(), 1u);
    EXPECT_EQ(rendered.frame(), 1u);
    EXPECT_EQ(shown(), (std::vector{0, 0, 0}));  // the window is there, the frame is not yet shown
    present(1, 1);
    EXPECT_EQ(shown(), (std::vector{255, 0, 0}));
}

TEST_F(NodeServerTest, ABadStreamEndsAloneAndWithAReason) {
    Client good(node_address()), bad(node_address());
    good.hello(1, "secret1");
    bad.hello(2, "secret2");
    good.expect(wire::FrameKind::welcome);
    bad.expect(wire::FrameKind::welcome);
    stack_session(1);
    wire::PackBuffer nonsense;
    pack::Swap(nonsense, SurfaceId(77), 1);
    bad.batch(nonsense);
    EXPECT_THAT(bad.expect_error(), ::testing::HasSubstr("surface 77"));
    const auto fault = walld_->wait_for(proto::Envelope::kSessionFault).session_fault();
    EXPECT_EQ(fault.session(), 2u);
    EXPECT_THAT(fault.reason(), ::testing::HasSubstr("Swap"));
    EXPECT_FALSE(fault.ends());
    good.batch(one_frame({0, 1, 0, 0}, 1));
    good.expect(wire::FrameKind::swap_done);
    present(1, 1);
    EXPECT_EQ(shown(), (std::vector{0, 255, 0}));
}

TEST_F(NodeServerTest, RefusesWhoHasNoTicket) {
    Client wrong(node_address());
    wrong.hello(1, "guess");
    EXPECT_THAT(wrong.expect_error(), ::testing::HasSubstr("ticket"));
    Client older(node_address());
    older.hello(1, "secret1", glapi::kStreamVersion + 1);
    EXPECT_THAT(older.expect_error(), ::testing::HasSubstr("another version"));
    Client noise(node_address());
    noise.send(wire::FrameKind::batch, {});
    EXPECT_THAT(noise.expect_error(), ::testing::HasSubstr("hello"));
    Client huge(node_address());
    huge.send(wire::FrameKind::hello, std::vector<std::byte>(100'000));
    EXPECT_THAT(huge.expect_error(), ::testing::HasSubstr("at most"));
}

// walld has said on which machine the session runs, and here comes somebody who has proven no key at all.
TEST_F(NodeServerTest, ATicketOfAnotherMachineIsNone) {
    proto::Envelope ticket;
    ticket.mutable_ticket()->set_session(3);
    ticket.mutable_ticket()->set_ticket("secret3");
    ticket.mutable_ticket()->set_key(std::string(32, 'k'));
    walld_->send(ticket);
    Client elsewhere(node_address());
    elsewhere.hello(3, "secret3");
    EXPECT_THAT(elsewhere.expect_error(), ::testing::HasSubstr("no valid ticket"));
    ticket.mutable_ticket()->clear_key();
    walld_->send(ticket);
    shown();  // behind which the node knows it
    Client here(node_address());
    here.hello(3, "secret3");
    here.expect(wire::FrameKind::welcome);
}

// The oldest of those who have shown no ticket goes; whoever has shown one stays, and new ones are let in.
TEST_F(NodeServerTest, ConnectionsWithoutATicketAreBounded) {
    Client known(node_address());
    known.hello(1, "secret1");
    known.expect(wire::FrameKind::welcome);
    std::vector<std::unique_ptr<Client>> silent;
    for (std::size_t i = 0; i < kStrangers + 2; ++i) silent.push_back(std::make_unique<Client>(node_address()));
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_THAT(silent[i]->expect_error(), ::testing::HasSubstr("shown no ticket")) << i;
    Client another(node_address());
    another.hello(2, "secret2");
    another.expect(wire::FrameKind::welcome);
    EXPECT_THAT(silent[2]->expect_error(), ::testing::HasSubstr("shown no ticket"));
    known.batch(one_frame({1, 0, 0, 0}, 1));
    known.expect(wire::FrameKind::swap_done);
    // One of the others may still say who it is.
    silent.back()->hello(2, "guess");
    EXPECT_THAT(silent.back()->expect_error(), ::testing::HasSubstr("no valid ticket"));
}

TEST_F(NodeServerTest, SaysWhatASessionCostsUntilItEnds) {
    {
        Client client(node_address());
        client.hello(1, "secret1");
        client.expect(wire::FrameKind::welcome);
        client.batch(one_frame({1, 0, 0, 0}, 1));
        client.expect(wire::FrameKind::swap_done);
        proto::NodeStats stats;
        while (stats.frames() == 0) stats = walld_->wait_for(proto::Envelope::kNodeStats).node_stats();
        ASSERT_EQ(stats.session_stats_size(), 1);
        const auto& session = stats.session_stats(0);
        EXPECT_EQ(session.session(), 1u);
        EXPECT_EQ(session.frames(), 1u);
        EXPECT_EQ(session.context_switches(), 1u);
        EXPECT_EQ(session.queued_bytes(), 0u);
        EXPECT_GT(session.state_bytes(), 0u);
        EXPECT_GT(session.geometry_bytes(), 0u);
        EXPECT_GT(session.decode_ns(), 0u);
        EXPECT_EQ(stats.decode_ns(), session.decode_ns());
        EXPECT_GT(stats.objects().textures(), 0u);
    }
    proto::NodeStats stats;
    do stats = walld_->wait_for(proto::Envelope::kNodeStats).node_stats();
    while (stats.session_stats_size() > 0);
    EXPECT_EQ(stats.frames(), 1u) << "the node's total stays";
    EXPECT_EQ(stats.objects().textures(), 0u);
}

TEST_F(NodeServerTest, GoesOnWithoutWalldAndFindsItAgain) {
    Client client(node_address());
    client.hello(1, "secret1");
    client.expect(wire::FrameKind::welcome);
    walld_->drop();
    client.batch(one_frame({0, 0, 1, 0}, 1));
    client.expect(wire::FrameKind::swap_done);
    introduce();
    stack_session(1);
    present(1, 1);
    EXPECT_EQ(shown(), (std::vector{0, 0, 255}));
}

/// Waits for a frame that may take a minute, while walld is not silent.
bool swapped(FakeWalld& walld, client::NodeStream& stream, std::uint32_t frame) {
    for (int seconds = 0; seconds < 300 && !stream.failed(); ++seconds) {  // a sanitizer on a busy machine is slow
        if (stream.wait_swap(SurfaceId(1), frame, 1000)) return true;
        walld.send_pong();
    }
    return false;
}

// ---- rings ----

TEST_F(NodeServerTest, TakesBatchesOutOfARing) {
    stack_session(1);
    auto ring = wire::RingWriter::create(wire::RingMemory::kSmallest);
    ASSERT_TRUE(ring);
    Client client(node_address());
    client.hello_with(ring->descriptor(), 1, "secret1");
    client.expect(wire::FrameKind::ring);
    const auto first = Client::batch_frame(one_frame({1, 0, 0, 1}, 1));
    ASSERT_EQ(ring->write(first), first.size());
    client.sign();
    client.expect(wire::FrameKind::swap_done);
}

TEST_F(NodeServerTest, SaysWhenThereIsRoomInARingAgain) {
    stack_session(1);
    auto ring = wire::RingWriter::create(wire::RingMemory::kSmallest);
    ASSERT_TRUE(ring);
    Client client(node_address());
    client.hello_with(ring->descriptor(), 1, "secret1");
    client.expect(wire::FrameKind::ring);
    wire::PackBuffer buffer;
    say_much(buffer, 100'000);
    const auto much = Client::batch_frame(buffer);
    ASSERT_GT(much.size(), wire::RingMemory::kSmallest);
    const std::size_t sent = ring->write(much);
    ASSERT_TRUE(ring->wait_for_room());
    client.sign();
    client.expect(wire::FrameKind::room);
    EXPECT_GT(ring->write(std::span(much).subspan(sent)), 0u);
}

TEST_F(NodeServerTest, RefusesARingThatIsNone) {
    stack_session(1);
    const UniqueFd open_memory(::memfd_create("test", MFD_CLOEXEC));
    ASSERT_EQ(::ftruncate(open_memory.get(), 4096 + 65536), 0);
    Client client(node_address());
    client.hello_with(open_memory.get(), 1, "secret1");
    EXPECT_THAT(client.expect_error(), ::testing::HasSubstr("sealed against another size"));
}

TEST_F(NodeServerTest, EndsAStreamWhoseRingCannotBe) {
    stack_session(1);
    auto ring = wire::RingWriter::create(wire::RingMemory::kSmallest);
    ASSERT_TRUE(ring);
    auto memory = wire::RingMemory::map(ring->descriptor(), wire::RingMemory::kSmallest);
    ASSERT_TRUE(memory);
    Client client(node_address());
    client.hello_with(ring->descriptor(), 1, "secret1");
    client.expect(wire::FrameKind::ring);
    memory->counters().written = ~std::uint64_t{0} / 2;
    client.sign();
    EXPECT_THAT(client.expect_error(), ::testing::HasSubstr("more than it can hold"));
}

// ---- connections that are lost ----

/// Brings bytes from whoever connects to it to the node, and back, and breaks in between.
class BreakingLink {
public:
    explicit BreakingLink(net::Address node) : node_(std::move(node)) {
        listens_ = std::move(*net::listen_on(*net::Address::parse("127.0.0.1:0"), net::Peers::of_this_machine));
        sockaddr_in at{};
        socklen_t length = sizeof at;
        ::getsockname(listens_.get(), reinterpret_cast<sockaddr*>(&at), &length);
        address_ = "127.0.0.1:" + std::to_string(ntohs(at.sin_port));
        thread_ = std::thread([this] { run(); });
    }
    ~BreakingLink() {
        stop_ = true;
        thread_.join();
    }
    const std::string& address() const { return address_; }
    /// After so many more bytes, both ways together.
    void break_after(std::int64_t bytes) { left_ = bytes; }
    int connections() const { return connections_; }

private:
    void run() {
        while (!stop_) {
            if (!readable(listens_.get(), std::chrono::milliseconds(20))) continue;
            const UniqueFd client(::accept(listens_.get(), nullptr, nullptr));
            const UniqueFd node = std::move(*net::connect_to(node_, kPatience));
            ++connections_;
            pump(client.get(), node.get());
        }
    }
    void pump(int client, int node) {
        std::vector<char> room(8192);
        while (!stop_) {
            pollfd ends[2] = {{client, POLLIN, 0}, {node, POLLIN, 0}};
            if (::poll(ends, 2, 20) <= 0) continue;
            for (const int i : {0, 1}) {
                if (ends[i].revents == 0) continue;
                const ssize_t n = ::read(ends[i].fd, room.data(), room.size());
                if (n <= 0) return;
                const auto passed = std::min<std::int64_t>(n, std::max<std::int64_t>(left_, 0));
                if (::send(ends[1 - i].fd, room.data(), static_cast<std::size_t>(passed), MSG_NOSIGNAL) < passed)
                    return;
                if ((left_ -= passed) <= 0) {
                    left_ = kNever;
                    return;
                }
            }
        }
    }
    static constexpr std::int64_t kNever = std::int64_t{1} << 62;
    net::Address node_;
    UniqueFd listens_;
    std::string address_;
    std::atomic<std::int64_t> left_{kNever};
    std::atomic<int> connections_{0};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

class ANodeOfAnotherMachine : public NodeServerTest {
protected:
    std::string listen_at() const override { return "127.0.0.1:0"; }
    static std::string hello_of(std::uint32_t session, std::uint32_t resume = 0, std::uint64_t received = 0,
                                std::uint64_t attempt = 0) {
        proto::DataHello hello;
        hello.set_version(glapi::kStreamVersion);
        hello.set_session(session);
        hello.set_ticket("secret" + std::to_string(session));
        if (resume != 0) {
            hello.mutable_resume()->set_stream(resume);
            hello.mutable_resume()->set_received(received);
            hello.mutable_resume()->set_attempt(attempt);
        }
        return hello.SerializeAsString();
    }
    /// Comes and gives the stream's number.
    static std::uint32_t come(Client& client, std::uint32_t session) {
        const std::string hello = hello_of(session);
        client.send(wire::FrameKind::hello, std::as_bytes(std::span(hello)));
        const auto welcome = client.next();
        std::uint32_t number = 0;
        EXPECT_TRUE(welcome && welcome->kind == wire::FrameKind::welcome && welcome->payload.size() == sizeof number);
        if (welcome) std::memcpy(&number, welcome->payload.data(), sizeof number);
        EXPECT_NE(number, 0u);
        return number;
    }
    static void come_again(Client& client, std::uint32_t session, std::uint32_t stream, std::uint64_t received,
                           std::uint64_t attempt = 1) {
        const std::string hello = hello_of(session, stream, received, attempt);
        client.send(wire::FrameKind::hello, std::as_bytes(std::span(hello)));
    }
};

class ABreakingStream : public ANodeOfAnotherMachine, public ::testing::WithParamInterface<client::Coding> {};
INSTANTIATE_TEST_SUITE_P(Coding, ABreakingStream, ::testing::Values(client::Coding::never, client::Coding::always));

/// Wherever it breaks, in the midst of a batch or an answer: all comes through, once, in order.
TEST_P(ABreakingStream, GoesOnWhereItBroke) {
    stack_session(1);
    BreakingLink link(node_address());
    auto stream = client::NodeStream::open(link.address(), hello_of(1), 10'000, false, GetParam());
    ASSERT_TRUE(stream) << stream.error().message;
    client::Transport transport([] {});
    transport.add(*stream);
    constexpr std::uint32_t kFrames = 400;
    const unsigned most = GetParam() == client::Coding::always ? 2'000 : 40'000;  // bytes until it breaks
    std::minstd_rand chance(1);
    for (std::uint32_t frame = 1; frame <= kFrames; ++frame) {
        if (frame % 40 == 1) link.break_after(static_cast<std::int64_t>(1 + chance() % most));
        if (frame % 100 == 0) walld_->send_pong();
        wire::PackBuffer buffer = one_frame({0, static_cast<float>(frame % 2), 0, 0}, frame);
        say_much(buffer, chance() % 2000);
        pack::Sync(buffer, RequestId(frame));
        (*stream)->send(ContextId(1), std::move(buffer));
        transport.wake();
        const auto answer = (*stream)->wait_reply(RequestId(frame), 10'000);
        ASSERT_TRUE(answer) << "frame " << frame << ": " << (*stream)->failure();
        proto::Envelope present;
        present.mutable_present()->set_session(1);
        present.mutable_present()->set_surface(1);
        present.mutable_present()->set_frame(frame);
        walld_->send(present);
    }
    EXPECT_TRUE((*stream)->wait_swap(SurfaceId(1), kFrames, 10'000));
    EXPECT_FALSE((*stream)->failed()) << (*stream)->failure();
    EXPECT_GT(link.connections(), 5);
    EXPECT_EQ(shown(), (std::vector{0, 0, 0}));
}

TEST_F(ANodeOfAnotherMachine, SendsAgainWhatHasNotComeToTheClient) {
    stack_session(1);
    std::uint32_t number = 0;
    {
        Client client(node_address());
        number = come(client, 1);
        client.batch(one_frame({1, 0, 0, 1}, 1));
        client.expect(wire::FrameKind::swap_done);
    }
    for (const bool seen : {false, true}) {
        Client again(node_address());
        come_again(again, 1, number, seen ? 1 : 0, seen ? 2 : 1);
        const auto resumed = again.next();
        ASSERT_TRUE(resumed && resumed->kind == wire::FrameKind::resumed && resumed->payload.size() == 8);
        EXPECT_EQ(std::to_integer<int>(resumed->payload[0]), 1) << "one batch has come";
        if (seen) again.batch(one_frame({0, 1, 0, 1}, 2));
        again.expect(wire::FrameKind::swap_done);
    }
}

// ---- parcels that nodes hand on to each other ----

class ANodeThatHandsOn : public ANodeOfAnotherMachine {
protected:
    static constexpr std::uint32_t kSelf = 0, kOther = 3;

    /// Comes as another node that hands parcels on.
    static void come_as_peer(Client& peer, std::uint32_t session = 1) {
        proto::DataHello hello;
        hello.set_version(glapi::kStreamVersion);
        hello.set_session(session);
        hello.set_ticket("secret" + std::to_string(session));
        hello.set_parcels(true);
        const std::string bytes = hello.SerializeAsString();
        peer.send(wire::FrameKind::hello, std::as_bytes(std::span(bytes)));
    }
    static void awaits(Client& client, std::uint32_t number) {
        const std::array<std::uint32_t, 2> words{number, kOther};
        client.send(wire::FrameKind::awaited, std::as_bytes(std::span(words)));
    }
    static std::vector<std::byte> batch_of(const wire::PackBuffer& buffer) {
        std::vector<std::byte> batch;
        wire::append_batch(batch, {ContextId(1), buffer.opcodes(), buffer.operands()});
        return batch;
    }
    /// Bytes `first` to `behind` of a batch as a piece.
    static void send_piece(Client& from, std::uint32_t number, std::span<const std::byte> batch,
                           std::vector<NodeIndex> route, std::size_t position, std::size_t first, std::size_t behind) {
        auto piece = wire::encode_parcel_lead({number, static_cast<std::uint32_t>(batch.size()), 0,
                                               static_cast<std::uint32_t>(first), position, std::move(route)});
        piece.insert(piece.end(), batch.begin() + static_cast<std::ptrdiff_t>(first),
                     batch.begin() + static_cast<std::ptrdiff_t>(behind));
        from.send(wire::FrameKind::parcel, piece);
    }
    static void bring(Client& peer, std::uint32_t number, const wire::PackBuffer& buffer) {
        const auto batch = batch_of(buffer);
        const std::vector route{NodeIndex(kOther), NodeIndex(kSelf)};
        send_piece(peer, number, batch, route, 1, 0, batch.size() / 2);
        send_piece(peer, number, batch, route, 1, batch.size() / 2, batch.size());
    }
    /// walld tells where the other node is.
    void tell_of_peer(const std::string& address) {
        proto::Envelope envelope;
        auto& peers = *envelope.mutable_peers();
        peers.set_session(1);
        auto& node = *peers.add_nodes();
        node.set_node(kOther);
        node.set_address(address);
        node.set_ticket("there");
        walld_->send(envelope);
    }
    /// The program hands a frame to this node, for it and the other one.
    static void send_frame_to_both(Client& client, std::uint32_t frame) {
        const auto batch = batch_of(one_frame({1, 0, 0, 1}, frame));
        send_piece(client, frame, batch, {NodeIndex(kSelf), NodeIndex(kOther)}, 0, 0, batch.size());
    }
    static std::array<std::uint32_t, 2> words_of(const std::optional<wire::Frame>& frame) {
        std::array<std::uint32_t, 2> words{};
        if (frame && frame->payload.size() <= sizeof words)
            std::memcpy(words.data(), frame->payload.data(), frame->payload.size());
        return words;
    }
};

TEST_F(ANodeThatHandsOn, DrawsNothingBehindAParcelBeforeItHasCome) {
    stack_session(1);
    Client client(node_address()), peer(node_address());
    come(client, 1);
    awaits(client, 5);
    client.batch(one_frame({0, 1, 0, 1}, 2));
    come_as_peer(peer);
    wire::PackBuffer early = one_frame({0, 0, 1, 1}, 3);
    bring(peer, 5, one_frame({1, 0, 0, 1}, 1));
    const auto said = client.next();
    ASSERT_TRUE(said && said->kind == wire::FrameKind::handed_on);
    EXPECT_EQ(words_of(said)[0], 5u);
    for (const std::uint32_t frame : {1u, 2u}) {
        const auto done = client.next();
        ASSERT_TRUE(done && done->kind == wire::FrameKind::swap_done);
        EXPECT_EQ(words_of(done)[1], frame);
    }
    bring(peer, 6, early);  // and then its place
    client.expect(wire::FrameKind::handed_on);
    awaits(client, 6);
    client.expect(wire::FrameKind::swap_done);
}

TEST_F(ANodeThatHandsOn, TakesPiecesOfSeveralParcelsInAnyOrder) {
    stack_session(1);
    Client client(node_address()), peer(node_address());
    come(client, 1);
    awaits(client, 5);
    awaits(client, 6);
    come_as_peer(peer);
    const std::vector route{NodeIndex(kOther), NodeIndex(kSelf)};
    const auto first = batch_of(one_frame({1, 0, 0, 1}, 1)), second = batch_of(one_frame({0, 1, 0, 1}, 2));
    send_piece(peer, 6, second, route, 1, 0, 20);
    send_piece(peer, 5, first, route, 1, 0, 40);
    send_piece(peer, 6, second, route, 1, 20, second.size());
    send_piece(peer, 5, first, route, 1, 40, first.size());
    for (const std::uint32_t number : {6u, 5u}) {
        const auto said = client.next();
        ASSERT_TRUE(said && said->kind == wire::FrameKind::handed_on);
        EXPECT_EQ(words_of(said)[0], number);
    }
    for (const std::uint32_t frame : {1u, 2u}) {
        const auto done = client.next();
        ASSERT_TRUE(done && done->kind == wire::FrameKind::swap_done);
        EXPECT_EQ(words_of(done)[1], frame);
    }
}

TEST_F(ANodeThatHandsOn, HandsOnWhatItGets) {
    stack_session(1);
    auto listener = std::move(*net::listen_on(*net::Address::parse("unix:" + folder_ + "/other.sock")));
    tell_of_peer("unix:" + folder_ + "/other.sock");
    Client client(node_address());
    come(client, 1);
    send_frame_to_both(client, 1);
    client.expect(wire::FrameKind::swap_done);
    ASSERT_TRUE(readable(listener.get()));
    Client other(UniqueFd(::accept(listener.get(), nullptr, nullptr)));
    const auto greeting = other.next();
    ASSERT_TRUE(greeting && greeting->kind == wire::FrameKind::hello);
    proto::DataHello hello;
    ASSERT_TRUE(hello.ParseFromArray(greeting->payload.data(), static_cast<int>(greeting->payload.size())));
    EXPECT_TRUE(hello.parcels() && !hello.partials());
    EXPECT_EQ(hello.ticket(), "there");
    const auto handed = other.next();
    ASSERT_TRUE(handed && handed->kind == wire::FrameKind::parcel);
    const auto piece = wire::read_parcel_piece(handed->payload);
    ASSERT_TRUE(piece);
    EXPECT_EQ(piece->lead.position, 1u);
    EXPECT_TRUE(std::ranges::equal(piece->content, batch_of(one_frame({1, 0, 0, 1}, 1))));
    other = Client(UniqueFd());
    client.expect(wire::FrameKind::not_handed_on);  // nobody knows what it has made of it
}

TEST_F(ANodeThatHandsOn, TellsTheProgramWhomItCannotReach) {
    stack_session(1);
    Client client(node_address());
    come(client, 1);
    const auto not_handed_on = [&] {
        std::optional<wire::Frame> frame;
        do frame = client.next();
        while (frame && frame->kind == wire::FrameKind::swap_done);
        return frame && frame->kind == wire::FrameKind::not_handed_on && words_of(frame)[0] == kOther;
    };
    send_frame_to_both(client, 1);
    EXPECT_TRUE(not_handed_on()) << "walld has not told where it is";
    tell_of_peer("unix:" + folder_ + "/nobody.sock");
    send_frame_to_both(client, 2);
    EXPECT_TRUE(not_handed_on()) << "nobody is there";
}

TEST_F(ANodeThatHandsOn, EndsAStreamThatWaitsForWhatDoesNotCome) {
    stack_session(1);
    Client client(node_address());
    const auto number = come(client, 1);
    awaits(client, 1);
    awaits(client, 2);
    {
        Client peer(node_address());
        come_as_peer(peer);
        bring(peer, 1, one_frame({1, 0, 0, 1}, 1));
        client.expect(wire::FrameKind::handed_on);
        client.expect(wire::FrameKind::swap_done);
    }
    EXPECT_FALSE(client.next()) << "its connection is closed";
    Client again(node_address());
    come_again(again, 1, number, 1);
    EXPECT_THAT(again.expect_error(), ::testing::HasSubstr("is over"));
    Client anew(node_address());
    come(anew, 1);
    anew.batch(one_frame({1, 0, 0, 1}, 1));
    anew.expect(wire::FrameKind::swap_done);
}

TEST_F(ANodeThatHandsOn, APeerThatIsGoneByWalldsWordIsNotWaitedFor) {
    stack_session(1);
    tell_of_peer("unix:" + folder_ + "/nobody.sock");
    Client client(node_address());
    come(client, 1);
    awaits(client, 1);
    client.batch(one_frame({1, 0, 0, 1}, 1));
    proto::Envelope nobody;
    nobody.mutable_peers()->set_session(1);
    std::this_thread::sleep_for(100ms);  // until it awaits it
    walld_->send(nobody);
    EXPECT_FALSE(client.next());
}

TEST_F(ANodeThatHandsOn, ABadPeerEndsAlone) {
    stack_session(1);
    Client client(node_address());
    come(client, 1);
    Client noise(node_address()), of_another(node_address()), gap(node_address());
    come_as_peer(noise);
    noise.send(wire::FrameKind::parcel, std::vector<std::byte>(5));
    EXPECT_THAT(noise.expect_error(), ::testing::HasSubstr("parcel"));
    come_as_peer(of_another, 2);
    bring(of_another, 1, one_frame({1, 0, 0, 1}, 1));
    come_as_peer(gap);
    const auto batch = batch_of(one_frame({1, 0, 0, 1}, 1));
    send_piece(gap, 1, batch, {NodeIndex(kOther), NodeIndex(kSelf)}, 1, 8, batch.size());
    EXPECT_THAT(gap.expect_error(), ::testing::HasSubstr("missing"));
    client.batch(one_frame({1, 0, 0, 1}, 1));
    client.expect(wire::FrameKind::swap_done);
}

TEST_F(ANodeOfAnotherMachine, GoesOnWithNoStreamOfAnotherSessionNorWithOneThatIsOver) {
    stack_session(1);
    Client first(node_address());
    const auto number = come(first, 1);
    const auto refused = [&](std::uint32_t session, std::uint32_t stream, std::uint64_t received) {
        Client client(node_address());
        come_again(client, session, stream, received);
        return client.expect_error();
    };
    EXPECT_THAT(refused(2, number, 0), ::testing::HasSubstr("is over")) << "another session's";
    EXPECT_THAT(refused(1, number + 100, 0), ::testing::HasSubstr("is over")) << "there was none";
    EXPECT_THAT(refused(1, number, 5), ::testing::HasSubstr("is over")) << "so much was never sent";
    first.batch(one_frame({1, 0, 0, 1}, 1));
    first.expect(wire::FrameKind::swap_done);
    proto::Envelope end;
    end.mutable_session_end()->set_session(1);
    walld_->send(end);
    EXPECT_FALSE(first.next());
    EXPECT_NE(refused(1, number, 0), "no error frame") << "its ticket is none any more";
}

TEST_F(ANodeOfAnotherMachine, IsNotLedBackByAnAttemptThatWasOnItsWayForLong) {
    stack_session(1);
    Client first(node_address());
    const auto number = come(first, 1);
    Client newer(node_address());
    come_again(newer, 1, number, 0, 20);
    newer.expect(wire::FrameKind::resumed);
    Client older(node_address());
    come_again(older, 1, number, 0, 10);
    EXPECT_THAT(older.expect_error(), ::testing::HasSubstr("is over"));
    newer.batch(one_frame({1, 0, 0, 1}, 1));
    newer.expect(wire::FrameKind::swap_done);
}

TEST_F(ANodeOfAnotherMachine, ForgetsALostStreamWhenItsProgramBeginsANewOne) {
    stack_session(1);
    std::uint32_t number = 0;
    {
        Client client(node_address());
        number = come(client, 1);
    }
    Client anew(node_address());
    EXPECT_NE(come(anew, 1), number);
    Client late(node_address());
    come_again(late, 1, number, 0);
    EXPECT_THAT(late.expect_error(), ::testing::HasSubstr("is over"));
}

/// From the client library's end: more than a frame holds.
class ABatchLargerThanAFrame : public NodeServerTest, public ::testing::WithParamInterface<bool> {};

TEST_P(ABatchLargerThanAFrame, Arrives) {
    stack_session(1);
    proto::DataHello hello;
    hello.set_version(glapi::kStreamVersion);
    hello.set_session(1);
    hello.set_ticket("secret1");
    auto stream = client::NodeStream::open(node_address().text(), hello.SerializeAsString(), 10'000, GetParam());
    ASSERT_TRUE(stream) << stream.error().message;
    EXPECT_EQ((*stream)->has_ring(), GetParam());
    client::Transport transport([] {});
    transport.add(*stream);
    wire::PackBuffer buffer = one_frame({0, 0, 0, 0}, 1), body;
    const std::vector<std::byte> content(4 << 20);
    constexpr ClientName kBuffer(7);
    pack::BufferData(buffer, kBuffer, static_cast<std::uint32_t>(content.size()), GL_STATIC_DRAW);
    while (buffer.bytes() <= wire::kMaxFramePayload) pack::BufferSubData(buffer, kBuffer, 0, content);
    const glstate::Vec4 green{0, 1, 0, 1};
    glapi::pack_state(buffer, glstate::el::clear_color::id, &green, sizeof green);
    pack::Clear(body, GL_COLOR_BUFFER_BIT);
    pack::Block(buffer, 1, 0, static_cast<std::uint32_t>(body.commands()),
                static_cast<std::uint32_t>(body.operand_bytes()));
    buffer.append(body, {}, body.mark());
    pack::Swap(buffer, SurfaceId(1), 2);
    (*stream)->send(ContextId(1), std::move(buffer));
    transport.wake();
    EXPECT_TRUE(swapped(*walld_, **stream, 1)) << (*stream)->failure();
    present(1, 1);
    EXPECT_TRUE(swapped(*walld_, **stream, 2)) << (*stream)->failure();
    present(1, 2);
    EXPECT_EQ(shown(), (std::vector{0, 255, 0}));
}

INSTANTIATE_TEST_SUITE_P(Transports, ABatchLargerThanAFrame, ::testing::Bool(),
                         [](const auto& ring) { return ring.param ? "ring" : "socket"; });

class StuckDriverTest : public NodeServerTest {
protected:
    StuckDriverTest() { longest_turn_ = 100ms; }
    /// One call of the driver that takes some tenths of a second.
    static wire::PackBuffer long_call() {
        wire::PackBuffer buffer = one_frame({0, 0, 0, 0}, 1), body;
        const std::array<float, 4 * 3> corners = {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0};
        pack::Map2(buffer, GL_MAP2_VERTEX_3, 0, 1, 2, 0, 1, 2, std::as_bytes(std::span(corners)));
        const glstate::Flag on = 1;
        glapi::pack_state(buffer, glstate::el::map2_vertex_3::id, &on, sizeof on);
        pack::EvalMesh2(body, GL_FILL, 0, 2000, 0, 2000);
        pack::Block(buffer, 1, 0, static_cast<std::uint32_t>(body.commands()),
                    static_cast<std::uint32_t>(body.operand_bytes()));
        buffer.append(body, {}, body.mark());
        return buffer;
    }
};

TEST_F(StuckDriverTest, TheSessionIsEndedAndShutOut) {
    Client good(node_address()), bad(node_address());
    good.hello(1, "secret1");
    bad.hello(2, "secret2");
    good.expect(wire::FrameKind::welcome);
    bad.expect(wire::FrameKind::welcome);
    bad.batch(long_call());
    bad.expect(wire::FrameKind::swap_done);
    EXPECT_THAT(bad.expect_error(), ::testing::HasSubstr("longer than 100 ms"));
    const auto fault = walld_->wait_for(proto::Envelope::kSessionFault).session_fault();
    EXPECT_EQ(fault.session(), 2u);
    EXPECT_TRUE(fault.ends());
    Client again(node_address());
    again.hello(2, "secret2");
    EXPECT_THAT(again.expect_error(), ::testing::HasSubstr("not let in"));
    stack_session(1);
    good.batch(one_frame({0, 1, 0, 0}, 1));
    good.expect(wire::FrameKind::swap_done);
    present(1, 1);
    EXPECT_EQ(shown(), (std::vector{0, 255, 0})) << "the others go on when the driver has come back";
}

TEST_F(NodeServerTest, ShowsFramesByItselfWhileWalldIsSilent) {
    Client client(node_address());
    client.hello(1, "secret1");
    client.expect(wire::FrameKind::welcome);
    stack_session(1);
    EXPECT_EQ(shown(), (std::vector{0x10, 0x20, 0x30}));
    const auto begin = std::chrono::steady_clock::now();
    constexpr std::uint32_t kFrames = 20;
    for (std::uint32_t frame = 1; frame <= kFrames; ++frame) {  // each one waits until the one before is shown
        client.batch(one_frame({0, 1, 0, 0}, frame));
        client.expect(wire::FrameKind::swap_done);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, (kFrames / 2) * config_.swap_timeout)
        << "the limit is paid once";
    // A sign of life: it is told where the node is, and says again when a frame is shown.
    walld_->send_pong();
    proto::Rendered rendered;
    do rendered = walld_->wait_for(proto::Envelope::kRendered).rendered();
    while (!rendered.has_shown());
    EXPECT_EQ(rendered.session(), 1u);
    EXPECT_GE(rendered.shown() + 1, kFrames);
    EXPECT_EQ(rendered.frame(), kFrames);
}

TEST_F(NodeServerTest, WaitsForAWalldThatAnswers) {
    Client client(node_address());
    draw_first_frame(client, {1, 0, 0, 0});
    answer_pings(4 * config_.swap_timeout);
    EXPECT_EQ(shown(), (std::vector{0, 0, 0})) << "walld lives, and has not said that it is to be shown";
    present(1, 1);
    EXPECT_EQ(shown(), (std::vector{255, 0, 0}));
}

TEST_F(NodeServerTest, HoldsWhatIsHeldWithoutWalldToo) {
    Client client(node_address());
    draw_first_frame(client, {1, 0, 0, 0}, true);
    std::this_thread::sleep_for(4 * config_.swap_timeout);
    EXPECT_EQ(shown(), (std::vector{0, 0, 0}));
    walld_->drop();
    introduce();
    EXPECT_EQ(shown(), (std::vector{0, 0, 0}));
    stack_session(1, true);
    proto::Envelope request;
    request.mutable_frames_request()->set_session(1);
    walld_->send(request);
    proto::Rendered rendered;
    do rendered = walld_->wait_for(proto::Envelope::kRendered).rendered();
    while (!rendered.has_shown());
    EXPECT_EQ(rendered.frame(), 1u);
    EXPECT_EQ(rendered.shown(), 0u);
    present(1, 1);
    expect_shown({255, 0, 0});
}

TEST_F(NodeServerTest, TellsTheNextWalldWhatItHas) {
    Client client(node_address());
    draw_first_frame(client, {0, 0, 1, 0});
    present(1, 1);
    expect_shown({0, 0, 255});
    proto::Envelope note;
    note.mutable_wall_note()->set_version(5);
    note.mutable_wall_note()->add_waiting()->set_program("gears");
    walld_->send(note);
    EXPECT_EQ(shown(), (std::vector{0, 0, 255}));
    walld_->drop();
    const auto hello = introduce();
    EXPECT_EQ(hello.sessions_size(), 2);
    for (const auto& known : hello.sessions()) EXPECT_EQ(known.ticket(), "secret" + std::to_string(known.session()));
    EXPECT_EQ(hello.wall_note().version(), 5u);
    EXPECT_EQ(hello.wall_note().waiting(0).program(), "gears");
    // A walld that waits for the session leaves in sight what it has.
    proto::Envelope stacking;
    stacking.mutable_stacking()->add_returning(1);
    walld_->send(stacking);
    EXPECT_EQ(shown(), (std::vector{0, 0, 255}));
    stacking.mutable_stacking()->clear_returning();
    walld_->send(stacking);
    EXPECT_EQ(shown(), (std::vector{0x10, 0x20, 0x30}));
}

TEST_F(NodeServerTest, ANumberWithAnotherTicketIsAnotherSession) {
    Client before(node_address());
    draw_first_frame(before, {1, 0, 0, 0});
    present(1, 1);
    expect_shown({255, 0, 0});
    proto::Envelope ticket;
    ticket.mutable_ticket()->set_session(1);
    ticket.mutable_ticket()->set_ticket("another");
    walld_->send(ticket);
    EXPECT_FALSE(before.next()) << "its stream has ended";
    expect_shown({0x10, 0x20, 0x30});
    Client after(node_address());
    after.hello(1, "another");
    after.expect(wire::FrameKind::welcome);
    Client late(node_address());
    late.hello(1, "secret1");
    EXPECT_THAT(late.expect_error(), ::testing::HasSubstr("ticket"));
}

TEST_F(NodeServerTest, AnEndedSessionIsGone) {
    Client client(node_address());
    draw_first_frame(client, {1, 1, 1, 0});
    proto::Envelope end;
    end.mutable_session_end()->set_session(1);
    walld_->send(end);
    EXPECT_FALSE(client.next());
    EXPECT_EQ(shown(), (std::vector{0x10, 0x20, 0x30}));
}

}  // namespace
}  // namespace wall::tileserver
