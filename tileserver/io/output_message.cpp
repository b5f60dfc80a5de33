// SPDX-License-Identifier: MIT
#include "tileserver/io/output_message.h"

#include <algorithm>
#include <cmath>

namespace wall::tileserver {
namespace {

constexpr std::uint32_t kMostBit = 15;
constexpr std::size_t kMostLabel = 1 << 20;  // bytes

using Floats = google::protobuf::RepeatedField<float>;

bool in_range(const Floats& values, float least, float most) {
    return std::ranges::all_of(values, [=](float v) { return v >= least && v <= most; });
}

bool gamma_ok(float gamma) { return gamma > 0 && std::isfinite(gamma); }

bool read_nine(const Floats& told, std::array<float, 9>& out) {
    if (told.size() != static_cast<int>(out.size())) return false;
    std::ranges::copy(told, out.begin());
    return std::ranges::all_of(out, [](float v) { return std::isfinite(v); });
}

Result<geom::Warp> warp_of(const proto::TileOutput::Warp& told) {
    geom::Warp out;
    out.columns = told.columns();
    out.rows = told.rows();
    if (out.columns == 0 && !read_nine(told.homography(), out.homography)) return fail("expected 9 numbers of a warp");
    if (told.points_size() % 2 != 0) return fail("expected pairs of numbers of a warp's points");
    for (int i = 0; out.columns != 0 && i < told.points_size(); i += 2)
        out.points.push_back({told.points(i), told.points(i + 1)});
    if (const char* wrong = geom::wrong_with(out)) return fail(std::string("its warp ") + wrong);
    return out;
}

Result<geom::Blend> blend_of(const proto::TileOutput::Blend& told) {
    geom::Blend out;
    out.ramps = {told.left(), told.right(), told.top(), told.bottom()};
    out.gamma = told.gamma();
    out.black = told.black();
    const auto ramp_ok = [](float pixels) { return pixels >= 0 && std::isfinite(pixels); };
    if (!std::ranges::all_of(out.ramps, ramp_ok) || !gamma_ok(out.gamma) || !(out.black >= 0 && out.black <= 1))
        return fail("its blend is none");
    return out;
}

geom::LightMap::Map map_of(const proto::TileOutput::Map& told) {
    return {told.width(), told.height(), told.channels(), {told.values().begin(), told.values().end()}};
}

Result<geom::ColorCorrection> color_of(const proto::TileOutput::Color& told) {
    geom::ColorCorrection out;
    out.gamma = told.gamma();
    if (!read_nine(told.matrix(), out.matrix) || !gamma_ok(out.gamma)) return fail("its colour matrix is none");
    const std::array<const Floats*, 3> curves{&told.red(), &told.green(), &told.blue()};
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const auto points = static_cast<std::size_t>(curves[i]->size());
        if (points == 1 || points > geom::kMaxCurvePoints || !in_range(*curves[i], 0, 1))
            return fail("its tone curve is none");
        out.curves[i].assign(curves[i]->begin(), curves[i]->end());
    }
    return out;
}

/// Takes what `read` makes of `told`, if it was told.
template <class Told, class Read, class Out>
Result<void> take(bool has, const Told& told, Read read, Out take_it) {
    if (!has) return {};
    auto out = read(told);
    if (!out) return tl::unexpected(out.error());
    take_it(std::move(*out));
    return {};
}

}  // namespace

std::shared_ptr<const TestPattern> pattern_of(const proto::TilePattern& told) {
    using Kind = proto::TilePattern;
    TestPattern out;
    switch (told.kind()) {
        case Kind::GRID: out.kind = TestPattern::Kind::grid; break;
        case Kind::RAMPS: out.kind = TestPattern::Kind::ramps; break;
        case Kind::NAMES: out.kind = TestPattern::Kind::names; break;
        case Kind::WHITE: out.kind = TestPattern::Kind::white; break;
        case Kind::BLACK: out.kind = TestPattern::Kind::black; break;
        case Kind::CODE: out.kind = TestPattern::Kind::code; break;
        default: return nullptr;
    }
    out.on_output = told.on_output();
    out.bit = std::min(told.bit(), kMostBit);
    out.rows = told.rows();
    out.inverted = told.inverted();
    if (std::uint64_t{told.label_width()} * told.label_height() == told.label().size() &&
        told.label().size() <= kMostLabel)
        out.label = {static_cast<std::int32_t>(told.label_width()), static_cast<std::int32_t>(told.label_height()),
                     told.label()};
    return std::make_shared<const TestPattern>(std::move(out));
}

Result<std::shared_ptr<const geom::TileOutput>> output_of(const proto::TileOutput& told) {
    constexpr auto kMost = static_cast<std::uint32_t>(geom::kMaxOutputExtent);
    if (told.rotation() % 90 != 0 || told.rotation() >= 360) return fail("its rotation is none");
    if (told.width() == 0 || told.height() == 0 || told.width() > kMost || told.height() > kMost)
        return fail("it has " + std::to_string(told.width()) + " x " + std::to_string(told.height()) + " pixels");
    geom::TileOutput out;
    out.rotation = told.rotation();
    out.width = static_cast<std::int32_t>(told.width());
    out.height = static_cast<std::int32_t>(told.height());
    const auto warp = take(told.has_warp(), told.warp(), warp_of,
                           [&](geom::Warp read) { out.warp = std::make_shared<const geom::Warp>(std::move(read)); });
    if (!warp) return tl::unexpected(warp.error());
    const auto blend =
        take(told.has_blend(), told.blend(), blend_of, [&](const geom::Blend& read) { out.blend = read; });
    if (!blend) return tl::unexpected(blend.error());
    if (told.has_share() || told.has_lift()) {
        geom::LightMap light{map_of(told.share()), map_of(told.lift())};
        if (const char* wrong = geom::wrong_with(light)) return fail(std::string("its map of light ") + wrong);
        out.light = std::make_shared<const geom::LightMap>(std::move(light));
    }
    const auto color = take(told.has_color(), told.color(), color_of,
                            [&](geom::ColorCorrection read) { out.color = std::move(read); });
    if (!color) return tl::unexpected(color.error());
    if (told.stereo() > static_cast<std::uint32_t>(geom::StereoLayout::anaglyph))
        return fail("it shows two eyes as no output does");
    out.stereo = static_cast<geom::StereoLayout>(told.stereo());
    out.right_slot = told.right_slot();
    return std::make_shared<const geom::TileOutput>(std::move(out));
}

}  // namespace wall::tileserver
