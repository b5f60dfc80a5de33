// SPDX-License-Identifier: MIT
#include "tileserver/partials/partial_format.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <numeric>
#include <string>
#include <utility>

#include "common/codec/packed_codec.h"
#include "common/wire/limits.h"

namespace wall::tileserver {
namespace {

constexpr std::size_t kWord = sizeof(std::uint32_t);
constexpr std::size_t kMostLetters = 4;
enum Field : std::size_t {
    surface,
    sequence,
    from,
    slot,
    x,
    y,
    width,
    height,
    top_row_first,
    codec_name,
    plain_bytes,
    rank,
    planes
};
static_assert((planes + 1) * kWord == kPartialHeader);

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t index) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + index * kWord, kWord);
    return word;
}

void set_word(std::span<std::byte> bytes, std::size_t index, std::uint32_t word) {
    std::memcpy(bytes.data() + index * kWord, &word, kWord);
}

bool is_drawn(std::uint32_t depth_stencil) { return (depth_stencil & 0xff) != 0; }

std::vector<PixelRun> runs_of(const PixelBlock& block) {
    std::vector<PixelRun> runs;
    const std::size_t all = block.depths.size();
    for (std::size_t at = 0; at < all;) {
        const std::size_t begin = at;
        while (at < all && !is_drawn(block.depths[at])) ++at;
        const std::size_t first = at;
        while (at < all && is_drawn(block.depths[at])) ++at;
        if (at > first)
            runs.push_back({static_cast<std::uint32_t>(first - begin), static_cast<std::uint32_t>(at - first)});
    }
    return runs;
}

/// A name as four letters, with blanks behind it.
std::uint32_t letters_of(std::string_view name) {
    std::array<char, kMostLetters> letters{' ', ' ', ' ', ' '};
    std::ranges::copy(name.substr(0, kMostLetters), letters.begin());
    return std::bit_cast<std::uint32_t>(letters);
}

std::string name_of(std::uint32_t word) {
    const auto letters = std::bit_cast<std::array<char, kMostLetters>>(word);
    std::string name(letters.begin(), letters.end());
    name.erase(name.find_last_not_of(' ') + 1);
    return name;
}

Result<const codec::Compressor*> compressor_of(std::string_view name) {
    const auto found = codec::find_codec(name);
    if (!found) return tl::unexpected(found.error());
    if ((*found)->compressor == nullptr) return fail("'" + std::string(name) + "' codes frames, and not any bytes");
    return (*found)->compressor;
}

/// The header of a message whose content has `plain` bytes, and room for so many coded ones.
std::vector<std::byte> begin_message(const PartialKey& key, const PixelBlock& block, PartialPlanes what,
                                     std::size_t plain) {
    const geom::Rect& area = block.area;
    std::vector<std::byte> out(kPartialHeader);
    set_word(out, surface, key.surface.value);
    set_word(out, sequence, key.sequence);
    set_word(out, rank, key.rank);
    set_word(out, from, key.from.value);
    set_word(out, slot, key.slot);
    set_word(out, x, static_cast<std::uint32_t>(area.x));
    set_word(out, y, static_cast<std::uint32_t>(area.y));
    set_word(out, width, static_cast<std::uint32_t>(area.width));
    set_word(out, height, static_cast<std::uint32_t>(area.height));
    set_word(out, top_row_first, block.top_row_first ? 1 : 0);
    set_word(out, planes, static_cast<std::uint32_t>(what));
    set_word(out, codec_name, letters_of(kNoCodec));
    set_word(out, plain_bytes, static_cast<std::uint32_t>(plain));
    return out;
}

template <class T>
void append(std::vector<std::byte>& out, std::span<const T> values) {
    const auto bytes = std::as_bytes(values);
    out.insert(out.end(), bytes.begin(), bytes.end());
}

Error wrong(const std::string& what) { return Error{"a partial picture: " + what}; }

/// Nothing is there that the header does not allow.
Result<std::vector<std::byte>> plain_of(std::span<const std::byte> message) {
    const auto coded = message.subspan(kPartialHeader);
    const std::size_t plain = word_at(message, plain_bytes);
    if (plain > wire::kMaxFramePayload) return tl::unexpected(wrong("larger than it may be"));
    const std::string name = name_of(word_at(message, codec_name));
    if (name == kNoCodec) {
        if (coded.size() != plain) return tl::unexpected(wrong("not as long as it says"));
        return std::vector<std::byte>(coded.begin(), coded.end());
    }
    const auto by = compressor_of(name);
    if (!by) return tl::unexpected(wrong(by.error().message));
    std::vector<std::byte> out(plain);
    if (auto restored = (*by)->restore(coded, out); !restored) return tl::unexpected(wrong(restored.error().message));
    return out;
}

}  // namespace

std::vector<std::byte> encode_partial(const PartialKey& key, const PixelBlock& block, std::string_view by,
                                      PartialPlanes what) {
    const std::vector<PixelRun> runs = runs_of(block);
    const std::size_t pixels = std::accumulate(runs.begin(), runs.end(), std::size_t{0},
                                               [](std::size_t n, const PixelRun& r) { return n + r.take; });
    const std::size_t plain =
        2 * kWord + runs.size() * sizeof(PixelRun) + static_cast<std::size_t>(what) * pixels * kWord;
    auto out = begin_message(key, block, what, plain);
    out.reserve(kPartialHeader + plain);
    const std::uint32_t counts[] = {static_cast<std::uint32_t>(runs.size()), static_cast<std::uint32_t>(pixels)};
    append(out, std::span<const std::uint32_t>(counts));
    append(out, std::span<const PixelRun>(runs));
    for (const auto* values : {&block.colors, &block.depths}) {
        if (values == &block.depths && what == PartialPlanes::colors) break;
        std::size_t at = 0;
        for (const PixelRun& run : runs) {
            at += run.skip;
            append(out, std::span<const std::uint32_t>(*values).subspan(at, run.take));
            at += run.take;
        }
    }
    return by == kNoCodec ? out : recode_partial(out, by);
}

std::vector<std::byte> recode_partial(std::span<const std::byte> message, std::string_view by) {
    const auto as_it_is = [&] { return std::vector<std::byte>(message.begin(), message.end()); };
    if (letters_of(by) == word_at(message, codec_name)) return as_it_is();
    auto coded = plain_of(message);
    if (!coded) return as_it_is();
    if (by != kNoCodec) {
        const auto compressor = compressor_of(by);
        if (!compressor) return as_it_is();
        const auto plain = std::exchange(*coded, std::vector<std::byte>((*compressor)->bound(coded->size())));
        const auto written = (*compressor)->compress(plain, *coded);
        if (!written) return as_it_is();
        coded->resize(*written);
    }
    std::vector<std::byte> out(message.begin(), message.begin() + kPartialHeader);
    set_word(out, codec_name, letters_of(by));
    append(out, std::span<const std::byte>(*coded));
    return out;
}

Result<void> check_partial_codec(std::string_view name) {
    if (name == kNoCodec) return {};
    if (name.empty() || name.size() > kMostLetters)
        return fail("'" + std::string(name) + "': expected the name of a codec of 1 to 4 letters");
    if (const auto found = compressor_of(name); !found) return tl::unexpected(found.error());
    return {};
}

Result<PartialKey> key_of_partial(std::span<const std::byte> message) {
    if (message.size() < kPartialHeader) return tl::unexpected(wrong("shorter than its header"));
    return PartialKey{SurfaceId(word_at(message, surface)), word_at(message, sequence), word_at(message, rank),
                      NodeIndex(word_at(message, from)), word_at(message, slot)};
}

Result<Partial> decode_partial(std::span<const std::byte> message) {
    const auto key = key_of_partial(message);
    if (!key) return tl::unexpected(key.error());
    const std::uint32_t columns = word_at(message, width), rows = word_at(message, height);
    if (columns == 0 || rows == 0 || columns > wire::kMaxSurfaceExtent || rows > wire::kMaxSurfaceExtent ||
        std::uint64_t{columns} * rows > kMaxPartialPixels || word_at(message, x) > wire::kMaxSurfaceExtent ||
        word_at(message, y) > wire::kMaxSurfaceExtent)
        return tl::unexpected(wrong("of an area that none can have"));
    const std::uint64_t each = word_at(message, planes);
    if (each != 1 && each != 2) return tl::unexpected(wrong("of neither one plane nor two"));
    const std::uint64_t most = 2 * kWord + std::uint64_t{columns} * rows * (sizeof(PixelRun) + each * kWord);
    if (word_at(message, plain_bytes) > most) return tl::unexpected(wrong("larger than its area"));
    const auto plain = plain_of(message);
    if (!plain) return tl::unexpected(plain.error());
    if (plain->size() < 2 * kWord) return tl::unexpected(wrong("it has no counts"));
    const std::uint64_t runs = word_at(*plain, 0), pixels = word_at(*plain, 1), area = std::uint64_t{columns} * rows;
    if (runs > area || pixels > area || plain->size() != 2 * kWord + runs * sizeof(PixelRun) + each * pixels * kWord)
        return tl::unexpected(wrong("its counts do not fit its length"));
    Partial out{*key,
                {static_cast<std::int32_t>(word_at(message, x)), static_cast<std::int32_t>(word_at(message, y)),
                 static_cast<std::int32_t>(columns), static_cast<std::int32_t>(rows)},
                word_at(message, top_row_first) != 0,
                std::vector<PixelRun>(runs),
                std::vector<std::uint32_t>(pixels),
                std::vector<std::uint32_t>(each == 2 ? pixels : 0)};
    const std::byte* at = plain->data() + 2 * kWord;
    const auto take = [&at](auto& values) {
        const std::size_t bytes = values.size() * sizeof values[0];
        if (bytes != 0) std::memcpy(values.data(), at, bytes);
        at += bytes;
    };
    take(out.runs);
    take(out.colors);
    take(out.depths);
    std::uint64_t end = 0, taken = 0;
    for (const PixelRun& run : out.runs) {
        end += std::uint64_t{run.skip} + run.take;
        taken += run.take;
        if (end > area || taken > pixels) return tl::unexpected(wrong("its runs lead out of it"));
    }
    if (taken != pixels) return tl::unexpected(wrong("its runs are not those of its pixels"));
    return out;
}

namespace {

/// Stretches of pixels that lie in a row in both: `each(theirs, ours, count)`, where they begin.
template <class Each>
void for_each_run(const Partial& partial, const PixelBlock& into, Each&& each) {
    const auto columns = static_cast<std::size_t>(partial.area.width),
               rows = static_cast<std::size_t>(partial.area.height);
    const bool upside_down = partial.top_row_first != into.top_row_first;
    std::size_t at = 0, pixel = 0;
    for (const PixelRun& run : partial.runs) {
        at += run.skip;
        for (std::size_t left = run.take; left != 0;) {
            const std::size_t row = at / columns, column = at % columns;
            const std::size_t count = upside_down ? std::min(left, columns - column) : left;
            each(pixel, upside_down ? (rows - 1 - row) * columns + column : at, count);
            at += count;
            pixel += count;
            left -= count;
        }
    }
}

/// `nearer(theirs, ours)`, of 24 bits each. `kMarks`: what the block has not yet, by its values, is theirs in any case,
/// and has it then.
template <bool kMarks, class Nearer>
void merge_by_depth(const Partial& partial, PixelBlock& into, const Nearer& nearer) {
    for_each_run(partial, into, [&](std::size_t pixel, std::size_t to, std::size_t count) {
        const std::uint32_t* const colors = &partial.colors[pixel];
        const std::uint32_t* const depths = &partial.depths[pixel];
        std::uint32_t* const our_colors = &into.colors[to];
        std::uint32_t* const our_depths = &into.depths[to];
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t value = our_depths[i] & 0xff;
            const bool wins = (kMarks && value == 0) || nearer(depths[i] >> 8, our_depths[i] >> 8);
            our_colors[i] = wins ? colors[i] : our_colors[i];
            our_depths[i] = wins ? (depths[i] & 0xffffff00) | (kMarks ? 1 : value) : our_depths[i];
        }
    });
}

/// Channel by channel theirs + ours * (255 - their alpha) / 255, rounded to the nearest.
std::uint32_t over(std::uint32_t theirs, std::uint32_t ours) {
    const std::uint32_t through = 255 - (theirs >> 24);
    std::uint32_t out = 0;
    for (unsigned shift = 0; shift < 32; shift += 8) {
        const std::uint32_t product = (ours >> shift & 0xff) * through + 128;
        const std::uint32_t left = (product + (product >> 8)) >> 8;
        out |= std::min<std::uint32_t>((theirs >> shift & 0xff) + left, 255) << shift;
    }
    return out;
}

template <bool kMarks>
void merge_over(const Partial& partial, PixelBlock& into) {
    for_each_run(partial, into, [&](std::size_t pixel, std::size_t to, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            into.colors[to + i] = over(partial.colors[pixel + i], into.colors[to + i]);
            if constexpr (kMarks) into.depths[to + i] = 1;
        }
    });
}

}  // namespace

bool is_merge(GLenum by) {
    return by == GL_LESS || by == GL_LEQUAL || by == GL_GREATER || by == GL_GEQUAL || by == GL_BLEND;
}

namespace {

template <bool kMarks>
bool merge_or_compose(const Partial& partial, GLenum by, PixelBlock& into) {
    if (partial.area != into.area) return false;
    if (by == GL_BLEND) return merge_over<kMarks>(partial, into), true;
    if (partial.depths.size() != partial.colors.size()) return false;
    switch (by) {
        case GL_LESS: merge_by_depth<kMarks>(partial, into, std::less<>()); return true;
        case GL_LEQUAL: merge_by_depth<kMarks>(partial, into, std::less_equal<>()); return true;
        case GL_GREATER: merge_by_depth<kMarks>(partial, into, std::greater<>()); return true;
        case GL_GEQUAL: merge_by_depth<kMarks>(partial, into, std::greater_equal<>()); return true;
        default: return false;
    }
}

}  // namespace

bool merge(const Partial& partial, GLenum by, PixelBlock& into) { return merge_or_compose<false>(partial, by, into); }

bool compose(const Partial& partial, GLenum by, PixelBlock& into) { return merge_or_compose<true>(partial, by, into); }

}  // namespace wall::tileserver
