// SPDX-License-Identifier: MIT
#include "client_lib/context/node_draw.h"

#include <algorithm>
#include <optional>
#include <span>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/element_bounds.h"
#include "client_lib/context/forget_objects.h"
#include "client_lib/context/program_use.h"
#include "client_lib/context/vertex_inputs.h"
#include "client_lib/follow/object_sender.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/process/options.h"

namespace wall::client {
namespace {

constexpr std::size_t kLargestIndices = std::size_t{64} << 20;  // bytes that come along with a draw

/// One draw on its way.
class NodeDraw {
public:
    NodeDraw(Context& c, VertexInput& input, const ArrayDraw& draw) : c_(c), input_(input), draw_(draw) {}

    /// Whether the nodes can draw it from their buffers and should.
    bool suits() {
        std::lock_guard lock(c_.share().mutex);
        if (!input_.positions()) return false;  // all vertices have the current attribute then
        if (std::ranges::any_of(input_.buffers(), [](const auto& buffer) { return buffer->mapped; }))
            return false;  // it changes meanwhile
        range_ = {draw_.mode, draw_.index_type, place(), draw_.count};
        known_ = in_buffers();
        return known_ != nullptr && worth_keeping();
    }
    void send();

private:
    /// What a node must hold before it can draw this.
    template <class Use>
    void for_each_object(Use&& use) const {
        for (const auto& buffer : input_.buffers()) use(*buffer);
        use(input_);
        if (cut()) use(*known_->pieces);
    }
    /// A shader puts the vertices anywhere.
    bool cut() const { return known_->cut && !c_.program; }
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
    ElementBounds bounds(const void* indices, const std::optional<glstate::Cut>& cut) const;
    const RangeBounds& known_bounds();
    bool worth_keeping();
    Needs needs() const;
    void bring_objects(Node& node, wire::PackBuffer& buffer) const;
    void pack(wire::PackBuffer& buffer) const;

    Context& c_;
    VertexInput& input_;
    const ArrayDraw& draw_;
    DrawnRange range_;
    const RangeBounds* known_ = nullptr;
    RangeBounds once_;  ///< of indices that are not in a buffer: nobody knows whether they are those of before
};

/// What is known of the draw, if all indices and all elements that they name lie in the buffers; else null.
const RangeBounds* NodeDraw::in_buffers() {
    const std::uint64_t elements = input_.elements();
    if (elements == 0) return nullptr;
    if (!indexed()) {
        const bool within = std::uint64_t{range_.first} + static_cast<std::uint64_t>(draw_.count) <= elements;
        return within ? &known_bounds() : nullptr;
    }
    if (in_memory()) {
        const ElementBounds of_draw = bounds(draw_.indices, {});
        once_.box = of_draw.box;
        return of_draw.last < elements ? &once_ : nullptr;
    }
    const auto offset = reinterpret_cast<std::uintptr_t>(draw_.indices);
    const std::size_t size = input_.indices()->size(), one = glstate::index_bytes(draw_.index_type);
    if (offset % one != 0 || offset > size || static_cast<std::size_t>(draw_.count) > (size - offset) / one)
        return nullptr;
    const RangeBounds& known = known_bounds();
    return known.last_element < elements ? &known : nullptr;
}

ElementBounds NodeDraw::bounds(const void* indices, const std::optional<glstate::Cut>& cut) const {
    const BufferReading content = input_.position_buffer().read(input_.positions()->offset);
    ElementRange elements;
    elements.first = draw_.first;
    elements.count = draw_.count;
    elements.type = draw_.index_type;
    elements.indices = indices;
    return bounds_of(array_source(*input_.positions(), content.bytes()), elements, cut);
}

const RangeBounds& NodeDraw::known_bounds() {
    RangeBounds& known = input_.bounds_of(range_);
    const std::uint64_t positions = input_.position_buffer().latest(),
                        indices = indexed() ? input_.indices()->latest() : 0;
    if (known.positions == positions && known.indices == indices) return known;
    const auto cut = glstate::cut_of(draw_.mode, static_cast<std::uint32_t>(draw_.count));
    ElementBounds found = bounds(indexed() ? input_.indices()->data() + range_.first : nullptr, cut);
    known = {positions, indices, found.box, found.last, std::move(known.pieces), !found.pieces.empty()};
    if (!known.cut) return known;
    if (!known.pieces) {
        known.pieces = std::make_shared<DrawPieces>();
        c_.share().by_id[known.pieces->id] = known.pieces;
    }
    known.pieces->define(*cut, std::move(found.pieces));
    return known;
}

/// Each buffer is charged with what its own arrays would take; that of the indices with all, since without it every
/// element would come along.
bool NodeDraw::worth_keeping() {
    const auto nodes = static_cast<std::uint64_t>(nodes_touched(c_.draw_target().layers(), std::nullopt).size());
    // What cannot be bounded would go to all of them.
    const std::uint64_t copies = c_.program ? nodes : 1;
    bool keep = true;
    const auto& arrays = input_.definition().arrays;
    for (std::size_t i = 0; i < input_.buffers().size(); ++i) {
        const auto components = i < arrays.size() ? static_cast<std::uint64_t>(arrays[i].size) : 0;
        const std::uint64_t bytes = components != 0
                                        ? (1 + sizeof(float) * components) * static_cast<std::uint64_t>(draw_.count)
                                        : input_.inline_bytes(draw_.count);
        input_.buffers()[i]->churn.drawn(bytes * copies, nodes);
        keep = keep && input_.buffers()[i]->churn.keep();
    }
    return keep;
}

/// The current value of an attribute that has an array is not looked at.
Needs NodeDraw::needs() const {
    Needs needs = needs_of_geometry(c_.state);
    for (const glstate::InputArray& array : input_.definition().arrays)
        if (array.place < kAttributes) needs.spare(static_cast<Attribute>(array.place));
    return needs;
}

void NodeDraw::send() {
    if (!may_draw(c_)) return;
    c_.determine_modelview_form();
    // A program's shader puts the vertices anywhere.
    const bool bounded = !options().broadcast && !c_.program;
    const auto box = bounded ? project(c_.projection(), known_->box) : std::nullopt;
    c_.session().draw(
        c_.draw_source(), box, needs(), [&](Node& node, wire::PackBuffer& buffer) { bring_objects(node, buffer); },
        [&](wire::PackBuffer& buffer) { pack(buffer); },
        [&](Node& node) {  // kept commands draw with them, too
            std::lock_guard lock(c_.share().mutex);
            for_each_object([&](const Object& object) { node.object_stamps[object.id] = object.latest(); });
        });
}

void NodeDraw::bring_objects(Node& node, wire::PackBuffer& buffer) const {
    std::lock_guard lock(c_.share().mutex);
    ObjectSender sender(c_.session().nodes(), node, buffer);
    for_each_object([&](const Object& object) { sender.send(object); });
    count(node, NodeCounter::object_bytes, sender.bytes());
}

void NodeDraw::pack(wire::PackBuffer& buffer) const {
    if (in_memory()) return glapi::pack::DrawIndices(buffer, input_.id, draw_.mode, draw_.index_type, 0, indices());
    const ClientName pieces = cut() ? known_->pieces->id : ClientName();
    if (indexed())
        glapi::pack::DrawElements(buffer, input_.id, pieces, draw_.mode, draw_.count, draw_.index_type, range_.first,
                                  0);
    else glapi::pack::DrawArrays(buffer, input_.id, pieces, draw_.mode, draw_.first, draw_.count);
}

/// Indices in the program's memory, of a size that a command of the stream can have.
bool may_come_along(const ArrayDraw& draw) {
    const std::size_t bytes = static_cast<std::size_t>(draw.count) * glstate::index_bytes(draw.index_type);
    return draw.indices != nullptr && bytes <= kLargestIndices;
}

}  // namespace

bool draw_on_nodes(Context& c, const ArrayDraw& draw) {
    if (c.table != &tables::immediate || !c.draw_target()) return false;
    const bool indexed = draw.index_type != 0, in_buffer = c.state.vertex_arrays.element_array_buffer != 0;
    if (indexed && (c.state.local.primitive_restart || (!in_buffer && !may_come_along(draw)))) return false;
    if (draw.count == 0) return true;
    if (buffers_were_deleted(c)) let_go_of_deleted_buffers(c);
    VertexInput* input = c.inputs->current(c.state, *c.buffers, c.share(), indexed && in_buffer);
    if (!input) return false;
    forget_inputs(c, c.inputs->take_unused());
    c.flush_block();
    if (input->has_too_many_ranges()) forget_ranges(c, *input);
    NodeDraw on_nodes(c, *input, draw);
    if (!on_nodes.suits()) return false;
    on_nodes.send();
    return true;
}

}  // namespace wall::client
