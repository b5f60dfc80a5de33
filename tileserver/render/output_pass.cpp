// SPDX-License-Identifier: MIT
#include "tileserver/render/output_pass.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tileserver/render/output_shader.h"

namespace wall::tileserver {
namespace {

enum Unit : unsigned { kCanvas, kMesh, kCurves, kShare, kRaise, kRightCanvas, kUnits };  // as in the shader
constexpr unsigned kParameters = 0;
constexpr float kLittle = 0.25f;  // of a pixel that is covered besides: a tap is linear, so none is missed

/// Each eye has half of the output.
bool is_halved(geom::StereoLayout stereo) {
    return stereo == geom::StereoLayout::side_by_side || stereo == geom::StereoLayout::over_under;
}

/// Pixel for pixel, maybe turned.
bool is_exact(const geom::TileOutput& output, const PictureTexture& canvas) {
    const bool sideways = geom::is_sideways(output.rotation);
    return !output.warp && !is_halved(output.stereo) && output.width == (sideways ? canvas.height : canvas.width) &&
           output.height == (sideways ? canvas.width : canvas.height);
}

/// No pixel of it covers more of the canvas than one tap takes in, as far as a grid of places tells. (Most projectors'
/// warps are so. A driver in software is four times faster then: it need not count taps.)
bool is_enlarged(const geom::TileOutput& output, const PictureTexture& canvas) {
    constexpr int kPlaces = 128;  // a side
    auto width = static_cast<float>(output.width), height = static_cast<float>(output.height);
    if (output.stereo == geom::StereoLayout::side_by_side) width /= 2;
    if (output.stereo == geom::StereoLayout::over_under) height /= 2;
    const auto covered = [&](geom::Point from, geom::Point to) {
        const auto a = geom::place_in_tile(output, from), b = geom::place_in_tile(output, to);
        return std::max(std::abs(b.x - a.x) * static_cast<float>(canvas.width),
                        std::abs(b.y - a.y) * static_cast<float>(canvas.height));
    };
    for (int row = 0; row <= kPlaces; ++row) {
        for (int column = 0; column <= kPlaces; ++column) {
            const geom::Point at{static_cast<float>(column) / kPlaces, static_cast<float>(row) / kPlaces};
            if (covered(at, {at.x + 1 / width, at.y}) > 1 + kLittle ||
                covered(at, {at.x, at.y + 1 / height}) > 1 + kLittle)
                return false;
        }
    }
    return true;
}

bool has_curves(const geom::TileOutput& output) {
    return output.color && !std::ranges::all_of(output.color->curves, [](const auto& curve) { return curve.empty(); });
}

/// The shader's #defines.
std::string steps_of(const geom::TileOutput& output, const PictureTexture& canvas) {
    std::string out =
        "#define LITTLE " + std::to_string(kLittle) + "\n#define TURNS " + std::to_string(output.rotation / 90) + "\n";
    const auto add = [&](bool wanted, const char* step) {
        if (wanted) out += std::string("#define ") + step + "\n";
    };
    add(is_exact(output, canvas), "EXACT");
    add(is_enlarged(output, canvas), "ENLARGED");
    add(output.warp && output.warp->columns != 0, "MESH");
    add(output.warp && output.warp->columns == 0, "HOMOGRAPHY");
    add(output.color && (output.color->matrix != geom::ColorCorrection{}.matrix), "COLOR");
    add(output.blend.has_value(), "BLEND");
    add(output.blend && output.blend->black != 0, "LIFT");
    const auto add_light = [&](const geom::LightMap::Map& map, const std::string& step) {
        const bool exact = static_cast<std::int32_t>(map.width) == output.width &&
                           static_cast<std::int32_t>(map.height) == output.height;
        out += "#define " + step + (map.width == 0 ? " 0\n" : exact ? " 2\n" : " 1\n");
    };
    const geom::LightMap none, &light = output.light ? *output.light : none;
    add_light(light.share, "SHARE");
    add_light(light.lift, "RAISE");
    add(has_curves(output), "CURVE");
    add(output.stereo != geom::StereoLayout::none, "STEREO");
    switch (output.stereo) {
        case geom::StereoLayout::side_by_side: add(true, "SIDES"); break;
        case geom::StereoLayout::over_under: add(true, "HALVES"); break;
        case geom::StereoLayout::rows: add(true, "ROWS"); break;
        case geom::StereoLayout::anaglyph: add(true, "ANAGLYPH"); break;
        case geom::StereoLayout::none: break;
    }
    return out;
}

template <std::size_t n>
void copy_rows(const std::array<float, 9>& rows, std::array<float, n>& out) {
    for (std::size_t i = 0; i < rows.size(); ++i) out[i / 3 * 4 + i % 3] = rows[i];
}

OutputParameters parameters_of(const geom::TileOutput& output, const PictureTexture& canvas) {
    OutputParameters out;
    out.sizes = {canvas.width, canvas.height, output.width, output.height};
    if (output.warp) copy_rows(output.warp->homography, out.homography);
    if (output.blend) {
        out.ramps = output.blend->ramps;
        out.blend = {output.blend->gamma, output.blend->black, 0, 0};
    }
    if (output.color) {
        copy_rows(output.color->matrix, out.color);
        out.color[3] = output.color->gamma;
        for (std::size_t i = 0; i < output.color->curves.size(); ++i)
            out.curves[i] = static_cast<std::int32_t>(output.color->curves[i].size());
    }
    return out;
}

}  // namespace

/// Of one slot: the picture, and what it is made with.
class OutputPass::Shown final : public RenderTarget {
public:
    Shown(Driver& driver, std::shared_ptr<const geom::TileOutput> what, const PictureTexture& of_canvas)
        : output(std::move(what)),
          canvas(of_canvas),
          exact(is_exact(*output, canvas)),
          steps(steps_of(*output, canvas)),
          driver_(driver) {
        const Gl& gl = driver_.gl();
        geometry_ = plain_geometry(output->width, output->height);
        complete_ = true;
        texture = make_texture(GL_RGBA8, output->width, output->height);
        gl.CreateFramebuffers(1, &framebuffer_);
        gl.NamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, texture, 0);
        const OutputParameters values = parameters_of(*output, canvas);
        gl.CreateBuffers(1, &parameters);
        gl.NamedBufferStorage(parameters, sizeof values, &values, 0);
        driver_.neutral_pixel_transfer();
        if (output->warp && output->warp->columns != 0) make_mesh(*output->warp);
        if (has_curves(*output)) make_curves(*output->color);
        if (output->light) {
            share = make_light(output->light->share);
            raise = make_light(output->light->lift);
        }
    }
    ~Shown() {
        const Gl& gl = driver_.gl();
        driver_.forget_target();
        gl.DeleteFramebuffers(1, &framebuffer_);
        driver_.forget_buffer(parameters);
        gl.DeleteBuffers(1, &parameters);
        for (const GLuint name : {texture, mesh, curves, share, raise}) {
            if (name == 0) continue;
            driver_.forget_texture(name);
            gl.DeleteTextures(1, &name);
        }
    }
    void bind(GLenum, GLenum) override { driver_.gl().BindFramebuffer(GL_FRAMEBUFFER, framebuffer_); }
    bool draws_colors() const override { return true; }
    bool has_depth() const override { return false; }
    PictureTexture picture() const {
        return {texture, framebuffer_, width(), height(), std::max(canvas.version, right_version)};
    }

    const std::shared_ptr<const geom::TileOutput> output;
    PictureTexture canvas;  // that it is for; its version is the one that is drawn
    std::uint64_t right_version = 0;
    const bool exact;
    const std::string steps;
    GLuint texture = 0, parameters = 0, mesh = 0, curves = 0, share = 0, raise = 0;

private:
    GLuint make_texture(GLenum format, std::int32_t width, std::int32_t height) const {
        GLuint out = 0;
        driver_.gl().CreateTextures(GL_TEXTURE_2D, 1, &out);
        driver_.gl().TextureStorage2D(out, 1, format, width, height);
        return out;
    }
    void make_mesh(const geom::Warp& warp) {
        const auto columns = static_cast<std::int32_t>(warp.columns), rows = static_cast<std::int32_t>(warp.rows);
        mesh = make_texture(GL_RG32F, columns, rows);
        driver_.gl().TextureSubImage2D(mesh, 0, 0, 0, columns, rows, GL_RG, GL_FLOAT, warp.points.data());
    }
    /// 0: there is none.
    GLuint make_light(const geom::LightMap::Map& map) const {
        if (map.width == 0) return 0;
        const auto width = static_cast<std::int32_t>(map.width), height = static_cast<std::int32_t>(map.height);
        const bool grey = map.channels == 1;
        const GLuint out = make_texture(grey ? GL_R8 : GL_RGB8, width, height);
        const Gl& gl = driver_.gl();
        gl.TextureSubImage2D(out, 0, 0, 0, width, height, grey ? GL_RED : GL_RGB, GL_UNSIGNED_BYTE, map.values.data());
        for (const GLenum channel : {GL_TEXTURE_SWIZZLE_G, GL_TEXTURE_SWIZZLE_B})
            if (grey) gl.TextureParameteri(out, channel, GL_RED);
        return out;
    }
    void make_curves(const geom::ColorCorrection& color) {
        std::size_t longest = 0;
        for (const auto& curve : color.curves) longest = std::max(longest, curve.size());
        curves =
            make_texture(GL_R32F, static_cast<std::int32_t>(longest), static_cast<std::int32_t>(color.curves.size()));
        for (std::int32_t row = 0; const auto& curve : color.curves)
            driver_.gl().TextureSubImage2D(curves, 0, 0, row++, static_cast<std::int32_t>(curve.size()), 1, GL_RED,
                                           GL_FLOAT, curve.data());
    }

    Driver& driver_;
};

OutputPass::OutputPass(Driver& driver) : driver_(driver), gl_(driver.gl()) {
    glstate::assign<glstate::el::dither>(state_, 0, 0);
}

OutputPass::~OutputPass() {
    shown_.clear();
    for (const auto& [steps, program] : programs_) {
        if (!program) continue;
        driver_.forget_program(*program);
        gl_.DeleteProgram(*program);
    }
    if (vertex_array_ == 0) return;
    driver_.forget_vertex_array(vertex_array_);
    gl_.DeleteVertexArrays(1, &vertex_array_);
    driver_.delete_sampler(linear_);
    driver_.delete_sampler(exact_);
}

GLuint OutputPass::compile(GLenum stage, const std::string& source) const {
    const GLuint shader = gl_.CreateShader(stage);
    const char* text = source.c_str();
    gl_.ShaderSource(shader, 1, &text, nullptr);
    gl_.CompileShader(shader);
    return shader;
}

Result<GLuint> OutputPass::build(const std::string& steps) const {
    const GLuint program = gl_.CreateProgram();
    for (const GLuint shader : {compile(GL_VERTEX_SHADER, kOutputVertexShader),
                                compile(GL_FRAGMENT_SHADER, "#version 430\n" + steps + kOutputFragmentShader)}) {
        gl_.AttachShader(program, shader);
        gl_.DeleteShader(shader);
    }
    gl_.LinkProgram(program);
    GLint linked = 0;
    gl_.GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked != 0) return program;
    std::array<char, 1024> why{};
    gl_.GetProgramInfoLog(program, why.size(), nullptr, why.data());
    gl_.DeleteProgram(program);
    return fail("the driver does not take the shader for turned, warped and blended outputs: " +
                std::string(why.data()));
}

Result<GLuint> OutputPass::program_for(const std::string& steps) {
    const auto known = programs_.find(steps);
    return known != programs_.end() ? known->second : programs_.emplace(steps, build(steps)).first->second;
}

void OutputPass::forget(std::uint32_t slot) { shown_.erase(slot); }

Result<PictureTexture> OutputPass::show(std::uint32_t slot, const std::shared_ptr<const geom::TileOutput>& output,
                                        const PictureTexture& canvas, const PictureTexture& of_right_eye) {
    auto& shown = shown_[slot];
    if (!shown || shown->output != output || shown->canvas.width != canvas.width ||
        shown->canvas.height != canvas.height) {
        shown.reset();
        shown = std::make_unique<Shown>(driver_, output, canvas);
        shown->canvas.version = 0;
    }
    if (shown->canvas.version == canvas.version && shown->right_version == of_right_eye.version)
        return shown->picture();
    const auto program = program_for(shown->steps);
    if (!program) return tl::unexpected(program.error());
    driver_.use_program(*program);
    draw(*shown, canvas.texture, of_right_eye.texture);
    shown->canvas.version = canvas.version;
    shown->right_version = of_right_eye.version;
    return shown->picture();
}

/// With the program that is in use. Nothing of other contexts may be left that a default state does not undo.
void OutputPass::draw(Shown& shown, GLuint canvas, GLuint of_right_eye) {
    if (vertex_array_ == 0) {
        gl_.CreateVertexArrays(1, &vertex_array_);
        for (GLuint* sampler : {&linear_, &exact_}) {
            gl_.CreateSamplers(1, sampler);
            for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
                gl_.SamplerParameteri(*sampler, wrap, GL_CLAMP_TO_EDGE);
            for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
                gl_.SamplerParameteri(*sampler, filter, sampler == &linear_ ? GL_LINEAR : GL_NEAREST);
        }
    }
    driver_.end_queries();
    driver_.stop_capturing();
    TextureBindings textures{glstate::next_value_id(), {}};
    const auto bind = [&](Unit unit, GLuint name) {
        textures.names[unit][static_cast<std::size_t>(TextureTarget::t2d)] = name;
    };
    bind(kCanvas, canvas);
    bind(kMesh, shown.mesh);
    bind(kCurves, shown.curves);
    bind(kShare, shown.share);
    bind(kRaise, shown.raise);
    bind(kRightCanvas, of_right_eye);
    SamplerBindings samplers{glstate::next_value_id(), {}};
    std::fill_n(samplers.names.begin(), kUnits, exact_);
    if (!shown.exact) samplers.names[kCanvas] = samplers.names[kRightCanvas] = linear_;
    glstate::assign<glstate::el::viewport>(
        state_, 0, {0, 0, static_cast<float>(shown.width()), static_cast<float>(shown.height())});
    driver_.sync(state_);
    driver_.bind_textures(textures);
    driver_.bind_samplers(samplers);
    driver_.bind_target(shown, state_);
    driver_.bind_uniform_buffer(kParameters, {shown.parameters, 0, sizeof(OutputParameters)});
    driver_.bind_vertex_array(vertex_array_);
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    driver_.forget_target();
}

}  // namespace wall::tileserver
