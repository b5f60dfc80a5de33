// SPDX-License-Identifier: MIT
#include "common/net/framing.h"

#include <cstring>

#include "common/base/assert.h"
#include "common/wire/limits.h"

namespace wall::net {
namespace {

constexpr std::size_t kPrefix = sizeof(std::uint32_t);

}  // namespace

std::string frame(const proto::Envelope& envelope) {
    const auto bytes = static_cast<std::uint32_t>(envelope.ByteSizeLong());
    WALL_ASSERT(bytes > 0 && bytes <= wire::kMaxControlMessage);
    std::string out(kPrefix + bytes, '\0');
    std::memcpy(out.data(), &bytes, kPrefix);
    envelope.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(out.data() + kPrefix));
    return out;
}

std::span<std::byte> Unframer::prepare(std::size_t bytes) {
    if (read_ > 0) {
        std::memmove(buffer_.data(), buffer_.data() + read_, filled_ - read_);
        filled_ -= read_;
        read_ = 0;
    }
    if (buffer_.size() < filled_ + bytes) buffer_.resize(std::max(filled_ + bytes, buffer_.size() * 2));
    return std::span(buffer_).subspan(filled_);
}

Result<std::optional<proto::Envelope>> Unframer::next() {
    if (failure_) return tl::unexpected(*failure_);
    const auto refuse = [&](std::string why) -> tl::unexpected<Error> {
        failure_ = Error{"control: " + std::move(why)};
        return tl::unexpected(*failure_);
    };
    if (filled_ - read_ < kPrefix) return std::nullopt;
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, buffer_.data() + read_, kPrefix);
    if (bytes == 0) return refuse("empty message");
    if (bytes > wire::kMaxControlMessage)
        return refuse("message of " + std::to_string(bytes) + " bytes; the limit is " +
                      std::to_string(wire::kMaxControlMessage));
    if (filled_ - read_ - kPrefix < bytes) return std::nullopt;
    std::optional<proto::Envelope> out(std::in_place);
    if (!out->ParseFromArray(buffer_.data() + read_ + kPrefix, static_cast<int>(bytes)))
        return refuse("message is not an Envelope");
    if (out->message_case() == proto::Envelope::MESSAGE_NOT_SET) return refuse("message of an unknown kind");
    read_ += kPrefix + bytes;
    return out;
}

}  // namespace wall::net
