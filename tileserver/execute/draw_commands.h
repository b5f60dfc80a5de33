// SPDX-License-Identifier: MIT
// Group [draw]: what draws in a block, other than vertices. Render thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "tileserver/execute/execution.h"
#include "tileserver/objects/run.h"

namespace wall::tileserver {

struct RasterPlace;  // draw_commands.cpp

class DrawCommands {
public:
    /// Both outlive it.
    DrawCommands(Execution& execution, OpenBlock& block) : execution_(execution), block_(block) {}

    void EvalMesh1(GLenum mode, std::int32_t i1, std::int32_t i2);
    void EvalMesh2(GLenum mode, std::int32_t i1, std::int32_t i2, std::int32_t j1, std::int32_t j2);
    void Clear(std::uint32_t mask);
    void ClearBuffer(GLenum buffer, std::int32_t drawbuffer, GLenum type, std::uint32_t v0, std::uint32_t v1,
                     std::uint32_t v2, std::uint32_t v3);
    void Accum(GLenum op, float value);
    void DrawPixels(std::int32_t width, std::int32_t height, GLenum format, GLenum type,
                    std::span<const std::byte> pixels);
    void Bitmap(std::int32_t width, std::int32_t height, float xorig, float yorig, float xmove, float ymove,
                std::span<const std::byte> bits);
    void WindowContent(std::int32_t x, std::int32_t y, std::int32_t width, std::int32_t height, GLenum format,
                       GLenum type, std::span<const std::byte> pixels);
    void RunCall(ClientName run);
    void InitNames();
    void LoadName(std::uint32_t name);
    void PushName(std::uint32_t name);
    void PopName();
    void PassThrough(float token);

    /// A run is being called: go_on() has parts of it left.
    bool calling() const { return called_ != nullptr; }
    /// To the called run's end, or to where there is no time left.
    void go_on();
    /// What is left of it is not called.
    void stop() { called_.reset(); }

private:
    bool outside_begin();
    bool has_accum() const { return block_.layer != nullptr && execution_.draw_surface->format().accum; }
    /// From `next_` on. True: to the last one.
    bool call_parts(const RunContent& run);
    template <class Draw>
    void at_raster_position(Draw&& draw);
    void draw_scaled_content(const geom::Rect& area, GLenum format, GLenum type, std::span<const std::byte> pixels);
    void spread_stencil_of_image(const RasterPlace& place, std::int32_t width, std::int32_t height);

    Execution& execution_;
    OpenBlock& block_;
    std::shared_ptr<const RunContent> called_;  // null unless something of it is left
    std::size_t next_ = 0;                      // of its parts
};

}  // namespace wall::tileserver
