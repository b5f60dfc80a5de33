// SPDX-License-Identifier: MIT
#include "client_lib/context/sampled_parts.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>

#include "client_lib/context/capture_use.h"
#include "client_lib/context/client_arrays.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/geometry/texel_distance.h"
#include "client_lib/objects/sampler.h"
#include "common/glstate/projection.h"

namespace wall::client {
namespace {

constexpr GLsizei kMostLooking = 64;  // of a picture: two triangles, or a strip of some

/// Of an image and a unit: no texel further off than the next one is looked at, and none at the other side.
bool looks_closely(const Context& c, const Texture& texture, std::uint32_t unit) {
    GLenum min = texture.parameters.min_filter, mag = texture.parameters.mag_filter, s = texture.parameters.wrap_s,
           t = texture.parameters.wrap_t;
    if (const ClientName bound(c.state.objects.sampler_binding[unit]); bound) {
        const auto found = c.share().by_id.find(bound);
        if (found == c.share().by_id.end()) return false;
        const auto& sampler = static_cast<const Sampler&>(*found->second);
        const auto word = [&](GLenum parameter) {
            return static_cast<GLenum>(std::bit_cast<float>(sampler.get(parameter).bits[0]));
        };
        min = word(GL_TEXTURE_MIN_FILTER), mag = word(GL_TEXTURE_MAG_FILTER);
        s = word(GL_TEXTURE_WRAP_S), t = word(GL_TEXTURE_WRAP_T);
    }
    if (min == GL_NEAREST && mag == GL_NEAREST) return true;
    const bool smooth = (min == GL_NEAREST || min == GL_LINEAR) && (mag == GL_NEAREST || mag == GL_LINEAR);
    return smooth && s == GL_CLAMP_TO_EDGE && t == GL_CLAMP_TO_EDGE;
}

/// Which array has what a shader calls by that name; nothing: none.
std::optional<Attribute> array_of(const Executable& executable, std::string_view name) {
    constexpr std::string_view kTexCoord = "gl_MultiTexCoord";
    if (name == "gl_Vertex") return kVertexArray;
    if (name.starts_with(kTexCoord)) {
        const std::string_view digits = name.substr(kTexCoord.size());
        unsigned unit = 0;
        const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), unit);
        const bool known = read.ec == std::errc() && unit < glstate::el::texcoord::count;
        return known ? std::optional(Attribute::texcoord + unit) : std::nullopt;
    }
    const GLint location = executable.attribute_location_of(name);
    if (location < 0 || location >= static_cast<GLint>(glstate::el::vertex_attrib::count)) return std::nullopt;
    return location == 0 ? kVertexArray : Attribute::vertex_attrib + static_cast<unsigned>(location);
}

using Vec4 = std::array<float, 4>;

/// The elements of a draw, one after the other.
class Elements {
public:
    Elements(Context& c, const ArrayDraw& draw) : arrays_(c, false), elements_(elements_of(c, draw, 0, indices_)) {
        if (draw.index_type != 0 && elements_.indices == nullptr) elements_.count = 0;
    }

    /// Calls `use(i, value)` for each of them. False: there is no such array of floats, or it ends before.
    template <class Use>
    bool each(Attribute attribute, Use&& use) const {
        const auto source = std::ranges::find(arrays_.sources(), attribute, &ArraySource::attribute);
        if (source == arrays_.sources().end() || source->integer || source->bgra) return false;
        for (GLsizei i = 0; i < elements_.count; ++i) {
            if (elements_.restarts_at(i)) return false;
            const GLuint element = elements_.at(i);
            if (element >= source->count) return false;
            Vec4 value{0, 0, 0, 1};
            source->load(source->base + source->stride * element, source->size, value.data());
            use(static_cast<std::size_t>(i), value);
        }
        return elements_.count > 0;
    }

private:
    BufferReading indices_;
    const ArraySet arrays_;
    ElementRange elements_;
};

/// Where the vertices come on the window; empty: that is not known, or they do not lie in one plane that faces it.
std::vector<LookingVertex> placed(Context& c, const Elements& elements) {
    const Placing& placing = c.placing();
    std::vector<LookingVertex> out;
    if (!placing.known || !placing.steady) return out;
    const Attribute array = placing.attribute == 0 ? kVertexArray : Attribute::vertex_attrib + placing.attribute;
    float depth = 0;
    bool plain = true;
    const bool all = elements.each(array, [&](std::size_t i, const Vec4& v) {
        const glstate::WindowVertex vertex = glstate::project(placing.projection, v[0], v[1], v[2], 1);
        if (i == 0) depth = vertex.clip[3];
        plain = plain && v[3] == 1 && vertex.in_front && std::abs(vertex.clip[3] - depth) <= 1e-6f * std::abs(depth);
        out.push_back({vertex.x, vertex.y});
    });
    if (!all || !plain) out.clear();
    return out;
}

/// False: an attribute that the places follow from is not known.
bool look_up(std::vector<LookingVertex>& vertices, const Elements& elements, Attribute array,
             const glapi::PositionTransform& transform, const TextureLevel& image) {
    return elements.each(array, [&](std::size_t i, const Vec4& v) {
        std::array<float, 2> place{transform.constant[0], transform.constant[1]};
        for (std::size_t row = 0; row < 2; ++row)
            for (std::size_t k = 0; k < 4; ++k) place[row] += transform.linear[4 * k + row] * v[k];
        vertices[i].texel_x = place[0] * static_cast<float>(image.width);
        vertices[i].texel_y = place[1] * static_cast<float>(image.height);
    });
}

/// Fragments lie where their values are those of a plane: not so those of lines and points.
bool fills(const Context& c, GLenum mode) {
    const auto& polygon_mode = c.state.polygon.polygon_mode;
    return mode >= GL_TRIANGLES && mode <= GL_POLYGON && polygon_mode[0] == GL_FILL && polygon_mode[1] == GL_FILL;
}

}  // namespace

bool DrawOfParts::may_copy(const Context& c, const ArrayDraw& draw) {
    return draw.count <= kMostLooking && draw.count >= 3 && draw.instances == 1 && c.program && c.at_once() &&
           c.share().has_drawn.load(std::memory_order_relaxed) && c.captures->now == nullptr && !c.draws_nothing &&
           c.state.local.render_mode == GL_RENDER && fills(c, draw.mode);
}

DrawOfParts::DrawOfParts(Context& c, const ArrayDraw& draw) : c_(c) {
    const DrawTarget target = c.draw_target();
    if (!target || !(target.of_objects() || draws_to_back_buffer(c))) return;
    find_images();
    if (!images_.empty()) find_places(draw);
    if (std::ranges::any_of(images_, [](const Image& image) { return image.target->parts() != nullptr; })) allow();
}

void DrawOfParts::find_images() {
    std::lock_guard lock(c_.share().mutex);
    Executable& executable = *c_.program->executable;
    for (std::size_t i = 0; i < executable.lookups().size(); ++i) {
        const Uniform& sampler = executable.uniforms[executable.lookups()[i].uniform];
        const std::uint32_t unit = executable.words_of(sampler)[0];
        if (unit >= kTextureImageUnits) continue;
        const auto texture = c_.share().texture_of(bound_id(c_, unit, sampler.type->texture_target));
        if (!texture || !texture->is_drawn() || !looks_closely(c_, *texture, unit)) continue;
        auto target = texture->drawn_by.lock();
        if (!target || !target->is_drawn_here() || target.get() == c_.draw_target().objects()) continue;
        images_.push_back({i, texture, std::move(target), {}});
    }
}

void DrawOfParts::find_places(const ArrayDraw& draw) {
    const Elements elements(c_, draw);
    std::vector<LookingVertex> vertices = placed(c_, elements);
    std::lock_guard lock(c_.share().mutex);
    Executable& executable = *c_.program->executable;
    std::erase_if(images_, [&](Image& image) {
        if (vertices.empty() || image.lookup >= executable.lookups().size()) return true;
        glapi::LinkedPosition& coordinates = executable.lookups()[image.lookup].coordinates;
        const auto array = array_of(executable, coordinates.program().attribute);
        const auto* const transform = coordinates.transform(c_.state.matrix.modelview, c_.state.matrix.projection);
        const TextureLevel* const level = image.texture->find_level(0, 0);
        if (!array || transform == nullptr || level == nullptr) return true;
        if (!look_up(vertices, elements, *array, *transform, *level)) return true;
        const auto distance = texel_distance(vertices, level->width, level->height);
        if (distance) image.to = place_of_copy(c_, distance->x, distance->y);
        return !distance;
    });
}

/// It alone: what was drawn before may look up more.
void DrawOfParts::allow() {
    c_.flush_block();
    std::vector<ClientName> images;
    for (const Image& image : images_)
        if (goes_on(c_, *image.target, image.to)) images.push_back(image.texture->id);
    allowed_ = !images.empty();
    if (allowed_) c_.session().drawn_parts([&](DrawnParts& parts) { parts.allow(c_.id, std::move(images)); });
}

void DrawOfParts::finish() {
    if (allowed_) {
        c_.flush_block();
        c_.session().drawn_parts([&](DrawnParts& parts) { parts.allow(c_.id, {}); });
    }
    for (const Image& image : images_) note_copy(c_, image.target, image.to);
}

}  // namespace wall::client
