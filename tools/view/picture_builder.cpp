// SPDX-License-Identifier: MIT
#include "tools/view/picture_builder.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/json/parse_json.h"
#include "common/net/base64.h"

namespace wall::view {
namespace {

using nlohmann::json;

constexpr std::size_t kFrameHead = 24;  // bytes: stream:u32 part:u32 time:u64 sequence:u32 flags:u32
constexpr codec::PixelLayout kLayout = codec::PixelLayout::rgba;

std::uint32_t read_u32(const char* from) {
    std::uint32_t out = 0;
    std::memcpy(&out, from, sizeof out);
    return out;
}

/// "#RRGGBB"
std::uint32_t color_of(const std::string& text) {
    return static_cast<std::uint32_t>(std::stoul(text.substr(1), nullptr, 16));
}

/// A number of pixels, or a place: never one with which a sum could overflow.
std::int32_t pixels_of(const json& value) {
    constexpr std::int64_t kMost = 1 << 24;
    const bool fits = value.is_number_unsigned() || (value.is_number_integer() && value.get<std::int64_t>() >= 0);
    if (!fits || value.get<std::uint64_t>() > kMost)
        throw std::range_error(fmt::format("pixels: expected an integer from 0 to {}, not {}", kMost, value.dump()));
    return value;
}

geom::Rect rect_of(const json& rect) {
    return {pixels_of(rect.at(0)), pixels_of(rect.at(1)), pixels_of(rect.at(2)), pixels_of(rect.at(3))};
}

std::byte* pixel(codec::Picture& picture, std::int32_t x, std::int32_t y) {
    return picture.row(static_cast<std::uint32_t>(y)) + std::ptrdiff_t{4} * x;
}

}  // namespace

Result<void> PictureBuilder::take_text(std::string_view text) try {
    const auto parsed = parse_json(text, kAnswerJson);
    if (!parsed) return fail("walld said what is not expected: " + parsed.error().message);
    const json& message = *parsed;
    if (message.contains("error")) return fail("walld refused: " + message.at("error").get<std::string>());
    if (message.contains("parts")) return set_parts(message);
    if (message.contains("part")) {
        const std::size_t number = message.at("part");
        return number < parts_.size() ? take_part(message, parts_[number])
                                      : fail("walld speaks of a part that it has not told");
    }
    if (!message.contains("ended")) return {};
    ended_ = message.at("ended");
    parts_.clear();
    clear({0, 0, static_cast<std::int32_t>(format_.width), static_cast<std::int32_t>(format_.height)});
    return {};
} catch (const std::exception& error) {  // of the JSON library, std::stoul and pixels_of
    return fail(std::string("walld said what is not expected: ") + error.what());
}

Result<void> PictureBuilder::set_parts(const json& text) {
    // Nothing is taken over before all of it is read: what is wrong must not leave old parts on a new picture.
    const codec::StreamFormat format{static_cast<std::uint32_t>(pixels_of(text.at("width"))),
                                     static_cast<std::uint32_t>(pixels_of(text.at("height"))), kLayout, false};
    if (const auto fits = codec::check(format); !fits) return fits;
    const geom::Rect whole{0, 0, static_cast<std::int32_t>(format.width), static_cast<std::int32_t>(format.height)};
    std::vector<Part> parts;
    for (const auto& part : text.at("parts")) {
        parts.push_back({part.at("tile"), rect_of(part.at("rect")), !part.at("away").get<bool>(), false, nullptr});
        if (geom::intersect(parts.back().at, whole) != parts.back().at)
            return fail("walld speaks of a part outside the picture");
    }
    const auto background = color_of(text.at("background"));
    codec_ = text.at("codec");
    // A window that moves keeps its picture until its new parts come.
    const auto old = std::exchange(picture_, codec::Picture(format));
    const bool same_size = format == std::exchange(format_, format);
    background_ = background;
    parts_ = std::move(parts);
    ended_.clear();
    clear(whole);
    if (!same_size) return {};
    for (const auto& part : parts_) {
        auto view = old.view();
        view.pixels = view.row(static_cast<std::uint32_t>(part.at.y)) + std::ptrdiff_t{4} * part.at.x;
        if (part.expected) paint(part.at, view);
    }
    return {};
}

Result<void> PictureBuilder::take_part(const json& text, Part& part) {
    if (text.contains("ended")) {
        part.expected = part.shown = false;
        part.decoder.reset();
        clear(part.at);
        return {};
    }
    const auto header = net::from_base64(text.at("header").get<std::string>());
    auto decoder = codec::make_decoder(
        codec_, {static_cast<std::uint32_t>(part.at.width), static_cast<std::uint32_t>(part.at.height), kLayout, false},
        header);
    if (!decoder) return tl::unexpected(decoder.error());
    part.expected = true;
    part.decoder = std::move(*decoder);
    return {};
}

Result<void> PictureBuilder::take_frame(std::string_view frame) {
    if (frame.size() < kFrameHead)
        return fail("a frame of " + std::to_string(frame.size()) + " bytes: expected at least " +
                    std::to_string(kFrameHead));
    const auto number = read_u32(frame.data() + 4);
    if (number >= parts_.size() || !parts_[number].decoder) return fail("a frame of a part that was not announced");
    Part& part = parts_[number];
    const auto decoded = part.decoder->decode(std::as_bytes(std::span(frame.substr(kFrameHead))));
    if (!decoded) return fail("tile " + part.tile + ": " + decoded.error().message);
    paint(part.at, *decoded);
    part.shown = true;
    return {};
}

bool PictureBuilder::complete() const {
    return format_.width > 0 && ended_.empty() &&
           std::ranges::all_of(parts_, [](const Part& part) { return part.shown || !part.expected; });
}

void PictureBuilder::paint(const geom::Rect& at, const codec::FrameView& frame) {
    for (std::int32_t y = 0; y < at.height; ++y)
        std::memcpy(pixel(picture_, at.x, at.y + y), frame.row(static_cast<std::uint32_t>(y)),
                    std::size_t{4} * static_cast<std::size_t>(at.width));
}

void PictureBuilder::clear(const geom::Rect& at) {
    const std::array<std::uint8_t, 4> color{static_cast<std::uint8_t>(background_ >> 16),
                                            static_cast<std::uint8_t>(background_ >> 8),
                                            static_cast<std::uint8_t>(background_), 255};
    for (std::int32_t y = at.y; y < at.bottom(); ++y)
        for (std::int32_t x = at.x; x < at.right(); ++x) std::memcpy(pixel(picture_, x, y), color.data(), 4);
}

}  // namespace wall::view
