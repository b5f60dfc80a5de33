// SPDX-License-Identifier: MIT
#include "client_lib/context/context.h"

#include <algorithm>

#include "client_lib/context/array_copies.h"
#include "client_lib/context/assembly_use.h"
#include "client_lib/context/attribute_stack.h"
#include "client_lib/context/buffer_use.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/debug_state.h"
#include "client_lib/context/es_version.h"
#include "client_lib/context/framebuffer_use.h"
#include "client_lib/context/list_state.h"
#include "client_lib/context/memory_use.h"
#include "client_lib/context/query_state.h"
#include "client_lib/context/select.h"
#include "client_lib/context/staging_buffers.h"
#include "client_lib/context/vertex_array_objects.h"
#include "client_lib/context/vertex_inputs.h"
#include "client_lib/geometry/fold.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/program.h"
#include "client_lib/objects/program_pipeline.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/process/log.h"
#include "common/glstate/program_environment.h"

namespace wall::client {

constinit thread_local Context* tls_context = nullptr;
constinit thread_local Packer* tls_packer = nullptr;

namespace {

const GlTable& table_of(const ContextProfile& profile) {
    if (profile.is_es()) return es_table(profile.es);
    return profile.core ? tables::core : tables::immediate;
}

}  // namespace

Context::Context(std::shared_ptr<ShareGroup> share, const ContextProfile& own_profile)
    : id(next_context_id()),
      profile(own_profile),
      table(&table_of(profile)),
      lists(std::make_unique<ListState>()),
      attributes(std::make_unique<AttributeStacks>()),
      select(std::make_unique<SelectState>()),
      maps(std::make_unique<ContextMaps>()),
      buffers(std::make_unique<BufferUse>()),
      inputs(std::make_unique<VertexInputs>()),
      framebuffers(std::make_unique<FramebufferUse>()),
      vertex_array_objects(std::make_unique<VertexArrayObjects>()),
      staging(std::make_unique<StagingBuffers>()),
      copies(std::make_unique<ArrayCopies>()),
      pipelines(std::make_unique<PipelineUse>()),
      queries(std::make_unique<QueryState>()),
      debug(std::make_unique<DebugState>()),
      captures(std::make_unique<CaptureUse>()),
      memory(std::make_unique<MemoryUse>()),
      assembly(std::make_unique<AssemblyUse>()),
      at_once_(*table),
      share_(std::move(share)) {
    for (auto& stack : texture_stacks) stack.limit = 10;
    for (auto& stack : program_stacks) stack.limit = kProgramStackLimit;
    {
        std::lock_guard lock(share_->mutex);
        if (!share_->labels) share_->labels = std::make_shared<ObjectLabels>();
    }
    glstate::assign<glstate::el::debug_output>(state, 0, profile.debug);
    set_first_state();
}

// What such a context always has or begins with, and the nodes' drivers, whose contexts are of OpenGL's compatibility
// profile, have to be told.
void Context::set_first_state() {
    namespace el = glstate::el;
    if (profile.has_begin()) return;
    glstate::assign<el::clamp_vertex_color>(state, 0, GL_FALSE);
    glstate::assign<el::clamp_fragment_color>(state, 0, GL_FALSE);
    if (profile.is_es()) glstate::assign<el::framebuffer_srgb>(state, 0, 1);
    if (profile.is_es1())  // GL_OES_texture_cube_map
        for (unsigned i = 0; i < el::tex_gen_mode::count; ++i)
            glstate::assign<el::tex_gen_mode>(state, i, GL_REFLECTION_MAP);
    if (profile.has_fixed_function()) return;
    glstate::assign<el::point_sprite>(state, 0, 1);
    if (!profile.is_es()) return;
    glstate::assign<el::program_point_size>(state, 0, 1);
    glstate::assign<el::texture_cube_map_seamless>(state, 0, 1);
}

Context::~Context() = default;

void Context::bind_surfaces(std::shared_ptr<ClientSurface> draw, std::shared_ptr<ClientSurface> read) {
    draw_ = std::move(draw);
    read_ = std::move(read);
    for (const auto& surface : {draw_, read_})
        if (surface && !surface->srgb) surface->srgb = surface->options.format.srgb || !profile.is_es();
    if (!used_ && draw_ && !has_no_surface()) first_use();
}

bool Context::has_no_surface() const { return draw_ && draw_->options.stands_for_none; }

// OpenGL 1.2.1, 2.10.2 and 4.1.2: viewport and scissor start with the size of the first window.
void Context::first_use() {
    used_ = true;
    const auto width = static_cast<std::int32_t>(draw_->layout.width),
               height = static_cast<std::int32_t>(draw_->layout.height);
    glstate::assign<glstate::el::viewport>(state, 0, {0, 0, static_cast<float>(width), static_cast<float>(height)});
    glstate::assign<glstate::el::scissor>(state, 0, {0, 0, width, height});
    const GLenum buffer = draw_->options.format.double_buffered ? GL_BACK : GL_FRONT;
    glstate::assign<glstate::el::draw_buffer>(state, 0, buffer);
    glstate::assign<glstate::el::read_buffer>(state, 0, buffer);
}

namespace {

/// Of what a projection depends on.
std::array<std::uint64_t, 5> projection_ids(const glstate::State& state) {
    using glstate::Category;
    const auto id = [&](Category category) { return state.ids[static_cast<std::size_t>(category)]; };
    return {id(Category::matrix), id(Category::window), id(Category::line_point), id(Category::transform),
            id(Category::polygon)};
}

}  // namespace

const glstate::Projection& Context::projection() {
    const auto ids = projection_ids(state);
    if (ids != projection_ids_) {
        projection_ = make_projection(state);
        projection_ids_ = ids;
    }
    return projection_;
}

const Placing& Context::placing() {
    const glstate::Projection& fixed_function = projection();
    const auto as_in_fixed_function = [&] { placing_ = {true, 0, true, fixed_function, true}; };
    if (!shades_vertices()) {
        if (is_placed_anew({0, projection_ids_, 0})) as_in_fixed_function();
        return placing_;
    }
    std::lock_guard lock(share_->mutex);
    if (draws_with_assembly(state, program.get(), glapi::AssemblyStage::vertex)) {
        AssemblyProgram* drawn = assembly->program(*share_, glapi::AssemblyStage::vertex);
        const auto environment = state.ids[static_cast<std::size_t>(glstate::Category::program_environment)];
        if (!is_placed_anew({drawn ? drawn->latest() : 0, projection_ids_, environment})) return placing_;
        if (!drawn || drawn->reflection().invariant) {
            as_in_fixed_function();
        } else {
            glstate::set_environment(drawn->position(), state);
            place(drawn->position(), glapi::position_attribute(drawn->reflection().position));
        }
        return placing_;
    }
    Executable& executable = *program->executable;
    if (is_placed_anew({executable.last_change, projection_ids_, 0}))
        place(executable.position(), executable.position_attribute());
    return placing_;
}

void Context::place(glapi::LinkedPosition& position, GLint attribute) {
    placing_ = {false, 0, true, glstate::unknown_projection(), true};
    const auto* transform = position.transform(state.matrix.modelview, state.matrix.projection);
    if (transform != nullptr && attribute >= 0)
        placing_ = {true, static_cast<std::uint32_t>(attribute), transform->homogeneous(),
                    make_projection(projection_, *transform, position.program().depth), transform->steady()};
    glstate::Projection& projection = placing_.projection;
    glstate::set_camera(projection, position.camera(state.matrix.projection));
    projection.unknown_elsewhere = projection.unknown_elsewhere || position.camera_is_named();
}

void Context::forget_object(ClientName gone) {
    if (!session_) return;
    before_change(gone);
    session_->delete_object(id, gone);
}

void Context::report_error(GLenum code, const char* where) {
    const bool logged = log_enabled(LogLevel::debug);
    if (!logged && !state.local.debug_output) return;
    DebugMessage message = error_message(code, where);
    if (logged) log(LogLevel::debug, "opengl_error %s", message.text.c_str());
    if (!state.local.debug_output) return;
    debug->untold.push_back(std::move(message));
    has_untold_ = true;
}

void Context::tell() {
    has_untold_ = false;
    for (DebugMessage& message : std::exchange(debug->untold, {})) debug->log.say(std::move(message));
}

void Context::begin_primitive(GLenum mode) {
    packer.begin(mode);
    if (shades_vertices() && !placing().of_vertices()) packer.mark_unbounded();
    if (at_once()) table = &tables::inside_begin;
}

void Context::end_primitive() {
    if (shades_vertices() && !places_packed_vertices())
        packer.mark_unbounded();  // of what are no positions, they may be no numbers
    packer.end();
    if (table == &tables::inside_begin) table = &at_once_;
    if (packer.take_overflow()) {
        complain_once("one glBegin .. glEnd or draw is larger than can be carried to a node; it was left out", "block");
        error(GL_OUT_OF_MEMORY);
    }
    if (packer.bytes() > kBlockBytes && !packer.closed()) flush_block();
}

bool Context::places_packed_vertices() {
    const Placing& now = placing();
    return now.of_vertices() && (now.homogeneous || !packer.has_w());
}

void Context::determine_modelview_form() {
    if (!(modelview_stack.form & form::kUnknown)) return;
    FormedMatrix top{state.matrix.modelview, modelview_stack.form, modelview_stack.origin};
    determine_form(top);
    modelview_stack.form = top.form;
    modelview_stack.origin = top.origin;
}

/// If another thread has linked the program anew meanwhile, boxes that were known may not be so any more. Sending a
/// block leaves its attributes in the state; each pass begins with those of before.
void Context::submit_geometry() {
    const bool known = !shades_vertices() || places_packed_vertices();
    const auto submit = [&] {
        const bool somewhere = known && captures->now == nullptr;  // what is captured is captured everywhere
        const glstate::Projection& placed = placing().projection;
        session_->submit_block(draw_source(), packer, somewhere ? placed : glstate::unknown_projection(placed.camera));
    };
    if (!captures->captures() && !state.local.rasterizer_discard) return submit();
    const glstate::State before = state;
    draw_in_passes(state, *captures, [&] {
        const auto objects = state.objects;
        constexpr auto kObjects = static_cast<std::size_t>(glstate::Category::objects);
        const auto kept_id = state.ids[kObjects];
        state = before;
        state.objects = objects;
        state.ids.take(kObjects, kept_id);
        submit();
    });
    state = before;
    fold_block(packer, state);
}

void Context::submit_block() {
    if (packer.has_geometry()) determine_modelview_form();
    if (packer.inside())
        return;  // only commands that are legal inside come here then, and they change nothing that is drawn with
    try {
        if (packer.has_geometry() && !draws_nothing) submit_geometry();
        else fold_block(packer, state);
    } catch (...) {  // the geometry is lost, what it set is not
        fold_block(packer, state);
        packer.reset();
        throw;
    }
    packer.reset();
}

void Context::lose() {
    lost_ = true;
    packer.reset();
}

const Caps& Context::caps() const {
    static const Caps kNone;
    return session_ ? session_->caps() : kNone;
}

}  // namespace wall::client
