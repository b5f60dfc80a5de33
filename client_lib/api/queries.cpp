// SPDX-License-Identifier: MIT
// Occlusion queries. Only glGetQueryObject waits for an answer, once for each query.
#include <algorithm>
#include <cstring>
#include <limits>

#include "client_lib/context/context.h"
#include "client_lib/context/occlusion.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

constexpr GLint kCounterBits = 64;

/// No stamp says which nodes have counted for it: each that has drawn while it was current.
void forget(Context& c, const OcclusionQuery& query) {
    if (!query.id) return;
    c.session().on_every_node(c.id,
                              [&](wire::PackBuffer& buffer, Node&) { glapi::pack::ObjectDelete(buffer, query.id); });
}

std::vector<Node*> live_nodes(ClientSession& session) {
    std::lock_guard lock(session.mutex());
    std::vector<Node*> nodes;
    for (const auto& node : session.nodes())
        if (node->answers()) nodes.push_back(node.get());
    return nodes;
}

std::uint64_t samples_of(Context& c, OcclusionQuery& query) {
    if (query.answered || !query.id) return query.samples;
    c.flush_block();
    c.session().hidden_parts([](HiddenParts& parts) { parts.before_counting_samples(); });
    for (Node* node : live_nodes(c.session())) {
        const auto answer = c.session().ask(
            c.draw_source(), *node, "glGetQueryObject",
            [&](wire::PackBuffer& buffer, RequestId request) { glapi::pack::QueryResult(buffer, request, query.id); });
        std::uint64_t samples = 0;
        if (answer && answer->size() == sizeof samples) std::memcpy(&samples, answer->data(), sizeof samples);
        query.samples += samples;
    }
    query.answered = true;
    return query.samples;
}

template <class Out>
void get(Context& c, GLuint name, GLenum pname, Out* params) {
    const auto query = c.occlusion->queries.find(name);
    if (!query || query == c.occlusion->current) return c.error(GL_INVALID_OPERATION);
    if (pname == GL_QUERY_RESULT)
        *params = static_cast<Out>(std::min<std::uint64_t>(samples_of(c, *query), std::numeric_limits<Out>::max()));
    else if (pname == GL_QUERY_RESULT_AVAILABLE) *params = GL_TRUE;  // asking for the result waits
    else c.error(GL_INVALID_ENUM);
}

}  // namespace

void GenQueries(Context& c, GLsizei count, GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    const GLuint first = c.occlusion->queries.reserve(static_cast<GLuint>(count));
    for (GLsizei i = 0; i < count; ++i) names[i] = first + static_cast<GLuint>(i);
}

void DeleteQueries(Context& c, GLsizei count, const GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    for (GLsizei i = 0; i < count; ++i) {
        const auto query = names[i] == 0 ? nullptr : c.occlusion->queries.erase(names[i]);
        if (!query) continue;
        if (query == c.occlusion->current) EndQuery(c, GL_SAMPLES_PASSED);
        forget(c, *query);
    }
}

GLboolean IsQuery(Context& c, GLuint name) { return name != 0 && c.occlusion->queries.find(name) != nullptr; }

void BeginQuery(Context& c, GLenum target, GLuint name) {
    if (target != GL_SAMPLES_PASSED) return c.error(GL_INVALID_ENUM);
    auto& queries = *c.occlusion;
    if (name == 0 || queries.current) return c.error(GL_INVALID_OPERATION);
    auto query = queries.queries.find(name);
    if (!query) {
        query = std::make_shared<OcclusionQuery>();
        queries.queries.put(name, query);
    }
    forget(c, *query);
    *query = {name, next_object_id()};
    queries.current = query;
    c.set<el::occlusion_query>(0, query->id.value);
}

void EndQuery(Context& c, GLenum target) {
    if (target != GL_SAMPLES_PASSED) return c.error(GL_INVALID_ENUM);
    if (!c.occlusion->current) return c.error(GL_INVALID_OPERATION);
    c.occlusion->current = nullptr;
    c.set<el::occlusion_query>(0, 0);
}

void GetQueryiv(Context& c, GLenum target, GLenum pname, GLint* params) {
    if (target != GL_SAMPLES_PASSED) return c.error(GL_INVALID_ENUM);
    const auto& current = c.occlusion->current;
    if (pname == GL_CURRENT_QUERY) *params = current ? static_cast<GLint>(current->name) : 0;
    else if (pname == GL_QUERY_COUNTER_BITS) *params = kCounterBits;
    else c.error(GL_INVALID_ENUM);
}

void GetQueryObjectiv(Context& c, GLuint name, GLenum pname, GLint* params) { get(c, name, pname, params); }
void GetQueryObjectuiv(Context& c, GLuint name, GLenum pname, GLuint* params) { get(c, name, pname, params); }

}  // namespace wall::client::api
