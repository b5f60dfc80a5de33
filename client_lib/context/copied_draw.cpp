// SPDX-License-Identifier: MIT
#include "client_lib/context/copied_draw.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "client_lib/context/array_copies.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/forget_objects.h"
#include "client_lib/context/vertex_inputs.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {
namespace {

using glstate::Attribute;
using glstate::ClientArray;
using glstate::InputArray;

constexpr GLsizei kFewest = 192;                         // elements of a draw that is worth the trouble
constexpr std::size_t kLongestStride = 256;              // bytes; what lies between elements is looked at, too
constexpr std::size_t kLargest = std::size_t{64} << 20;  // of a copy
constexpr std::size_t kPage = ChangedPages::kPageBytes;
constexpr unsigned kMostPatience = 256;  // draws

/// In each of so many bytes an element begins: then one does on every page, wherever that begins.
constexpr std::size_t kChunk = kPage / 2;

struct Elements {
    std::size_t first = 0, last = 0;
};

/// Which elements of client memory a draw takes, and whether all pages between the first and the last are its own.
class TakenElements {
public:
    TakenElements(const ElementRange& range, std::size_t stride) : range_(range), stride_(stride) {}
    std::optional<Elements> find() {
        if (range_.type == 0) {
            const auto first = static_cast<std::size_t>(range_.first);
            return Elements{first, first + static_cast<std::size_t>(range_.count) - 1};
        }
        Elements found{~std::size_t{0}, 0};
        for (GLsizei i = 0; i < range_.count; ++i) {
            if (range_.restarts_at(i)) continue;
            const std::size_t element = range_.at(i);
            found.first = std::min(found.first, element);
            found.last = std::max(found.last, element);
        }
        if (found.first > found.last) return std::nullopt;
        const std::size_t chunks = (found.last - found.first) * stride_ / kChunk + 1;
        if (chunks > static_cast<std::size_t>(range_.count)) return std::nullopt;
        return touches_all(found, chunks) ? std::optional(found) : std::nullopt;
    }

private:
    bool touches_all(const Elements& found, std::size_t chunks) const {
        if (chunks <= 2) return true;  // the first's and the last's
        std::vector<bool> touched(chunks);
        for (GLsizei i = 0; i < range_.count; ++i)
            if (!range_.restarts_at(i)) touched[(range_.at(i) - found.first) * stride_ / kChunk] = true;
        return std::ranges::find(touched, false) == touched.end();
    }

    const ElementRange& range_;
    const std::size_t stride_;
};

/// A draw whose arrays are gathered into blocks.
class CopiedDraw {
public:
    CopiedDraw(Context& c, const ArrayDraw& draw) : c_(c), draw_(draw) {}
    bool run();

private:
    struct Placed {
        InputArray input;
        std::uintptr_t pointer = 0;  ///< 0: it lies in a buffer
    };
    bool gather();
    void add(std::uint32_t place, const ClientArray& array);
    void find_blocks();
    std::optional<Elements> elements() const;
    bool due() const;
    bool refresh_all(const Elements& taken);

    Context& c_;
    const ArrayDraw& draw_;
    bool suitable_ = true;
    std::vector<Placed> arrays_;
    std::vector<ArrayBlock> blocks_;
    glstate::VertexInputDefinition definition_;
};

void CopiedDraw::add(std::uint32_t place, const ClientArray& array) {
    if (!array.enabled) return;
    Placed placed{.input = {.place = place,
                            .buffer = ClientName(array.buffer),
                            .offset = static_cast<std::uint32_t>(array.pointer),
                            .stride = array.stride,
                            .type = array.type,
                            .size = array.size,
                            .normalized = array.normalized,
                            .divisor = array.divisor,
                            .reaches_as = array.reaches_as}};
    if (array.buffer == 0) {
        placed.pointer = static_cast<std::uintptr_t>(array.pointer);
        placed.input.stride = static_cast<std::int32_t>(placed.input.step());
        suitable_ = suitable_ && array.pointer != 0 && array.divisor == 0 && placed.input.step() <= kLongestStride;
    }
    arrays_.push_back(placed);
}

/// False: not all arrays can be copied.
bool CopiedDraw::gather() {
    const auto& arrays = c_.state.vertex_arrays;
    glstate::for_each_attribute_array(c_.state, [&](Attribute attribute, const ClientArray& array) {
        add(static_cast<std::uint32_t>(glstate::place_of(attribute)), array);
    });
    add(glstate::kPositionArray, arrays.vertex_array);
    find_blocks();
    return suitable_ && !blocks_.empty();
}

/// Arrays in the same memory are one block; the others have one each.
void CopiedDraw::find_blocks() {
    std::vector<const Placed*> sorted;
    for (const Placed& array : arrays_)
        if (array.pointer != 0) sorted.push_back(&array);
    std::ranges::sort(sorted, {}, [](const Placed* array) { return array->pointer; });
    for (const Placed* array : sorted) {
        const std::size_t step = array->input.step(), bytes = array->input.element_bytes();
        if (!blocks_.empty()) {
            ArrayBlock& last = blocks_.back();
            const std::size_t end = array->pointer + bytes - last.start;
            if (last.stride == step && end <= step) {
                last.width = std::max(last.width, end);
                continue;
            }
        }
        blocks_.push_back({array->pointer, step, bytes});
    }
}

std::optional<Elements> CopiedDraw::elements() const {
    ElementRange range{.first = draw_.first,
                       .count = draw_.count,
                       .type = draw_.index_type,
                       .indices = draw_.indices,
                       .base_vertex = draw_.base_vertex,
                       .restart = draw_.restart};
    BufferReading reading;
    if (const ClientName buffer(c_.state.vertex_arrays.element_array_buffer); range.type != 0 && buffer) {
        reading = buffer_content(c_, buffer, reinterpret_cast<std::uintptr_t>(draw_.indices));
        const std::size_t have = reading.bytes().size() / glstate::index_bytes(range.type);
        if (static_cast<std::size_t>(range.count) > have) return std::nullopt;
        range.indices = reading.bytes().data();
    }
    if (range.type != 0 && !range.indices) return std::nullopt;
    const auto longest = std::ranges::max(blocks_, {}, &ArrayBlock::stride).stride;
    return TakenElements(range, longest).find();
}

/// False: one of the blocks is seen for the first time, or was another each time.
bool CopiedDraw::due() const {
    bool all = true;
    for (const ArrayBlock& block : blocks_) {
        ArrayCopy& copy = c_.copies->copy_of(block);
        if (copy.wait != 0) --copy.wait, all = false;
        else if (copy.last_use == 0) all = false;
        copy.last_use = c_.copies->next_use();
    }
    return all;
}

/// False: one of the copies would be too large.
bool CopiedDraw::refresh_all(const Elements& taken) {
    const auto too_large = [&](const ArrayBlock& block) { return (taken.last + 1) * block.stride > kLargest; };
    if (std::ranges::any_of(blocks_, too_large)) return false;
    const ArrayCopies::Holder holder{c_.share(), *c_.buffers,
                                     [this](const Buffer& buffer) { before_writing(c_, buffer); }};
    for (const ArrayBlock& block : blocks_)
        c_.copies->refresh(holder, block, c_.copies->copy_of(block),
                           {taken.first * block.stride, taken.last * block.stride + block.width});
    return true;
}

bool CopiedDraw::run() {
    if (!gather() || !due()) return false;
    const auto taken = elements();
    if (!taken || !refresh_all(*taken)) return false;
    for (Placed& array : arrays_) {
        if (array.pointer != 0) {
            const auto block = std::ranges::find_if(blocks_, [&](const ArrayBlock& b) {
                return b.stride == array.input.step() && array.pointer >= b.start && array.pointer < b.start + b.width;
            });
            array.input.buffer = c_.copies->copy_of(*block).buffer->id;
            array.input.offset = static_cast<std::uint32_t>(array.pointer - block->start);
        }
        definition_.arrays.push_back(array.input);
    }
    if (draw_.index_type != 0) definition_.indices = ClientName(c_.state.vertex_arrays.element_array_buffer);
    VertexInput* input = c_.inputs->of(definition_, *c_.buffers, c_.share());
    const bool drawn = input && draw_if_worth(c_, *input, draw_);
    for (const ArrayBlock& block : blocks_) {
        ArrayCopy& copy = c_.copies->copy_of(block);
        copy.patience = drawn ? 1 : std::min(2 * copy.patience, kMostPatience);
        copy.wait = drawn ? 0 : copy.patience;
    }
    forget_inputs(c_, c_.inputs->take_unused());
    for (auto& buffer : c_.copies->take_unused()) let_go_of_buffer(c_, std::move(buffer));
    return drawn;
}

}  // namespace

bool draw_copied(Context& c, const ArrayDraw& draw) {
    if (draw.count < kFewest || draw.instances != 1 || !c.draw_target()) return false;
    if (!c.at_once()) return false;
    const std::size_t bytes = static_cast<std::size_t>(draw.count) * glstate::index_bytes(draw.index_type);
    if (draw.index_type != 0 && bytes > kLargestIndices) return false;
    return CopiedDraw(c, draw).run();
}

}  // namespace wall::client
