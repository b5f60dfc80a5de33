// SPDX-License-Identifier: MIT
// An operator's answer of any size over a connection whose messages are small: what belongs to one request comes in
// replies with `more`, JSON first, and the last one without. Pure; one thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "proto/control.pb.h"

namespace wall::net {

/// What an answer may add up to at whoever reads it.
inline constexpr std::uint64_t kMaxReplyJson = 256u << 20;              ///< bytes
inline constexpr std::uint64_t kMaxReplyBlob = std::uint64_t{4} << 30;  ///< bytes; a picture of a very large wall

/// Cuts an answer. The texts must stay as they are while this is used.
class ReplyParts {
public:
    /// `about`: the reply without JSON and blob. The blob is `head` and what comes after it.
    ReplyParts(proto::OperatorReply about, std::string_view json, std::string_view head, std::string_view rest)
        : about_(std::move(about)), json_(json), head_(head), rest_(rest) {}

    /// The next part; nothing after the last.
    std::optional<proto::OperatorReply> next();

private:
    proto::OperatorReply about_;
    std::string_view json_, head_, rest_;
    bool done_ = false;
};

/// Puts an answer together again.
class ReplyJoiner {
public:
    /// The whole answer, nothing while more of it is to come, or why it is too large.
    Result<std::optional<proto::OperatorReply>> add(proto::OperatorReply part);
    /// How many have come so far, of all answers.
    std::uint64_t parts() const { return parts_; }

private:
    std::uint64_t parts_ = 0;
    std::optional<proto::OperatorReply> whole_;  // what has come of an answer
};

}  // namespace wall::net
