// SPDX-License-Identifier: MIT
#include "tileserver/execute/read_commands.h"

#include <array>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/glapi/image.h"
#include "tileserver/session/limits.h"

namespace wall::tileserver {
namespace {

/// A copy of a part of a scaled layer at the window's own resolution.
std::unique_ptr<Layer> window_copy(Driver& driver, const Layer& layer, const SurfaceFormat& format,
                                   const WindowValues::IntBox& window, PixelBudget& budget) {
    const geom::Rect size{0, 0, window.width, window.height};
    LayerFormat copy_format = format.layer;
    copy_format.double_buffered = false;
    auto copy = std::make_unique<Layer>(
        driver.gl(), driver.flip_y(),
        LayerGeometry{size, size, static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height)},
        copy_format, budget);
    copy->bind(GL_FRONT, GL_FRONT);
    const auto from = layer_box(layer.geometry(), window);
    driver.disable_scissor();
    const GLbitfield buffers = GL_COLOR_BUFFER_BIT | (copy_format.depth ? GL_DEPTH_BUFFER_BIT : 0u) |
                               (copy_format.stencil ? GL_STENCIL_BUFFER_BIT : 0u);
    driver.gl().BlitNamedFramebuffer(layer.framebuffer(), copy->framebuffer(), from.x, from.y, from.x + from.width,
                                     from.y + from.height, 0, 0, size.width, size.height, buffers, GL_NEAREST);
    return copy;
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
    Layer* layer = surface != nullptr ? surface->layer(slot) : nullptr;
    if (layer != nullptr && layer->complete() && !answer.empty()) {
        Driver& driver = execution_.node.driver;
        driver.sync_pixel_transfer(execution_.context->state);
        execution_.node.maps.sync_pixel_maps(execution_.gl, execution_.context->maps);
        driver.forget_target();
        driver.bind_target(*layer, execution_.context->state);
        if (layer->geometry().scaled()) {
            PixelBudget budget;  // gone with the answer
            const auto copy = window_copy(driver, *layer, surface->format(), {x, y, width, height}, budget);
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
void ReadCommands::SamplePosition(RequestId request, std::uint32_t samples, std::uint32_t index) {
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
    std::array<GLfloat, 2> position{};
    gl.GetMultisamplefv(GL_SAMPLE_POSITION, index, position.data());
    gl.DeleteFramebuffers(1, &framebuffer);
    gl.DeleteTextures(1, &texture);
    execution_.node.driver.drain_errors();
    const auto bytes = std::as_bytes(std::span(position));
    execution_.output.reply(request, {bytes.begin(), bytes.end()});
}

void ReadCommands::RenderMode(RequestId request, GLenum mode, GLenum feedback_type, std::uint32_t buffer_entries) {
    if (mode != GL_RENDER && mode != GL_SELECT && mode != GL_FEEDBACK) return execution_.refuse("no such mode");
    if (mode == GL_FEEDBACK && (feedback_type < GL_2D || feedback_type > GL_4D_COLOR_TEXTURE))
        return execution_.refuse("no such feedback type");
    if (buffer_entries > kMaxFeedbackEntries) return execution_.refuse("buffer is too large");
    execution_.output.reply(request, execution_.modes.change(mode, feedback_type, buffer_entries));
}

}  // namespace wall::tileserver
