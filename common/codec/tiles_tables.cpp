// SPDX-License-Identifier: MIT
#include "common/codec/tiles_tables.h"

#include <string>

#include "common/codec/huffman.h"

namespace wall::codec::tiles {
namespace {

// Lengths are written in nibbles: a length, or one of these and how often.
constexpr unsigned kNibble = 4;
constexpr std::uint32_t kRepeat = 13;     ///< nibble n: the length before, 3 + n times
constexpr std::uint32_t kZeros = 14;      ///< nibble n: length 0, 3 + n times
constexpr std::uint32_t kManyZeros = 15;  ///< two nibbles n: length 0, 19 + n times
constexpr std::size_t kLeastRun = 3, kLeastManyZeros = 19;
static_assert(kLongestCode < kRepeat);

constexpr std::array<const char*, 4> kNames{"main", "blue", "red", "alpha"};

std::uint32_t reversed(std::uint32_t bits, unsigned length) {
    std::uint32_t out = 0;
    for (unsigned i = 0; i < length; ++i) out |= (bits >> i & 1) << (length - 1 - i);
    return out;
}

std::size_t run_at(std::span<const std::uint8_t> lengths, std::size_t at) {
    std::size_t end = at;
    while (end < lengths.size() && lengths[end] == lengths[at]) ++end;
    return end - at;
}

void write_code(std::span<const std::uint8_t> lengths, ByteBitWriter& to) {
    const auto nibble = [&](std::size_t value) { to.put(value, kNibble); };
    for (std::size_t at = 0; at < lengths.size();) {
        const bool zero = lengths[at] == 0, repeat = at > 0 && lengths[at] == lengths[at - 1];
        const std::size_t run = std::min(run_at(lengths, at), kLeastManyZeros + 255);
        if (zero && run >= kLeastManyZeros) {
            nibble(kManyZeros), nibble((run - kLeastManyZeros) & 15), nibble((run - kLeastManyZeros) >> 4);
            at += run;
        } else if (run >= kLeastRun && (zero || repeat)) {
            const std::size_t taken = std::min<std::size_t>(run, kLeastRun + 15);
            nibble(zero ? kZeros : kRepeat), nibble(taken - kLeastRun);
            at += taken;
        } else {
            nibble(lengths[at++]);
        }
    }
}

Result<void> read_code(std::span<std::uint8_t> lengths, ByteBitReader& from) {
    for (std::size_t at = 0; at < lengths.size();) {
        from.refill();
        const std::uint32_t head = from.take(kNibble);
        if (head <= kLongestCode) {
            lengths[at++] = static_cast<std::uint8_t>(head);
            continue;
        }
        if (head == kRepeat && at == 0) return fail("repeats a length before the first one");
        const std::size_t run =
            head == kManyZeros ? kLeastManyZeros + from.take(2 * kNibble) : kLeastRun + from.take(kNibble);
        if (run > lengths.size() - at)
            return fail("has a run of " + std::to_string(run) + " at symbol " + std::to_string(at) + "; at most " +
                        std::to_string(lengths.size() - at) + " fit");
        const std::uint8_t length = head == kRepeat ? lengths[at - 1] : std::uint8_t{0};
        std::fill_n(lengths.begin() + static_cast<std::ptrdiff_t>(at), run, length);
        at += run;
    }
    return {};
}

DecodeTables::Main main_entry(std::uint32_t symbol, std::uint8_t length) {
    if (symbol < kSmall) return {symbol, 0, length, 0};
    if (symbol == kRest) return {0, DecodeTables::kToTheEnd, length, 0};
    if (symbol >= kGrey && symbol < kRuns) return {(symbol - kGrey) * 0x010101, 1, length, 0};
    if (symbol < kRuns) {
        const auto digit = [&](unsigned shift) { return ((symbol - kSmall) >> shift & 3) - 1; };
        const std::uint32_t blue = digit(0), green = digit(2), red = digit(4);
        return {((blue + green) & 255) | (green & 255) << 8 | ((red + green) & 255) << 16, 1, length, 0};
    }
    const std::uint32_t run = symbol - kRuns;
    if (run < 16) return {0, static_cast<std::uint16_t>(run + 1), length, 0};
    const std::uint32_t power = 4 + (run - 16) / 2;
    return {0, static_cast<std::uint16_t>((1u << power) + ((run - 16) % 2 << (power - 1)) + 1), length,
            static_cast<std::uint8_t>(power - 1)};
}

/// Calls `each(index, symbol, length)` for every index that begins with a code.
template <class Each>
Result<void> fill(std::span<const std::uint8_t> lengths, Each each) {
    const auto codes = canonical_codes(lengths);
    if (!codes) return tl::unexpected(codes.error());
    for (std::uint32_t symbol = 0; symbol < lengths.size(); ++symbol) {
        const auto [bits, length] = (*codes)[symbol];
        if (length == 0) continue;
        for (std::uint32_t index = reversed(bits, length); index < 1u << kLongestCode; index += 1u << length)
            each(index, symbol, length);
    }
    return {};
}

}  // namespace

std::span<const std::uint32_t> Counts::of(std::size_t code) const {
    if (code == kMain) return main;
    return others[code - 1];
}

void Counts::add(const Counts& other) {
    for (std::size_t i = 0; i < main.size(); ++i) main[i] += other.main[i];
    for (std::size_t code = 0; code < others.size(); ++code)
        for (std::size_t i = 0; i < others[code].size(); ++i) others[code][i] += other.others[code][i];
}

bool Counts::empty() const {
    return std::all_of(main.begin(), main.end(), [](auto count) { return count == 0; });
}

Lengths suit(const Counts& counts) {
    Lengths out;
    for (std::size_t code = 0; code < out.size(); ++code) out[code] = huffman_lengths(counts.of(code), kLongestCode);
    return out;
}

std::uint64_t bits_with(const Counts& counts, const Lengths& lengths) {
    constexpr std::uint64_t kNever = 1u << 31;  // for each use of a symbol without a code
    std::uint64_t bits = 0;
    for (std::size_t code = 0; code < lengths.size(); ++code)
        for (std::size_t i = 0; i < lengths[code].size(); ++i)
            bits += counts.of(code)[i] * (lengths[code][i] > 0 ? lengths[code][i] : kNever);
    return bits;
}

void write_lengths(const Lengths& lengths, ByteBitWriter& to) {
    for (const auto& code : lengths) write_code(code, to);
}

Result<Lengths> read_lengths(ByteBitReader& from) {
    Lengths out;
    for (std::size_t code = 0; code < out.size(); ++code) {
        out[code].resize(kSymbols[code]);
        if (auto good = read_code(out[code], from); !good)
            return fail(std::string("the ") + kNames[code] + " code " + good.error().message);
    }
    return out;
}

std::array<EncodeTable, 4> encode_tables(const Lengths& lengths) {
    std::array<EncodeTable, 4> out{};
    for (std::size_t code = 0; code < out.size(); ++code) {
        const auto codes = canonical_codes(lengths[code]);
        for (std::size_t i = 0; i < codes->size(); ++i)
            out[code][i] = reversed((*codes)[i].bits, (*codes)[i].length) << 8 | (*codes)[i].length;
    }
    return out;
}

Result<std::unique_ptr<DecodeTables>> decode_tables(const Lengths& lengths) {
    auto out = std::make_unique<DecodeTables>();
    for (std::size_t code = 0; code < lengths.size(); ++code) {
        const auto good = fill(lengths[code], [&](std::uint32_t index, std::uint32_t symbol, std::uint8_t length) {
            if (code == kMain) out->main[index] = main_entry(symbol, length);
            else out->others[code - 1][index] = {static_cast<std::uint8_t>(symbol), length};
        });
        if (!good) return fail(std::string("the ") + kNames[code] + " code: " + good.error().message);
    }
    return out;
}

}  // namespace wall::codec::tiles
