// SPDX-License-Identifier: MIT
// Query objects (OpenGL 3.3, 2.14). Only a question for a result waits for an answer, once for each query.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "client_lib/api/query_targets.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/captured_draw.h"
#include "client_lib/context/context.h"
#include "client_lib/context/copied_parts.h"
#include "client_lib/context/query_result.h"
#include "client_lib/context/query_state.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

/// A target: where a query of it is current, and the bits of its result.
struct Target {
    GLenum target;
    QuerySlot slot;
    GLint bits;
};
constexpr Target kTargets[] = {
    {GL_SAMPLES_PASSED, QuerySlot::samples, 64},
    {GL_ANY_SAMPLES_PASSED, QuerySlot::samples, 1},
    {GL_ANY_SAMPLES_PASSED_CONSERVATIVE, QuerySlot::samples, 1},
    {GL_PRIMITIVES_GENERATED, QuerySlot::primitives, 64},
    {GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, QuerySlot::captured, 64},
    {GL_TIME_ELAPSED, QuerySlot::time, 64},
    {GL_TIMESTAMP, QuerySlot::none, 64},
};

}  // namespace

std::optional<QuerySlot> slot_of_query(GLenum target) {
    const auto* found = std::ranges::find(kTargets, target, &Target::target);
    return found != std::end(kTargets) ? std::optional(found->slot) : std::nullopt;
}

namespace {

/// Null, and the error is set: there is none of that name.
const Target* find_target(Context& c, GLenum target, bool begins) {
    const auto* found = std::ranges::find(kTargets, target, &Target::target);
    if (found != std::end(kTargets) && !(begins && found->slot == QuerySlot::none)) return found;
    c.error(GL_INVALID_ENUM);
    return nullptr;
}

/// No stamp says which nodes have counted for it: each that has drawn while it was current.
void forget(Context& c, const QueryObject& query) {
    if (!query.id || query.slot == QuerySlot::time || query.slot == QuerySlot::none) return;
    c.session().on_every_node(c.id,
                              [&](wire::PackBuffer& buffer, Node&) { glapi::pack::ObjectDelete(buffer, query.id); });
}

/// What is counted from here on counts for it; null: for none.
void make_current(Context& c, QuerySlot slot, GLuint stream, std::shared_ptr<QueryObject> query) {
    const std::uint32_t id = query ? query->id.value : 0;
    if (slot == QuerySlot::samples) c.set<el::occlusion_query>(0, id);
    if (slot == QuerySlot::primitives) c.set<el::primitives_query>(stream, id);
    if (slot == QuerySlot::captured) c.set<el::captured_query>(stream, id);
    if (slot == QuerySlot::time) c.flush_block();
    c.queries->current(slot, stream) = std::move(query);
}

bool is_current(const Context& c, const QueryObject& query) {
    return query.slot != QuerySlot::none && c.queries->current(query.slot, query.stream).get() == &query;
}

/// The streams that there may be a query of the target for. False, and an error: there is none of this number.
bool check_stream(Context& c, const Target& target, GLuint stream) {
    if (stream < (by_stream(target.slot) ? vertex_streams(c) : 1)) return true;
    return c.error(GL_INVALID_VALUE), false;
}

void end(Context& c, const std::shared_ptr<QueryObject>& query) {
    make_current(c, query->slot, query->stream, nullptr);
    query->place = ++c.queries->ended;
    if (query->slot == QuerySlot::time) query->ended = c.session().fence();
}

/// The object of a name that begins anew; null, and the error is set, if it may not.
std::shared_ptr<QueryObject> begun_anew(Context& c, GLuint name, const Target& target) {
    if (name == 0) return c.error(GL_INVALID_OPERATION), nullptr;
    auto query = c.queries->names.find(name);
    if (query && (is_current(c, *query) || query->target != target.target))
        return c.error(GL_INVALID_OPERATION), nullptr;
    if (!query && !c.profile.has_fixed_function() && !c.queries->names.known(name))
        return c.error(GL_INVALID_OPERATION), nullptr;
    if (!query) c.queries->names.put(name, query = std::make_shared<QueryObject>());
    forget(c, *query);
    *query = {};
    query->name = name;
    query->target = target.target;
    query->slot = target.slot;
    query->id = next_object_id();
    return query;
}

/// What is asked for of a query; nothing: there is an error, or it is not known yet and need not be.
template <class Out>
std::optional<Out> answer(Context& c, GLuint name, GLenum pname) {
    const auto query = c.queries->names.find(name);
    if (!query || is_current(c, *query)) return c.error(GL_INVALID_OPERATION), std::nullopt;
    constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<Out>::max());
    switch (pname) {
        case GL_QUERY_RESULT_NO_WAIT:
            if (!is_available(c, *query)) return std::nullopt;
            [[fallthrough]];
        case GL_QUERY_RESULT: return static_cast<Out>(std::min(result_of(c, *query), kMost));
        case GL_QUERY_RESULT_AVAILABLE: return static_cast<Out>(is_available(c, *query));
        case GL_QUERY_TARGET: return static_cast<Out>(query->target);
        default: return c.error(GL_INVALID_ENUM), std::nullopt;
    }
}

/// Into a buffer (GL_ARB_query_buffer_object). The content is here, so that the program waits as if it had asked.
template <class Out>
void get_into(Context& c, ClientName buffer_id, GLuint name, GLenum pname, GLintptr offset) {
    Buffer* buffer = buffer_of(c, buffer_id);
    if (!buffer) return c.error(GL_INVALID_OPERATION);
    if (offset < 0) return c.error(GL_INVALID_VALUE);
    const auto first = static_cast<std::size_t>(offset);
    const auto value = answer<Out>(c, name, pname);
    if (!value) return;
    before_writing(c, *buffer);
    std::lock_guard lock(c.share().mutex);
    if (buffer->blocked() || first > buffer->size() || sizeof(Out) > buffer->size() - first)
        return c.error(GL_INVALID_OPERATION);
    buffer->write({first, first + sizeof(Out)}, &*value);
}

template <class Out>
void get(Context& c, GLuint name, GLenum pname, Out* params) {
    if (const ClientName buffer(c.state.local.query_buffer); buffer)
        return get_into<Out>(c, buffer, name, pname, reinterpret_cast<GLintptr>(params));
    if (const auto value = answer<Out>(c, name, pname)) *params = *value;
}

template <class Out>
void get_into_named(Context& c, GLuint name, GLuint buffer_name, GLenum pname, GLintptr offset) {
    std::shared_ptr<Buffer> buffer;
    {
        std::lock_guard lock(c.share().mutex);
        if (buffer_name != 0) buffer = c.share().buffers.find(buffer_name);
    }
    if (!buffer) return c.error(GL_INVALID_OPERATION);
    c.buffers->by_id.try_emplace(buffer->id, buffer);
    get_into<Out>(c, buffer->id, name, pname, offset);
}

}  // namespace

void GenQueries(Context& c, GLsizei count, GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    const GLuint first = c.queries->names.reserve(static_cast<GLuint>(count));
    for (GLsizei i = 0; i < count; ++i) names[i] = first + static_cast<GLuint>(i);
}

void DeleteQueries(Context& c, GLsizei count, const GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    for (GLsizei i = 0; i < count; ++i) {
        const auto query = names[i] == 0 ? nullptr : c.queries->names.erase(names[i]);
        if (!query) continue;
        if (is_current(c, *query)) end(c, query);
        forget(c, *query);
    }
}

GLboolean IsQuery(Context& c, GLuint name) { return name != 0 && c.queries->names.find(name) != nullptr; }

void BeginQueryIndexed(Context& c, GLenum word, GLuint stream, GLuint name) {
    const Target* target = find_target(c, word, true);
    if (!target || !check_stream(c, *target, stream)) return;
    if (c.queries->current(target->slot, stream)) return c.error(GL_INVALID_OPERATION);
    const auto query = begun_anew(c, name, *target);
    if (!query) return;
    query->stream = stream;
    if (target->slot == QuerySlot::samples) want_whole_images(c);  // of what all nodes draw alike one counts
    make_current(c, target->slot, stream, query);
    if (target->slot == QuerySlot::time) query->begun = c.session().fence();
}

void EndQueryIndexed(Context& c, GLenum word, GLuint stream) {
    const Target* target = find_target(c, word, true);
    if (!target || !check_stream(c, *target, stream)) return;
    const auto query = c.queries->current(target->slot, stream);
    if (!query || query->target != word) return c.error(GL_INVALID_OPERATION);
    end(c, query);
}

void QueryCounter(Context& c, GLuint name, GLenum word) {
    if (word != GL_TIMESTAMP) return c.error(GL_INVALID_ENUM);
    const auto query = begun_anew(c, name, *find_target(c, word, false));
    if (!query) return;
    c.flush_block();
    query->place = ++c.queries->ended;
    query->ended = c.session().fence();
}

void GetQueryIndexediv(Context& c, GLenum word, GLuint stream, GLenum pname, GLint* params) {
    const Target* target = find_target(c, word, false);
    if (!target || !check_stream(c, *target, stream)) return;
    const auto current = target->slot == QuerySlot::none ? nullptr : c.queries->current(target->slot, stream);
    if (pname == GL_CURRENT_QUERY) *params = current && current->target == word ? static_cast<GLint>(current->name) : 0;
    else if (pname == GL_QUERY_COUNTER_BITS) *params = target->bits;
    else c.error(GL_INVALID_ENUM);
}

void GetQueryObjectiv(Context& c, GLuint name, GLenum pname, GLint* params) { get(c, name, pname, params); }
void GetQueryObjectuiv(Context& c, GLuint name, GLenum pname, GLuint* params) { get(c, name, pname, params); }
void GetQueryObjecti64v(Context& c, GLuint name, GLenum pname, GLint64* params) { get(c, name, pname, params); }
void GetQueryObjectui64v(Context& c, GLuint name, GLenum pname, GLuint64* params) { get(c, name, pname, params); }

void GetQueryBufferObjectiv(Context& c, GLuint name, GLuint buffer, GLenum pname, GLintptr offset) {
    get_into_named<GLint>(c, name, buffer, pname, offset);
}
void GetQueryBufferObjectuiv(Context& c, GLuint name, GLuint buffer, GLenum pname, GLintptr offset) {
    get_into_named<GLuint>(c, name, buffer, pname, offset);
}
void GetQueryBufferObjecti64v(Context& c, GLuint name, GLuint buffer, GLenum pname, GLintptr offset) {
    get_into_named<GLint64>(c, name, buffer, pname, offset);
}
void GetQueryBufferObjectui64v(Context& c, GLuint name, GLuint buffer, GLenum pname, GLintptr offset) {
    get_into_named<GLuint64>(c, name, buffer, pname, offset);
}

}  // namespace wall::client::api
