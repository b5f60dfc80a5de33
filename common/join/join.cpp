// SPDX-License-Identifier: MIT
#include "common/join/join.h"

#include <pwd.h>
#include <unistd.h>

#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>
#include <climits>
#include <cstring>

#include "common/base/trusted_server.h"
#include "common/base/whole_file.h"
#include "common/net/control_connection.h"
#include "common/tls/identity.h"
#include "common/wire/limits.h"

namespace wall::join {
namespace {

namespace asio = boost::asio;
constexpr std::chrono::seconds kAnswerLimit{5};

std::string own_name() {
    std::array<char, HOST_NAME_MAX + 1> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

Result<proto::JoinAnswer> answer_of(Result<proto::Envelope> message) {
    if (!message) return fail("walld gave no answer: " + message.error().message);
    if (message->has_refused()) return fail("walld refused: " + message->refused().reason());
    if (!message->has_join_answer()) return fail("walld answered something else");
    return std::move(*message->mutable_join_answer());
}

asio::awaitable<Result<proto::JoinAnswer>> ask(const tls::JoinLine& line, MachineKind kind,
                                               std::shared_ptr<const tls::TlsContext> own) {
    auto walld = co_await net::ControlConnection::connect_tls(line.walld, std::move(own), line.fingerprint);
    if (!walld) co_return tl::unexpected(walld.error());
    asio::steady_timer limit((*walld)->executor(), kAnswerLimit);
    limit.async_wait([connection = *walld](const boost::system::error_code& cancelled) {
        if (!cancelled) connection->close();
    });
    proto::Envelope request;
    request.mutable_join_request()->set_version(wire::kProtocolVersion);
    request.mutable_join_request()->set_secret(line.secret);
    request.mutable_join_request()->set_node(kind == MachineKind::node);
    request.mutable_join_request()->set_host(own_name());
    (*walld)->send(request);
    auto message = co_await (*walld)->receive();
    (*walld)->close();
    co_return answer_of(std::move(message));
}

Result<proto::JoinAnswer> ask_and_wait(const tls::JoinLine& line, MachineKind kind, const tls::Identity& own) {
    auto context = tls::TlsContext::make(own);
    if (!context) return tl::unexpected(context.error());
    asio::io_context io(1);
    Result<proto::JoinAnswer> out = fail("walld was not asked");
    asio::co_spawn(io, ask(line, kind, std::make_shared<const tls::TlsContext>(std::move(*context))),
                   [&](std::exception_ptr failure, Result<proto::JoinAnswer> answer) {
                       if (failure) std::rethrow_exception(failure);
                       out = std::move(answer);
                   });
    io.run();
    return out;
}

/// What root has made, the services could not read.
Result<void> give_to_services(const std::filesystem::path& folder) {
    const passwd* user = ::geteuid() == 0 ? ::getpwnam(kWallUser) : nullptr;
    if (!user) return {};
    for (const auto& path : {folder, key_file(folder), membership_file(folder), wall_file(folder)})
        if (::chown(path.c_str(), user->pw_uid, user->pw_gid) != 0 && errno != ENOENT)
            return fail(path.string() + ": cannot be given to the user " + kWallUser + ": " + std::strerror(errno));
    return {};
}

}  // namespace

Result<Membership> join(const tls::JoinLine& line, MachineKind kind, const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return fail(folder.string() + ": " + error.message());
    const auto own = tls::Identity::load_or_make(key_file(folder));
    if (!own) return tl::unexpected(own.error());
    const auto answer = ask_and_wait(line, kind, *own);
    if (!answer) return tl::unexpected(answer.error());
    const Membership out{kind, answer->name(), line.walld, line.fingerprint};
    if (kind == MachineKind::node) {
        if (auto kept = write_whole(wall_file(folder), answer->wall_toml(), 0644); !kept)
            return tl::unexpected(kept.error());
    }
    if (auto kept = out.save(folder); !kept) return tl::unexpected(kept.error());
    if (auto given = give_to_services(folder); !given) return tl::unexpected(given.error());
    return out;
}

}  // namespace wall::join
