// SPDX-License-Identifier: MIT
#include "tileserver/execute/read_commands.h"

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/glapi/image.h"
#include "common/glstate/draw_buffers.h"
#include "tileserver/driver/window_stand_in.h"
#include "tileserver/session/limits.h"
#include "tileserver/session/soft_switch.h"

namespace wall::tileserver {
namespace {

/// The buffers that pixels of a format are read from.
GLbitfield buffers_of(GLenum format) {
    switch (format) {
        case GL_DEPTH_COMPONENT: return GL_DEPTH_BUFFER_BIT;
        case GL_STENCIL_INDEX: return GL_STENCIL_BUFFER_BIT;
        case GL_DEPTH_STENCIL: return GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
        default: return GL_COLOR_BUFFER_BIT;
    }
}

/// What copies of parts of layers are made with, and must not outlive.
struct Copies {
    Driver& driver;
    LayerFormat format;
    GLbitfield buffers;
    PixelBudget budget;

    /// `buffers` of the part in pixels of that size, bound.
    std::unique_ptr<Layer> copy(const Layer& layer, const WindowValues::IntBox& from, std::int32_t width,
                                std::int32_t height);
};

std::unique_ptr<Layer> Copies::copy(const Layer& layer, const WindowValues::IntBox& from, std::int32_t width,
                                    std::int32_t height) {
    format.double_buffered = false;
    format.depth = format.depth && (buffers & GL_DEPTH_BUFFER_BIT) != 0;
    format.stencil = format.stencil && (buffers & GL_STENCIL_BUFFER_BIT) != 0;
    format.samples = 0;
    auto made = std::make_unique<Layer>(driver.gl(), driver.flip_y(), plain_geometry(width, height), format, budget);
    made->bind(GL_FRONT, GL_FRONT);
    driver.disable_scissor();
    driver.gl().BlitNamedFramebuffer(layer.framebuffer(), made->framebuffer(), from.x, from.y, from.x + from.width,
                                     from.y + from.height, 0, 0, width, height, buffers, GL_NEAREST);
    return made;
}

/// A part of a layer that cannot be read as it is: at the window's own resolution, and of one sample a pixel. Samples
/// become pixels first, as nothing is scaled meanwhile (OpenGL 4.6, 18.3.1).
std::unique_ptr<Layer> window_copy(Copies& copies, const Layer& layer, const WindowValues::IntBox& window) {
    const auto from = layer_box(layer.geometry(), window);
    if (layer.samples() == 0) return copies.copy(layer, from, window.width, window.height);
    auto pixels = copies.copy(layer, from, from.width, from.height);
    if (!layer.geometry().scaled()) return pixels;
    return copies.copy(*pixels, {0, 0, from.width, from.height}, window.width, window.height);
}

/// The driver's current raster position and what belongs to it, but for its distance, which Mesa leaves as it is where
/// a shader or program is in use.
void read_raster(const Gl& gl, glstate::RasterState& raster) {
    GLboolean valid = GL_FALSE;
    gl.GetBooleanv(GL_CURRENT_RASTER_POSITION_VALID, &valid);
    raster.raster_position_valid = valid;
    if (valid == GL_FALSE) return;
    gl.GetFloatv(GL_CURRENT_RASTER_POSITION, raster.raster_position.data());
    gl.GetFloatv(GL_CURRENT_RASTER_COLOR, raster.raster_color.data());
    gl.GetFloatv(GL_CURRENT_RASTER_SECONDARY_COLOR, raster.raster_secondary_color.data());
    for (unsigned unit = 0; unit < raster.raster_texcoord.size(); ++unit) {
        gl.ActiveTexture(GL_TEXTURE0 + unit);
        gl.GetFloatv(GL_CURRENT_RASTER_TEXTURE_COORDS, raster.raster_texcoord[unit].data());
    }
    gl.ActiveTexture(GL_TEXTURE0);
}

}  // namespace

void ReadCommands::ReadPixels(RequestId request, std::uint32_t slot, std::int32_t x, std::int32_t y, std::int32_t width,
                              std::int32_t height, GLenum format, GLenum type) {
    constexpr std::int32_t kMost = wire::kMaxSurfaceExtent;
    if (slot >= wire::kMaxTilesPerNode || width < 0 || height < 0 || width > kMost || height > kMost)
        return execution_.refuse("no such slot or size");
    if (x < -kMost || x > kMost || y < -kMost || y > kMost) return execution_.refuse("far outside the window");
    const auto bytes = glapi::image_bytes(format, type, width, height, 1);
    if (!bytes || *bytes > wire::kMaxFramePayload - 8) return execution_.refuse("no such format or type, or too large");
    std::vector<std::byte> answer(*bytes);
    const Timed timed(execution_.session.work.render);
    if (const ClientName framebuffer = execution_.context->read_framebuffer) {
        read_framebuffer(framebuffer, {x, y, width, height}, format, type, answer);
        return execution_.output.reply(request, std::move(answer));
    }
    SurfaceReplica* surface = execution_.session.surface(execution_.context->read);
    const geom::Eye eye = glstate::eye_of(glstate::el::read_buffer::ref(execution_.context->state));
    Layer* layer = surface != nullptr ? surface->layer(slot, eye) : nullptr;
    if (layer != nullptr && layer->complete() && !answer.empty()) {
        Driver& driver = execution_.node.driver;
        driver.sync_pixel_transfer(execution_.context->state);
        execution_.node.maps.sync_pixel_maps(execution_.gl, execution_.context->maps);
        driver.forget_target();
        driver.bind_target(*layer, execution_.context->state);
        if (layer->geometry().scaled() || layer->samples() != 0) {
            Copies copies{driver, surface->format().layer, buffers_of(format)};
            const auto copy = window_copy(copies, *layer, {x, y, width, height});
            execution_.gl.ReadPixels(0, 0, width, height, format, type, answer.data());
            driver.forget_target();
        } else {
            const auto at = layer_point(layer->geometry(), x, y);
            execution_.gl.ReadPixels(static_cast<GLint>(at.x), static_cast<GLint>(at.y), width, height, format, type,
                                     answer.data());
        }
    }
    execution_.output.reply(request, std::move(answer));
}

void ReadCommands::read_framebuffer(ClientName name, const WindowValues::IntBox& box, GLenum format, GLenum type,
                                    std::span<std::byte> answer) {
    Driver& driver = execution_.node.driver;
    Framebuffer* framebuffer = execution_.updated(execution_.session.objects.find<Framebuffer>(name));
    if (framebuffer == nullptr || answer.empty()) return;
    driver.sync_pixel_transfer(execution_.context->state);
    execution_.node.maps.sync_pixel_maps(execution_.gl, execution_.context->maps);
    driver.forget_target();
    driver.bind_target(*framebuffer, execution_.context->state);
    execution_.gl.ReadPixels(box.x, box.y, box.width, box.height, format, type, answer.data());
    driver.forget_target();
}

// The driver says it of a framebuffer that has so many.
void ReadCommands::SamplePosition(RequestId request, std::uint32_t samples, std::uint32_t index,
                                  std::uint32_t of_window) {
    constexpr std::uint32_t kMostSamples = 64;
    if (samples < 1 || samples > kMostSamples || index >= samples) return execution_.refuse("no such sample");
    const Gl& gl = execution_.gl;
    GLuint framebuffer = 0, texture = 0;
    gl.CreateFramebuffers(1, &framebuffer);
    gl.CreateTextures(gl_target(TextureTarget::t2d_multisample), 1, &texture);
    gl.TextureStorage2DMultisample(texture, static_cast<GLsizei>(samples), GL_RGBA8, 1, 1, GL_TRUE);
    gl.NamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, texture, 0);
    execution_.node.driver.forget_target();
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    if (of_window != 0 && execution_.node.driver.flip_y())  // as its layers
        gl.FramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_FLIP_Y_MESA, 1);
    std::array<GLfloat, 2> position{};
    gl.GetMultisamplefv(GL_SAMPLE_POSITION, index, position.data());
    gl.DeleteFramebuffers(1, &framebuffer);
    gl.DeleteTextures(1, &texture);
    execution_.node.driver.drain_errors();
    const auto bytes = std::as_bytes(std::span(position));
    execution_.output.reply(request, {bytes.begin(), bytes.end()});
}

// The place and the values that go with it do not depend on pixels, so no layer need be there, and they are the same on
// every node (OpenGL 4.6 compatibility, 14.1.3: the vertex shader or program makes them).
void ReadCommands::RasterPosition(RequestId request, float x, float y, float z, float w) {
    const auto bytes_of = [](const glstate::RasterState& raster) {
        const auto bytes = std::as_bytes(std::span(&raster, 1));
        return std::vector(bytes.begin(), bytes.end());
    };
    glstate::RasterState raster = execution_.context->state.raster;
    raster.raster_position_valid = 0;
    if (!execution_.targets_known) execution_.look_up_targets();
    Framebuffer* const framebuffer = execution_.updated(execution_.draw_framebuffer);
    if (execution_.refused()) return;
    const SurfaceReplica* const surface = execution_.draw_surface;
    if (framebuffer == nullptr && surface == nullptr) return execution_.output.reply(request, bytes_of(raster));
    const Timed timed(execution_.session.work.render);
    std::optional<WindowStandIn> window;
    if (surface != nullptr)
        window.emplace(execution_.node.driver, surface->where().window_width, surface->where().window_height);
    RenderTarget& target = framebuffer != nullptr ? static_cast<RenderTarget&>(*framebuffer) : *window;
    if (!switch_to(execution_.node, execution_.session, *execution_.context, target, {}))
        return execution_.refuse("no such query, or " + too_much("objects"));
    execution_.gl.RasterPos4f(x, y, z, w);
    read_raster(execution_.gl, raster);
    execution_.output.reply(request, bytes_of(raster));
}

void ReadCommands::RenderMode(RequestId request, GLenum mode, GLenum feedback_type, std::uint32_t buffer_entries) {
    if (mode != GL_RENDER && mode != GL_SELECT && mode != GL_FEEDBACK) return execution_.refuse("no such mode");
    if (mode == GL_FEEDBACK && (feedback_type < GL_2D || feedback_type > GL_4D_COLOR_TEXTURE))
        return execution_.refuse("no such feedback type");
    if (buffer_entries > kMaxFeedbackEntries) return execution_.refuse("buffer is too large");
    execution_.output.reply(request, execution_.modes.change(mode, feedback_type, buffer_entries));
}

}  // namespace wall::tileserver
