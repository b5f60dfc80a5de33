// SPDX-License-Identifier: MIT
#include "client_lib/context/context.h"

#include <algorithm>

#include "client_lib/context/attribute_stack.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/lists.h"
#include "client_lib/context/material.h"
#include "client_lib/context/occlusion.h"
#include "client_lib/context/program_use.h"
#include "client_lib/context/share_group.h"
#include "client_lib/follow/block_sender.h"
#include "client_lib/geometry/select.h"
#include "client_lib/objects/maps.h"
#include "client_lib/process/guard.h"
#include "client_lib/process/log.h"

namespace wall::client {

constinit thread_local Context* tls_context = nullptr;
constinit thread_local Packer* tls_packer = nullptr;

Context::Context(std::shared_ptr<ShareGroup> share, const ContextOptions&)
    : id(next_context_id()),
      table(&tables::immediate),
      lists(std::make_unique<ListState>()),
      attributes(std::make_unique<AttributeStacks>()),
      select(std::make_unique<SelectState>()),
      maps(std::make_unique<ContextMaps>()),
      buffers(std::make_unique<BufferUse>()),
      occlusion(std::make_unique<OcclusionState>()),
      share_(std::move(share)) {
    for (auto& stack : texture_stacks) stack.limit = 10;
}

Context::~Context() {
    if (!session_) return;
    try {
        if (program) use_program(*this, nullptr);
        session_->destroy_context(id);
    } catch (...) {
        caught_exception("the end of a context");
    }
}

void Context::bind_surfaces(std::shared_ptr<ClientSurface> draw, std::shared_ptr<ClientSurface> read) {
    draw_ = std::move(draw);
    read_ = std::move(read);
    if (!used_ && draw_) first_use();
}

// OpenGL 1.2.1, 2.10.2 and 4.1.2: viewport and scissor start with the size of the first window.
void Context::first_use() {
    used_ = true;
    const auto width = static_cast<std::int32_t>(draw_->layout.width),
               height = static_cast<std::int32_t>(draw_->layout.height);
    glstate::assign<glstate::el::viewport>(state, 0, {0, 0, width, height});
    glstate::assign<glstate::el::scissor>(state, 0, {0, 0, width, height});
    const GLenum buffer = draw_->options.format.double_buffered ? GL_BACK : GL_FRONT;
    glstate::assign<glstate::el::draw_buffer>(state, 0, buffer);
    glstate::assign<glstate::el::read_buffer>(state, 0, buffer);
}

const Projection& Context::projection() {
    using glstate::Category;
    const std::array<std::uint64_t, 3> ids = {state.ids[static_cast<std::size_t>(Category::matrix)],
                                              state.ids[static_cast<std::size_t>(Category::window)],
                                              state.ids[static_cast<std::size_t>(Category::line_point)]};
    if (ids != projection_ids_) {
        projection_ = make_projection(state);
        projection_ids_ = ids;
    }
    return projection_;
}

const SurfaceLayout& Context::draw_layout() const { return select->layout ? *select->layout : draw_->layout; }

void Context::begin_primitive(GLenum mode) {
    packer.begin(mode);
    if (program) packer.mark_unbounded();  // its shader puts the vertices anywhere
    if (table == &tables::immediate) table = &tables::inside_begin;
}

void Context::end_primitive() {
    packer.end();
    if (table == &tables::inside_begin) table = &tables::immediate;
    if (packer.take_overflow()) {
        complain_once("one glBegin .. glEnd or draw is larger than can be carried to a node; it was left out", "block");
        error(GL_OUT_OF_MEMORY);
    }
    if (packer.bytes() > kBlockBytes && !packer.closed()) flush_block();
}

void Context::determine_modelview_form() {
    if (!(modelview_stack.form & form::kUnknown)) return;
    FormedMatrix top{state.matrix.modelview, modelview_stack.form, modelview_stack.origin};
    determine_form(top);
    modelview_stack.form = top.form;
    modelview_stack.origin = top.origin;
}

void Context::submit_block() {
    if (packer.has_geometry()) determine_modelview_form();
    if (packer.inside())
        return;  // only commands that are legal inside come here then, and they change nothing that is drawn with
    try {
        if (packer.has_geometry()) session_->submit_block(*this);
        else fold_attributes();
    } catch (...) {  // the geometry is lost, what it set is not
        fold_attributes();
        forget_block();
        throw;
    }
    forget_block();
}

void Context::forget_block() {
    packer.reset();
    pending_materials.clear();
}

void Context::lose() {
    lost_ = true;
    forget_block();
}

// Attributes go from the packed block to `state` (T3.2).
void Context::fold_attributes() {
    bool changed = false;
    for (std::size_t i = 0; i < kAttributes; ++i) {
        if (!packer.last[i]) continue;
        glstate::apply_attribute(state, packer.last_op[i], packer.last[i]);
        changed = true;
    }
    if (changed) state.ids[static_cast<std::size_t>(glstate::Category::current)] = glstate::next_value_id();
    folded_material_ = !pending_materials.empty();
    for (const PendingMaterial& material : pending_materials)
        assign_material(state, material.face, material.pname, material.value);
}

}  // namespace wall::client
