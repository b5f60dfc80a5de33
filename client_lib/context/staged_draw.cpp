// SPDX-License-Identifier: MIT
#include "client_lib/context/staged_draw.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <numeric>
#include <utility>
#include <vector>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/forget_objects.h"
#include "client_lib/context/program_use.h"
#include "client_lib/context/staging_buffers.h"
#include "client_lib/context/vertex_inputs.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {
namespace {

using glstate::Attribute;
using glstate::ClientArray;
using glstate::InputArray;

constexpr std::size_t kMostUnused = std::size_t{1} << 20;  // elements that come along for the others' numbers
constexpr GLuint kRestart = ~GLuint{0};                    // among the staged indices

class StagedDraw {
public:
    StagedDraw(Context& c, const ArrayDraw& draw) : c_(c), draw_(draw) {}
    void run();

private:
    bool find_elements();
    bool keep_numbers(const std::vector<GLuint>& drawn);
    void stage(std::uint32_t place, const ClientArray& array);
    void stage_constant_position();
    void stage_constant_doubles();
    Buffer& buffer_at(std::uint32_t place);
    void add(const InputArray& input, const std::vector<std::byte>& content);

    Context& c_;
    const ArrayDraw& draw_;
    std::vector<GLuint> elements_;  ///< of the arrays, each once, ascending
    std::vector<GLuint> indices_;   ///< into `elements_`, or kRestart
    glstate::VertexInputDefinition definition_;
};

/// False: it draws nothing.
bool StagedDraw::find_elements() {
    ElementRange range{.first = draw_.first,
                       .count = draw_.count,
                       .type = draw_.index_type,
                       .indices = draw_.indices,
                       .base_vertex = draw_.base_vertex,
                       .restart = draw_.restart};
    BufferReading reading;
    if (const ClientName buffer(c_.state.vertex_arrays.element_array_buffer); draw_.index_type != 0 && buffer) {
        reading = buffer_content(c_, buffer, reinterpret_cast<std::uintptr_t>(draw_.indices));
        const std::size_t have = reading.bytes().size() / glstate::index_bytes(draw_.index_type);
        range.indices = reading.bytes().data();
        range.count = static_cast<GLsizei>(std::min<std::size_t>(static_cast<std::size_t>(range.count), have));
    }
    if (draw_.index_type != 0 && !range.indices) return false;
    std::vector<GLuint> drawn;
    drawn.reserve(static_cast<std::size_t>(range.count));
    for (GLsizei i = 0; i < range.count; ++i)
        if (!range.restarts_at(i)) drawn.push_back(range.at(i));
    if (reads_numbers(c_) && keep_numbers(drawn)) {
        for (GLsizei i = 0; i < range.count; ++i) indices_.push_back(range.restarts_at(i) ? kRestart : range.at(i));
        return true;
    }
    elements_ = drawn;
    std::ranges::sort(elements_);
    const auto behind = std::ranges::unique(elements_);
    elements_.erase(behind.begin(), behind.end());
    std::size_t next = 0;
    for (GLsizei i = 0; i < range.count; ++i) {
        if (range.restarts_at(i)) {
            indices_.push_back(kRestart);
            continue;
        }
        const auto at = std::ranges::lower_bound(elements_, drawn[next++]);
        indices_.push_back(static_cast<GLuint>(at - elements_.begin()));
    }
    return !elements_.empty();
}

/// All elements up to the highest, so that each keeps its number. False: there are too many, or none.
bool StagedDraw::keep_numbers(const std::vector<GLuint>& drawn) {
    if (drawn.empty()) return false;
    const std::size_t behind = std::size_t{*std::ranges::max_element(drawn)} + 1;
    if (behind > kMostUnused + drawn.size()) return false;
    elements_.resize(behind);
    std::iota(elements_.begin(), elements_.end(), GLuint{0});
    return true;
}

Buffer& StagedDraw::buffer_at(std::uint32_t place) {
    auto& buffer = c_.staging->by_place[place];
    if (!buffer) {
        buffer = std::make_shared<Buffer>(next_object_id(), 0);
        c_.buffers->by_id[buffer->id] = buffer;
        std::lock_guard lock(c_.share().mutex);
        c_.share().by_id[buffer->id] = buffer;
    }
    return *buffer;
}

void StagedDraw::add(const InputArray& input, const std::vector<std::byte>& content) {
    Buffer& buffer = buffer_at(input.place);
    before_writing(c_, buffer);
    definition_.arrays.push_back(input);
    definition_.arrays.back().buffer = buffer.id;
    std::lock_guard lock(c_.share().mutex);
    buffer.define(content.data(), content.size(), GL_STREAM_DRAW);
}

/// What the draw reads of an array, in a row; what lies beyond a buffer is 0.
void StagedDraw::stage(std::uint32_t place, const ClientArray& array) {
    if (!array.enabled) return;
    const InputArray input{.place = place,
                           .type = array.type,
                           .size = array.size,
                           .normalized = array.normalized,
                           .divisor = array.divisor,
                           .reaches_as = array.reaches_as};
    const std::size_t bytes = input.element_bytes();
    const std::size_t stride = array.stride ? static_cast<std::size_t>(array.stride) : bytes;
    const auto pointer = static_cast<std::uintptr_t>(array.pointer);
    const auto* base = reinterpret_cast<const std::byte*>(pointer);
    std::size_t have = ArraySource::kNoLimit;
    BufferReading reading;
    if (array.buffer != 0) {
        reading = buffer_content(c_, ClientName(array.buffer), pointer);
        base = reading.bytes().data();
        have = reading.bytes().size() < bytes ? 0 : (reading.bytes().size() - bytes) / stride + 1;
    } else if (!base) {
        return;
    }
    const auto instances = static_cast<std::size_t>(draw_.instances);
    const std::size_t count = array.divisor == 0 ? elements_.size() : (instances + array.divisor - 1) / array.divisor;
    std::vector<std::byte> content(count * bytes);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t element = array.divisor == 0 ? elements_[i] : i;
        if (element < have) std::memcpy(content.data() + i * bytes, base + element * stride, bytes);
    }
    add(input, content);
}

/// A program may draw without an array of positions: all vertices have the current attribute 0 then.
void StagedDraw::stage_constant_position() {
    const glstate::Vec4& position = c_.state.current.vertex_attrib[0];
    std::vector<std::byte> content(elements_.size() * sizeof position);
    for (std::size_t i = 0; i < elements_.size(); ++i)
        std::memcpy(content.data() + i * sizeof position, position.data(), sizeof position);
    add({.place = glstate::kPositionArray}, content);
}

/// Values that are the same for all vertices, as doubles.
void StagedDraw::stage_constant_doubles() {
    const std::uint32_t doubles = constant_doubles(c_);
    for (std::uint32_t i = 0; i < kVertexAttributes; ++i) {
        if ((doubles >> i & 1) == 0) continue;
        const auto& value = c_.get<glstate::el::attrib_doubles>(i);
        std::vector<std::byte> content(sizeof value);
        std::memcpy(content.data(), &value, sizeof value);
        add({.place = static_cast<std::uint32_t>(glstate::place_of(Attribute::vertex_attrib + i)),
             .type = GL_DOUBLE,
             .divisor = glstate::kNeverSteps,
             .reaches_as = glstate::kAsDoubles},
            content);
    }
}

void StagedDraw::run() {
    c_.flush_block();  // the current attributes are in `state` after it
    if (!find_elements()) return;
    const auto& arrays = c_.state.vertex_arrays;
    glstate::for_each_attribute_array(c_.state, [&](Attribute attribute, const ClientArray& array) {
        stage(static_cast<std::uint32_t>(glstate::place_of(attribute)), array);
    });
    if (!arrays.attrib_array[0].enabled) stage(glstate::kPositionArray, arrays.vertex_array);
    stage_constant_doubles();
    const auto is_position = [](const InputArray& array) {
        return array.place == glstate::kPositionArray || array.place == glstate::place_of(Attribute::vertex_attrib);
    };
    if (std::ranges::none_of(definition_.arrays, is_position)) {
        if (!c_.program) return;  // there is nothing to draw
        stage_constant_position();
    }
    VertexInput* input = c_.inputs->of(definition_, *c_.buffers, c_.share());
    if (!input) return;
    draw_from(c_, *input,
              {.mode = draw_.mode,
               .count = static_cast<GLsizei>(indices_.size()),
               .index_type = GL_UNSIGNED_INT,
               .indices = indices_.data(),
               .restart = draw_.restart ? std::optional(kRestart) : std::nullopt,
               .instances = draw_.instances});
    forget_inputs(c_, c_.inputs->take_unused());
}

}  // namespace

void draw_staged(Context& c, const ArrayDraw& draw) {
    if (draw.count == 0 || draw.instances == 0 || !c.draw_target()) return;
    StagedDraw(c, draw).run();
}

}  // namespace wall::client
