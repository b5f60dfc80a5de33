// SPDX-License-Identifier: MIT
#include <algorithm>

#include "common/codec/huffyuv.h"
#include "common/codec/huffyuv_rows.h"
#include "common/codec/huffyuv_tables.h"
#include "common/codec/word_bits.h"

namespace wall::codec::huffyuv {
namespace {

/// Turns bits into residuals of four-byte pixels.
class PixelReader {
public:
    PixelReader(const Stream& stream, PixelLayout layout)
        : order_{stream.decorrelate, stream.pixels == Pixels::rgb32, layout == PixelLayout::rgba ? 0u : 16u},
          symbols_{SymbolTable(stream.tables[0]), SymbolTable(stream.tables[1]), SymbolTable(stream.tables[2])},
          entries_(pixel_entries(stream.tables, order_)) {
        find_zero_group(stream.tables);
    }

    /// False when the bits hold a code that does not exist.
    bool read(WordBitReader& source, std::uint32_t* out, std::size_t count) const {
        WordBitReader from = source;  // in registers
        bool failed = false;
        std::uint32_t* const end = out + count;
        while (end - out >= static_cast<std::ptrdiff_t>(kGroup)) {
            from.refill();
            if (from.peek(zero_bits_) == zero_value_) {
                std::fill_n(out, kGroup, 0u);
                out += kGroup;
                from.skip(zero_bits_);
                continue;
            }
            const PixelEntry& entry = entries_[from.peek(kIndexBits)];
            std::memcpy(out, entry.pixels.data(), sizeof entry.pixels);
            out += entry.count;
            from.skip(entry.bits);
            if (entry.count == 0) [[unlikely]]
                *out++ = slow_pixel(from, failed);
        }
        while (out < end) {
            from.refill();
            const PixelEntry& entry = entries_[from.peek(kIndexBits)];
            from.skip(entry.first_bits);
            *out++ = entry.count > 0 ? entry.pixels[0] : slow_pixel(from, failed);
        }
        source = from;
        return !failed;
    }
    std::uint32_t first_pixel(WordBitReader& from) const {
        const std::uint32_t word = from.take(32);
        const std::uint32_t bgra = order_.alpha ? word : word >> 8 | 0xff000000;
        return order_.red_shift == 16 ? bgra : (bgra & 0xff00ff00) | (bgra & 255) << 16 | (bgra >> 16 & 255);
    }
    bool alpha() const { return order_.alpha; }

private:
    std::uint32_t slow_pixel(WordBitReader& from, bool& failed) const {
        const std::uint32_t a = symbols_[order_.decorrelated ? 1 : 0].take(from, failed);
        const std::uint32_t b = symbols_[order_.decorrelated ? 0 : 1].take(from, failed);
        const std::uint32_t red = symbols_[2].take(from, failed);
        const std::uint32_t alpha = order_.alpha ? symbols_[2].take(from, failed) : 0;
        return order_.decorrelated ? order_.pixel(b, a, red, alpha) : order_.pixel(a, b, red, alpha);
    }
    /// The bits of kGroup pixels without residual, if they fit a refill; else a pattern that is never there.
    void find_zero_group(const Tables& tables) {
        const std::size_t first = order_.decorrelated ? 1 : 0;
        std::uint64_t bits = 0;
        unsigned length = 0;
        for (std::size_t i = 0; i < kGroup && length <= 32; ++i) {
            for (std::size_t k = 0; k < (order_.alpha ? 4u : 3u); ++k) {
                const Code code = tables[k == 0 ? first : k == 1 ? 1 - first : 2][0];
                if (code.length == 0) return;
                bits = bits << code.length | code.bits;
                length += code.length;
            }
        }
        if (length > 32) return;
        zero_bits_ = length;
        zero_value_ = bits;
    }

    const PixelOrder order_;
    const std::array<SymbolTable, 3> symbols_;
    const std::vector<PixelEntry> entries_;
    unsigned zero_bits_ = 1;
    std::uint64_t zero_value_ = 2;  ///< more than one bit can hold
};

class HuffyuvDecoder final : public Decoder {
public:
    HuffyuvDecoder(const StreamFormat& format, const Stream& stream)
        : stream_(stream),
          reader_(stream, format.layout),
          picture_(format),
          width_(format.width),
          height_(format.height),
          residuals_(format.width) {
        for (const auto& codes : stream.tables) planes_.emplace_back(codes);
    }

    Result<FrameView> decode(std::span<const std::byte> packet) override {
        if (packet.size() > picture_.bytes().size() * 4 + 64)
            return fail("huffyuv: packet of " + std::to_string(packet.size()) +
                        " bytes; the picture justifies at most " + std::to_string(picture_.bytes().size() * 4 + 64));
        words_.assign(packet.begin(), packet.end());
        words_.resize(packet.size() / 4 * 4 + width_ * kMostPixelBytes + 16);
        WordBitReader from(words_.data());
        const std::byte* end = words_.data() + packet.size() / 4 * 4;
        for (std::uint32_t row = 0; row < height_; ++row) {
            const bool good = stream_.pixels == Pixels::yuy2 ? read_yuy2_row(from, row) : read_rgb_row(from, row);
            if (from.at() > end)
                return fail("huffyuv: packet of " + std::to_string(packet.size()) + " bytes ends in coded row " +
                            std::to_string(row) + " of " + std::to_string(height_));
            if (!good)
                return fail("huffyuv: a code that does not exist in coded row " + std::to_string(row) + " of " +
                            std::to_string(height_));
        }
        return picture_.view();
    }

private:
    bool predicted_from_above(std::uint32_t row) const {
        return stream_.predictor == Predictor::gradient && row > (stream_.interlaced ? 1u : 0u);
    }
    bool read_rgb_row(WordBitReader& from, std::uint32_t coded) {
        std::byte* row = picture_.row(height_ - 1 - coded);
        const bool vertical = predicted_from_above(coded);
        std::size_t skip = 0;
        if (coded == 0) {
            carried_ = reader_.first_pixel(from);
            std::memcpy(row, &carried_, sizeof carried_);
            skip = 1;
        }
        if (!reader_.alpha()) carried_ = vertical ? carried_ & 0x00ffffff : carried_ | 0xff000000;
        const bool good = reader_.read(from, residuals_.data(), width_ - skip);
        const auto& kernels = row_kernels();
        if (!vertical) {
            kernels.add_left(row + 4 * skip, residuals_.data(), width_ - skip, {carried_, 0});
            carried_ = pixel_at(row, width_ - 1);
        } else {
            const std::byte* above = row + picture_.stride() * (stream_.interlaced ? 2 : 1);
            kernels.add_gradient(row, residuals_.data(), above, width_, {carried_, 0});
            carried_ = difference(pixel_at(row, width_ - 1), pixel_at(above, width_ - 1));
        }
        return good;
    }
    static std::uint32_t difference(std::uint32_t a, std::uint32_t b) {
        std::uint32_t out = 0;
        for (unsigned shift = 0; shift < 32; shift += 8) out |= (((a >> shift) - (b >> shift)) & 255) << shift;
        return out;
    }
    bool read_yuy2_row(WordBitReader& from, std::uint32_t y) {
        auto* row = reinterpret_cast<std::uint8_t*>(picture_.row(y));
        const std::uint32_t apart = stream_.interlaced ? 2 : 1;  // rows
        const std::uint8_t* above = y >= apart ? row - picture_.stride() * static_cast<std::ptrdiff_t>(apart) : nullptr;
        const bool vertical = predicted_from_above(y);
        const bool by_median = stream_.predictor == Predictor::median && above != nullptr;
        bool failed = false;
        std::size_t i = 0;
        if (y == 0) {
            left_ = {}, above_left_ = {};
            const std::uint32_t first = from.take(32);
            std::memcpy(row, &first, sizeof first);
            left_ = {row[2], row[1], row[3]};
            i = 4;
        }
        for (; i < 2 * std::size_t{width_}; ++i) {
            const auto plane = plane_of(i);
            const std::uint8_t residual = planes_[plane].take(from, failed);
            const bool median_here = by_median && (y > apart || i >= 8);
            const auto value = static_cast<std::uint8_t>(
                residual + (median_here ? median(left_[plane], above[i], above_left_[plane]) : left_[plane]));
            left_[plane] = value;
            if (above != nullptr) above_left_[plane] = above[i];
            row[i] = static_cast<std::uint8_t>(value + (vertical ? above[i] : 0));
        }
        return !failed;
    }

    const Stream stream_;
    const PixelReader reader_;
    std::vector<SymbolTable> planes_;
    Picture picture_;
    const std::uint32_t width_, height_;
    std::vector<std::uint32_t> residuals_;
    std::vector<std::byte> words_;
    std::uint32_t carried_ = 0;  ///< what left prediction goes on from, as it was coded
    std::array<std::uint8_t, 3> left_{}, above_left_{};
};

}  // namespace

Result<std::unique_ptr<Decoder>> make_stream_decoder(const StreamFormat& format, const Stream& stream) {
    if (auto good = codec::check(format); !good) return tl::unexpected(good.error());
    if (auto good = check(stream, format.width); !good) return tl::unexpected(good.error());
    if ((stream.pixels == Pixels::yuy2) != (format.layout == PixelLayout::yuy2))
        return fail("huffyuv: a stream of " + std::to_string(static_cast<int>(stream.pixels)) +
                    " bits a pixel does not decode to " + std::string(name_of(format.layout)));
    return std::make_unique<HuffyuvDecoder>(format, stream);
}

}  // namespace wall::codec::huffyuv
