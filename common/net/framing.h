// SPDX-License-Identifier: MIT
// The control connection's bytes:
//
//   stream  := message*
//   message := bytes:u32 (little endian; 1 .. kMaxControlMessage)  Envelope
//
// Pure; every byte may be foreign.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "proto/control.pb.h"

namespace wall::net {

/// One message as it goes out. An error for one that no Unframer would take; what may be large goes in parts
/// (docs/streams.md, reply_parts.h).
Result<std::string> frame(const proto::Envelope& envelope);

/// Takes bytes in any portions, gives messages. A failure is final: the stream cannot be trusted after it.
class Unframer {
public:
    /// Room for at least `bytes` more; say with commit() how much of it was filled.
    std::span<std::byte> prepare(std::size_t bytes = 64 << 10);
    void commit(std::size_t bytes) { filled_ += bytes; }

    /// The next whole message, nothing if it has not all come yet, or why the stream is bad.
    Result<std::optional<proto::Envelope>> next();
    /// True between two messages: an end of the stream is orderly here.
    bool at_boundary() const { return read_ == filled_; }

private:
    std::vector<std::byte> buffer_;
    std::size_t read_ = 0, filled_ = 0;
    std::optional<Error> failure_;
};

}  // namespace wall::net
