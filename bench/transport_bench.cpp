// SPDX-License-Identifier: MIT
// How many bytes a second go from a program to a node: one way of bringing them, for some time (bench/transport.py
// runs all of them in turn).
//
//   transport_bench KIND SECONDS        prints bytes a second
//
// wallgl-ring, -unix, -tcp: batches through the library's NodeStream and Transport, over the I/O thread's FrameSource,
// to whoever takes them out of the queue in which the render thread finds them. wallgl-tls: what an agent writes to a
// node. bare-*: the least that must happen: one thread writes the same bytes again and again, another one reads them
// all to one place, over a ring, a socket, or a socket with each record sealed by AES-256-GCM.
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <openssl/evp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <semaphore>
#include <string>
#include <thread>

#include "client_lib/link/node_stream.h"
#include "client_lib/link/transport.h"
#include "common/net/control_connection.h"
#include "common/tls/identity.h"
#include "common/wire/limits.h"
#include "common/wire/ring.h"
#include "tileserver/io/frame_source.h"
#include "tileserver/render/batch_queue.h"

namespace wall {
namespace {

namespace asio = boost::asio;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kWrite = 1 << 20;  // bytes at a time, as of one batch

[[noreturn]] void give_up(const std::string& why) {
    std::fprintf(stderr, "transport_bench: %s\n", why.c_str());
    std::exit(2);
}

/// What has come so far; asked for at the beginning and at the end of the time that counts. The threads that bring it
/// go on until the process ends.
std::atomic<std::uint64_t> came{0};

double measure(double seconds) {
    const auto pause = [](double s) { std::this_thread::sleep_for(std::chrono::duration<double>(s)); };
    pause(0.2);  // until it runs as it will
    const auto begin = Clock::now();
    const std::uint64_t first = came;
    pause(seconds);
    const std::chrono::duration<double> took = Clock::now() - begin;
    return static_cast<double>(came - first) / took.count();
}

// ---- as WallGL does it ----

class Node {
public:
    explicit Node(const std::string& address) {
        auto listener = net::Listener::open(io_.get_executor(), *net::Address::parse(address));
        if (!listener) give_up(listener.error().message);
        listener_.emplace(std::move(*listener));
    }
    std::string address() const { return listener_->address().text(); }
    const net::Address& at() const { return listener_->address(); }
    const tls::Fingerprint& key() const { return own_->fingerprint(); }

    void serve(bool with_tls) {
        asio::co_spawn(io_, take(with_tls), asio::detached);
        std::thread([this] { io_.run(); }).detach();
        std::thread([this] { render(); }).detach();
    }

private:
    asio::awaitable<void> take(bool with_tls) {
        auto socket = co_await listener_->accept();
        if (!socket) give_up(socket.error().message);
        if (with_tls) {
            auto accepted = co_await net::Stream::accept_tls(std::move(*socket), *own_);
            if (!accepted) give_up(accepted.error().message);
            stream_.emplace(std::move(*accepted));
        } else {
            stream_.emplace(std::move(*socket));
        }
        auto& stream = *stream_;
        tileserver::FrameSource source(stream, wire::kMaxFramePayload, [](std::size_t bytes) { came += bytes; });
        if (auto hello = co_await source.next(); !hello) give_up(hello.error().message);
        const auto told = [](wire::FrameKind kind) { return wire::encode_frame_header({0, kind}); };
        const auto room = told(wire::FrameKind::room);
        auto ring = source.take_ring([&] {
            if (::send(stream.descriptor(), room.data(), room.size(), MSG_NOSIGNAL) < 0) give_up("nobody reads");
        });
        if (!ring) give_up(ring.error().message);
        const auto welcome = told(*ring ? wire::FrameKind::ring : wire::FrameKind::welcome);
        co_await stream.write(asio::buffer(welcome));
        for (;;) {
            source.lend(queue_.take_spare());
            auto frame = co_await source.next();
            if (!frame) co_return;
            room_ = queue_.push(std::move(frame->payload));
            pushed_.release();
            while (!room_) co_await asio::post(io_, asio::use_awaitable);
        }
    }
    void render() {
        for (;;) {
            pushed_.acquire();
            queue_.give_back(queue_.pop());
        }
    }

    asio::io_context io_{1};
    std::optional<net::Listener> listener_;
    std::optional<net::Stream> stream_;
    std::shared_ptr<const tls::TlsContext> own_ =
        std::make_shared<const tls::TlsContext>(*tls::TlsContext::make(*tls::Identity::make()));
    std::atomic<bool> room_{true};
    tileserver::BatchQueue queue_{[this] { room_ = true; }};
    std::counting_semaphore<> pushed_{0};
};

double wallgl(const std::string& address, bool ring, double seconds) {
    static Node node(address);
    node.serve(false);
    auto stream = client::NodeStream::open(node.address(), "hello", 5000, ring);
    if (!stream) give_up(stream.error().message);
    if ((*stream)->has_ring() != ring) give_up("not the transport that was asked for");
    static client::Transport transport([] { give_up("the stream has failed"); });
    transport.add(*stream);
    std::thread([stream = *stream] {
        for (;;) {
            wire::PackBuffer batch = stream->spare();
            batch.append(0, kWrite);
            stream->send(ContextId(1), std::move(batch));
            transport.wake();
        }
    }).detach();
    return measure(seconds);
}

double wallgl_tls(double seconds) {
    static Node node("127.0.0.1:0");
    node.serve(true);
    static asio::io_context io(1);
    static const auto own = std::make_shared<const tls::TlsContext>(*tls::TlsContext::make(*tls::Identity::make()));
    const auto write = []() -> asio::awaitable<void> {
        auto stream = co_await net::Stream::connect_tls(node.at(), *own, node.key());
        if (!stream) give_up(stream.error().message);
        const std::vector<std::byte> payload(kWrite);
        const auto head = wire::encode_frame_header({kWrite, wire::FrameKind::batch});
        const auto hello = wire::encode_frame_header({0, wire::FrameKind::hello});
        co_await stream->write(asio::buffer(hello));
        for (;;) {
            co_await stream->write(asio::buffer(head));
            co_await stream->write(asio::buffer(payload));
        }
    };
    asio::co_spawn(io, write(), asio::detached);
    std::thread([] { io.run(); }).detach();
    return measure(seconds);
}

// ---- the least that must happen ----

double bare_ring(double seconds) {
    static auto writer = std::move(*wire::RingWriter::create());
    static auto reader = std::move(*wire::RingReader::open(UniqueFd(::dup(writer.descriptor()))));
    std::thread([] {
        const std::vector<std::byte> bytes(kWrite, std::byte{1});
        for (;;)
            for (std::size_t done = 0; done < bytes.size();) done += writer.write(std::span(bytes).subspan(done));
    }).detach();
    std::thread([] {
        std::vector<std::byte> room(kWrite);
        for (;;) came += *reader.read(room);
    }).detach();
    return measure(seconds);
}

struct Sockets {
    int writes = -1, reads = -1;
};

Sockets unix_pair() {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) give_up("socketpair");
    return {ends[0], ends[1]};
}

Sockets tcp_pair() {
    const int listens = ::socket(AF_INET, SOCK_STREAM, 0), writes = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof at;
    auto* address = reinterpret_cast<sockaddr*>(&at);
    if (::bind(listens, address, length) != 0 || ::listen(listens, 1) != 0 ||
        ::getsockname(listens, address, &length) != 0 || ::connect(writes, address, length) != 0)
        give_up("no TCP connection");
    const int one = 1;
    ::setsockopt(writes, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
    return {writes, ::accept(listens, nullptr, nullptr)};
}

void send_all(int fd, const std::byte* data, std::size_t size) {
    while (size > 0) {
        const auto n = ::send(fd, data, size, MSG_NOSIGNAL);
        if (n <= 0) return;
        data += n;
        size -= static_cast<std::size_t>(n);
    }
}

double bare_socket(Sockets ends, double seconds) {
    std::thread([fd = ends.writes] {
        const std::vector<std::byte> bytes(kWrite, std::byte{1});
        for (;;) send_all(fd, bytes.data(), bytes.size());
    }).detach();
    std::thread([fd = ends.reads] {
        std::vector<std::byte> room(kWrite);
        for (ssize_t n = 1; n > 0; came += static_cast<std::uint64_t>(n)) n = ::recv(fd, room.data(), room.size(), 0);
    }).detach();
    return measure(seconds);
}

constexpr int kRecord = 16 << 10, kTag = 16;  // bytes; TLS's largest record

double bare_sealed(double seconds) {
    static const Sockets ends = tcp_pair();
    static const std::vector<unsigned char> key(32, 7), nonce(12, 9);
    std::thread([] {
        const std::vector<unsigned char> plain(kWrite, 1);
        std::vector<unsigned char> sealed(kWrite / kRecord * (kRecord + kTag));
        auto* context = EVP_CIPHER_CTX_new();
        EVP_EncryptInit_ex(context, EVP_aes_256_gcm(), nullptr, key.data(), nonce.data());
        for (;;) {
            for (int at = 0, out = 0; at < static_cast<int>(kWrite); at += kRecord, out += kRecord + kTag) {
                int n = 0;
                EVP_EncryptInit_ex(context, nullptr, nullptr, nullptr, nonce.data());
                EVP_EncryptUpdate(context, sealed.data() + out, &n, plain.data() + at, kRecord);
                EVP_EncryptFinal_ex(context, sealed.data() + out + n, &n);
                EVP_CIPHER_CTX_ctrl(context, EVP_CTRL_AEAD_GET_TAG, kTag, sealed.data() + out + kRecord);
            }
            send_all(ends.writes, reinterpret_cast<const std::byte*>(sealed.data()), sealed.size());
        }
    }).detach();
    std::thread([] {
        std::vector<unsigned char> sealed(kWrite / kRecord * (kRecord + kTag)), plain(kWrite);
        auto* context = EVP_CIPHER_CTX_new();
        EVP_DecryptInit_ex(context, EVP_aes_256_gcm(), nullptr, key.data(), nonce.data());
        for (;;) {
            if (::recv(ends.reads, sealed.data(), sealed.size(), MSG_WAITALL) <= 0) return;
            for (int at = 0, in = 0; at < static_cast<int>(kWrite); at += kRecord, in += kRecord + kTag) {
                int n = 0;
                EVP_DecryptInit_ex(context, nullptr, nullptr, nullptr, nonce.data());
                EVP_DecryptUpdate(context, plain.data() + at, &n, sealed.data() + in, kRecord);
                EVP_CIPHER_CTX_ctrl(context, EVP_CTRL_AEAD_SET_TAG, kTag, sealed.data() + in + kRecord);
                if (EVP_DecryptFinal_ex(context, plain.data() + at + n, &n) != 1) give_up("a seal is broken");
            }
            came += kWrite;
        }
    }).detach();
    return measure(seconds);
}

double run(const std::string& kind, double seconds) {
    const std::string socket = "unix:/tmp/wallgl-transport-" + std::to_string(::getpid()) + ".sock";
    if (kind == "wallgl-ring") return wallgl(socket, true, seconds);
    if (kind == "wallgl-unix") return wallgl(socket, false, seconds);
    if (kind == "wallgl-tcp") return wallgl("127.0.0.1:0", false, seconds);
    if (kind == "wallgl-tls") return wallgl_tls(seconds);
    if (kind == "bare-ring") return bare_ring(seconds);
    if (kind == "bare-unix") return bare_socket(unix_pair(), seconds);
    if (kind == "bare-tcp") return bare_socket(tcp_pair(), seconds);
    if (kind == "bare-tls") return bare_sealed(seconds);
    give_up("unknown kind '" + kind + "': expected wallgl- or bare-, and ring, unix, tcp or tls");
}

}  // namespace
}  // namespace wall

int main(int argc, char** argv) {
    if (argc != 3) wall::give_up("expected KIND SECONDS");
    const double rate = wall::run(argv[1], std::atof(argv[2]));
    std::printf("%.0f\n", rate);
    std::fflush(stdout);
    ::unlink(("/tmp/wallgl-transport-" + std::to_string(::getpid()) + ".sock").c_str());
    std::_Exit(0);  // the threads go on
}
