// SPDX-License-Identifier: MIT
// What goes between a node and its compilers: first an empty answer when the compiler is ready, then one answer for
// each question. Both are a header and as many bytes. A compiler works on what strangers have written, so the node
// believes it little: what it may say has a limit, and is decoded as any foreign bytes. Blocks; one thread for each
// end.
#pragma once

#include <sys/socket.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/glapi/gl_types.h"

namespace wall::tileserver {

/// Of a question, and of an answer.
inline constexpr std::uint64_t kMostMessageBytes = std::uint64_t{64} << 20;

struct CompilerQuestion {
    GLenum shader_type = 0;  ///< 0: the bytes define a program (glapi::decode_definition), else they are source, of a
                             ///< shader or of an assembly program
    std::vector<std::byte> bytes;
};

namespace detail {

inline bool send_all(int socket, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(sent));
    }
    return true;
}

inline bool receive_all(int socket, std::span<std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t received = ::recv(socket, bytes.data(), bytes.size(), 0);
        if (received < 0 && errno == EINTR) continue;
        if (received <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(received));
    }
    return true;
}

struct Header {
    std::uint64_t bytes = 0;
    std::uint32_t shader_type = 0, unused = 0;
};

}  // namespace detail

/// False: the other end is gone.
inline bool send_message(int socket, GLenum shader_type, std::span<const std::byte> bytes) {
    const detail::Header header{bytes.size(), shader_type};
    return detail::send_all(socket, std::as_bytes(std::span(&header, 1))) && detail::send_all(socket, bytes);
}

/// Nothing: the other end is gone, or says more than it may.
inline std::optional<CompilerQuestion> receive_message(int socket) {
    detail::Header header;
    if (!detail::receive_all(socket, std::as_writable_bytes(std::span(&header, 1)))) return std::nullopt;
    if (header.bytes > kMostMessageBytes) return std::nullopt;
    CompilerQuestion message{header.shader_type, std::vector<std::byte>(header.bytes)};
    if (!detail::receive_all(socket, message.bytes)) return std::nullopt;
    return message;
}

}  // namespace wall::tileserver
