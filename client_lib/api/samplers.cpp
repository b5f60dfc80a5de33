// SPDX-License-Identifier: MIT
// Sampler objects (OpenGL 3.3, 3.8.2). They belong to the share group; which of them a unit has is a state element.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>

#include "client_lib/context/context.h"
#include "client_lib/context/param_commands.h"
#include "client_lib/objects/sampler.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

std::shared_ptr<Sampler> find(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return c.share().samplers.find(name);
}

/// Null, and the error is set: it is no name of a sampler.
std::shared_ptr<Sampler> find_or_refuse(Context& c, GLuint name) {
    auto sampler = find(c, name);
    if (!sampler) c.error(GL_INVALID_OPERATION);
    return sampler;
}

void set(Context& c, Sampler& sampler, GLenum pname, const Sampler::Value& value) {
    if (sampler.get(pname) == value) return;
    c.flush_block();
    c.before_change(sampler.id);
    std::lock_guard lock(c.share().mutex);
    sampler.set(pname, value);
    c.share().last_change.store(sampler.latest(), std::memory_order_release);
}

void set_number(Context& c, GLuint name, GLenum pname, double number) {
    const auto sampler = find_or_refuse(c, name);
    if (!sampler) return;
    if (Sampler::components(pname) != 1) return c.error(GL_INVALID_ENUM);
    if (const GLenum error = Sampler::refuses(pname, number)) return c.error(error);
    if (pname == GL_TEXTURE_MAX_ANISOTROPY_EXT) number = std::min(number, 16.0);
    set(c, *sampler, pname, {GL_FLOAT, {std::bit_cast<std::uint32_t>(static_cast<float>(number)), 0, 0, 0}});
}

/// `bits(v)`: a component of a border colour, of that type.
template <class T, class Bits>
void set_values(Context& c, GLuint name, GLenum pname, const T* v, GLenum type, Bits&& bits) {
    if (pname != GL_TEXTURE_BORDER_COLOR) return set_number(c, name, pname, static_cast<double>(v[0]));
    if (const auto sampler = find_or_refuse(c, name))
        set(c, *sampler, pname, {type, {bits(v[0]), bits(v[1]), bits(v[2]), bits(v[3])}});
}

template <class T>
std::uint32_t as_they_are(T v) {
    return std::bit_cast<std::uint32_t>(v);
}
std::uint32_t as_fraction(GLint v) { return std::bit_cast<std::uint32_t>(glapi::to_fraction(v)); }

/// `color(bits)`: an answer about a border colour's component.
template <class T, class Color>
void get_values(Context& c, GLuint name, GLenum pname, T* out, Color&& color) {
    const auto sampler = find_or_refuse(c, name);
    if (!sampler) return;
    const unsigned components = Sampler::components(pname);
    if (components == 0) return c.error(GL_INVALID_ENUM);
    std::lock_guard lock(c.share().mutex);
    const auto& bits = sampler->get(pname).bits;
    if (components > 1) return void(std::transform(bits.begin(), bits.end(), out, color));
    const auto value = std::bit_cast<float>(bits[0]);
    if constexpr (std::is_same_v<T, GLfloat>) *out = value;
    else *out = static_cast<T>(std::lround(value));
}

/// Its name is gone: it leaves the context's units, and the nodes unless another context may have it.
void forget(Context& c, const std::shared_ptr<Sampler>& sampler) {
    for (unsigned unit = 0; unit < el::sampler_binding::count; ++unit)
        if (c.get<el::sampler_binding>(unit) == sampler->id.value) c.set<el::sampler_binding>(unit, 0);
    if (sampler->bound_by.empty() || (sampler->bound_by.size() == 1 && sampler->bound_by[0] == c.id)) {
        c.forget_object(sampler->id);
        std::lock_guard lock(c.share().mutex);
        c.share().by_id.erase(sampler->id);
    }
}

}  // namespace

void GenSamplers(Context& c, GLsizei count, GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    if (count == 0 || !names) return;
    std::lock_guard lock(c.share().mutex);
    ShareGroup& share = c.share();
    const GLuint first = share.samplers.reserve(static_cast<GLuint>(count));
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
        const auto made = std::make_shared<Sampler>(names[i] = first + i);
        share.samplers.put(made->name, made);
        share.by_id[made->id] = made;
    }
}

void DeleteSamplers(Context& c, GLsizei count, const GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    c.flush_block();
    for (GLsizei i = 0; i < count; ++i) {
        if (names[i] == 0) continue;
        std::shared_ptr<Sampler> sampler;
        {
            std::lock_guard lock(c.share().mutex);
            sampler = c.share().samplers.erase(names[i]);
        }
        if (sampler) forget(c, sampler);
    }
}

GLboolean IsSampler(Context& c, GLuint name) { return find(c, name) != nullptr; }

void BindSampler(Context& c, GLuint unit, GLuint name) {
    if (unit >= el::sampler_binding::count) return c.error(GL_INVALID_VALUE);
    std::uint32_t id = 0;
    if (name != 0) {
        const auto sampler = find_or_refuse(c, name);
        if (!sampler) return;
        std::lock_guard lock(c.share().mutex);
        auto& users = sampler->bound_by;
        if (std::ranges::count(users, c.id) == 0) users.push_back(c.id);
        id = sampler->id.value;
    }
    c.set<el::sampler_binding>(unit, id);
}

void SamplerParameterf(Context& c, GLuint sampler, GLenum pname, GLfloat param) {
    set_number(c, sampler, pname, static_cast<double>(param));
}
void SamplerParameteri(Context& c, GLuint sampler, GLenum pname, GLint param) { set_number(c, sampler, pname, param); }
void SamplerParameterfv(Context& c, GLuint sampler, GLenum pname, const GLfloat* param) {
    set_values(c, sampler, pname, param, GL_FLOAT, as_they_are<GLfloat>);
}
void SamplerParameteriv(Context& c, GLuint sampler, GLenum pname, const GLint* param) {
    set_values(c, sampler, pname, param, GL_FLOAT, as_fraction);
}
void SamplerParameterIiv(Context& c, GLuint sampler, GLenum pname, const GLint* param) {
    set_values(c, sampler, pname, param, GL_INT, as_they_are<GLint>);
}
void SamplerParameterIuiv(Context& c, GLuint sampler, GLenum pname, const GLuint* param) {
    set_values(c, sampler, pname, param, GL_UNSIGNED_INT, as_they_are<GLuint>);
}

void GetSamplerParameterfv(Context& c, GLuint sampler, GLenum pname, GLfloat* params) {
    get_values(c, sampler, pname, params, [](std::uint32_t bits) { return std::bit_cast<float>(bits); });
}
void GetSamplerParameteriv(Context& c, GLuint sampler, GLenum pname, GLint* params) {
    get_values(c, sampler, pname, params, [](std::uint32_t bits) {
        const auto value = static_cast<double>(std::bit_cast<float>(bits));
        return to_int(2147483647.0 * std::clamp(value, -1.0, 1.0));
    });
}
void GetSamplerParameterIiv(Context& c, GLuint sampler, GLenum pname, GLint* params) {
    get_values(c, sampler, pname, params, [](std::uint32_t bits) { return static_cast<GLint>(bits); });
}
void GetSamplerParameterIuiv(Context& c, GLuint sampler, GLenum pname, GLuint* params) {
    get_values(c, sampler, pname, params, [](std::uint32_t bits) { return bits; });
}

}  // namespace wall::client::api
