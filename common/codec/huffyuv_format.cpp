// SPDX-License-Identifier: MIT
#include "common/codec/huffyuv_format.h"

#include <algorithm>
#include <string>

namespace wall::codec::huffyuv {
namespace {

constexpr std::size_t kFixedBytes = 4;  // method, bits a pixel, interlacing, zero; then the tables
constexpr std::uint8_t kDecorrelate = 64, kInterlaceMask = 0x30, kInterlaced = 0x10, kProgressive = 0x20,
                       kPerFrameTables = 0x40;
constexpr std::uint32_t kInterlacedAbove = 288;  // rows; where a stream does not say, taller ones are interlaced
constexpr unsigned kLongestRun = 255, kLongestShortRun = 7;

/// Lengths run by run: length in the low 5 bits, run in the high 3, or those zero and the run in a byte of its own.
void write_lengths(const std::array<Code, 256>& codes, std::vector<std::byte>& out) {
    for (std::size_t at = 0; at < codes.size();) {
        const unsigned length = codes[at].length;
        unsigned run = 0;
        while (at < codes.size() && codes[at].length == length && run < kLongestRun) ++at, ++run;
        out.push_back(static_cast<std::byte>(length | (run <= kLongestShortRun ? run << 5 : 0)));
        if (run > kLongestShortRun) out.push_back(static_cast<std::byte>(run));
    }
}

/// Reads one table from the front of `bytes`.
Result<std::array<Code, 256>> read_table(std::span<const std::byte>& bytes) {
    std::array<std::uint8_t, 256> lengths{};
    for (std::size_t at = 0; at < lengths.size();) {
        if (bytes.empty()) return fail("ends at symbol " + std::to_string(at));
        const auto head = std::to_integer<unsigned>(bytes[0]);
        const bool long_run = head >> 5 == 0;
        if (long_run && bytes.size() < 2) return fail("ends at symbol " + std::to_string(at));
        const std::size_t run = long_run ? std::to_integer<unsigned>(bytes[1]) : head >> 5;
        bytes = bytes.subspan(long_run ? 2 : 1);
        if (run == 0 || run > lengths.size() - at)
            return fail("has a run of " + std::to_string(run) + " at symbol " + std::to_string(at) +
                        "; expected 1 to " + std::to_string(lengths.size() - at));
        std::fill_n(lengths.begin() + static_cast<std::ptrdiff_t>(at), run, static_cast<std::uint8_t>(head & 31));
        at += run;
    }
    const auto codes = canonical_codes(lengths);
    if (!codes) return tl::unexpected(codes.error());
    std::array<Code, 256> out;
    std::copy(codes->begin(), codes->end(), out.begin());
    return out;
}

Result<Pixels> pixels_of(unsigned bits) {
    switch (bits) {
        case 16: return Pixels::yuy2;
        case 24: return Pixels::rgb24;
        case 32: return Pixels::rgb32;
        default: return fail("huffyuv: " + std::to_string(bits) + " bits a pixel; expected 16, 24 or 32");
    }
}

/// HuffYUV 1.x: the low three bits of biBitCount are the method.
Result<Stream> read_classic(std::uint16_t bit_count, bool interlaced) {
    const auto pixels = pixels_of(bit_count & ~7u);
    if (!pixels) return tl::unexpected(pixels.error());
    const bool rgb = *pixels != Pixels::yuy2;
    Stream out{.pixels = *pixels,
               .decorrelate = false,
               .interlaced = interlaced,
               .classic = true,
               .tables = classic_tables(*pixels)};
    switch (bit_count & 7) {
        case 0:
        case 1: break;
        case 2: out.decorrelate = rgb; break;
        case 3: out.predictor = Predictor::gradient, out.decorrelate = rgb; break;
        case 4: out.predictor = Predictor::median; break;
        default: return fail("huffyuv: method " + std::to_string(bit_count & 7) + " in biBitCount; expected 0 to 4");
    }
    return out;
}

}  // namespace

std::vector<std::byte> write_extradata(const Stream& stream) {
    if (stream.classic) return {};
    const bool rgb = stream.pixels != Pixels::yuy2;
    const auto method = static_cast<unsigned>(stream.predictor) | (rgb && stream.decorrelate ? kDecorrelate : 0u);
    std::vector<std::byte> out{static_cast<std::byte>(method), static_cast<std::byte>(stream.pixels),
                               static_cast<std::byte>(stream.interlaced ? kInterlaced : kProgressive), std::byte{0}};
    for (const auto& codes : stream.tables) write_lengths(codes, out);
    return out;
}

std::uint16_t bit_count(const Stream& stream) {
    const auto bits = static_cast<std::uint16_t>(stream.pixels);
    if (!stream.classic) return bits;
    const unsigned method = stream.predictor == Predictor::median     ? 4
                            : stream.predictor == Predictor::gradient ? 3
                            : stream.decorrelate                      ? 2
                                                                      : 1;
    return static_cast<std::uint16_t>(bits | method);
}

Result<Stream> read_stream(std::uint16_t bit_count, std::uint32_t height, std::span<const std::byte> extradata) {
    const bool tall = height > kInterlacedAbove;
    if (extradata.empty()) return read_classic(bit_count, tall);
    if (extradata.size() < kFixedBytes || extradata[3] != std::byte{0})
        return fail("huffyuv: extradata of " + std::to_string(extradata.size()) +
                    " bytes is not HuffYUV 2.x: expected method, bits a pixel, interlacing, 0, tables");
    const auto method = std::to_integer<unsigned>(extradata[0]), flags = std::to_integer<unsigned>(extradata[2]);
    if ((method & 63) > 2 || method > (kDecorrelate | 63u))
        return fail("huffyuv: method " + std::to_string(method) +
                    " in extradata; expected 0, 1 or 2, and 64 for decorrelation");
    if (flags & kPerFrameTables) return fail("huffyuv: per-frame tables (ffvhuff) are not HuffYUV");
    const unsigned bits = std::to_integer<unsigned>(extradata[1]);
    const auto pixels = pixels_of(bits != 0 ? bits : bit_count & ~7u);
    if (!pixels) return tl::unexpected(pixels.error());
    Stream out{.pixels = *pixels, .predictor = static_cast<Predictor>(method & 63)};
    out.decorrelate = out.pixels != Pixels::yuy2 && (method & kDecorrelate) != 0;
    out.interlaced = (flags & kInterlaceMask) == kInterlaced || ((flags & kInterlaceMask) != kProgressive && tall);
    auto rest = extradata.subspan(kFixedBytes);
    for (std::size_t plane = 0; plane < out.tables.size(); ++plane) {
        const auto table = read_table(rest);
        if (!table) return fail("huffyuv: code table " + std::to_string(plane) + " " + table.error().message);
        out.tables[plane] = *table;
    }
    return out;
}

Result<void> check(const Stream& stream, std::uint32_t width) {
    if (stream.pixels != Pixels::yuy2 && stream.predictor == Predictor::median)
        return fail("huffyuv: median prediction of RGB does not exist; expected left or gradient");
    if (stream.pixels == Pixels::yuy2 && (width < 2 || width % 2 != 0))
        return fail("huffyuv: YUY2 of width " + std::to_string(width) + "; expected an even width");
    if (stream.pixels == Pixels::yuy2 && stream.predictor == Predictor::median && width % 4 != 0)
        return fail("huffyuv: median prediction of width " + std::to_string(width) + "; expected a multiple of 4");
    return {};
}

}  // namespace wall::codec::huffyuv
