// SPDX-License-Identifier: MIT
// Drawing commands other than vertices. Render thread.
#include <algorithm>
#include <cmath>

#include "common/glapi/image.h"
#include "tileserver/render/accum.h"
#include "tileserver/render/executor.h"

namespace wall::tileserver {
namespace {

constexpr std::int64_t kMaxScaledBitmap = std::int64_t{1} << 28;  // pixels
constexpr std::int32_t kMaxEvalSteps = 1 << 16;                   // of a mesh, in each direction

/// A bitmap in which every pixel is repeated: glBitmap knows no zoom. Nearest, anchored at the bottom left.
std::vector<GLubyte> scale_bitmap(std::span<const std::byte> bits, std::int32_t width, std::int32_t height,
                                  std::int32_t new_width, std::int32_t new_height) {
    const std::size_t row = (static_cast<std::size_t>(width) + 7) / 8,
                      new_row = (static_cast<std::size_t>(new_width) + 7) / 8;
    std::vector<GLubyte> out(new_row * static_cast<std::size_t>(new_height));
    for (std::int32_t y = 0; y < new_height; ++y) {
        const std::byte* from = bits.data() + row * static_cast<std::size_t>(std::int64_t{y} * height / new_height);
        for (std::int32_t x = 0; x < new_width; ++x) {
            const auto source = static_cast<std::size_t>(std::int64_t{x} * width / new_width);
            if ((std::to_integer<unsigned>(from[source / 8]) >> (7 - source % 8) & 1) != 0)
                out[new_row * static_cast<std::size_t>(y) + static_cast<std::size_t>(x) / 8] |=
                    static_cast<GLubyte>(0x80u >> (x % 8));
        }
    }
    return out;
}

}  // namespace

void Executor::Material(GLenum face, GLenum pname, float p0, float p1, float p2, float p3) {
    const glstate::Vec4 value = {p0, p1, p2, p3};
    if (pname == GL_SHININESS && !(p0 >= 0 && p0 <= 128)) return refuse("shininess is not within 0 and 128");
    if (!trail_.material(face, pname, value)) return refuse("no such face or parameter");
    if (draws_) gl_.Materialfv(face, pname, value.data());
}

void Executor::EvalMesh1(GLenum mode, std::int32_t i1, std::int32_t i2) {
    if (!outside_begin()) return;
    if (std::int64_t{i2} - i1 > kMaxEvalSteps) return refuse("mesh is too fine");
    if (draws_) gl_.EvalMesh1(mode, i1, i2);
}
void Executor::EvalMesh2(GLenum mode, std::int32_t i1, std::int32_t i2, std::int32_t j1, std::int32_t j2) {
    if (!outside_begin()) return;
    const std::int64_t across = std::int64_t{i2} - i1, along = std::int64_t{j2} - j1;
    if (across > kMaxEvalSteps || along > kMaxEvalSteps ||
        (across > 0 && along > 0 && across * along > std::int64_t{kMaxEvalSteps} * 64))
        return refuse("mesh is too fine");
    if (draws_) gl_.EvalMesh2(mode, i1, i2, j1, j2);
}

void Executor::Clear(std::uint32_t mask) {
    if (!outside_begin()) return;
    constexpr GLbitfield kBuffers = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    if ((mask & ~(kBuffers | GL_ACCUM_BUFFER_BIT)) != 0) return refuse("no such buffer");
    if (!draws_) return;
    if ((mask & kBuffers) != 0) gl_.Clear(mask & kBuffers);
    if ((mask & GL_ACCUM_BUFFER_BIT) != 0 && draw_surface_->format().accum)
        clear_accum(*layer_, accum_area(*layer_, context_->state), glstate::el::clear_accum::ref(context_->state));
}

void Executor::Accum(GLenum op, float value) {
    if (!outside_begin()) return;
    if (op < GL_ACCUM || op > GL_ADD) return refuse("no such operation");
    if (draws_ && draw_surface_->format().accum) accumulate(node_.driver, *layer_, context_->state, op, value);
}

// ---- images at the raster position ----

/// Calls `draw` with the driver's raster position at the soft context's, and its colour the raster colour.
template <class Draw>
void Executor::at_raster_position(Draw&& draw) {
    namespace el = glstate::el;
    const glstate::State& state = context_->state;
    if (el::raster_position_valid::ref(state) == 0 || !std::isfinite(raster_[0]) || !std::isfinite(raster_[1]) ||
        !std::isfinite(raster_[2]))
        return;
    Driver& driver = node_.driver;
    trail_.fold_into(driver.mirror);
    // glWindowPos takes the current colour for the raster colour, and maps z through the depth range.
    const bool tracking = driver.mirror.material.color_material_enabled != 0;
    if (tracking) gl_.Disable(GL_COLOR_MATERIAL);
    const auto& color = el::raster_color::ref(state);
    const auto& secondary = el::raster_secondary_color::ref(state);
    gl_.Color4f(color[0], color[1], color[2], color[3]);
    gl_.SecondaryColor3f(secondary[0], secondary[1], secondary[2]);
    const auto& depth = el::depth_range::ref(state);
    const double range = depth.far_value - depth.near_value;
    const auto at = layer_point(layer_->geometry(), raster_[0], raster_[1]);
    gl_.WindowPos3f(static_cast<float>(at.x), static_cast<float>(at.y),
                    range == 0 ? 0.0f : static_cast<float>((raster_[2] - depth.near_value) / range));
    draw();
    const auto& now = driver.mirror.current;
    gl_.Color4f(now.color[0], now.color[1], now.color[2], now.color[3]);
    gl_.SecondaryColor3f(now.secondary_color[0], now.secondary_color[1], now.secondary_color[2]);
    if (tracking) gl_.Enable(GL_COLOR_MATERIAL);
}

void Executor::DrawPixels(std::int32_t width, std::int32_t height, GLenum format, GLenum type,
                          std::span<const std::byte> pixels) {
    if (!outside_begin() || !check_image(format, type, width, height, 1, pixels)) return;
    if (!draws_ || width == 0 || height == 0) return;
    node_.maps.sync_pixel_maps(gl_, context_->maps);
    at_raster_position([&] { gl_.DrawPixels(width, height, format, type, pixels.data()); });
}

void Executor::Bitmap(std::int32_t width, std::int32_t height, float xorig, float yorig, float xmove, float ymove,
                      std::span<const std::byte> bits) {
    if (!outside_begin()) return;
    if (width < 0 || height < 0 || width > (1 << 16) || height > (1 << 16)) return refuse("absurd size");
    if (bits.size() != (static_cast<std::size_t>(width) + 7) / 8 * static_cast<std::size_t>(height))
        return refuse("size does not fit the bits");
    if (draws_ && width != 0 && height != 0) {
        node_.driver.hold_bitmap();
        const LayerGeometry& g = layer_->geometry();
        at_raster_position([&] {
            if (!g.scaled())
                return gl_.Bitmap(width, height, xorig, yorig, 0, 0, reinterpret_cast<const GLubyte*>(bits.data()));
            const auto new_width = std::max(1, static_cast<std::int32_t>(std::lround(width * g.scale_x())));
            const auto new_height = std::max(1, static_cast<std::int32_t>(std::lround(height * g.scale_y())));
            if (std::int64_t{new_width} * new_height > kMaxScaledBitmap) return;
            const auto scaled = scale_bitmap(bits, width, height, new_width, new_height);
            gl_.Bitmap(new_width, new_height, static_cast<float>(xorig * g.scale_x()),
                       static_cast<float>(yorig * g.scale_y()), 0, 0, scaled.data());
        });
    }
    if (glstate::el::raster_position_valid::ref(context_->state) == 0) return;
    raster_[0] += xmove;
    raster_[1] += ymove;
}

// ---- selection and feedback ----

void Executor::InitNames() {
    if (outside_begin() && draws_) modes_.init_names();
}
void Executor::LoadName(std::uint32_t name) {
    if (outside_begin() && draws_) modes_.load_name(name);
}
void Executor::PushName(std::uint32_t name) {
    if (outside_begin() && draws_) modes_.push_name(name);
}
void Executor::PopName() {
    if (outside_begin() && draws_) modes_.pop_name();
}
void Executor::PassThrough(float token) {
    if (outside_begin() && draws_) gl_.PassThrough(token);
}

}  // namespace wall::tileserver
