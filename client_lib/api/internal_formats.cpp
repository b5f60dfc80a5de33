// SPDX-License-Identifier: MIT
// What internal formats can do (GL_ARB_internalformat_query; OpenGL 4.2, 6.1.20; OpenGL ES 3.0.6, 6.1.15): how many
// samples a pixel may have.
#include <algorithm>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/param_commands.h"
#include "client_lib/objects/es_formats.h"
#include "client_lib/objects/renderbuffer.h"
#include "common/glapi/texture_target.h"

namespace wall::client::api {
namespace {

/// Of what has several samples. OpenGL ES 3.0 knows renderbuffers only.
bool has_samples(const Context& c, GLenum target) {
    if (target == GL_RENDERBUFFER) return true;
    const auto* info = target_of(target);
    return !c.profile.is_es() && info && info->samples;
}

/// Null: images of that format are not drawn to.
const TextureFormat* drawn_format(const Context& c, GLenum internal_format) {
    const TextureFormat* format = find_renderbuffer_format(internal_format);
    if (!format || is_removed(c, internal_format)) return nullptr;
    return !c.profile.is_es() || es_is_drawn(c.profile.es, format->answer) ? format : nullptr;
}

std::vector<GLsizei> samples_of(Context& c, const TextureFormat& format) {
    if (c.profile.es == 30 && format.whole()) return {};
    return sample_counts(static_cast<GLsizei>(limit_of(c.caps(), GL_MAX_SAMPLES, kUsualSamples)));
}

template <class Out>
void get(Context& c, GLenum target, GLenum internal_format, GLenum pname, GLsizei room, Out* params) {
    if (!has_samples(c, target)) return c.error(GL_INVALID_ENUM);
    const TextureFormat* format = drawn_format(c, internal_format);
    if (!format || (pname != GL_SAMPLES && pname != GL_NUM_SAMPLE_COUNTS)) return c.error(GL_INVALID_ENUM);
    if (room < 0) return c.error(GL_INVALID_VALUE);
    const auto counts = samples_of(c, *format);
    if (pname == GL_NUM_SAMPLE_COUNTS && room > 0) *params = static_cast<Out>(counts.size());
    if (pname == GL_SAMPLES) std::copy_n(counts.begin(), std::min<std::size_t>(counts.size(), room), params);
}

}  // namespace

void GetInternalformativ(Context& c, GLenum target, GLenum internal_format, GLenum pname, GLsizei room, GLint* params) {
    get(c, target, internal_format, pname, room, params);
}

void GetInternalformati64v(Context& c, GLenum target, GLenum internal_format, GLenum pname, GLsizei room,
                           GLint64* params) {
    get(c, target, internal_format, pname, room, params);
}

}  // namespace wall::client::api
