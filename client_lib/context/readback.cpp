// SPDX-License-Identifier: MIT
#include "client_lib/context/readback.h"

#include <algorithm>

#include "client_lib/context/ask_one.h"
#include "client_lib/context/copied_parts.h"
#include "common/glapi/image.h"

namespace wall::client {
namespace {

/// Of one answer; more is asked for in several, all at once.
constexpr std::size_t kMostAnswerBytes = std::size_t{64} << 20;

PixelBox common_part(const PixelBox& a, const geom::Rect& b) {
    const geom::Rect both = geom::intersect({a.x, a.y, a.width, a.height}, b);
    return {both.x, both.y, both.width, both.height};
}

/// While it lives the context's pixel transfer is neutral.
class NeutralTransfer {
public:
    explicit NeutralTransfer(Context& c) : state_(c.state), saved_(c.state.pixel_transfer), id_(state_.ids[kCategory]) {
        state_.pixel_transfer = {};
        state_.ids.take(kCategory, glstate::State{}.ids[kCategory]);
    }
    ~NeutralTransfer() {
        state_.pixel_transfer = saved_;
        state_.ids.take(kCategory, id_);
    }
    NeutralTransfer(const NeutralTransfer&) = delete;

private:
    static constexpr auto kCategory = static_cast<std::size_t>(glstate::Category::pixel_transfer);
    glstate::State& state_;
    glstate::PixelTransferState saved_;
    std::uint64_t id_;
};

/// Rows of a box that one answer may have.
std::int32_t most_rows(const glapi::PixelLayout& layout, std::int32_t width) {
    const std::size_t row = std::max<std::size_t>(1, glapi::row_bytes(layout, width));
    return static_cast<std::int32_t>(std::max<std::size_t>(1, kMostAnswerBytes / row));
}

/// Of a framebuffer object, which every node holds.
void gather_from_one(Context& c, const PixelBox& box, GLenum format, GLenum type, const char* function,
                     std::vector<std::byte>& pixels) {
    const auto layout = *glapi::pixel_layout(format, type);
    const std::int32_t rows = most_rows(layout, box.width);
    for (std::int32_t y = 0; y < box.height; y += rows) {
        const std::int32_t height = std::min(rows, box.height - y);
        const auto answer = ask_one_node(c, function, [&](wire::PackBuffer& buffer, RequestId request) {
            glapi::pack::ReadPixels(buffer, request, 0, box.x, box.y + y, box.width, height, format, type);
        });
        if (!answer || answer->bytes.size() != glapi::row_bytes(layout, box.width) * static_cast<std::size_t>(height))
            continue;
        glapi::copy_rect(layout, {pixels.data(), box.width, box.height}, 0, y, answer->bytes.data(), box.width,
                         box.width, height);
    }
}

}  // namespace

PixelBox clip_to_window(const Context& c, const PixelBox& box) {
    const DrawTarget target = c.read_target();
    if (!target) return {};
    const auto [width, height] = target.size();
    return common_part(box, {0, 0, static_cast<std::int32_t>(width), static_cast<std::int32_t>(height)});
}

std::vector<std::byte> gather_pixels(Context& c, const PixelBox& box, GLenum format, GLenum type,
                                     const char* function) {
    std::vector<std::byte> pixels(glapi::image_bytes(format, type, box.width, box.height, 1).value_or(0));
    const DrawTarget target = c.read_target();
    const auto layout = glapi::pixel_layout(format, type);
    if (!target || pixels.empty() || !layout) return pixels;
    c.flush_block();
    c.session().hidden_parts([&](HiddenParts& parts) {
        parts.before_reading(target, {box.x, box.y, box.width, box.height});
    });
    if (target.of_objects()) {
        want_whole_images(c);
        gather_from_one(c, box, format, type, function, pixels);
        return pixels;
    }
    std::vector<TargetLayer> layers;  // one for each of the parts
    std::vector<PixelBox> parts;
    for (const TargetLayer& layer : target.layers()) {
        if (layer.view != 0 || !c.session().may_be_read(layer)) continue;  // it shows something else, or tells nothing
        const PixelBox part = common_part(box, layer.pixels);
        if (part.empty()) continue;
        const std::int32_t rows = most_rows(*layout, part.width);
        for (std::int32_t y = 0; y < part.height; y += rows) {
            layers.push_back(layer);
            parts.push_back({part.x, part.y + y, part.width, std::min(rows, part.height - y)});
        }
        if (target.alike()) break;
    }
    const auto answers = c.session().ask_all(c.draw_source(), layers, function,
                                             [&](wire::PackBuffer& buffer, RequestId request, std::size_t i) {
                                                 const PixelBox& part = parts[i];
                                                 glapi::pack::ReadPixels(buffer, request, layers[i].slot, part.x,
                                                                         part.y, part.width, part.height, format, type);
                                             });
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const PixelBox& part = parts[i];
        const std::size_t bytes = glapi::row_bytes(*layout, part.width) * static_cast<std::size_t>(part.height);
        if (!answers[i] || answers[i]->size() != bytes) continue;
        glapi::copy_rect(*layout, {pixels.data(), box.width, box.height}, part.x - box.x, part.y - box.y,
                         answers[i]->data(), part.width, part.width, part.height);
    }
    return pixels;
}

std::vector<std::byte> gather_plain(Context& c, const PixelBox& box, GLenum format, GLenum type, const char* function) {
    const NeutralTransfer neutral(c);
    const PixelBox inside = clip_to_window(c, box);
    auto pixels = gather_pixels(c, inside, format, type, function);
    if (inside.width == box.width && inside.height == box.height) return pixels;
    std::vector<std::byte> all(glapi::image_bytes(format, type, box.width, box.height, 1).value_or(0));
    if (inside.empty() || all.empty()) return all;
    glapi::copy_rect(*glapi::pixel_layout(format, type), {all.data(), box.width, box.height}, inside.x - box.x,
                     inside.y - box.y, pixels.data(), inside.width, inside.width, inside.height);
    return all;
}

}  // namespace wall::client
