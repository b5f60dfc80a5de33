// SPDX-License-Identifier: MIT
// The one driver context of a GPU and what is known to be in it: a mirror that every soft context is compared with
// before it draws, so that a switch costs what differs (Tracking Graphics State, section 5). Render thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "common/glapi/assembly_format.h"
#include "common/glapi/texture_target.h"
#include "common/glstate/diff.h"
#include "gen/glstate/driver_emit.gen.h"
#include "gen/glstate/state.gen.h"
#include "tileserver/driver/quirks.h"
#include "tileserver/driver/window_values.h"
#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

inline constexpr unsigned kTextureUnits = glstate::el::texture_binding_2d::count;

using glapi::kTextureTargets;
using glapi::TextureTarget;
inline GLenum gl_target(TextureTarget target) { return glapi::info_of(target).target; }
/// Of a target or an image target (cube map faces); nothing: not one of ours.
std::optional<TextureTarget> texture_target(GLenum target);
inline bool is_1d(TextureTarget target) { return glapi::info_of(target).images == 1; }
/// Its images have a depth.
inline bool is_3d(TextureTarget target) { return glapi::info_of(target).images == 3; }

using TextureNames = std::array<std::array<GLuint, kTextureTargets>, kTextureUnits>;
/// What a query of the driver counts.
enum class QueryTarget : std::uint8_t { samples, primitives, captured };
inline constexpr std::size_t kQueryTargets = 3;
/// Streams of vertices that a geometry shader may make; primitives are counted of each.
inline constexpr unsigned kVertexStreams = glstate::el::captured_query::count;
inline GLenum gl_query_target(QueryTarget target) {
    constexpr std::array<GLenum, kQueryTargets> kTargets = {GL_SAMPLES_PASSED, GL_PRIMITIVES_GENERATED,
                                                            GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN};
    return kTargets[static_cast<std::size_t>(target)];
}

/// Driver samplers at all units; 0: what the texture itself says.
using SamplerNames = std::array<GLuint, glstate::el::sampler_binding::count>;
/// Equal stamps mean equal names. 0: none anywhere.
struct SamplerBindings {
    std::uint64_t stamp = 0;
    SamplerNames names{};
};

/// Driver textures at all units; equal ids mean equal names. Id 0: none anywhere.
struct TextureBindings {
    std::uint64_t id = 0;
    TextureNames names{};
};

/// The state of a driver context goes through here, never around it.
class Driver : private glstate::DriverEmit<Gl> {
public:
    /// The context is current; `gl` is loaded.
    explicit Driver(const Gl& gl);
    Driver(const Driver&) = delete;

    const Gl& gl() const { return gl_; }
    bool flip_y() const { return flip_y_; }
    /// What the driver holds; of the window category, what it was computed from. Textures, the raster position and
    /// objects are kept elsewhere.
    glstate::State mirror;

    /// A glBitmap was drawn. Mesa 22 gathers them, and would draw them by the state of a later one.
    void hold_bitmap() { bitmap_held_ = true; }
    /// Somebody has changed it without the driver's knowing.
    void restore_pixel_zoom() const { gl_.PixelZoom(window_.pixel_zoom[0], window_.pixel_zoom[1]); }
    /// Everything but vertex attributes and what depends on the target or names objects. The state's categories take
    /// the driver's value ids where they prove equal.
    void sync(glstate::State& state) {
        if (!glstate::same_ids<kSynced>(mirror, state)) sync_values(state);
    }
    /// Whether this state was followed last, and neither it nor what the driver holds has changed since: then all of
    /// sync() and sync_current() is done. One number instead of a comparison of each category.
    bool holds(const glstate::State& state) const { return mirror.ids.follows(state.ids); }
    /// After sync() and sync_current(), in that order.
    void follow(glstate::State& state) { mirror.ids.follow(state.ids); }
    /// The current attributes; the last thing before geometry, so that Mesa packs them with its vertices. Behind them
    /// any other change would make it set up each as an array of its own.
    void sync_current(glstate::State& state) {
        if (quirks_.keeps_attributes_together) [[unlikely]]
            return sync_separated(state);
        glstate::diff_and_unify<kCurrentMask>(mirror, state, *this);
    }
    /// `state` holds what the driver holds since sync() and the vertex attributes that both have seen since.
    void unify_attributes(glstate::State& state) const { glstate::unify_ids(kAttributesMask, state, mirror); }
    void sync_pixel_transfer(const glstate::State& state);
    /// Images pass unchanged, for the driver's own work.
    void neutral_pixel_transfer() { sync_pixel_transfer(defaults_); }
    /// The target and the window category as it concerns it.
    void bind_target(RenderTarget& target, glstate::State& state) {
        if (target_ != &target || mirror.ids[kWindow] != state.ids[kWindow]) bind_window(target, state);
    }
    /// Whether bind_target(), bind_textures(), bind_samplers() and use_program(0) would find nothing to do.
    bool has_bound(const RenderTarget& target, const glstate::State& state, const TextureBindings& textures,
                   const SamplerBindings& samplers) const {
        return target_ == &target && mirror.ids[kWindow] == state.ids[kWindow] && bound_textures_.id == textures.id &&
               samplers_.stamp == samplers.stamp && program_ == 0 && pipeline_ == 0 && !assembly_[0].enabled &&
               !assembly_[1].enabled;
    }
    /// Another framebuffer was bound, or a target is gone.
    void forget_target() {
        target_ = nullptr;
        colorless_ = true;
    }
    void bind_textures(const TextureBindings& wanted) {
        if (wanted.id != bound_textures_.id) bind_all(wanted);
    }
    void bind_samplers(const SamplerBindings& wanted) {
        if (wanted.stamp != samplers_.stamp) bind_each_sampler(wanted);
    }
    void delete_sampler(GLuint sampler) {  // the driver unbinds it by itself
        std::ranges::replace(samplers_.names, sampler, 0u);
        samplers_.stamp = glstate::next_value_id();
        gl_.DeleteSamplers(1, &sampler);
    }
    /// On the active unit, for commands that work on the bound object.
    void bind_texture_to_edit(TextureTarget target, GLuint texture) {
        bind_texture(0, target, texture);
        unit(gl_, 0);
    }
    void select_first_unit() { unit(gl_, 0); }
    /// The driver unbinds a deleted texture by itself.
    void forget_texture(GLuint texture);
    /// A program of the driver; 0: fixed function. `attributes`: the generic ones that it reads, a bit each.
    void use_program(GLuint program, std::uint32_t attributes = 0) {
        reads_attributes(attributes);
        if (pipeline_ != 0) gl_.BindProgramPipeline(pipeline_ = 0);
        if (program_ != program) gl_.UseProgram(program_ = program);
    }
    /// Several programs of the driver, a stage or more each.
    void use_pipeline(GLuint pipeline, std::uint32_t attributes) {
        reads_attributes(attributes);
        if (program_ != 0) gl_.UseProgram(program_ = 0);
        if (pipeline_ != pipeline) gl_.BindProgramPipeline(pipeline_ = pipeline);
    }
    /// Before it is deleted.
    void forget_pipeline(GLuint pipeline) {
        if (pipeline_ == pipeline) use_program(0);
    }
    /// Before a program is deleted.
    void forget_program(GLuint program) {
        if (program_ == program) use_program(0);
    }
    bool has_assembly() const { return has_assembly_; }
    /// The first of the environment parameters that are the node's own (kWindowParameters).
    unsigned window_parameter() const { return environment_[1]; }
    /// An assembly program of the driver draws where no shader does; 0: none.
    void use_assembly(glapi::AssemblyStage stage, GLuint program);
    /// It is given a string or parameters next.
    void edit_assembly(glapi::AssemblyStage stage, GLuint program);
    /// Before it is deleted.
    void forget_assembly(glapi::AssemblyStage stage, GLuint program);
    /// Where the layer lies, for programs of fragments that read it: scale, then offset.
    void set_fragment_window(const std::array<float, 4>& value);
    /// Counts for a query of the driver until end_queries(): one of each target and stream; samples are of stream 0.
    void begin_query(QueryTarget target, unsigned stream, GLuint query) {
        gl_.BeginQueryIndexed(gl_query_target(target), stream, queries_of(target)[stream] = query);
    }
    /// Of whatever counts.
    void end_queries() {
        for (std::size_t i = 0; i < queries_.size(); ++i)
            if (std::exchange(queries_[i], 0) != 0)
                gl_.EndQueryIndexed(gl_query_target(static_cast<QueryTarget>(i / kVertexStreams)),
                                    static_cast<GLuint>(i % kVertexStreams));
    }
    void delete_query(GLuint query) {
        if (std::ranges::count(queries_, query) != 0) end_queries();
        gl_.DeleteQueries(1, &query);
    }
    /// Part of a buffer of the driver, for blocks of uniforms; buffer 0: nothing. It lies within the buffer, and
    /// begins where the driver allows it.
    void bind_uniform_buffer(unsigned place, const glstate::BufferRange& wanted) {
        bind_buffer_part(GL_UNIFORM_BUFFER, uniform_buffers_[place], place, wanted);
    }
    /// Bytes that such a part may begin at a multiple of.
    std::uint32_t uniform_buffer_alignment() const { return uniform_buffer_alignment_; }
    /// Before a buffer changes: what is drawn and not yet sent on by the driver has read its uniforms. (Mesa 22 gathers
    /// glBegin .. glEnd, and a change of a buffer's content does not send them on as one of a binding does.)
    void release_uniform_buffer(GLuint buffer) {
        for (unsigned place = 0; place < uniform_buffers_.size(); ++place)
            if (uniform_buffers_[place].buffer == buffer) bind_uniform_buffer(place, {});
    }
    /// The same for blocks of storage.
    void bind_storage_buffer(unsigned place, const glstate::BufferRange& wanted) {
        bind_buffer_part(GL_SHADER_STORAGE_BUFFER, storage_buffers_[place], place, wanted);
    }
    /// For atomic counters; the part begins at a multiple of 4 bytes.
    void bind_counter_buffer(unsigned place, const glstate::BufferRange& wanted) {
        bind_buffer_part(GL_ATOMIC_COUNTER_BUFFER, counter_buffers_[place], place, wanted);
    }
    /// Bytes that a part for a block of storage may begin at a multiple of.
    std::uint32_t storage_buffer_alignment() const { return storage_buffer_alignment_; }
    /// An image of a texture of the driver; texture 0: nothing. The driver takes its level, layer, access and format.
    void bind_image(unsigned unit, const glstate::ImageUnit& wanted) {
        glstate::ImageUnit& bound = images_[unit];
        if (glstate::same(bound, wanted)) return;
        bound = wanted;
        gl_.BindImageTexture(unit, bound.texture, bound.level, static_cast<GLboolean>(bound.layered), bound.layer,
                             bound.access, bound.format);
    }
    /// What is drawn now reads or writes memory at places that it addresses, until settle_memory().
    void touches_memory() { touches_memory_ = true; }
    /// Whatever comes next sees what was written. (Mesa 22.3 gathers glBegin .. glEnd, and draws them before another
    /// program is used, but not before a barrier.)
    void settle_memory() {
        if (!std::exchange(touches_memory_, false)) return;
        use_program(0);
        gl_.MemoryBarrier(GL_ALL_BARRIER_BITS);
    }
    /// The driver unbinds a deleted buffer by itself.
    void forget_buffer(GLuint buffer) {
        for (glstate::BufferRange& bound : storage_buffers_)
            if (bound.buffer == buffer) bound = {};
        for (glstate::BufferRange& bound : counter_buffers_)
            if (bound.buffer == buffer) bound = {};
        for (glstate::BufferRange& bound : uniform_buffers_)
            if (bound.buffer == buffer) bound = {};
    }
    /// Begins the bound transform feedback, if the driver finds all that it needs.
    void begin_capturing(GLenum mode) {
        gl_.BeginTransformFeedback(mode);
        GLint active = 0;
        gl_.GetIntegerv(GL_TRANSFORM_FEEDBACK_ACTIVE, &active);
        if (active != 0) captured_mode_ = mode;
    }
    /// Of the transform feedback that was begun last; 0: none was. (Mesa 22.3 draws primitives of this mode only while
    /// any transform feedback is active, one that began with another mode and is resumed, too.)
    GLenum captured_mode() const { return captured_mode_; }
    /// Transform feedback of the driver has begun or goes on; nothing of what is drawn is seen.
    void captures() {
        discard_all();
        capturing_ = true;
    }
    /// The same without it.
    void discard_all() {
        gl_.Enable(GL_RASTERIZER_DISCARD);
        discarding_ = true;
    }
    /// It waits.
    void stop_capturing() {
        if (!std::exchange(discarding_, false)) return;
        if (std::exchange(capturing_, false)) {
            gl_.PauseTransformFeedback();
            gl_.BindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
        }
        gl_.Disable(GL_RASTERIZER_DISCARD);
    }
    /// Part of a buffer of the driver's.
    void write_buffer(GLuint buffer, std::uint32_t offset, std::span<const std::byte> content) const;
    /// A vertex array object of the driver, for the next draw from arrays.
    void bind_vertex_array(GLuint vertex_array) {
        if (vertex_array_ != vertex_array) gl_.BindVertexArray(vertex_array_ = vertex_array);
    }
    /// Before it is deleted.
    void forget_vertex_array(GLuint vertex_array) {
        if (vertex_array_ == vertex_array) bind_vertex_array(0);
    }
    /// No scissor for the driver's own work (blits, clears); the next bind_target() sets it again.
    void disable_scissor();

    /// Takes all of the driver's errors; how many there were.
    unsigned drain_errors();
    /// Why the context is lost; null: it is not. After a reset nothing that it had is left.
    const char* reset() const;

    template <class E>
    void set(unsigned i, const typename E::type& value) {
        emit(gl_, E{}, i, value);
    }

private:
    using DriverEmit::emit;
    void emit(Gl& gl, glstate::el::modelview, unsigned, const glstate::Mat4& v);
    void emit(Gl& gl, glstate::el::modelview_base, unsigned, const glstate::Mat4& v);
    void emit(Gl& gl, glstate::el::modelview_step, unsigned, const glstate::ModelviewStep& v);
    void emit(Gl& gl, glstate::el::modelview_form, unsigned, const glstate::ModelviewForm& v);
    void emit(Gl& gl, glstate::el::projection, unsigned, const glstate::Mat4& v);
    void emit(Gl& gl, glstate::el::texture_matrix, unsigned i, const glstate::Mat4& v);
    void emit(Gl& gl, glstate::el::program_matrix, unsigned i, const glstate::Mat4& v);
    void emit(Gl& gl, glstate::el::vertex_env, unsigned i, const glstate::Vec4& v);
    void emit(Gl& gl, glstate::el::fragment_env, unsigned i, const glstate::Vec4& v);
    // Several elements make up what draw buffers have; the driver is told when all of them are known.
    void emit(Gl&, glstate::el::blend_func, unsigned, const glstate::BlendFunc&) { blend_func_changed_ = true; }
    void emit(Gl&, glstate::el::depth_range, unsigned, const glstate::DepthRange&) { depth_range_changed_ = true; }
    void emit(Gl&, glstate::el::depth_range_rest, unsigned, const glstate::DepthRange&) { depth_range_changed_ = true; }
    void emit(Gl&, glstate::el::blend_func_rest, unsigned, const glstate::BlendFunc&) { blend_func_changed_ = true; }
    void emit(Gl&, glstate::el::blend_equation, unsigned, const glstate::BlendEquation&) {
        blend_equation_changed_ = true;
    }
    void emit(Gl&, glstate::el::blend_equation_rest, unsigned, const glstate::BlendEquation&) {
        blend_equation_changed_ = true;
    }
    void emit(Gl& gl, glstate::el::sample_mask, unsigned, std::uint32_t v) { gl.SampleMaski(0, v); }
    void emit(Gl& gl, glstate::el::clip_plane, unsigned i, const glstate::Vec4& v);
    void emit(Gl& gl, glstate::el::light_position, unsigned i, const glstate::Vec4& v);
    void emit(Gl& gl, glstate::el::light_spot_direction, unsigned i, const glstate::Vec3& v);
    void emit(Gl& gl, glstate::el::tex_gen_eye_plane, unsigned i, const glstate::Vec4& v);
    void load_projection(const Gl& gl, const glstate::Mat4& wanted) const;
    void apply_viewports(const WindowValues& values);
    void apply_scissors(const WindowValues& values);

    /// Of two attributes that lie at one place, what is drawn with next has the one that it reads.
    void sync_separated(glstate::State& state);
    void reads_attributes(std::uint32_t generic) {
        if (generic == generic_) return;
        generic_ = generic;
        if (quirks_.keeps_attributes_together) mirror.ids.renew(kCurrent);
    }
    void stop_tracking(const glstate::State& state);
    void sync_values(glstate::State& state);
    void bind_window(RenderTarget& target, glstate::State& state);
    void tell_textures_again();
    void bind_all(const TextureBindings& wanted);
    void bind_texture(unsigned unit, TextureTarget target, GLuint texture);
    void bind_each_sampler(const SamplerBindings& wanted);

    std::optional<geom::EyeView> view_;  ///< of the target
    void bind_buffer_part(GLenum target, glstate::BufferRange& bound, unsigned place,
                          const glstate::BufferRange& wanted) const {
        if (glstate::same(bound, wanted)) return;
        bound = wanted;
        if (bound.buffer == 0) gl_.BindBufferBase(target, place, 0);
        else gl_.BindBufferRange(target, place, bound.buffer, bound.offset, bound.size);
    }
    GLuint* queries_of(QueryTarget target) {
        return queries_.data() + static_cast<std::size_t>(target) * kVertexStreams;
    }
    /// What draw buffers and viewports have each for itself, as far as it has changed.
    void apply_indexed();

    static constexpr auto kWindow = static_cast<std::size_t>(glstate::Category::window);
    static constexpr auto kCurrent = static_cast<std::size_t>(glstate::Category::current);
    static constexpr glstate::CategoryMask kCurrentMask = glstate::mask_of(glstate::Category::current);
    static constexpr glstate::CategoryMask kAttributesMask =
        kCurrentMask | glstate::mask_of(glstate::Category::material);
    /// Whether a category differs that takes part in drawing a bitmap.
    static bool fragments_change(const glstate::State& from, const glstate::State& to);

    static constexpr glstate::CategoryMask kSynced =
        glstate::kSentCategories & ~kCurrentMask & ~glstate::kLayerCategories &
        ~glstate::mask_of(glstate::Category::textures) & ~glstate::mask_of(glstate::Category::objects) &
        ~glstate::mask_of(glstate::Category::uniform_buffers) & ~glstate::mask_of(glstate::Category::shader_memory);

    Gl gl_;
    const glstate::State defaults_;
    bool flip_y_ = false;
    bool has_assembly_ = false;
    std::array<unsigned, glapi::kAssemblyStages> environment_{};  // parameters that programs may set
    Quirks quirks_;
    bool modelview_changed_ = false;  // since it was loaded
    bool blend_func_changed_ = false, blend_equation_changed_ = false, depth_range_changed_ = false;  // the same
    bool modelview_has_origin_ = false;                                                               // what was loaded
    TextureBindings bound_textures_;
    SamplerBindings samplers_;           // that the driver has bound
    GLuint program_ = 0, pipeline_ = 0;  // that the driver draws with: one of them
    struct Assembly {
        GLuint bound = 0;
        bool enabled = false;
    };
    std::array<Assembly, glapi::kAssemblyStages> assembly_{};       // of each stage
    std::array<float, 4> fragment_window_{};                        // that programs of fragments are told
    std::uint32_t generic_ = 0;                                     // attributes that it reads, a bit each
    std::uint64_t separated_ = 0;                                   // the mirror's id of attributes that are
    std::array<GLuint, kQueryTargets * kVertexStreams> queries_{};  // that count
    GLuint vertex_array_ = 0;
    bool discarding_ = false, capturing_ = false;
    GLenum captured_mode_ = 0;
    std::array<glstate::BufferRange, glstate::el::uniform_buffer::count> uniform_buffers_{};  // the driver's names
    std::array<glstate::BufferRange, glstate::el::storage_buffer::count> storage_buffers_{};  // the same
    std::array<glstate::BufferRange, glstate::el::counter_buffer::count> counter_buffers_{};  // the same
    std::array<glstate::ImageUnit, glstate::el::image_unit::count> images_{};                 // the same
    bool touches_memory_ = false;
    std::uint32_t uniform_buffer_alignment_ = 1, storage_buffer_alignment_ = 1;
    RenderTarget* target_ = nullptr;  // whose window values are in the driver
    WindowValues window_;             // what the driver holds
    bool colorless_ = true;           // what is bound may be a framebuffer that is drawn to without colours
    bool bitmap_held_ = false;
};

}  // namespace wall::tileserver
