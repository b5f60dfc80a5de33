// SPDX-License-Identifier: MIT
#include "tileserver/driver/driver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "common/glstate/draw_buffers.h"
#include "common/glstate/indexed_values.h"
#include "common/glstate/modelview.h"
#include "common/glstate/view_change.h"
#include "tileserver/gpu/extensions.h"

namespace wall::tileserver {
namespace {

/// Exact for whole numbers that a viewport may have; absurd ones are cut.
GLint whole(float value) { return static_cast<GLint>(std::clamp(value, -1e9f, 1e9f)); }

// Lights, clip planes and eye planes are kept in eye coordinates, but the driver transforms them by its modelview when
// it is told. While this lives, that is none: for all of a difference, since for each value apart it would be four
// calls around one.
class IdentityModelview {
public:
    IdentityModelview(const Gl& gl, bool needed) : gl_(gl), needed_(needed) {
        if (!needed_) return;
        gl_.MatrixMode(GL_MODELVIEW);
        gl_.PushMatrix();
        gl_.LoadIdentity();
    }
    ~IdentityModelview() {
        if (!needed_) return;
        gl_.MatrixMode(GL_MODELVIEW);
        gl_.PopMatrix();
    }
    IdentityModelview(const IdentityModelview&) = delete;

private:
    const Gl& gl_;
    const bool needed_;
};

/// Categories that hold such values.
constexpr glstate::CategoryMask kEyeCategories = glstate::mask_of(glstate::el::clip_plane::category) |
                                                 glstate::mask_of(glstate::el::light_position::category) |
                                                 glstate::mask_of(glstate::el::light_spot_direction::category) |
                                                 glstate::mask_of(glstate::el::tex_gen_eye_plane::category);

/// diff of a category whose elements have a value for each texture unit, unit by unit: element by element the driver
/// would be told another active unit before nearly each value.
template <glstate::Category C, class... E>
[[gnu::noinline]] void diff_by_unit(glstate::ElementList<E...>, glstate::State& from, glstate::State& to,
                                    Driver& driver) {
    constexpr auto kId = static_cast<std::size_t>(C);
    const std::array different = {std::memcmp(&E::ref(std::as_const(from), 0), &E::ref(std::as_const(to), 0),
                                              sizeof(typename E::type) * E::count) != 0 ...};
    bool any = false;
    for (unsigned i = 0; i < std::max({E::count...}); ++i) {
        std::size_t element = 0;
        ((any |=
          different[element++] && i < E::count && glstate::detail::diff_value<E, false>(from, to, i, driver) != 0),
         ...);
    }
    (any ? from : to).ids.take(kId, (any ? to : from).ids[kId]);
}
template <glstate::Category C>
void diff_by_unit(glstate::State& from, glstate::State& to, Driver& driver) {
    constexpr auto kId = static_cast<std::size_t>(C);
    if (from.ids[kId] != to.ids[kId]) diff_by_unit<C>(typename glstate::CategoryElements<C>::list{}, from, to, driver);
}

}  // namespace

std::optional<TextureTarget> texture_target(GLenum target) {
    const auto found = glapi::find_target_word(target);
    return found && !found->is_proxy() ? std::optional(found->info->id) : std::nullopt;
}

Driver::Driver(const Gl& gl)
    : gl_(gl),
      flip_y_(has_extension(gl, "GL_MESA_framebuffer_flip_y")),
      has_assembly_(tileserver::has_assembly(gl)),
      quirks_(try_out(gl)) {
    if (has_assembly_)
        for (const auto stage : {glapi::AssemblyStage::vertex, glapi::AssemblyStage::fragment})
            environment_[glapi::index_of(stage)] = environment_parameters(gl, stage);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);  // images travel with tight rows
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
    // Whatever the driver started with, it now holds what the mirror says.
    {
        const IdentityModelview identity(gl_, true);
        glstate::for_each_element([&]<class E>() {
            if constexpr (((kSynced | kCurrentMask) >> static_cast<unsigned>(E::category) & 1) != 0)
                for (unsigned i = 0; i < E::count; ++i) set<E>(i, E::ref(defaults_, i));
        });
    }
    gl_.Disable(GL_SCISSOR_TEST);
    GLint alignment = 1;
    gl_.GetIntegerv(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT, &alignment);
    storage_buffer_alignment_ = static_cast<std::uint32_t>(std::max(alignment, 1));
    gl_.GetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    uniform_buffer_alignment_ = static_cast<std::uint32_t>(std::max(alignment, 1));
    drain_errors();
}

unsigned Driver::drain_errors() {
    unsigned count = 0;
    while (count < 64 && gl_.GetError() != GL_NO_ERROR) ++count;
    return count;
}

const char* Driver::reset() const {
    switch (gl_.GetGraphicsResetStatus != nullptr ? gl_.GetGraphicsResetStatus() : GLenum{GL_NO_ERROR}) {
        case GL_NO_ERROR: return nullptr;
        case GL_GUILTY_CONTEXT_RESET: return "what was drawn here made the GPU hang";
        case GL_INNOCENT_CONTEXT_RESET: return "another program made the GPU hang";
        default: return "the GPU was reset";
    }
}

void Driver::write_buffer(GLuint buffer, std::uint32_t offset, std::span<const std::byte> content) const {
    const auto size = static_cast<GLsizeiptr>(content.size());
    if (!quirks_.loses_writes) return gl_.NamedBufferSubData(buffer, offset, size, content.data());
    GLuint from = 0;
    gl_.CreateBuffers(1, &from);
    gl_.NamedBufferData(from, size, content.data(), GL_STREAM_COPY);
    gl_.CopyNamedBufferSubData(from, buffer, 0, offset, size);
    gl_.DeleteBuffers(1, &from);
}

void Driver::sync_separated(glstate::State& state) {
    namespace el = glstate::el;
    const bool drawn = mirror.ids[kCurrent] != separated_;
    glstate::diff_and_unify<kCurrentMask>(mirror, state, *this);
    if (!drawn && mirror.ids[kCurrent] == separated_) return;
    const auto tell = [this]<class E>(E, auto wanted) {
        for (unsigned i = 0; i < E::count; ++i)
            if (wanted(i)) set<E>(i, E::ref(std::as_const(mirror), i));
    };
    const auto all = [](unsigned) { return true; };
    tell(el::color{}, all);
    tell(el::normal{}, all);
    tell(el::texcoord{}, all);
    tell(el::secondary_color{}, all);
    tell(el::fog_coord{}, all);
    tell(el::vertex_attrib{}, [this](unsigned i) { return (generic_ >> i & 1) != 0; });
    separated_ = mirror.ids[kCurrent];
}

bool Driver::fragments_change(const glstate::State& from, const glstate::State& to) {
    for (std::size_t category = 0; category < glstate::kCategoryCount; ++category)
        if ((kSynced >> category & 1) != 0 && from.ids[category] != to.ids[category]) return true;
    return false;
}

/// glColorMaterial is given while tracking is off: a colour that Mesa 22.3 still holds then (glColor outside of
/// glBegin) would be lost to the material.
void Driver::stop_tracking(const glstate::State& state) {
    constexpr auto kMaterial = static_cast<std::size_t>(glstate::Category::material);
    if (mirror.ids[kMaterial] == state.ids[kMaterial] || !mirror.material.color_material_enabled) return;
    if (glstate::same(mirror.material.color_material, state.material.color_material)) return;
    gl_.Disable(GL_COLOR_MATERIAL);
    glstate::assign<glstate::el::color_material_enabled>(mirror, 0, 0);
}

void Driver::sync_values(glstate::State& state) {
    if (bitmap_held_ && fragments_change(mirror, state)) {
        gl_.Flush();
        bitmap_held_ = false;
    }
    stop_tracking(state);
    {
        const IdentityModelview identity(gl_, !glstate::same_ids<kEyeCategories>(mirror, state));
        diff_by_unit<glstate::Category::texture_units>(mirror, state, *this);
        diff_by_unit<glstate::Category::texture_gen>(mirror, state, *this);
        glstate::diff_and_unify<kSynced>(mirror, state, *this);
    }
    apply_indexed();
    if (std::exchange(modelview_changed_, false))
        modelview_has_origin_ = glstate::load_modelview(gl_, mirror, modelview_has_origin_);
}

void Driver::apply_indexed() {
    namespace el = glstate::el;
    if (std::exchange(blend_func_changed_, false)) {
        const auto of = [&](unsigned i) -> const glstate::BlendFunc& {
            return glstate::value_at<el::blend_func, el::blend_func_rest>(mirror, i);
        };
        const glstate::BlendFunc& all = of(0);
        if (glstate::none_has_its_own<el::blend_func_rest>(mirror))
            gl_.BlendFuncSeparate(all.src_rgb, all.dst_rgb, all.src_alpha, all.dst_alpha);
        else
            for (unsigned i = 0; i < glstate::kDrawBuffers; ++i)
                gl_.BlendFuncSeparatei(i, of(i).src_rgb, of(i).dst_rgb, of(i).src_alpha, of(i).dst_alpha);
    }
    if (std::exchange(depth_range_changed_, false)) {
        std::array<glstate::DepthRange, glstate::kViewports> ranges;
        for (unsigned i = 0; i < ranges.size(); ++i)
            ranges[i] = glstate::value_at<el::depth_range, el::depth_range_rest>(mirror, i);
        if (glstate::none_has_its_own<el::depth_range_rest>(mirror))
            gl_.DepthRange(ranges[0].near_value, ranges[0].far_value);
        else gl_.DepthRangeArrayv(0, static_cast<GLsizei>(ranges.size()), &ranges[0].near_value);
    }
    if (!std::exchange(blend_equation_changed_, false)) return;
    const auto of = [&](unsigned i) -> const glstate::BlendEquation& {
        return glstate::value_at<el::blend_equation, el::blend_equation_rest>(mirror, i);
    };
    // Advanced equations are those of both, which only the commands for both take (GL_KHR_blend_equation_advanced).
    if (glstate::none_has_its_own<el::blend_equation_rest>(mirror)) {
        if (of(0).rgb == of(0).alpha) gl_.BlendEquation(of(0).rgb);
        else gl_.BlendEquationSeparate(of(0).rgb, of(0).alpha);
        return;
    }
    for (unsigned i = 0; i < glstate::kDrawBuffers; ++i)
        if (of(i).rgb == of(i).alpha) gl_.BlendEquationi(i, of(i).rgb);
        else gl_.BlendEquationSeparatei(i, of(i).rgb, of(i).alpha);
}

void Driver::sync_pixel_transfer(const glstate::State& state) {
    glstate::diff_category<glstate::Category::pixel_transfer>(mirror, state, *this);
}

// ---- matrices, and what is transformed by them (IdentityModelview) ----

// Four elements make up one matrix; it is loaded when all of them are known.
void Driver::emit(Gl&, glstate::el::modelview, unsigned, const glstate::Mat4&) { modelview_changed_ = true; }
void Driver::emit(Gl&, glstate::el::modelview_base, unsigned, const glstate::Mat4&) { modelview_changed_ = true; }
void Driver::emit(Gl&, glstate::el::modelview_step, unsigned, const glstate::ModelviewStep&) {
    modelview_changed_ = true;
}
void Driver::emit(Gl&, glstate::el::modelview_form, unsigned, const glstate::ModelviewForm&) {
    modelview_changed_ = true;
}
/// As the target's view has it. What is no perspective is the same in all views.
void Driver::load_projection(const Gl& gl, const glstate::Mat4& wanted) const {
    const auto change = view_ ? glstate::view_change(*view_, wanted) : std::nullopt;
    const glstate::Mat4 seen = change ? glstate::product(*change, wanted) : wanted;
    gl.MatrixMode(GL_PROJECTION);
    gl.LoadMatrixf(seen.data());
}

void Driver::emit(Gl& gl, glstate::el::projection, unsigned, const glstate::Mat4& v) { load_projection(gl, v); }
void Driver::emit(Gl& gl, glstate::el::texture_matrix, unsigned i, const glstate::Mat4& v) {
    unit(gl, i);
    gl.MatrixMode(GL_TEXTURE);
    gl.LoadMatrixf(v.data());
}
void Driver::emit(Gl& gl, glstate::el::program_matrix, unsigned i, const glstate::Mat4& v) {
    if (!has_assembly_) return;
    gl.MatrixMode(GL_MATRIX0_ARB + i);
    gl.LoadMatrixf(v.data());
}
void Driver::emit(Gl& gl, glstate::el::clip_plane, unsigned i, const glstate::Vec4& v) {
    const std::array<GLdouble, 4> plane = {v[0], v[1], v[2], v[3]};
    gl.ClipPlane(GL_CLIP_PLANE0 + i, plane.data());
}
void Driver::emit(Gl& gl, glstate::el::light_position, unsigned i, const glstate::Vec4& v) {
    gl.Lightfv(GL_LIGHT0 + i, GL_POSITION, v.data());
}
void Driver::emit(Gl& gl, glstate::el::light_spot_direction, unsigned i, const glstate::Vec3& v) {
    gl.Lightfv(GL_LIGHT0 + i, GL_SPOT_DIRECTION, v.data());
}
void Driver::emit(Gl& gl, glstate::el::tex_gen_eye_plane, unsigned i, const glstate::Vec4& v) {
    unit(gl, i / 4);
    gl.TexGenfv(GL_S + i % 4, GL_EYE_PLANE, v.data());
}

// ---- assembly programs ----

// Of a driver that has fewer than others of the wall, no program is told that there are more.
void Driver::emit(Gl& gl, glstate::el::vertex_env, unsigned i, const glstate::Vec4& v) {
    if (i < environment_[0]) gl.ProgramEnvParameter4fvARB(GL_VERTEX_PROGRAM_ARB, i, v.data());
}
void Driver::emit(Gl& gl, glstate::el::fragment_env, unsigned i, const glstate::Vec4& v) {
    if (i < environment_[1]) gl.ProgramEnvParameter4fvARB(GL_FRAGMENT_PROGRAM_ARB, i, v.data());
}

void Driver::edit_assembly(glapi::AssemblyStage stage, GLuint program) {
    Assembly& known = assembly_[glapi::index_of(stage)];
    if (known.bound != program) gl_.BindProgramARB(glapi::target_of(stage), known.bound = program);
}

void Driver::use_assembly(glapi::AssemblyStage stage, GLuint program) {
    Assembly& known = assembly_[glapi::index_of(stage)];
    const bool enabled = program != 0;
    if (enabled) edit_assembly(stage, program);
    if (std::exchange(known.enabled, enabled) == enabled) return;
    enabled ? gl_.Enable(glapi::target_of(stage)) : gl_.Disable(glapi::target_of(stage));
}

void Driver::forget_assembly(glapi::AssemblyStage stage, GLuint program) {
    if (assembly_[glapi::index_of(stage)].bound != program) return;
    use_assembly(stage, 0);
    edit_assembly(stage, 0);
}

void Driver::set_fragment_window(const std::array<float, 4>& value) {
    if (std::exchange(fragment_window_, value) == value) return;
    const std::array<std::array<float, 4>, kWindowParameters> parameters = {
        {{value[0], value[1], 1, 1}, {value[2], value[3], 0, 0}}};
    for (unsigned i = 0; i < kWindowParameters; ++i)
        gl_.ProgramEnvParameter4fvARB(GL_FRAGMENT_PROGRAM_ARB, window_parameter() + i, parameters[i].data());
}

// ---- textures ----

void Driver::bind_texture(unsigned i, TextureTarget target, GLuint texture) {
    GLuint& bound = bound_textures_.names[i][static_cast<std::size_t>(target)];
    if (bound == texture) return;
    unit(gl_, i);
    gl_.BindTexture(gl_target(target), texture);
    bound = texture;
    bound_textures_.id = glstate::next_value_id();
}

void Driver::bind_all(const TextureBindings& wanted) {
    for (unsigned i = 0; i < kTextureUnits; ++i) {
        if (bound_textures_.names[i] == wanted.names[i]) continue;
        for (std::size_t target = 0; target < kTextureTargets; ++target)
            bind_texture(i, static_cast<TextureTarget>(target), wanted.names[i][target]);
    }
    bound_textures_.id = wanted.id;
}

void Driver::forget_texture(GLuint texture) {
    for (auto& unit_bindings : bound_textures_.names)
        for (GLuint& bound : unit_bindings)
            if (bound == texture) bound = 0, bound_textures_.id = glstate::next_value_id();
    for (glstate::ImageUnit& image : images_)  // the driver unbinds them, too
        if (image.texture == texture) image = {};
}

void Driver::bind_each_sampler(const SamplerBindings& wanted) {
    for (unsigned i = 0; i < wanted.names.size(); ++i)
        if (samplers_.names[i] != wanted.names[i]) gl_.BindSampler(i, wanted.names[i]);
    samplers_ = wanted;
}

// ---- the target ----

void Driver::bind_window(RenderTarget& target, glstate::State& state) {
    if (glstate::same(mirror.window, state.window)) {
        state.ids.take(kWindow, mirror.ids[kWindow]);
        if (target_ == &target) return;
    }
    mirror.window = state.window;
    mirror.ids.take(kWindow, state.ids[kWindow]);
    target_ = &target;
    if (view_ != target.geometry().view) {
        view_ = target.geometry().view;
        load_projection(gl_, mirror.matrix.projection);
    }
    target.bind(glstate::el::draw_buffer::ref(state), glstate::el::read_buffer::ref(state));
    const bool colors = target.draws_colors();
    if (std::exchange(colorless_, !colors) && colors) tell_textures_again();
    const WindowValues wanted = window_values(target.geometry(), state);
    apply_viewports(wanted);
    apply_scissors(wanted);
    if (wanted.stipple != window_.stipple) gl_.PolygonStipple(reinterpret_cast<const GLubyte*>(wanted.stipple.data()));
    if (wanted.pixel_zoom != window_.pixel_zoom) gl_.PixelZoom(wanted.pixel_zoom[0], wanted.pixel_zoom[1]);
    window_ = wanted;
}

/// Mesa 22.3 makes fixed function's fragment program without textures for a framebuffer without colours. If something
/// asks for that (a read, a question) and nothing is drawn, it goes back to the program of before, but not to the
/// textures: what is drawn next samples whatever lies there. Anything about textures that changes makes it look again.
void Driver::tell_textures_again() {
    const bool enabled = glstate::el::texture_1d_enabled::ref(mirror) != 0;
    unit(gl_, 0);
    const GLenum target = gl_target(TextureTarget::t1d);
    for (const bool on : {!enabled, enabled}) on ? gl_.Enable(target) : gl_.Disable(target);
}

namespace {

template <class Boxes>
bool all_alike(const Boxes& boxes) {
    return std::ranges::all_of(boxes, [&](const auto& box) { return box == boxes.front(); });
}

bool is_whole(const WindowValues::Box& box) {
    return std::ranges::all_of(std::array{box.x, box.y, box.width, box.height},
                               [](float value) { return std::floor(value) == value; });
}

}  // namespace

/// Older commands are for all of them.
void Driver::apply_viewports(const WindowValues& values) {
    if (values.viewports == window_.viewports) return;
    const WindowValues::Box& first = values.viewports.front();
    if (all_alike(values.viewports) && is_whole(first))
        return gl_.Viewport(whole(first.x), whole(first.y), whole(first.width), whole(first.height));
    static_assert(sizeof(WindowValues::Box) == 4 * sizeof(GLfloat));
    gl_.ViewportArrayv(0, static_cast<GLsizei>(WindowValues::kViewports), &first.x);
}

void Driver::apply_scissors(const WindowValues& values) {
    constexpr std::uint32_t kAll = (1u << WindowValues::kViewports) - 1;
    if (values.scissor_enabled != window_.scissor_enabled) {
        const bool all = (values.scissor_enabled & kAll) == kAll;
        all ? gl_.Enable(GL_SCISSOR_TEST) : gl_.Disable(GL_SCISSOR_TEST);
        for (GLuint i = 0; i < WindowValues::kViewports && !all; ++i)
            if ((values.scissor_enabled >> i & 1) != 0) gl_.Enablei(GL_SCISSOR_TEST, i);
    }
    if (values.scissors == window_.scissors) return;
    const WindowValues::IntBox& first = values.scissors.front();
    static_assert(sizeof(WindowValues::IntBox) == 4 * sizeof(GLint));
    if (all_alike(values.scissors)) gl_.Scissor(first.x, first.y, first.width, first.height);
    else gl_.ScissorArrayv(0, static_cast<GLsizei>(WindowValues::kViewports), &first.x);
}

void Driver::disable_scissor() {
    if (std::exchange(window_.scissor_enabled, 0) != 0) gl_.Disable(GL_SCISSOR_TEST);
    forget_target();
}

}  // namespace wall::tileserver
