// SPDX-License-Identifier: MIT
#include <algorithm>

#include "common/codec/huffyuv.h"
#include "common/codec/huffyuv_rows.h"
#include "common/codec/huffyuv_statistics.h"
#include "common/codec/word_bits.h"
#include "common/codec/worker_pool.h"

namespace wall::codec::huffyuv {
namespace {

constexpr unsigned kPutBits = 32;  ///< what WordBitWriter takes at once

/// Codes packed for the inner loop: the value above 8 bits of length. Lengths over 24 do not fit.
using PackedCodes = std::array<std::uint32_t, 256>;

PackedCodes pack(const std::array<Code, 256>& codes) {
    PackedCodes out;
    std::transform(codes.begin(), codes.end(), out.begin(), [](Code code) { return code.bits << 8 | code.length; });
    return out;
}

unsigned longest(const std::array<Code, 256>& codes) {
    return std::max_element(codes.begin(), codes.end(), [](Code a, Code b) { return a.length < b.length; })->length;
}

struct Put {
    std::uint64_t bits = 0;
    unsigned length = 0;

    void append(Code code) {
        bits = bits << code.length | code.bits;
        length += code.length;
    }
};

/// Codes of four-byte pixels, in the order green, blue, red, alpha (not decorrelated: blue, green, red, alpha).
class PixelCoder {
public:
    PixelCoder(const Stream& stream, PixelLayout layout)
        : stream_(stream), red_shift_(layout == PixelLayout::rgba ? 0 : 16), alpha_(stream.pixels == Pixels::rgb32) {
        for (std::size_t plane = 0; plane < 3; ++plane) packed_[plane] = pack(stream.tables[plane]);
        const auto& t = stream.tables;
        at_once_ = longest(t[0]) + longest(t[1]) + longest(t[2]) <= kPutBits;
        Put group;
        for (std::size_t i = 0; i < kGroup && group.length <= kPutBits; ++i) {
            group.append(t[stream.decorrelate ? 1 : 0][0]);
            group.append(t[stream.decorrelate ? 0 : 1][0]);
            group.append(t[2][0]);
            if (alpha_) group.append(t[2][0]);
        }
        if (at_once_ && group.length <= kPutBits) zero_group_ = group;
    }

    void put_row(WordBitWriter& to, const std::uint32_t* residuals, std::size_t count) const {
        if (!at_once_) return put_slowly(to, residuals, count);
        if (stream_.decorrelate && !alpha_)
            red_shift_ == 16 ? put_fast<true, false, 16>(to, residuals, count)
                             : put_fast<true, false, 0>(to, residuals, count);
        else if (stream_.decorrelate)
            red_shift_ == 16 ? put_fast<true, true, 16>(to, residuals, count)
                             : put_fast<true, true, 0>(to, residuals, count);
        else if (!alpha_)
            red_shift_ == 16 ? put_fast<false, false, 16>(to, residuals, count)
                             : put_fast<false, false, 0>(to, residuals, count);
        else
            red_shift_ == 16 ? put_fast<false, true, 16>(to, residuals, count)
                             : put_fast<false, true, 0>(to, residuals, count);
    }

private:
    template <bool decorrelated, bool alpha, unsigned red_shift>
    void put_fast(WordBitWriter& out, const std::uint32_t* residuals, std::size_t count) const {
        WordBitWriter to = out;  // in registers
        const auto put_pixel = [&](std::uint32_t r) {
            const std::uint32_t blue = packed_[0][r >> (16 - red_shift) & 255], green = packed_[1][r >> 8 & 255];
            const std::uint32_t red = packed_[2][r >> red_shift & 255];
            const std::uint32_t first = decorrelated ? green : blue, second = decorrelated ? blue : green;
            const std::uint64_t bits =
                ((std::uint64_t{first >> 8} << (second & 63)) | second >> 8) << (red & 63) | red >> 8;
            to.put(bits, (first & 63) + (second & 63) + (red & 63));
            if constexpr (alpha) to.put(packed_[2][r >> 24] >> 8, packed_[2][r >> 24] & 63);
        };
        constexpr std::uint64_t kMask = alpha ? ~std::uint64_t{0} : 0x00ffffff'00ffffff;
        std::size_t i = 0;
        for (; i + kGroup <= count; i += kGroup) {
            std::uint64_t pairs[kGroup / 2];
            std::memcpy(pairs, residuals + i, sizeof pairs);
            const bool zero = ((pairs[0] | pairs[1] | pairs[2] | pairs[3]) & kMask) == 0;
            if (zero && zero_group_.length > 0) to.put(zero_group_.bits, zero_group_.length);
            else
                for (std::size_t k = 0; k < kGroup; ++k) put_pixel(residuals[i + k]);
        }
        for (; i < count; ++i) put_pixel(residuals[i]);
        out = to;
    }

    void put_slowly(WordBitWriter& to, const std::uint32_t* residuals, std::size_t count) const {
        const auto put = [&](std::size_t plane, std::uint32_t symbol) {
            const Code code = stream_.tables[plane][symbol & 255];
            to.put(code.bits, code.length);
        };
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t r = residuals[i], blue = r >> (16 - red_shift_);
            put(stream_.decorrelate ? 1 : 0, stream_.decorrelate ? r >> 8 : blue);
            put(stream_.decorrelate ? 0 : 1, stream_.decorrelate ? blue : r >> 8);
            put(2, r >> red_shift_);
            if (alpha_) put(2, r >> 24);
        }
    }

    const Stream& stream_;
    const unsigned red_shift_;
    const bool alpha_;
    std::array<PackedCodes, 3> packed_;
    bool at_once_ = false;  ///< a pixel without alpha fits one put()
    Put zero_group_;        ///< kGroup pixels without residual; length 0 if they do not fit one put()
};

class HuffyuvEncoder final : public StreamEncoder {
public:
    HuffyuvEncoder(const StreamFormat& format, const EncoderOptions& options, ParallelFor parallel)
        : format_(format), options_(options), parallel_(std::move(parallel)) {
        const bool one = !parallel_ || format.layout == PixelLayout::yuy2;
        bands_.resize(one ? 1 : std::min(kBands, format.height));
        for (auto& band : bands_) band.residuals.resize(format.width);
    }

    const Stream& stream() const override { return stream_; }
    std::span<const std::byte> stream_header() const override { return extradata_; }

    Result<PacketKind> encode(const FrameView& frame, PacketKind, std::vector<std::byte>& out) override {
        if (auto good = codec::check(frame, format_); !good) return tl::unexpected(good.error());
        if (!pixel_coder_) choose_format(frame);
        if (format_.layout == PixelLayout::yuy2) encode_yuy2(frame, bands_[0].words);
        else for_each_index(parallel_, bands_.size(), [&](std::size_t i) { encode_band(frame, i); });
        for (std::size_t i = 1; i < bands_.size(); ++i) bands_[0].words.append(bands_[i].words);
        const auto words = bands_[0].words.finish();
        out.insert(out.end(), words.begin(), words.end());
        return PacketKind::key;
    }

private:
    /// Rows that one thread codes; the bits of all bands are put behind each other.
    struct Band {
        WordBuffer words;
        std::vector<std::uint32_t> residuals;
    };
    static constexpr std::uint32_t kBands = 16;

    void choose_format(const FrameView& frame) {
        stream_ = suit(frame, format_.alpha, options_);
        extradata_ = write_extradata(stream_);
        pixel_coder_.emplace(stream_, format_.layout);
    }
    void encode_band(const FrameView& frame, std::size_t number) {
        Band& band = bands_[number];
        band.words.clear();
        if (number == 0) band.words.writer(4).put(first_pixel(pixel_at(coded_row(frame, 0), 0)), 32);
        const auto begin = number * std::size_t{frame.height} / bands_.size();
        const auto end = (number + 1) * std::size_t{frame.height} / bands_.size();
        for (auto coded = static_cast<std::uint32_t>(begin); coded < end; ++coded) {
            rgb_residuals(frame, coded, stream_.predictor, stream_.decorrelate, band.residuals.data());
            const std::size_t skip = coded == 0 ? 1 : 0;
            auto& to = band.words.writer(frame.width * kMostPixelBytes);
            pixel_coder_->put_row(to, band.residuals.data() + skip, frame.width - skip);
        }
    }
    /// Alpha, red, green, blue, or red, green, blue, zero.
    std::uint32_t first_pixel(std::uint32_t pixel) const {
        if (format_.layout == PixelLayout::rgba)
            pixel = (pixel & 0xff00ff00) | (pixel & 255) << 16 | (pixel >> 16 & 255);
        return stream_.pixels == Pixels::rgb32 ? pixel : pixel << 8;
    }
    void encode_yuy2(const FrameView& frame, WordBuffer& words) const {
        words.clear();
        Yuy2Residuals residuals(frame, stream_.predictor);
        for (std::uint32_t y = 0; y < frame.height; ++y) {
            WordBitWriter& to = words.writer(frame.width * kMostPixelBytes);
            const auto& row = residuals.next();
            if (y == 0) to.put(pixel_at(frame.row(0), 0), 32);
            for (std::size_t i = y == 0 ? 4 : 0; i < row.size(); ++i) {
                const Code code = stream_.tables[plane_of(i)][row[i]];
                to.put(code.bits, code.length);
            }
        }
    }

    const StreamFormat format_;
    const EncoderOptions options_;
    const ParallelFor parallel_;
    Stream stream_;
    std::vector<std::byte> extradata_;
    std::vector<Band> bands_;
    std::optional<PixelCoder> pixel_coder_;  ///< once the format is chosen
};

}  // namespace

Result<std::unique_ptr<StreamEncoder>> make_stream_encoder(const StreamFormat& format, const EncoderOptions& options,
                                                           ParallelFor parallel) {
    Stream wanted{.pixels = format.layout == PixelLayout::yuy2 ? Pixels::yuy2 : Pixels::rgb24,
                  .predictor = options.predictor.value_or(Predictor::left)};
    if (auto good = check(wanted, format.width); !good) return tl::unexpected(good.error());
    if (options.classic && wanted.pixels != Pixels::yuy2 && wanted.predictor == Predictor::gradient &&
        !options.decorrelate)
        return fail("huffyuv: HuffYUV 1.x decorrelates RGB under gradient prediction; expected decorrelate");
    return std::make_unique<HuffyuvEncoder>(format, options, std::move(parallel));
}

}  // namespace wall::codec::huffyuv

namespace wall::codec {
namespace {

Result<std::unique_ptr<Decoder>> make_huffyuv_decoder(const StreamFormat& format, std::span<const std::byte> header,
                                                      ParallelFor) {
    if (header.empty()) return fail("huffyuv: no stream header; expected the encoder's");
    const auto stream = huffyuv::read_stream(0, format.height, header);
    if (!stream) return tl::unexpected(stream.error());
    return huffyuv::make_stream_decoder(format, *stream);
}

}  // namespace

extern const Codec codec_huffyuv;
const Codec codec_huffyuv{"huffyuv", "HuffYUV 2.x, as AVI files hold it",
                          [](const StreamFormat& format, ParallelFor parallel) -> Result<std::unique_ptr<Encoder>> {
                              return huffyuv::make_stream_encoder(format, {}, std::move(parallel));
                          },
                          make_huffyuv_decoder};

}  // namespace wall::codec
