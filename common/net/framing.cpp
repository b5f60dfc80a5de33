// SPDX-License-Identifier: MIT
#include "common/net/framing.h"

#include <google/protobuf/stubs/logging.h>

#include <cstring>

#include "common/wire/limits.h"

namespace wall::net {
namespace {

constexpr std::size_t kPrefix = sizeof(std::uint32_t);

/// Protobuf writes a line to standard error for each text that is no UTF-8. Whoever is answered here may send many, and
/// who was refused is said by whoever refuses, with a limit (common/log/refusals.h).
[[maybe_unused]] const auto kNobodyHearsProtobuf = google::protobuf::SetLogHandler(nullptr);

Error size_error(std::size_t bytes) {
    return {bytes == 0 ? "control: empty message"
                       : "control: message of " + std::to_string(bytes) + " bytes; the limit is " +
                             std::to_string(wire::kMaxControlMessage)};
}

bool size_ok(std::size_t bytes) { return bytes > 0 && bytes <= wire::kMaxControlMessage; }

}  // namespace

Result<std::string> frame(const proto::Envelope& envelope) {
    const std::size_t size = envelope.ByteSizeLong();
    if (!size_ok(size)) return tl::unexpected(size_error(size));
    const auto bytes = static_cast<std::uint32_t>(size);
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
    const auto refuse = [&](Error why) -> tl::unexpected<Error> {
        failure_ = std::move(why);
        return tl::unexpected(*failure_);
    };
    if (filled_ - read_ < kPrefix) return std::nullopt;
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, buffer_.data() + read_, kPrefix);
    if (!size_ok(bytes)) return refuse(size_error(bytes));
    if (filled_ - read_ - kPrefix < bytes) return std::nullopt;
    std::optional<proto::Envelope> out(std::in_place);
    if (!out->ParseFromArray(buffer_.data() + read_ + kPrefix, static_cast<int>(bytes)))
        return refuse({"control: message is not an Envelope"});
    if (out->message_case() == proto::Envelope::MESSAGE_NOT_SET) return refuse({"control: message of an unknown kind"});
    read_ += kPrefix + bytes;
    return out;
}

}  // namespace wall::net
