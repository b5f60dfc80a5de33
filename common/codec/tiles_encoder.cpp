// SPDX-License-Identifier: MIT
// Codec `huffyuv-tiles`, encoder: one pass over the slices chooses a mode for every block and turns residuals into
// tokens, which are counted; then the codes are made; a second pass writes the tokens.
#include <limits>

#include "common/codec/tiles.h"
#include "common/codec/tiles_tables.h"
#include "common/codec/worker_pool.h"

namespace wall::codec::tiles {
namespace {

constexpr std::uint32_t kProbeStep = 8;                     ///< rows; every eighth one is tried with each predictor
constexpr std::size_t kMostBlockBytes = kBlockPixels * 6;   ///< four codes a pixel; runs take less
constexpr std::size_t kMostBlockTokens = kBlockPixels * 2;  ///< whole pixels with alpha

struct BlockPlan {
    std::uint8_t mode;
    std::size_t tokens_end;  ///< of the slice's tokens; they begin where the block before ends
};

/// A token is a symbol of the main code and its extra bits, or a whole pixel's residual; where the stream keeps alpha,
/// a word with alpha's residual follows it.
namespace token {
constexpr std::uint32_t kPixel = 1u << 31;  ///< over the residual of three colours
constexpr unsigned kSymbolBits = 10, kExtraShift = 16;
static_assert(kMainSymbols <= 1u << kSymbolBits);

constexpr std::uint32_t symbol(std::uint32_t symbol, std::uint32_t extra = 0, unsigned extra_bits = 0) {
    return symbol | extra_bits << kSymbolBits | extra << kExtraShift;
}
constexpr std::uint32_t symbol_of(std::uint32_t token) { return token & ((1u << kSymbolBits) - 1); }
constexpr unsigned extra_bits_of(std::uint32_t token) { return token >> kSymbolBits & 15; }
}  // namespace token

/// One slice's work, by one thread at a time.
struct Slice {
    std::vector<BlockPlan> blocks;
    std::vector<std::uint32_t> tokens;  ///< see Token
    std::size_t tokens_used = 0;
    Counts counts;
    std::vector<std::byte> bytes;  ///< as in the packet
    std::size_t bytes_used = 0;
    bool changed = false;
};

struct Input {
    const FrameView& frame;
    Picture& previous;  ///< becomes `frame`, each block once it is planned
    StreamFormat format;
    bool key;

    std::uint32_t mask() const { return format.alpha ? 0xffffffff : 0x00ffffff; }
    const std::byte* row(const Block& block, std::uint32_t y) const {
        return frame.row(block.y + y) + 4 * std::size_t{block.x};
    }
    std::byte* previous_row(const Block& block, std::uint32_t y) const {
        return previous.row(block.y + y) + 4 * std::size_t{block.x};
    }
    void keep(const Block& block) const {
        // memmove: of memcpy, with so narrow a range of sizes, GCC makes a `rep movs`, a quarter of all the time.
        for (std::uint32_t y = 0; y < block.height; ++y)
            std::memmove(previous_row(block, y), row(block, y), 4 * std::size_t{block.width});
    }
};

void residuals(const Input& in, const Block& block, std::uint32_t y, Mode mode, std::uint32_t* out) {
    const auto& kernels = row_kernels();
    const std::byte* row = in.row(block, y);
    if (mode == Mode::previous) return kernels.difference(out, row, in.previous_row(block, y), block.width, true);
    const std::byte* above = y > 0 ? in.row(block, y - 1) : nullptr;
    const RowStart start = row_start(row, above, block.x);
    if (mode == Mode::left || above == nullptr) return kernels.left(out, row, block.width, start, true);
    (mode == Mode::gradient ? kernels.gradient : kernels.median)(out, row, above, block.width, start, true);
}

/// The predictor that costs least on a sample of the block's rows.
Mode choose_predictor(const Input& in, const Block& block) {
    std::array<std::uint32_t, kBlock> residual;
    Mode best = Mode::left;
    std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
    for (const Mode mode : {Mode::left, Mode::gradient, Mode::median, Mode::previous}) {
        if (mode == Mode::previous && in.key) continue;
        std::uint32_t cost = 0;
        for (std::uint32_t y = std::min(1u, block.height - 1); y < block.height; y += kProbeStep) {
            residuals(in, block, y, mode, residual.data());
            cost += row_kernels().cost(residual.data(), block.width, in.mask());
        }
        if (mode == Mode::median) cost += cost / 32;  // it decodes more slowly
        if (cost < least) best = mode, least = cost;
        if (cost == 0) break;
    }
    return best;
}

/// Turns residuals into tokens and counts their symbols.
class Tokenizer {
public:
    Tokenizer(Slice& slice, std::uint32_t mask)
        : slice_(slice), mask_(mask), at_(slice.tokens.data() + slice.tokens_used) {}

    void add_row(const std::uint32_t* residual, std::uint32_t count) {
        std::uint64_t rest = row_kernels().nonzero(residual, count, mask_);
        std::uint32_t next = 0;  // the first pixel that has no token yet
        while (rest != 0) {
            const auto at = static_cast<std::uint32_t>(std::countr_zero(rest));
            rest &= rest - 1;
            run_ += at - next;
            if (run_ > 0) end_run();
            pixel(residual[at] & mask_);
            next = at + 1;
        }
        run_ += count - next;
    }
    /// Whether any pixel had alpha.
    bool end_block() {
        if (run_ > 0) put_symbol(kRest);
        slice_.tokens_used = static_cast<std::size_t>(at_ - slice_.tokens.data());
        return (any_ >> 24) != 0;
    }
    /// After end_block(), for the tokens from `from` on: in blocks with alpha every whole pixel has a symbol of it.
    void count_alpha(std::size_t from) {
        for (std::size_t i = from; i < slice_.tokens_used; ++i)
            if (slice_.tokens[i] & token::kPixel) ++slice_.counts.others[kAlpha - 1][slice_.tokens[++i]];
    }

private:
    void put_symbol(std::size_t symbol, std::uint32_t extra = 0, unsigned extra_bits = 0) {
        ++slice_.counts.main[symbol];
        *at_++ = token::symbol(static_cast<std::uint32_t>(symbol), extra, extra_bits);
    }
    void end_run() {
        const RunClass found = run_class(run_);
        put_symbol(kRuns + found.symbol, found.extra, found.extra_bits);
        run_ = 0;
    }
    void pixel(std::uint32_t residual) {
        const std::uint32_t digits = small_digits(residual);
        if (digits < 64) return put_symbol(kSmall + digits);
        if ((residual & 0xffff00ff) == 0) return put_symbol(kGrey + (residual >> 8));
        any_ |= residual;
        *at_++ = (residual & 0x00ffffff) | token::kPixel;
        if (mask_ >> 24) *at_++ = residual >> 24;
        auto& counts = slice_.counts;
        ++counts.main[residual >> 8 & 255];
        ++counts.others[kBlue - 1][residual & 255];
        ++counts.others[kRed - 1][residual >> 16 & 255];
    }

    Slice& slice_;
    const std::uint32_t mask_;
    std::uint32_t* at_;
    std::uint32_t run_ = 0, any_ = 0;
};

bool is_unchanged(const Input& in, const Block& block) {
    for (std::uint32_t y = 0; y < block.height; ++y)
        if (std::memcmp(in.row(block, y), in.previous_row(block, y), 4 * std::size_t{block.width}) != 0) return false;
    return true;
}

bool is_flat(const Input& in, const Block& block) {
    const std::uint32_t pixel = row_start(in.row(block, 0), nullptr, block.x).left;
    for (std::uint32_t y = 0; y < block.height; ++y)
        if (!row_kernels().all_equal(in.row(block, y), block.width, pixel, in.mask())) return false;
    return true;
}

std::uint8_t plan_coded(const Input& in, const Block& block, Slice& slice) {
    const Mode mode = choose_predictor(in, block);
    const std::size_t begin = slice.tokens_used;
    std::array<std::uint32_t, kBlock> residual;
    Tokenizer tokenizer(slice, in.mask());
    for (std::uint32_t y = 0; y < block.height; ++y) {
        residuals(in, block, y, mode, residual.data());
        tokenizer.add_row(residual.data(), block.width);
    }
    if (!tokenizer.end_block()) return static_cast<std::uint8_t>(mode);
    tokenizer.count_alpha(begin);
    return static_cast<std::uint8_t>(static_cast<std::uint8_t>(mode) + kWithAlpha);
}

void plan_slice(const Input& in, std::uint32_t number, Slice& slice) {
    slice.blocks.clear();
    slice.tokens_used = 0;
    slice.counts = {};
    slice.changed = in.key;
    for (std::uint32_t column = 0; column < blocks_across(in.format); ++column) {
        const Block block = block_at(in.format, column, number);
        auto mode = static_cast<std::uint8_t>(Mode::unchanged);
        if (in.key || !is_unchanged(in, block)) {
            mode = is_flat(in, block) ? static_cast<std::uint8_t>(Mode::flat) : plan_coded(in, block, slice);
            in.keep(block);
            slice.changed = true;
        }
        slice.blocks.push_back({mode, slice.tokens_used});
    }
}

/// `alpha_words`: every whole pixel's token has alpha's behind it; `alpha`: it is written.
template <bool alpha_words, bool alpha>
void write_tokens(std::span<const std::uint32_t> tokens, const std::array<EncodeTable, 4>& tables, ByteBitWriter& out) {
    ByteBitWriter to = out;  // in registers
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        const std::uint32_t now = tokens[i];
        if (!(now & token::kPixel)) {
            const std::uint32_t code = tables[kMain][token::symbol_of(now)];
            to.put(code >> 8 | std::uint64_t{now >> token::kExtraShift} << (code & 63),
                   (code & 63) + token::extra_bits_of(now));
            continue;
        }
        const std::uint32_t green = tables[kMain][now >> 8 & 255], blue = tables[kBlue][now & 255],
                            red = tables[kRed][now >> 16 & 255];
        std::uint64_t bits = green >> 8 | std::uint64_t{blue >> 8} << (green & 63);
        unsigned length = (green & 63) + (blue & 63);
        bits |= std::uint64_t{red >> 8} << length;
        length += red & 63;
        if constexpr (alpha_words) ++i;
        if constexpr (alpha) {
            const std::uint32_t last = tables[kAlpha][tokens[i]];
            bits |= std::uint64_t{last >> 8} << length;
            length += last & 63;
        }
        to.put(bits, length);
    }
    out = to;
}

void write_raw(const Input& in, const Block& block, bool alpha, ByteBitWriter& to) {
    const std::uint32_t mask = alpha ? 0xffffffff : 0x00ffffff;
    for (std::uint32_t y = 0; y < block.height; ++y)
        for (std::uint32_t x = 0; x < block.width; ++x)
            to.put(load_pixel(in.row(block, y) + 4 * std::size_t{x}) & mask, alpha ? 32 : 24);
}

/// Modes run by run: the mode, then the run in Elias' gamma code, its leading zeros first.
void write_modes(std::span<const BlockPlan> blocks, ByteBitWriter& to) {
    for (std::size_t at = 0; at < blocks.size();) {
        std::size_t end = at;
        while (end < blocks.size() && blocks[end].mode == blocks[at].mode) ++end;
        const std::size_t run = end - at;
        const auto power = static_cast<unsigned>(std::bit_width(run)) - 1;
        to.put(blocks[at].mode, kModeBits);
        to.put(std::uint64_t{1} << power, power + 1);
        to.put(run & ((std::size_t{1} << power) - 1), power);
        at = end;
    }
}

/// A block that its codes would make larger than its pixels is written raw. Returns where it ends.
void write_block(const Input& in, const Block& block, std::span<const std::uint32_t> tokens,
                 const std::array<EncodeTable, 4>& tables, BlockPlan& plan, ByteBitWriter& to) {
    if (plan.mode < static_cast<std::uint8_t>(Mode::left)) return;
    const ByteBitWriter before = to;
    const bool alpha = has_alpha(plan.mode);
    if (!in.format.alpha) write_tokens<false, false>(tokens, tables, to);
    else alpha ? write_tokens<true, true>(tokens, tables, to) : write_tokens<true, false>(tokens, tables, to);
    const std::size_t raw_bytes = std::size_t{block.width} * block.height * (alpha ? 4 : 3);
    if (static_cast<std::size_t>(to.at() - before.at()) <= raw_bytes) return;
    to = before;
    plan.mode = static_cast<std::uint8_t>(alpha ? Mode::raw_alpha : Mode::raw);
    write_raw(in, block, alpha, to);
}

void write_slice(const Input& in, std::uint32_t number, const std::array<EncodeTable, 4>& tables, Slice& slice) {
    slice.bytes_used = 0;
    if (!slice.changed) return;
    // Tokens first, at a distance that surely holds the modes; then the modes, and the tokens moved up to them.
    const std::size_t modes_room = slice.blocks.size() * 4 + 8;
    if (slice.bytes.size() < modes_room + kMostBlockBytes) slice.bytes.resize(modes_room + kMostBlockBytes);
    ByteBitWriter to(slice.bytes.data() + modes_room);
    std::size_t begin = 0;
    for (std::uint32_t column = 0; column < slice.blocks.size(); ++column) {
        const auto used = static_cast<std::size_t>(to.at() - slice.bytes.data());
        if (slice.bytes.size() - used < kMostBlockBytes) {
            slice.bytes.resize(slice.bytes.size() * 2 + kMostBlockBytes);
            to.move_to(slice.bytes.data() + used);
        }
        BlockPlan& plan = slice.blocks[column];
        write_block(in, block_at(in.format, column, number),
                    std::span(slice.tokens).subspan(begin, plan.tokens_end - begin), tables, plan, to);
        begin = plan.tokens_end;
    }
    const std::byte* const tokens_begin = slice.bytes.data() + modes_room;
    const auto tokens_bytes = static_cast<std::size_t>(to.finish() - tokens_begin);
    ByteBitWriter modes(slice.bytes.data());
    write_modes(slice.blocks, modes);
    std::byte* const modes_end = modes.finish();
    std::memmove(modes_end, tokens_begin, tokens_bytes);
    slice.bytes_used = static_cast<std::size_t>(modes_end - slice.bytes.data()) + tokens_bytes;
}

void put_number(std::size_t value, std::vector<std::byte>& out) {
    for (; value >= 128; value >>= 7) out.push_back(static_cast<std::byte>(value | 128));
    out.push_back(static_cast<std::byte>(value));
}

class TilesEncoder final : public Encoder {
public:
    TilesEncoder(const StreamFormat& format, ParallelFor parallel)
        : format_(format), parallel_(std::move(parallel)), previous_(format), slices_(slices_of(format)) {
        for (auto& slice : slices_) slice.tokens.resize(std::size_t{blocks_across(format)} * kMostBlockTokens);
    }

    Result<PacketKind> encode(const FrameView& frame, PacketKind want, std::vector<std::byte>& out) override {
        if (auto good = check(frame, format_); !good) return tl::unexpected(good.error());
        const bool key = want == PacketKind::key || !started_;
        started_ = true;
        const Input in{frame, previous_, format_, key};
        for_each_index(parallel_, slices_.size(),
                       [&](std::size_t i) { plan_slice(in, static_cast<std::uint32_t>(i), slices_[i]); });
        const auto kind = key ? PacketKind::key : PacketKind::delta;
        if (std::none_of(slices_.begin(), slices_.end(), [](const Slice& slice) { return slice.changed; })) {
            out.push_back(std::byte{kUnchanged});
            return kind;
        }
        const std::size_t at = out.size();
        out.push_back(std::byte{key ? kKey : std::uint8_t{0}});
        if (write_tables_if_better(key, out)) out[at] |= std::byte{kTables};
        for_each_index(parallel_, slices_.size(),
                       [&](std::size_t i) { write_slice(in, static_cast<std::uint32_t>(i), tables_, slices_[i]); });
        for (const Slice& slice : slices_) put_number(slice.bytes_used, out);
        for (const Slice& slice : slices_)
            out.insert(out.end(), slice.bytes.begin(),
                       slice.bytes.begin() + static_cast<std::ptrdiff_t>(slice.bytes_used));
        return kind;
    }

private:
    /// Writes new tables unless those of the packets before are good enough; true if it did.
    bool write_tables_if_better(bool key, std::vector<std::byte>& out) {
        Counts counts;
        for (const Slice& slice : slices_) counts.add(slice.counts);
        if (counts.empty()) return false;
        Lengths lengths = suit(counts);
        std::array<std::byte, kMostTableBytes> bytes;
        ByteBitWriter to(bytes.data());
        write_lengths(lengths, to);
        const auto size = static_cast<std::size_t>(to.finish() - bytes.data());
        if (!key && have_tables_ && bits_with(counts, lengths_) <= bits_with(counts, lengths) + 8 * size) return false;
        lengths_ = std::move(lengths);
        tables_ = encode_tables(lengths_);
        have_tables_ = true;
        out.insert(out.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        return true;
    }

    const StreamFormat format_;
    const ParallelFor parallel_;
    Picture previous_;
    std::vector<Slice> slices_;
    Lengths lengths_;
    std::array<EncodeTable, 4> tables_{};
    bool started_ = false, have_tables_ = false;
};

}  // namespace

Result<std::unique_ptr<Encoder>> make_encoder(const StreamFormat& format, ParallelFor parallel) {
    if (format.layout == PixelLayout::yuy2) return fail("huffyuv-tiles: yuy2 frames; expected bgra or rgba");
    return std::make_unique<TilesEncoder>(format, std::move(parallel));
}

}  // namespace wall::codec::tiles
