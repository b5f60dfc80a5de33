// SPDX-License-Identifier: MIT
// Codec `huffyuv-tiles`, decoder. Slices share nothing but the tables and the picture before.
#include <optional>

#include "common/codec/tiles.h"
#include "common/codec/tiles_tables.h"
#include "common/codec/worker_pool.h"

namespace wall::codec::tiles {
namespace {

using Residuals = std::array<std::uint32_t, kBlockPixels>;
using Failure = std::optional<std::string>;

struct Output {
    Picture& picture;
    const StreamFormat& format;
    const DecodeTables* tables;  ///< none: there were none since the key packet
    bool key;

    std::byte* row(const Block& block, std::uint32_t y) const {
        return picture.row(block.y + y) + 4 * std::size_t{block.x};
    }
};

/// Fills `count` residuals; false when the bits hold a code or run that cannot be.
template <bool alpha>
bool read_residuals(ByteBitReader& source, const DecodeTables& tables, Residuals& out, std::size_t count) {
    ByteBitReader from = source;  // in registers
    std::fill_n(out.begin(), count, 0u);
    const auto symbol = [&](std::size_t code, bool& good) {
        const auto found = tables.others[code - 1][from.peek(kLongestCode)];
        from.skip(found.length);
        good &= found.length > 0;
        return std::uint32_t{found.symbol};
    };
    std::size_t at = 0;
    while (at < count) {
        from.refill();
        const auto found = tables.main[from.peek(kLongestCode)];
        from.skip(found.length);
        if (found.advance > 0) {
            out[at] = found.value;
            at += found.advance + from.take(found.extra_bits);
            continue;
        }
        bool good = found.length > 0;
        const std::uint32_t green = found.value, blue = symbol(kBlue, good) + green, red = symbol(kRed, good) + green;
        out[at] = (blue & 255) | green << 8 | (red & 255) << 16;
        if constexpr (alpha) out[at] |= symbol(kAlpha, good) << 24;
        if (!good) return false;
        ++at;
    }
    source = from;
    return at == count || at >= DecodeTables::kToTheEnd;
}

void add_residuals(const Output& to, const Block& block, Mode mode, const Residuals& residuals) {
    const auto& kernels = row_kernels();
    for (std::uint32_t y = 0; y < block.height; ++y) {
        std::byte* row = to.row(block, y);
        const std::uint32_t* residual = residuals.data() + std::size_t{y} * block.width;
        if (mode == Mode::previous) {
            kernels.add_difference(row, residual, row, block.width);
            continue;
        }
        const std::byte* above = y > 0 ? to.row(block, y - 1) : nullptr;
        const RowStart start = row_start(row, above, block.x);
        if (mode == Mode::left || above == nullptr) kernels.add_left(row, residual, block.width, start);
        else
            (mode == Mode::gradient ? kernels.add_gradient : kernels.add_median)(row, residual, above, block.width,
                                                                                 start);
    }
}

void fill_flat(const Output& to, const Block& block) {
    const std::uint32_t pixel = row_start(to.row(block, 0), nullptr, block.x).left;
    for (std::uint32_t y = 0; y < block.height; ++y) {
        std::byte* row = to.row(block, y);
        for (std::uint32_t x = 0; x < block.width; ++x) std::memcpy(row + 4 * std::size_t{x}, &pixel, sizeof pixel);
    }
}

void read_raw(const Output& to, const Block& block, bool alpha, ByteBitReader& from) {
    for (std::uint32_t y = 0; y < block.height; ++y) {
        std::byte* row = to.row(block, y);
        for (std::uint32_t x = 0; x < block.width; ++x) {
            from.refill();
            const std::uint32_t pixel = alpha ? from.take(32) : from.take(24) | kOpaqueBlack;
            std::memcpy(row + 4 * std::size_t{x}, &pixel, sizeof pixel);
        }
    }
}

Failure read_block(const Output& to, const Block& block, std::uint8_t coded_mode, ByteBitReader& from,
                   Residuals& residuals) {
    const bool alpha = has_alpha(coded_mode);
    const auto mode = static_cast<Mode>(alpha ? coded_mode - kWithAlpha : coded_mode);
    if (to.key && (mode == Mode::unchanged || mode == Mode::previous))
        return "refers to the picture before in a key packet";
    if (mode == Mode::unchanged) return {};
    if (mode == Mode::flat) return fill_flat(to, block), Failure{};
    if (mode == Mode::raw || mode == Mode::raw_alpha)
        return read_raw(to, block, mode == Mode::raw_alpha, from), Failure{};
    if (to.tables == nullptr) return "has codes, and no tables came yet";
    const std::size_t count = std::size_t{block.width} * block.height;
    const bool good = alpha ? read_residuals<true>(from, *to.tables, residuals, count)
                            : read_residuals<false>(from, *to.tables, residuals, count);
    if (!good) return "holds a code or a run that cannot be";
    add_residuals(to, block, mode, residuals);
    return {};
}

/// The modes of a slice's blocks, or nothing if they are not so many.
bool read_modes(ByteBitReader& from, std::span<std::uint8_t> modes) {
    for (std::size_t at = 0; at < modes.size();) {
        from.refill();
        const auto mode = static_cast<std::uint8_t>(from.take(kModeBits));
        const auto power = static_cast<unsigned>(std::countr_zero(from.peek(16) | 1u << 16));
        if (mode >= kModes || power >= 16) return false;
        from.skip(power + 1);
        const std::size_t run = (std::size_t{1} << power) | from.take(power);
        if (run > modes.size() - at) return false;
        std::fill_n(modes.begin() + static_cast<std::ptrdiff_t>(at), run, mode);
        at += run;
    }
    from.align();
    return true;
}

Failure read_slice(const Output& to, std::uint32_t number, std::span<const std::byte> bytes) {
    if (bytes.empty()) return to.key ? Failure("is empty in a key packet") : Failure{};
    ByteBitReader from(bytes);
    std::vector<std::uint8_t> modes(blocks_across(to.format));
    if (!read_modes(from, modes)) return "has other modes than its " + std::to_string(modes.size()) + " blocks want";
    Residuals residuals;
    for (std::uint32_t column = 0; column < modes.size(); ++column) {
        auto failure = read_block(to, block_at(to.format, column, number), modes[column], from, residuals);
        if (!failure && from.overrun()) failure = "goes beyond the slice's " + std::to_string(bytes.size()) + " bytes";
        if (failure) return "block " + std::to_string(column) + " " + *failure;
    }
    if (!from.at_end()) return "has bytes after its last block";
    return {};
}

/// A number of at most 28 bits in bytes of seven, the lowest first.
std::optional<std::size_t> take_number(std::span<const std::byte>& bytes) {
    std::size_t value = 0;
    for (unsigned shift = 0; shift < 28 && !bytes.empty(); shift += 7) {
        const auto byte = std::to_integer<std::size_t>(bytes[0]);
        bytes = bytes.subspan(1);
        value |= (byte & 127) << shift;
        if (byte < 128) return value;
    }
    return std::nullopt;
}

class TilesDecoder final : public Decoder {
public:
    TilesDecoder(const StreamFormat& format, ParallelFor parallel)
        : format_(format), parallel_(std::move(parallel)), picture_(format) {}

    Result<FrameView> decode(std::span<const std::byte> packet) override {
        if (packet.empty()) return fail("huffyuv-tiles: empty packet");
        const auto flags = std::to_integer<std::uint8_t>(packet[0]);
        if ((flags & ~(kKey | kUnchanged | kTables)) != 0 || ((flags & kUnchanged) && flags != kUnchanged))
            return fail("huffyuv-tiles: unknown flags " + std::to_string(flags));
        if (!(flags & kKey) && !whole_)
            return fail("huffyuv-tiles: a delta packet without the picture before; expected a key packet");
        if (flags == kUnchanged && packet.size() == 1) return picture_.view();
        if (flags == kUnchanged)
            return fail("huffyuv-tiles: " + std::to_string(packet.size() - 1) + " bytes after 'unchanged'");
        whole_ = false;
        if (auto good = read_body(flags, packet.subspan(1)); !good)
            return fail("huffyuv-tiles: " + good.error().message);
        whole_ = true;
        return picture_.view();
    }

private:
    Result<void> read_body(std::uint8_t flags, std::span<const std::byte> bytes) {
        if (flags & kKey) tables_.reset();
        if (flags & kTables) {
            if (auto good = read_tables(bytes); !good) return good;
        }
        std::vector<std::size_t> sizes;
        std::size_t total = 0;
        for (std::uint32_t slice = 0; slice < slices_of(format_); ++slice) {
            const auto size = take_number(bytes);
            if (!size) return fail("ends in the size of slice " + std::to_string(slice));
            sizes.push_back(*size);
            total += *size;
        }
        if (total != bytes.size())
            return fail("slices of " + std::to_string(total) + " bytes in a packet with " +
                        std::to_string(bytes.size()) + " left");
        std::vector<std::span<const std::byte>> slices;
        for (const std::size_t size : sizes) {
            slices.push_back(bytes.first(size));
            bytes = bytes.subspan(size);
        }
        return read_slices({picture_, format_, tables_.get(), (flags & kKey) != 0}, slices);
    }
    Result<void> read_tables(std::span<const std::byte>& bytes) {
        ByteBitReader from(bytes);
        const auto lengths = read_lengths(from);
        if (!lengths) return tl::unexpected(lengths.error());
        if (from.overrun()) return fail("ends in the tables");
        auto tables = decode_tables(*lengths);
        if (!tables) return tl::unexpected(tables.error());
        tables_ = std::move(*tables);
        from.align();
        bytes = bytes.last(from.bytes_left());
        return {};
    }
    Result<void> read_slices(const Output& to, const std::vector<std::span<const std::byte>>& slices) {
        std::vector<Failure> failures(slices.size());
        for_each_index(parallel_, slices.size(),
                       [&](std::size_t i) { failures[i] = read_slice(to, static_cast<std::uint32_t>(i), slices[i]); });
        for (std::size_t i = 0; i < failures.size(); ++i)
            if (failures[i]) return fail("slice " + std::to_string(i) + " " + *failures[i]);
        return {};
    }

    const StreamFormat format_;
    const ParallelFor parallel_;
    Picture picture_;
    std::unique_ptr<DecodeTables> tables_;
    bool whole_ = false;  ///< the picture is one that an encoder had
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_decoder(const StreamFormat& format, std::span<const std::byte>,
                                              ParallelFor parallel) {
    if (format.layout == PixelLayout::yuy2) return fail("huffyuv-tiles: yuy2 frames; expected bgra or rgba");
    return std::make_unique<TilesDecoder>(format, std::move(parallel));
}

}  // namespace wall::codec::tiles

namespace wall::codec {

extern const Codec codec_huffyuv_tiles;
const Codec codec_huffyuv_tiles{"huffyuv-tiles",
                                "prediction and prefix codes over slices and blocks; unchanged blocks are free",
                                tiles::make_encoder, tiles::make_decoder};

}  // namespace wall::codec
