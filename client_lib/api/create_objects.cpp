// SPDX-License-Identifier: MIT
// Objects that are there without having been bound (GL_ARB_direct_state_access; OpenGL 4.5): a name and, other than by
// glGen*, the object.
#include <algorithm>
#include <memory>
#include <mutex>

#include "client_lib/api/query_targets.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/context.h"
#include "client_lib/context/framebuffer_use.h"
#include "client_lib/context/query_state.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/vertex_array_objects.h"
#include "client_lib/objects/program_pipeline.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

/// Objects of a table of the share group: `make(name)` is one.
template <class T, class Make>
void create_shared(Context& c, NameTable<T>& table, GLsizei count, GLuint* names, Make&& make) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    std::lock_guard lock(c.share().mutex);
    const GLuint first = table.reserve(static_cast<GLuint>(count));
    for (GLuint i = 0; names && i < static_cast<GLuint>(count); ++i) {
        const std::shared_ptr<T> made = make(names[i] = first + i);
        table.put(made->name, made);
        c.share().by_id[made->id] = made;
    }
}

/// The same of the context's own.
template <class Table, class Make>
void create_own(Context& c, Table& table, GLsizei count, GLuint* names, Make&& make) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    const GLuint first = table.reserve(static_cast<GLuint>(count));
    for (GLuint i = 0; names && i < static_cast<GLuint>(count); ++i) table.put(names[i] = first + i, make(first + i));
}

}  // namespace

void CreateBuffers(Context& c, GLsizei count, GLuint* names) {
    create_shared(c, c.share().buffers, count, names,
                  [](GLuint name) { return std::make_shared<Buffer>(next_object_id(), name); });
}

void CreateTextures(Context& c, GLenum target, GLsizei count, GLuint* names) {
    const auto* info = target_of(target);
    if (!info) return c.error(GL_INVALID_ENUM);
    create_shared(c, c.share().textures, count, names, [&](GLuint name) { return make_texture(c, name, info->id); });
}

void CreateRenderbuffers(Context& c, GLsizei count, GLuint* names) {
    create_shared(c, c.share().renderbuffers, count, names,
                  [](GLuint name) { return std::make_shared<Renderbuffer>(name); });
}

void CreateSamplers(Context& c, GLsizei count, GLuint* names) { GenSamplers(c, count, names); }

void CreateFramebuffers(Context& c, GLsizei count, GLuint* names) {
    create_own(c, c.framebuffers->names, count, names, [&](GLuint name) {
        auto made = std::make_shared<Framebuffer>(name, c.profile.es);
        std::lock_guard lock(c.share().mutex);
        c.share().by_id[made->id] = made;
        return made;
    });
}

void CreateVertexArrays(Context& c, GLsizei count, GLuint* names) {
    if (count < 0) return c.error(GL_INVALID_VALUE);
    GenVertexArrays(c, count, names);
    const GLuint bound = c.state.vertex_arrays.vertex_array_object;
    for (GLsizei i = 0; i < count; ++i) c.vertex_array_objects->bind(c.state, names[i]);
    c.vertex_array_objects->bind(c.state, bound);
}

void CreateTransformFeedbacks(Context& c, GLsizei count, GLuint* names) {
    create_own(c, c.captures->names, count, names, [](GLuint) { return std::make_shared<FeedbackObject>(); });
}

void CreateProgramPipelines(Context& c, GLsizei count, GLuint* names) {
    GenProgramPipelines(c, count, names);
    for (GLsizei i = 0; i < count; ++i) {
        GLint bound = 0;
        GetProgramPipelineiv(c, names[i], GL_ACTIVE_PROGRAM, &bound);  // the first command about it makes it
    }
}

void CreateQueries(Context& c, GLenum target, GLsizei count, GLuint* names) {
    const auto slot = slot_of_query(target);
    if (!slot) return c.error(GL_INVALID_ENUM);
    create_own(c, c.queries->names, count, names, [&](GLuint name) {
        auto made = std::make_shared<QueryObject>();
        made->name = name;
        made->target = target;
        made->slot = *slot;
        made->answered = true;  // nothing has been counted
        return made;
    });
}

}  // namespace wall::client::api
