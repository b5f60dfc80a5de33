// SPDX-License-Identifier: MIT
#include "walld/mpcdi/maps.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>

namespace wall::mpcdi {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::string_view kPngBegins = "\x89PNG\r\n\x1a\n";
constexpr std::size_t kPngSize = 16;  // where width and height stand, 4 bytes each, high one first

/// A word of a header, and the one byte of space behind it.
std::optional<std::string_view> next_word(std::string_view& bytes) {
    constexpr std::string_view kSpace = " \t\r\n";
    const auto begin = bytes.find_first_not_of(kSpace);
    const auto end = begin == bytes.npos ? bytes.npos : bytes.find_first_of(kSpace, begin);
    if (end == bytes.npos) return std::nullopt;
    const auto word = bytes.substr(begin, end - begin);
    bytes.remove_prefix(end + 1);
    return word;
}

template <class Number>
std::optional<Number> number(std::optional<std::string_view> word) {
    Number out{};
    if (!word || std::from_chars(word->data(), word->data() + word->size(), out).ptr != word->data() + word->size())
        return std::nullopt;
    return out;
}

bool size_ok(std::uint64_t width, std::uint64_t height) {
    return width >= 2 && height >= 2 && width <= kMaxExtent && height <= kMaxExtent && width * height <= kMaxPlaces;
}

std::uint32_t big_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t out = 0;
    for (std::size_t i = 0; i < 4; ++i) out = out << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    return out;
}

float swapped(float value) { return std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value))); }

}  // namespace

Result<Field> parse_pfm(std::string_view bytes, const std::string& what) {
    if (next_word(bytes) != "PF") return fail(what + ": expected a PFM file of three numbers a place (PF)");
    const auto width = number<std::uint32_t>(next_word(bytes)), height = number<std::uint32_t>(next_word(bytes));
    const auto scale = number<double>(next_word(bytes));
    if (!width || !height || !size_ok(*width, *height))
        return fail(what + ": expected a width and a height of 2 to " + std::to_string(kMaxExtent) +
                    " places, 33554432 in all");
    if (!scale || *scale == 0 || !std::isfinite(*scale))
        return fail(what + ": expected -1.0 (little endian) or 1.0 (big endian) behind width and height");
    Field out{*width, *height, {}};
    const std::size_t places = std::size_t{*width} * *height, wanted = places * sizeof(Field::Value);
    if (bytes.size() != wanted)
        return fail(what + ": expected " + std::to_string(wanted) + " bytes behind its header, there are " +
                    std::to_string(bytes.size()));
    out.values.resize(places);
    std::memcpy(out.values.data(), bytes.data(), wanted);
    if (*scale > 0)
        for (auto& value : out.values)
            for (float& each : value) each = swapped(each);
    return out;
}

Result<Factors> parse_png(std::string_view bytes, const std::string& what) {
    if (!bytes.starts_with(kPngBegins) || bytes.size() < kPngSize + 8) return fail(what + ": expected a PNG file");
    if (!size_ok(big_endian(bytes, kPngSize), big_endian(bytes, kPngSize + 4)))
        return fail(what + ": expected 2 to " + std::to_string(kMaxExtent) + " pixels a side, 33554432 in all");
    const cv::Mat all(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    cv::Mat picture;
    try {
        picture = cv::imdecode(all, cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception&) {
        picture.release();
    }
    if (picture.empty() || (picture.depth() != CV_8U && picture.depth() != CV_16U))
        return fail(what + " is damaged: expected a PNG file of 8 or 16 bits a channel");
    Factors out;
    out.width = static_cast<std::uint32_t>(picture.cols);
    out.height = static_cast<std::uint32_t>(picture.rows);
    const auto stored = static_cast<std::uint32_t>(picture.channels());
    out.channels = stored < 3 ? 1 : 3;
    out.values.reserve(std::size_t{out.width} * out.height * out.channels);
    const float most = picture.depth() == CV_8U ? 255.0f : 65535.0f;
    for (int y = 0; y < picture.rows; ++y) {
        const auto value = [&](std::uint32_t i) {
            return picture.depth() == CV_8U ? static_cast<float>(picture.ptr<std::uint8_t>(y)[i])
                                            : static_cast<float>(picture.ptr<std::uint16_t>(y)[i]);
        };
        for (std::uint32_t x = 0; x < out.width; ++x)
            for (std::uint32_t channel = 0; channel < out.channels; ++channel)  // which OpenCV has as blue, green, red
                out.values.push_back(value(x * stored + (out.channels == 1 ? 0 : 2 - channel)) / most);
    }
    return out;
}

}  // namespace wall::mpcdi
