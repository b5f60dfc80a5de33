// SPDX-License-Identifier: MIT
#include "common/net/reply_parts.h"

#include <algorithm>
#include <utility>

#include "common/wire/limits.h"

namespace wall::net {
namespace {

/// Takes at most `room` bytes off the front of `from`.
std::string_view take(std::string_view& from, std::size_t& room) {
    const auto part = from.substr(0, room);
    from.remove_prefix(part.size());
    room -= part.size();
    return part;
}

/// Protobuf's texts are UTF-8, each for itself: a cut does not go through a character.
std::string_view take_text(std::string_view& from, std::size_t& room) {
    constexpr std::size_t kLongest = 4;  // bytes of a character
    const auto inside = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
    std::size_t most = std::min(room, from.size());
    for (std::size_t back = 0; back < kLongest && most > 0 && most < from.size() && inside(from[most]); ++back) --most;
    return take(from, most);
}

}  // namespace

std::optional<proto::OperatorReply> ReplyParts::next() {
    if (std::exchange(done_, json_.size() + head_.size() + rest_.size() <= wire::kControlPart)) return std::nullopt;
    proto::OperatorReply part = about_;
    std::size_t room = wire::kControlPart;
    const auto text = take_text(json_, room);
    part.set_json(text.data(), text.size());
    room = json_.empty() ? room - text.size() : 0;
    const auto first = take(head_, room), second = take(rest_, room);
    part.mutable_blob()->reserve(first.size() + second.size());
    part.mutable_blob()->append(first).append(second);
    part.set_more(!done_);
    return part;
}

Result<std::optional<proto::OperatorReply>> ReplyJoiner::add(proto::OperatorReply part) {
    ++parts_;
    if (!whole_) {
        whole_ = std::move(part);
    } else {
        if (part.request() != whole_->request()) return fail("control: parts of two answers are mixed");
        if (whole_->json().size() + part.json().size() > kMaxReplyJson ||
            whole_->blob().size() + part.blob().size() > kMaxReplyBlob)
            return fail("control: the answer is larger than any may be");
        whole_->mutable_json()->append(part.json());
        whole_->mutable_blob()->append(part.blob());
        whole_->set_more(part.more());
    }
    if (whole_->more()) return std::nullopt;
    return std::exchange(whole_, std::nullopt);
}

}  // namespace wall::net
