// SPDX-License-Identifier: MIT
// Bytes in JSON (RFC 4648, section 4). Boost.Beast has the coder for its WebSocket handshake. Pure.
#pragma once

#include <boost/beast/core/detail/base64.hpp>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace wall::net {

inline std::string to_base64(std::string_view bytes) {
    namespace coder = boost::beast::detail::base64;
    std::string out(coder::encoded_size(bytes.size()), '\0');
    out.resize(coder::encode(out.data(), bytes.data(), bytes.size()));
    return out;
}

/// Up to the first character that does not belong there.
inline std::vector<std::byte> from_base64(std::string_view text) {
    namespace coder = boost::beast::detail::base64;
    std::vector<std::byte> out(coder::decoded_size(text.size()));
    out.resize(coder::decode(out.data(), text.data(), text.size()).first);
    return out;
}

}  // namespace wall::net
