// SPDX-License-Identifier: MIT
#include "common/wire/parcel.h"

#include <array>
#include <cstring>
#include <string>
#include <utility>

#include "common/wire/history_coder.h"

namespace wall::wire {
namespace {

constexpr std::size_t kFixedWords = 6, kPositionWord = 4;
constexpr std::size_t kWord = sizeof(std::uint32_t);

}  // namespace

std::vector<std::byte> encode_parcel_lead(const ParcelLead& lead) {
    std::vector<std::uint32_t> words{lead.number,
                                     lead.bytes,
                                     lead.plain_bytes,
                                     lead.offset,
                                     static_cast<std::uint32_t>(lead.position),
                                     static_cast<std::uint32_t>(lead.route.size())};
    for (const NodeIndex node : lead.route) words.push_back(node.value);
    const auto bytes = std::as_bytes(std::span(words));
    return {bytes.begin(), bytes.end()};
}

Result<ParcelPiece> read_parcel_piece(std::span<const std::byte> payload) {
    std::array<std::uint32_t, kFixedWords> words;
    if (payload.size() < sizeof words) return fail("parcel: a piece shorter than what stands in front of it");
    std::memcpy(words.data(), payload.data(), sizeof words);
    const auto [number, bytes, plain_bytes, offset, position, nodes] = words;
    if (nodes == 0 || nodes > kMostHandedTo || position >= nodes)
        return fail("parcel: for node " + std::to_string(position) + " of " + std::to_string(nodes) + ", at most " +
                    std::to_string(kMostHandedTo) + " are allowed");
    const auto rest = payload.subspan(sizeof words);
    if (rest.size() < nodes * kWord) return fail("parcel: a piece shorter than its route");
    const auto content = rest.subspan(nodes * kWord);
    if (bytes == 0 || bytes > kMostParcel || plain_bytes > kMostCodedBatch)
        return fail("parcel of " + std::to_string(bytes) + " bytes that say " + std::to_string(plain_bytes) +
                    "; at most " + std::to_string(kMostParcel) + " are allowed, and " +
                    std::to_string(kMostCodedBatch) + " coded");
    if (offset > bytes || content.size() > bytes - offset) return fail("parcel: a piece behind its end");
    ParcelPiece piece{{number, bytes, plain_bytes, offset, position, std::vector<NodeIndex>(nodes)}, content};
    for (std::size_t i = 0; i < nodes; ++i) std::memcpy(&piece.lead.route[i].value, rest.data() + i * kWord, kWord);
    return piece;
}

void hand_on_piece(std::span<std::byte> payload) {
    std::uint32_t position = 0;
    std::byte* const at = payload.data() + kPositionWord * kWord;
    std::memcpy(&position, at, kWord);
    ++position;
    std::memcpy(at, &position, kWord);
}

Result<AwaitedParcel> read_awaited(std::span<const std::byte> payload) {
    std::array<std::uint32_t, 2> words;
    if (payload.size() != sizeof words) return fail("awaited parcel: expected 8 bytes");
    std::memcpy(words.data(), payload.data(), sizeof words);
    return AwaitedParcel{words[0], NodeIndex(words[1])};
}

Result<std::optional<RawBytes>> ParcelReader::take(const ParcelPiece& piece) {
    auto taken = add(piece);
    if (!taken) bytes_.clear();
    return taken;
}

Result<std::optional<RawBytes>> ParcelReader::add(const ParcelPiece& piece) {
    const ParcelLead& lead = piece.lead;
    if (lead.number != number_ && lead.offset == 0) bytes_.clear();
    if ((!bytes_.empty() && lead.number != number_) || lead.offset != bytes_.size())
        return fail("parcel " + std::to_string(lead.number) + ": pieces of it are missing, or of another one");
    number_ = lead.number;
    bytes_.insert(bytes_.end(), piece.content.begin(), piece.content.end());
    if (bytes_.size() < lead.bytes) return std::optional<RawBytes>();
    RawBytes whole = std::exchange(bytes_, {});
    if (lead.plain_bytes == 0) return std::optional(std::move(whole));
    RawBytes plain;
    if (auto done = HistoryDecoder().decode(whole, lead.plain_bytes, plain); !done) return tl::unexpected(done.error());
    return std::optional(std::move(plain));
}

}  // namespace wall::wire
