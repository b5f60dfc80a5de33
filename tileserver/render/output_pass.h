// SPDX-License-Identifier: MIT
// Makes a tile's picture what its output shows (common/geom/tile_output.h), in one draw. To the driver it is one soft
// context more, which is switched to as to those of programs. Nothing is done for outputs that show the canvas's pixels
// as they are. Render thread.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "common/base/result.h"
#include "common/geom/tile_output.h"
#include "tileserver/driver/driver.h"
#include "tileserver/driver/render_target.h"

namespace wall::tileserver {

/// Pixels of a tile in the driver, 8 bits a channel, top row first.
struct PictureTexture {
    GLuint texture = 0, framebuffer = 0;
    std::int32_t width = 0, height = 0;  ///< pixels
    std::uint64_t version = 0;           ///< another one for another picture, on the wall
};

class OutputPass {
public:
    explicit OutputPass(Driver& driver);
    ~OutputPass();
    OutputPass(const OutputPass&) = delete;

    /// What the output of that slot shows of `canvas`, which is the left eye's where it shows two; good until the next
    /// call for the slot. An error: the driver cannot do it.
    Result<PictureTexture> show(std::uint32_t slot, const std::shared_ptr<const geom::TileOutput>& output,
                                const PictureTexture& canvas, const PictureTexture& of_right_eye = {});
    /// There is no tile in that slot any more.
    void forget(std::uint32_t slot);

private:
    class Shown;
    Result<GLuint> program_for(const std::string& steps);
    Result<GLuint> build(const std::string& steps) const;
    void draw(Shown& shown, GLuint canvas, GLuint of_right_eye);
    GLuint compile(GLenum stage, const std::string& source) const;

    Driver& driver_;
    const Gl& gl_;
    glstate::State state_;                            // as every context begins, but for the viewport and dithering
    GLuint vertex_array_ = 0;                         // of a draw without arrays
    GLuint linear_ = 0, exact_ = 0;                   // samplers
    std::map<std::string, Result<GLuint>> programs_;  // by their steps
    std::map<std::uint32_t, std::unique_ptr<Shown>> shown_;
};

}  // namespace wall::tileserver
