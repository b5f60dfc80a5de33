// SPDX-License-Identifier: MIT
// What internal formats can do (GL_ARB_internalformat_query, GL_ARB_internalformat_query2; OpenGL 4.3, 22.3; OpenGL ES
// 3.0.6, 6.1.15). How many samples a pixel may have is known here; about the rest a node's driver is asked.
#include <algorithm>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "client_lib/context/ask_one.h"
#include "client_lib/context/context.h"
#include "client_lib/context/es_words.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/param_commands.h"
#include "client_lib/objects/es_formats.h"
#include "client_lib/objects/renderbuffer.h"
#include "client_lib/objects/share_group.h"
#include "common/glapi/format_words.h"
#include "common/glapi/texture_target.h"

namespace wall::client::api {
namespace {

/// Of what has several samples: before OpenGL ES 3.1 there are only renderbuffers.
bool has_samples(const Context& c, GLenum target) {
    if (target == GL_RENDERBUFFER) return true;
    const auto* info = target_of(target);
    return info && info->samples && (!c.profile.is_es() || is_es_word(c.profile.es, target));
}

/// Of formats without a size OpenGL ES says so of those that glTexImage has for colours (OpenGL ES 3.2, 20.3.1).
bool is_said_to_be_drawn(GLenum internal_format, const TextureFormat& format) {
    if (internal_format == GL_RGB || internal_format == GL_RGBA) return true;
    return internal_format != GL_STENCIL_INDEX && (format.base == GL_STENCIL_INDEX || is_sized(format));
}

/// Null: images of that format are not drawn to.
const TextureFormat* drawn_format(const Context& c, GLenum internal_format) {
    const TextureFormat* format = find_renderbuffer_format(internal_format);
    if (!format || is_removed(c, internal_format)) return nullptr;
    if (!c.profile.is_es()) return format;
    return is_said_to_be_drawn(internal_format, *format) && es_is_drawn(c.profile.es, format->answer) ? format
                                                                                                      : nullptr;
}

std::vector<GLsizei> samples_of(Context& c, const TextureFormat& format) {
    if (!has_samples_of_integers(c.profile) && format.whole()) return {};
    if (c.profile.is_es() && format.base != GL_STENCIL_INDEX && !is_sized(format)) return {};
    return sample_counts(static_cast<GLsizei>(limit_of(c.caps(), GL_MAX_SAMPLES, kUsualSamples)));
}

/// Of samples: answered here, as the client rounds their number.
template <class Out>
void get_samples(Context& c, const TextureFormat* format, GLenum pname, GLsizei room, Out* params) {
    const auto counts = format ? samples_of(c, *format) : std::vector<GLsizei>();
    if (pname == GL_NUM_SAMPLE_COUNTS && room > 0) *params = static_cast<Out>(counts.size());
    if (pname == GL_SAMPLES) std::copy_n(counts.begin(), std::min<std::size_t>(counts.size(), room), params);
}

/// The client takes images of that format for the target; what it does not know, nodes are not asked about.
bool is_known(const Context& c, GLenum target, GLenum internal_format) {
    if (has_samples(c, target)) {
        const TextureFormat* format = drawn_format(c, internal_format);
        return format && (target == GL_RENDERBUFFER || format->use == ImageUse::drawn);
    }
    return !is_removed(c, internal_format) && find_texture_format(static_cast<GLint>(internal_format)) != nullptr;
}

/// What the nodes' drivers say, each asked once.
GLint64 answer_of(Context& c, GLenum target, GLenum internal_format, std::size_t word) {
    if (!is_known(c, target, internal_format)) return 0;
    const std::pair key(target, internal_format);
    {
        std::lock_guard lock(c.share().mutex);
        const auto found = c.share().format_answers.find(key);
        if (found != c.share().format_answers.end()) return found->second[word];
    }
    const auto answer = ask_one_node(c, "glGetInternalformativ", [&](wire::PackBuffer& buffer, RequestId request) {
        glapi::pack::FormatQuery(buffer, request, target, internal_format);
    });
    std::vector<GLint64> values(glapi::kFormatWords.size());
    const std::size_t bytes = values.size() * sizeof(GLint64);
    if (!answer || answer->bytes.size() != bytes) return 0;
    std::memcpy(values.data(), answer->bytes.data(), bytes);
    std::lock_guard lock(c.share().mutex);
    return c.share().format_answers.insert_or_assign(key, std::move(values)).first->second[word];
}

/// What glGetTexLevelParameter says of a compressed format, whose blocks have no bits for each component: nodes may
/// have taken another one for a generic format. Nothing: the word is not one of these.
std::optional<GLint64> bits_of_blocks(GLenum internal_format, GLenum word) {
    const TextureFormat* format = find_texture_format(static_cast<GLint>(internal_format));
    if (!format || !format->compressed()) return {};
    switch (word) {
        case GL_INTERNALFORMAT_RED_SIZE: return format->bits.red;
        case GL_INTERNALFORMAT_GREEN_SIZE: return format->bits.green;
        case GL_INTERNALFORMAT_BLUE_SIZE: return format->bits.blue;
        case GL_INTERNALFORMAT_ALPHA_SIZE: return format->bits.alpha;
        default: return {};
    }
}

GLint64 answer_to(Context& c, GLenum target, GLenum internal_format, std::size_t word) {
    const GLint64 answer = answer_of(c, target, internal_format, word);
    if (answer == 0) return 0;  // not for this target, or no such component
    return bits_of_blocks(internal_format, glapi::kFormatWords[word]).value_or(answer);
}

/// What every version of OpenGL 4 answers: nothing that is not supported is an error (GL_ARB_internalformat_query2).
template <class Out>
void get_any(Context& c, GLenum target, GLenum internal_format, GLenum pname, GLsizei room, Out* params) {
    const auto* info = target_of(target);
    if (target != GL_RENDERBUFFER && !info) return c.error(GL_INVALID_ENUM);
    const bool samples = pname == GL_SAMPLES || pname == GL_NUM_SAMPLE_COUNTS;
    const auto* word = std::ranges::find(glapi::kFormatWords, pname);
    if (!samples && word == glapi::kFormatWords.end()) return c.error(GL_INVALID_ENUM);
    if (room < 0) return c.error(GL_INVALID_VALUE);
    if (samples) {
        const TextureFormat* format = has_samples(c, target) ? drawn_format(c, internal_format) : nullptr;
        return get_samples(c, format, pname, room, params);
    }
    const auto index = static_cast<std::size_t>(word - glapi::kFormatWords.begin());
    constexpr GLint64 kMost = std::numeric_limits<Out>::max();
    if (room > 0) *params = static_cast<Out>(std::min(answer_to(c, target, internal_format, index), kMost));
}

template <class Out>
void get(Context& c, GLenum target, GLenum internal_format, GLenum pname, GLsizei room, Out* params) {
    if (c.profile.es == 0) return get_any(c, target, internal_format, pname, room, params);
    if (!has_samples(c, target)) return c.error(GL_INVALID_ENUM);
    const TextureFormat* format = drawn_format(c, internal_format);
    if (!format || (pname != GL_SAMPLES && pname != GL_NUM_SAMPLE_COUNTS)) return c.error(GL_INVALID_ENUM);
    if (room < 0) return c.error(GL_INVALID_VALUE);
    get_samples(c, format, pname, room, params);
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
