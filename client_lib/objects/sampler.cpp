// SPDX-License-Identifier: MIT
#include "client_lib/objects/sampler.h"

#include <algorithm>
#include <bit>
#include <iterator>

#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

template <GLenum... kWords>
bool one_of(double number) {
    return ((number == static_cast<double>(kWords)) || ...);
}
bool any(double) { return true; }
bool at_least_one(double number) { return number >= 1; }

constexpr auto is_wrap = one_of<GL_REPEAT, GL_CLAMP, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_BORDER, GL_MIRRORED_REPEAT>;
constexpr auto is_min_filter = one_of<GL_NEAREST, GL_LINEAR, GL_NEAREST_MIPMAP_NEAREST, GL_LINEAR_MIPMAP_NEAREST,
                                      GL_NEAREST_MIPMAP_LINEAR, GL_LINEAR_MIPMAP_LINEAR>;
constexpr auto is_compare =
    one_of<GL_NEVER, GL_LESS, GL_EQUAL, GL_LEQUAL, GL_GREATER, GL_NOTEQUAL, GL_GEQUAL, GL_ALWAYS>;

struct Row {
    GLenum pname;
    float first;  ///< default
    bool (*allows)(double);
    GLenum error;  ///< else
    unsigned components = 1;
};
constexpr Row kRows[] = {
    {GL_TEXTURE_WRAP_S, GL_REPEAT, is_wrap, GL_INVALID_ENUM},
    {GL_TEXTURE_WRAP_T, GL_REPEAT, is_wrap, GL_INVALID_ENUM},
    {GL_TEXTURE_WRAP_R, GL_REPEAT, is_wrap, GL_INVALID_ENUM},
    {GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_LINEAR, is_min_filter, GL_INVALID_ENUM},
    {GL_TEXTURE_MAG_FILTER, GL_LINEAR, one_of<GL_NEAREST, GL_LINEAR>, GL_INVALID_ENUM},
    {GL_TEXTURE_MIN_LOD, -1000, any, GL_NO_ERROR},
    {GL_TEXTURE_MAX_LOD, 1000, any, GL_NO_ERROR},
    {GL_TEXTURE_LOD_BIAS, 0, any, GL_NO_ERROR},
    {GL_TEXTURE_COMPARE_MODE, GL_NONE, one_of<GL_NONE, GL_COMPARE_R_TO_TEXTURE>, GL_INVALID_ENUM},
    {GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL, is_compare, GL_INVALID_ENUM},
    {GL_TEXTURE_MAX_ANISOTROPY_EXT, 1, at_least_one, GL_INVALID_VALUE},
    {GL_TEXTURE_SRGB_DECODE_EXT, GL_DECODE_EXT, one_of<GL_DECODE_EXT, GL_SKIP_DECODE_EXT>, GL_INVALID_ENUM},
    {GL_TEXTURE_BORDER_COLOR, 0, any, GL_NO_ERROR, 4},
};
static_assert(std::size(kRows) == kSamplerParameters);

const Row* find_row(GLenum pname) {
    const auto* found = std::ranges::find(kRows, pname, &Row::pname);
    return found == std::end(kRows) ? nullptr : found;
}

std::size_t place_of(GLenum pname) { return static_cast<std::size_t>(find_row(pname) - kRows); }

}  // namespace

Sampler::Sampler(GLuint own_name) : Object(next_object_id(), own_name) {
    for (std::size_t i = 0; i < kSamplerParameters; ++i)
        values_[i].bits[0] = std::bit_cast<std::uint32_t>(kRows[i].first);
}

GLenum Sampler::refuses(GLenum pname, double number) {
    const Row* row = find_row(pname);
    if (!row) return GL_INVALID_ENUM;
    return row->allows(number) ? GLenum{GL_NO_ERROR} : row->error;
}

unsigned Sampler::components(GLenum pname) {
    const Row* row = find_row(pname);
    return row ? row->components : 0;
}

const Sampler::Value& Sampler::get(GLenum pname) const { return values_[place_of(pname)]; }

bool Sampler::set(GLenum pname, const Value& value) {
    const std::size_t place = place_of(pname);
    if (values_[place] == value) return false;
    values_[place] = value;
    stamps_[place] = stamp_ = next_stamp();
    return true;
}

// A name that a state element carries must exist on the node: one parameter is always said.
void Sampler::pack_changes(std::uint64_t known, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    for (std::size_t i = 0; i < kSamplerParameters; ++i) {
        if (stamps_[i] <= known && (known != 0 || i != 0)) continue;
        const auto& [type, v] = values_[i];
        glapi::pack::SamplerParameter(buffer, id, kRows[i].pname, type, v[0], v[1], v[2], v[3]);
        packed();
    }
}

}  // namespace wall::client
