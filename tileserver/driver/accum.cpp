// SPDX-License-Identifier: MIT
#include "tileserver/driver/accum.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/glstate/draw_buffers.h"

namespace wall::tileserver {
namespace {

using Box = WindowValues::IntBox;

/// What x86 makes of a float that is cast to a short, defined for all values.
std::int16_t to_short(float v) {
    return std::abs(v) < 2147483648.0f ? static_cast<std::int16_t>(static_cast<std::int32_t>(v)) : std::int16_t{0};
}

/// Calls `row(accum components, index of the row within the area)`.
template <class Row>
void for_each_row(Layer& layer, const Box& area, Row&& row) {
    if (layer.accum.empty())
        layer.accum.resize(std::size_t{4} * static_cast<std::size_t>(layer.width()) *
                           static_cast<std::size_t>(layer.height()));
    for (std::int32_t y = 0; y < area.height; ++y) {
        const auto first = (static_cast<std::size_t>(area.y + y) * static_cast<std::size_t>(layer.width()) +
                            static_cast<std::size_t>(area.x)) *
                           4;
        row(layer.accum.data() + first, static_cast<std::size_t>(y));
    }
}

std::vector<std::uint8_t> read_color(const Gl& gl, const Box& area) {
    std::vector<std::uint8_t> pixels(std::size_t{4} * static_cast<std::size_t>(area.width) *
                                     static_cast<std::size_t>(area.height));
    gl.ReadPixels(area.x, area.y, area.width, area.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    return pixels;
}

void add_color(Driver& driver, Layer& layer, const Box& area, float value, bool load) {
    const float scale = value * 32767.0f;
    driver.neutral_pixel_transfer();
    const auto pixels = read_color(driver.gl(), area);
    const std::size_t row_bytes = static_cast<std::size_t>(area.width) * 4;
    for_each_row(layer, area, [&](std::int16_t* accum, std::size_t y) {
        const std::uint8_t* color = pixels.data() + y * row_bytes;
        for (std::size_t i = 0; i < row_bytes; ++i) {
            const std::int16_t more = to_short(static_cast<float>(color[i]) * (1.0f / 255.0f) * scale);
            accum[i] = load ? more : static_cast<std::int16_t>(accum[i] + more);
        }
    });
}

/// Writes the area through a texture copy, not through drawing: no state of the context takes part but the colour mask.
void return_color(Driver& driver, Layer& layer, const Box& area, const glstate::State& state, float value) {
    const float scale = value / 32767.0f;
    const std::size_t row_bytes = static_cast<std::size_t>(area.width) * 4;
    const std::array<bool, 4> writes = glstate::written_channels(state, 0);
    const std::array<bool, 4> keep = {!writes[0], !writes[1], !writes[2], !writes[3]};
    for (const GLuint texture : layer.draw_textures()) {
        std::vector<std::uint8_t> pixels(row_bytes * static_cast<std::size_t>(area.height));
        if (keep[0] || keep[1] || keep[2] || keep[3])
            layer.read_texture(texture, {area.x, area.y, area.width, area.height}, pixels);
        for_each_row(layer, area, [&](const std::int16_t* accum, std::size_t y) {
            std::uint8_t* color = pixels.data() + y * row_bytes;
            for (std::size_t i = 0; i < row_bytes; ++i)
                if (!keep[i % 4])
                    color[i] = static_cast<std::uint8_t>(
                        std::lrintf(std::clamp(static_cast<float>(accum[i]) * scale, 0.0f, 1.0f) * 255.0f));
        });
        driver.neutral_pixel_transfer();
        layer.write_texture(texture, {area.x, area.y, area.width, area.height}, pixels);
    }
}

template <class Change>
void change_all(Layer& layer, const Box& area, Change&& change) {
    const std::size_t components = static_cast<std::size_t>(area.width) * 4;
    for_each_row(layer, area, [&](std::int16_t* accum, std::size_t) {
        for (std::size_t i = 0; i < components; ++i) accum[i] = change(accum[i]);
    });
}

}  // namespace

Box accum_area(const Layer& layer, const glstate::State& state) {
    const geom::Rect all{0, 0, layer.width(), layer.height()};
    if ((glstate::el::scissor_enabled::ref(state) & 1) == 0) return {0, 0, all.width, all.height};
    const WindowValues::IntBox box = window_values(layer.geometry(), state).scissors.front();
    const auto cut = geom::intersect(all, {box.x, box.y, box.width, box.height});
    return {cut.x, cut.y, cut.width, cut.height};
}

void clear_accum(Layer& layer, const Box& area, const glstate::Vec4& value) {
    std::array<std::int16_t, 4> cleared{};
    for (std::size_t i = 0; i < 4; ++i) {
        const float sane = std::isnan(value[i]) ? 0.0f : std::clamp(value[i], -1.0f, 1.0f);
        cleared[i] = static_cast<std::int16_t>((static_cast<int>(65535.0f * sane) - 1) / 2);
    }
    for_each_row(layer, area, [&](std::int16_t* accum, std::size_t) {
        for (std::size_t i = 0; i < static_cast<std::size_t>(area.width) * 4; ++i) accum[i] = cleared[i % 4];
    });
}

void accumulate(Driver& driver, Layer& layer, const glstate::State& state, GLenum op, float value) {
    const Box area = accum_area(layer, state);
    if (area.width <= 0 || area.height <= 0 || !std::isfinite(value)) return;
    if (op == GL_LOAD || (op == GL_ACCUM && value != 0)) add_color(driver, layer, area, value, op == GL_LOAD);
    if (op == GL_RETURN) return_color(driver, layer, area, state, value);
    const std::int16_t increment = to_short(value * 32767.0f);
    if (op == GL_ADD && value != 0)
        change_all(layer, area, [&](std::int16_t a) { return static_cast<std::int16_t>(a + increment); });
    if (op == GL_MULT && value != 1)
        change_all(layer, area, [&](std::int16_t a) { return to_short(static_cast<float>(a) * value); });
}

}  // namespace wall::tileserver
