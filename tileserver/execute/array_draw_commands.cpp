// SPDX-License-Identifier: MIT
#include "tileserver/execute/array_draw_commands.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/glapi/primitive.h"
#include "common/glstate/view_change.h"
#include "tileserver/execute/free_order.h"
#include "tileserver/objects/assembly_program.h"
#include "tileserver/objects/buffer.h"
#include "tileserver/objects/draw_pieces.h"
#include "tileserver/objects/program.h"
#include "tileserver/session/shader_memory.h"

namespace wall::tileserver {
namespace {

const void* offset_pointer(std::uint64_t offset) {
    return reinterpret_cast<const void*>(static_cast<std::uintptr_t>(offset));
}

bool draws_lines(GLenum mode, const glstate::State& state) {
    const auto& fill = state.polygon.polygon_mode;
    return mode == GL_LINES || mode == GL_LINE_STRIP || fill[0] == GL_LINE || fill[1] == GL_LINE;
}

}  // namespace

bool ArrayDrawCommands::may_be_cut(GLenum mode) const {
    const glstate::State& state = execution_.context->state;
    if (execution_.modes.mode() != GL_RENDER) return false;
    return !state.line_point.line_stipple_enabled || !draws_lines(mode, state);  // its counter runs along the draw
}

std::optional<glstate::Projection> ArrayDrawCommands::projection() const {
    const glstate::State& state = execution_.context->state;
    const glstate::Projection fixed_function = glstate::make_projection(state);
    const ClientName name(state.objects.current_program);
    Program* program = name ? execution_.session.objects.find<Program>(name) : nullptr;
    if (program != nullptr) return program->project(fixed_function, state);
    if (state.objects.vertex_program_enabled == 0) return fixed_function;
    const ClientName assembly(state.objects.vertex_program);
    AssemblyProgram* found = assembly ? execution_.session.objects.find<AssemblyProgram>(assembly) : nullptr;
    return found != nullptr ? found->project(fixed_function, state) : std::nullopt;
}

VertexInput* ArrayDrawCommands::begin(ClientName name, GLenum mode, std::int32_t count) {
    if (block_.in_begin) return execution_.refuse("between Begin and End"), nullptr;
    const auto input = execution_.session.objects.get<VertexInput>(name);
    if (!input) return execution_.refuse(input.error().message), nullptr;
    if (!glapi::is_primitive(mode) || count < 0)
        return execution_.refuse("no such primitive, or fewer than no elements"), nullptr;
    if (!block_.draws || count == 0) return nullptr;
    execution_.node.driver.bind_vertex_array((*input)->name());
    return *input;
}

void ArrayDrawCommands::find_runs(ClientName name, std::int32_t count, GLenum mode) {
    firsts_.clear();
    counts_.clear();
    const auto add = [&](std::uint32_t first, std::uint32_t elements) {
        firsts_.push_back(static_cast<GLint>(first));
        counts_.push_back(static_cast<GLsizei>(elements));
    };
    const auto all = static_cast<std::uint32_t>(count);
    const auto range = std::exchange(execution_.pieces, {});
    if (!name || (range.behind == 0 && !may_be_cut(mode))) return add(0, all);
    const auto found = execution_.session.objects.get<DrawPieces>(name);
    if (!found) return execution_.refuse(found.error().message);
    const DrawPieces& pieces = **found;
    if ((all + pieces.cut().step - 1) / pieces.cut().step != pieces.boxes().size())
        return execution_.refuse("pieces of another draw");
    const auto count_of_pieces = static_cast<std::uint32_t>(pieces.boxes().size());
    const std::uint32_t behind = range.behind != 0 ? std::min(range.behind, count_of_pieces) : count_of_pieces;
    const std::uint32_t begin = std::min(range.first, behind), offset = begin * pieces.cut().step;
    const auto add_wanted = [&](auto&& wanted) {
        glstate::for_each_run(pieces.cut(), pieces.boxes().subspan(begin, behind - begin), all - offset, wanted,
                              [&](std::uint32_t first, std::uint32_t elements) { add(first + offset, elements); });
    };
    const auto any = [](const geom::Box&) { return true; };
    const LayerGeometry& layer = block_.target->geometry();
    auto projection = this->projection();
    if (!projection || !may_be_cut(mode)) return add_wanted(any);
    if (layer.view && projection->anywhere_in_views()) return add_wanted(any);
    if (const auto change = layer.view ? glstate::view_change(*layer.view, projection->camera) : std::nullopt)
        projection = glstate::seen(*projection, glstate::narrow(*change));
    const geom::PixelRect area = layer.window_area();
    const auto wanted = [&](const geom::Box& box) {
        const auto rect = glstate::project(*projection, box, mode);
        return !rect || rect->overlaps(area);
    };
    add_wanted(wanted);
}

void ArrayDrawCommands::count_runs() {
    for (const GLsizei count : counts_) count_elements(static_cast<std::uint64_t>(count));
}

void ArrayDrawCommands::DrawArrays(ClientName name, ClientName pieces, GLenum mode, std::int32_t first,
                                   std::int32_t count) {
    VertexInput* input = begin(name, mode, count);
    if (input == nullptr || !has_elements(*input, first, count)) return;
    find_runs(pieces, count, mode);
    count_runs();
    for (GLint& run : firsts_) run += first;
    execution_.gl.MultiDrawArrays(mode, firsts_.data(), counts_.data(), static_cast<GLsizei>(counts_.size()));
}

bool ArrayDrawCommands::has_elements(VertexInput& input, std::int32_t first, std::int32_t count) {
    if (first < 0) return execution_.refuse("no such elements"), false;
    const std::uint64_t behind = static_cast<std::uint64_t>(first) + static_cast<std::uint64_t>(count);
    // Another thread of the program may have made a buffer smaller since the client has looked.
    if (behind <= input.elements(execution_.session.objects)) return true;
    ++execution_.session.work.gl_errors;
    return false;
}

bool ArrayDrawCommands::has_indices(VertexInput& input, std::int32_t count, GLenum type, std::uint32_t offset) {
    const auto bytes = input.index_bytes(execution_.session.objects);
    if (!bytes) return execution_.refuse("the buffer of the input's indices is not there"), false;
    const std::size_t one = glstate::index_bytes(type);
    if (one == 0 || offset % one != 0) return execution_.refuse("no such indices"), false;
    // Another thread of the program may have made the buffer smaller since the client has looked.
    if (offset + static_cast<std::uint64_t>(count) * one <= *bytes) return true;
    ++execution_.session.work.gl_errors;
    return false;
}

std::optional<std::int32_t> ArrayDrawCommands::count_indices(GLenum type, std::span<const std::byte> indices) {
    const std::size_t one = glstate::index_bytes(type);
    if (one == 0 || indices.size() % one != 0 || indices.size() / one > std::numeric_limits<std::int32_t>::max()) {
        execution_.refuse("no such indices");
        return std::nullopt;
    }
    return static_cast<std::int32_t>(indices.size() / one);
}

void ArrayDrawCommands::DrawElements(ClientName name, ClientName pieces, GLenum mode, std::int32_t count, GLenum type,
                                     std::uint32_t offset, std::int32_t base_vertex) {
    VertexInput* input = begin(name, mode, count);
    if (input == nullptr || !has_indices(*input, count, type, offset)) return;
    find_runs(pieces, count, mode);
    count_runs();
    GLuint ordered = 0;
    if (execution_.node.orders_triangles && draws_in_any_order(mode))
        ordered = in_order(*input, pieces, {type, offset, static_cast<std::uint32_t>(count), 0});
    const std::size_t one = glstate::index_bytes(type);
    places_.clear();
    for (const GLint first : firsts_)
        places_.push_back(offset_pointer((ordered != 0 ? 0 : offset) + static_cast<std::uint64_t>(first) * one));
    base_vertices_.assign(places_.size(), base_vertex);
    if (ordered != 0) execution_.gl.VertexArrayElementBuffer(input->name(), ordered);
    execution_.gl.MultiDrawElementsBaseVertex(mode, counts_.data(), type, places_.data(),
                                              static_cast<GLsizei>(counts_.size()), base_vertices_.data());
    if (ordered != 0)
        execution_.gl.VertexArrayElementBuffer(input->name(),
                                               execution_.session.objects.find<Buffer>(input->indices())->name());
}

bool ArrayDrawCommands::draws_in_any_order(GLenum mode) const {
    const glstate::State& state = execution_.context->state;
    if (mode != GL_TRIANGLES || execution_.modes.mode() != GL_RENDER) return false;
    if (!order_is_free(state) || !block_.target->has_depth()) return false;
    bool free = true;
    for_each_program(execution_.session, state,
                     [&](const Program& program) { free = free && program.draws_in_any_order(); });
    return free;
}

/// As a whole, where all of it is drawn; else each piece for itself.
GLuint ArrayDrawCommands::in_order(const VertexInput& input, ClientName pieces, const IndexRange& all) const {
    Buffer* const buffer = execution_.session.objects.find<Buffer>(input.indices());
    if (buffer == nullptr || counts_.empty()) return 0;
    IndexRange range = all;
    const bool whole = counts_.size() == 1 && counts_.front() == static_cast<GLsizei>(all.count);
    if (!whole) range.step = execution_.session.objects.find<DrawPieces>(pieces)->cut().step;
    return buffer->in_order(range);
}

void ArrayDrawCommands::DrawIndices(ClientName name, GLenum mode, GLenum type, std::int32_t base_vertex,
                                    std::span<const std::byte> indices) {
    const auto count = count_indices(type, indices);
    const VertexInput* input = count ? begin(name, mode, *count) : nullptr;
    if (input == nullptr) return;
    if (input->indices()) return execution_.refuse("the input's indices lie in a buffer");
    count_elements(static_cast<std::uint64_t>(*count));
    execution_.gl.DrawElementsBaseVertex(mode, *count, type, indices.data(), base_vertex);
}

}  // namespace wall::tileserver
