// SPDX-License-Identifier: MIT
#include "client_lib/context/node_draw.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/captured_content.h"
#include "client_lib/context/element_bounds.h"
#include "client_lib/context/forget_objects.h"
#include "client_lib/context/program_use.h"
#include "client_lib/context/vertex_inputs.h"
#include "client_lib/follow/object_sender.h"
#include "client_lib/objects/share_group.h"
#include "common/glstate/draw_buffers.h"

namespace wall::client {
namespace {

/// One draw on its way.
class NodeDraw {
public:
    NodeDraw(Context& c, VertexInput& input, const ArrayDraw& draw)
        : c_(c),
          input_(input),
          draw_(draw),
          placing_(c.placing()),
          bounded_(find_bounding_array()),
          range_{draw.mode,
                 draw.index_type,
                 place(),
                 draw.count,
                 draw.base_vertex,
                 restart_key(draw),
                 static_cast<std::uint32_t>(array_.value_or(0))} {}

    /// Whether nothing has to be found out: it was found to suit before, and no buffer has changed since.
    bool known_to_suit();
    /// Before suits(): what the program has written into persistent mappings of what is drawn is a change.
    void find_written();
    /// Whether the nodes can draw it from their buffers and should.
    bool suits() {
        std::lock_guard lock(c_.share().mutex);
        if (input_.facts().blocked) return false;  // it changes meanwhile
        if (!input_.positions()) return suits_without_positions();
        known_ = in_buffers();
        if (known_ == nullptr) return false;
        if (input_.facts().drawn) return know_no_bounds(), true;  // nobody else has it
        const bool worth = worth_keeping();
        // In a block of vertices there are no instances, no numbers, and no doubles.
        return worth || draw_.instances != 1 || input_.has_doubles() ||
               (c_.program && c_.program->executable->reads_numbers());
    }
    /// A program may make of gl_VertexID what it likes. In fixed function all vertices have the current attribute then.
    bool suits_without_positions() {
        const InputFacts& facts = input_.facts();
        if (!c_.shades_vertices() || indexed() || facts.written_unseen) return false;
        if (facts.instances < static_cast<std::uint64_t>(draw_.instances)) return false;
        once_.box.make_unbounded();
        known_ = bounded_ && array_ && !facts.drawn ? &known_bounds() : &once_;
        return std::uint64_t{range_.first} + static_cast<std::uint64_t>(draw_.count) <= facts.elements;
    }
    /// Instead, if the input was made for this draw.
    void know_all_of_it() {
        std::lock_guard lock(c_.share().mutex);
        if (array_ && of_each_vertex(*array_)) once_.box = bounds(draw_.indices, {}).box;
        else once_.box.make_unbounded();
        known_ = &once_;
    }
    void send();

    // ---- what it names (named_objects.h) ----
    bool are_on(const Node& node) const { return !cut() && node.brought.has(input_.id, latest_); }
    template <class Use>
    void for_each(Use&& use) const {
        for (const auto& buffer : input_.buffers()) use(*buffer);
        use(input_);
        if (cut()) use(*known_->pieces);
    }
    void note_on(Node& node) const { node.brought.note(input_.id, latest_); }
    void note_drawn(Node&) const {}

private:
    void send_once();
    static std::uint64_t restart_key(const ArrayDraw& draw) {
        return draw.index_type != 0 && draw.restart ? std::uint64_t{1} << 32 | *draw.restart : 0;
    }
    /// More than what most draws are.
    bool special() const { return draw_.instances != 1 || range_.restart != 0; }
    /// A shader may put the vertices anywhere.
    bool cut() const {
        return known_->cut && bounded_ && !special() && c_.captures->now == nullptr &&
               !glstate::counts_primitives(c_.state);
    }
    /// Not one value for a whole instance.
    bool of_each_vertex(std::size_t array) const { return input_.definition().arrays[array].divisor == 0; }
    bool find_bounding_array();
    bool in_memory() const { return indexed() && input_.indices() == nullptr; }  ///< the indices
    std::span<const std::byte> indices() const {
        return {static_cast<const std::byte*>(draw_.indices),
                static_cast<std::size_t>(draw_.count) * glstate::index_bytes(draw_.index_type)};
    }
    bool indexed() const { return draw_.index_type != 0; }
    std::uint32_t place() const {
        return indexed() ? static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(draw_.indices))
                         : static_cast<std::uint32_t>(draw_.first);
    }
    const RangeBounds* in_buffers();
    void know_no_bounds();
    /// Whether the indices lie in their buffer.
    bool indices_in_buffer() const;
    /// The lowest and the highest element; nothing: they are not in the buffers.
    std::optional<std::pair<std::uint32_t, std::uint32_t>> elements();
    ElementBounds bounds(const void* indices, const std::optional<glstate::Cut>& cut) const;
    RangeBounds& known_bounds();
    /// What VertexInput::count_drawn() is told.
    std::uint64_t drawn_elements() const {
        return static_cast<std::uint64_t>(draw_.count) * static_cast<std::uint64_t>(draw_.instances);
    }
    /// What cannot be bounded as vertices of a block would go to all nodes.
    std::uint64_t copies(std::uint64_t nodes) const { return placing_.of_vertices() ? 1 : nodes; }
    std::uint64_t nodes() const { return static_cast<std::uint64_t>(count_nodes(c_.draw_target().layers())); }
    bool worth_keeping() { return input_.count_drawn(drawn_elements(), copies(nodes()), nodes()); }
    Needs needs() const;
    std::uint64_t latest_of_input() const;
    void pack(wire::PackBuffer& buffer) const;
    void pack_special(wire::PackBuffer& buffer) const;

    Context& c_;
    VertexInput& input_;
    const ArrayDraw& draw_;
    const Placing& placing_;
    std::optional<std::size_t> array_;  ///< that has the positions
    const bool bounded_;                ///< whether the box around them tells where they are drawn
    DrawnRange range_;
    const RangeBounds* known_ = nullptr;
    std::uint64_t latest_ = 0;  ///< InputFacts::latest as it is sent
    RangeBounds once_;          ///< of indices that are not in a buffer: nobody knows whether they are those of before
};

/// What places the vertices may be known to the nodes only.
void NodeDraw::know_no_bounds() {
    once_.box.make_unbounded();
    once_.cut = false;
    known_ = &once_;
}

bool NodeDraw::find_bounding_array() {
    array_ = input_.position_array();
    if (!c_.program) return true;
    const auto found = placing_.known ? input_.array_of_generic(placing_.attribute) : std::nullopt;
    if (!found || !of_each_vertex(*found)) return false;
    const glstate::InputArray& array = input_.definition().arrays[*found];
    if (array.reaches_as != glstate::kAsFloats || array.size == GL_BGRA) return false;
    array_ = found;
    return true;
}

bool NodeDraw::indices_in_buffer() const {
    const auto offset = reinterpret_cast<std::uintptr_t>(draw_.indices);
    const std::size_t size = input_.indices()->size(), one = glstate::index_bytes(draw_.index_type);
    return offset % one == 0 && offset <= size && static_cast<std::size_t>(draw_.count) <= (size - offset) / one;
}

std::optional<std::pair<std::uint32_t, std::uint32_t>> NodeDraw::elements() {
    if (!indexed()) {
        const auto count = static_cast<std::uint32_t>(draw_.count);
        return std::pair{range_.first, range_.first + count - 1};
    }
    if (!in_memory()) {
        if (!indices_in_buffer()) return std::nullopt;
        const RangeBounds& known = input_.bounds_of(range_);
        if (known.indices != 0 && known.indices == input_.indices()->latest())
            return std::pair{known.first_element, known.last_element};
    }
    const void* indices = in_memory() ? draw_.indices : input_.indices()->data() + range_.first;
    const ElementBounds found = bounds(indices, {});
    return std::pair{found.first, found.last};
}

void NodeDraw::find_written() {
    std::vector<ClientName> changed;
    {
        std::lock_guard lock(c_.share().mutex);
        if (!input_.facts().written_unseen || !input_.positions() || input_.facts().elements == 0) return;
        if (indexed() && !in_memory() && indices_in_buffer() && input_.indices()->written_unseen()) {
            const std::size_t bytes = glstate::index_bytes(draw_.index_type) * static_cast<std::size_t>(draw_.count);
            if (input_.find_written_indices({range_.first, range_.first + bytes}))
                changed.push_back(input_.indices()->id);
        }
        if (const auto drawn = elements(); drawn && drawn->second < input_.facts().elements) {
            const auto in_arrays = input_.find_written(drawn->first, drawn->second);
            changed.insert(changed.end(), in_arrays.begin(), in_arrays.end());
        }
    }
    for (const ClientName id : changed) c_.before_change(id);
}

/// What is known of the draw, if all indices and all elements that they name lie in the buffers; else null.
const RangeBounds* NodeDraw::in_buffers() {
    const InputFacts facts = input_.facts();
    if (facts.elements == 0 || !of_each_vertex(*input_.position_array())) return nullptr;
    if (facts.instances < static_cast<std::uint64_t>(draw_.instances)) return nullptr;
    const auto lies_within = [&](RangeBounds& known) {
        known.found_within = facts.as_of;
        return &known;
    };
    if (!indexed()) {
        const bool within = std::uint64_t{range_.first} + static_cast<std::uint64_t>(draw_.count) <= facts.elements;
        return within ? lies_within(known_bounds()) : nullptr;
    }
    if (in_memory()) {
        const ElementBounds of_draw = bounds(draw_.indices, {});
        once_.box = of_draw.box;
        return of_draw.last < facts.elements ? &once_ : nullptr;
    }
    if (!indices_in_buffer()) return nullptr;
    RangeBounds& known = known_bounds();
    return known.last_element < facts.elements ? lies_within(known) : nullptr;
}

bool NodeDraw::known_to_suit() {
    if (!input_.settled() || !input_.facts().plain() || in_memory() || !input_.positions()) return false;
    if (input_.facts().instances < static_cast<std::uint64_t>(draw_.instances)) return false;
    const RangeBounds& known = input_.bounds_of(range_);
    if (known.found_within != input_.facts().as_of) return false;
    known_ = &known;
    const std::uint64_t reached = nodes();
    input_.count_drawn_later(drawn_elements(), copies(reached), reached);
    return true;
}

ElementBounds NodeDraw::bounds(const void* indices, const std::optional<glstate::Cut>& cut) const {
    const glstate::InputArray& array = input_.definition().arrays[*array_];
    const BufferReading content = input_.buffers()[*array_]->read(array.offset);
    ElementRange elements;
    elements.first = draw_.first;
    elements.count = draw_.count;
    elements.type = draw_.index_type;
    elements.indices = indices;
    elements.base_vertex = draw_.base_vertex;
    elements.restart = draw_.restart;
    return bounds_of(array_source(array, content.bytes()), elements, cut);
}

RangeBounds& NodeDraw::known_bounds() {
    RangeBounds& known = input_.bounds_of(range_);
    const std::uint64_t positions = input_.buffers()[*array_]->latest(),
                        indices = indexed() ? input_.indices()->latest() : 0;
    if (known.positions == positions && known.indices == indices) return known;
    // Where primitives begin anew the pieces would not be whole ones.
    const auto cut =
        range_.restart == 0 ? glstate::cut_of(draw_.mode, static_cast<std::uint32_t>(draw_.count)) : std::nullopt;
    ElementBounds found = bounds(indexed() ? input_.indices()->data() + range_.first : nullptr, cut);
    known = {positions, indices, 0, found.box, found.first, found.last, std::move(known.pieces), !found.pieces.empty()};
    if (!known.cut) return known;
    if (!known.pieces) {
        known.pieces = std::make_shared<DrawPieces>();
        c_.share().by_id[known.pieces->id] = known.pieces;
    }
    known.pieces->define(*cut, std::move(found.pieces));
    return known;
}

/// The current value of an attribute that has an array is not looked at.
Needs NodeDraw::needs() const {
    Needs needs = needs_of_geometry(c_.state);
    for (const glstate::InputArray& array : input_.definition().arrays)
        if (array.place < kAttributes) needs.spare(static_cast<Attribute>(array.place));
    return needs;
}

void NodeDraw::send() {
    if (!may_draw(c_) || c_.draws_nothing) return;
    c_.determine_modelview_form();
    draw_in_passes(c_.state, *c_.captures, [&] { send_once(); });
}

/// What is captured is captured everywhere.
void NodeDraw::send_once() {
    const bool bounded = bounded_ && c_.captures->now == nullptr;
    const glstate::Projection& by = placing_.projection;
    Drawn drawn = bounded ? Drawn(by, known_->box, draw_.mode) : Drawn::anywhere(by);
    drawn.elements = static_cast<double>(drawn_elements());
    if (cut() && !c_.state.line_point.line_stipple_enabled)
        drawn.pieces = static_cast<std::uint32_t>(known_->pieces->count());
    latest_ = latest_of_input();
    c_.session().draw(c_.draw_source(), drawn, needs(), *this, [&](wire::PackBuffer& buffer) { pack(buffer); });
}

std::uint64_t NodeDraw::latest_of_input() const {
    if (input_.settled()) return input_.facts().latest;
    std::lock_guard lock(c_.share().mutex);
    return input_.facts().latest;
}

void NodeDraw::pack(wire::PackBuffer& buffer) const {
    if (special()) return pack_special(buffer);
    if (in_memory())
        return glapi::pack::DrawIndices(buffer, input_.id, draw_.mode, draw_.index_type, draw_.base_vertex, indices());
    const ClientName pieces = cut() ? known_->pieces->id : ClientName();
    if (indexed())
        glapi::pack::DrawElements(buffer, input_.id, pieces, draw_.mode, draw_.count, draw_.index_type, range_.first,
                                  draw_.base_vertex);
    else glapi::pack::DrawArrays(buffer, input_.id, pieces, draw_.mode, draw_.first, draw_.count);
}

void NodeDraw::pack_special(wire::PackBuffer& buffer) const {
    const bool restarts = range_.restart != 0;
    const GLuint restart = restarts ? *draw_.restart : 0;
    if (!indexed())
        glapi::pack::DrawArraysInstanced(buffer, input_.id, draw_.mode, draw_.first, draw_.count, draw_.instances);
    else if (in_memory())
        glapi::pack::DrawIndicesInstanced(buffer, input_.id, draw_.mode, draw_.index_type, draw_.base_vertex,
                                          draw_.instances, restarts, restart, indices());
    else
        glapi::pack::DrawElementsInstanced(buffer, input_.id, draw_.mode, draw_.count, draw_.index_type, range_.first,
                                           draw_.base_vertex, draw_.instances, restarts, restart);
}

/// Indices in the program's memory, of a size that a command of the stream can have.
bool may_come_along(const ArrayDraw& draw) {
    const std::size_t bytes = static_cast<std::size_t>(draw.count) * glstate::index_bytes(draw.index_type);
    return draw.indices != nullptr && bytes <= kLargestIndices;
}

}  // namespace

ElementRange elements_of(Context& c, const ArrayDraw& draw, GLsizei instance, BufferReading& reading) {
    ElementRange out{.first = draw.first,
                     .count = draw.count,
                     .type = draw.index_type,
                     .indices = draw.indices,
                     .base_vertex = draw.base_vertex,
                     .restart = draw.restart,
                     .instance = instance};
    const ClientName buffer(c.state.vertex_arrays.element_array_buffer);
    if (draw.index_type == 0 || !buffer) return out;
    reading = buffer_content(c, buffer, reinterpret_cast<std::uintptr_t>(draw.indices));
    const auto content = reading.bytes();
    const std::size_t have = content.size() / glstate::index_bytes(draw.index_type);
    out.indices = content.data();
    out.count = static_cast<GLsizei>(std::min<std::size_t>(static_cast<std::size_t>(draw.count), have));
    return out;
}

bool draw_on_nodes(Context& c, const ArrayDraw& draw) {
    if (!c.at_once() || !c.draw_target()) return false;
    const bool indexed = draw.index_type != 0, in_buffer = c.state.vertex_arrays.element_array_buffer != 0;
    if (indexed && !in_buffer && !may_come_along(draw)) return false;
    if (draw.count == 0 || draw.instances == 0) return true;
    if (buffers_were_deleted(c)) let_go_of_deleted_buffers(c);
    VertexInput* input = c.inputs->current(c.state, *c.buffers, c.share(), indexed && in_buffer);
    if (!input) return false;
    forget_inputs(c, c.inputs->take_unused());
    return draw_if_worth(c, *input, draw);
}

bool draw_if_worth(Context& c, VertexInput& input, const ArrayDraw& draw) {
    c.flush_block();
    if (input.has_too_many_ranges()) forget_ranges(c, input);
    const bool settled = input.settled() && input.facts().plain();
    if (!settled && draw.index_type != 0 && input.indices())
        fetch_captured(c, input.shared_indices(), "glDrawElements");  // the highest is looked for
    NodeDraw on_nodes(c, input, draw);
    if (!settled || !on_nodes.known_to_suit()) {
        on_nodes.find_written();
        if (!on_nodes.suits()) return false;
    }
    on_nodes.send();
    return true;
}

void draw_from(Context& c, VertexInput& input, const ArrayDraw& draw) {
    NodeDraw made(c, input, draw);
    made.know_all_of_it();
    made.send();
}

}  // namespace wall::client
