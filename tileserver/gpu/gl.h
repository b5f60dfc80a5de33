// SPDX-License-Identifier: MIT
// The driver's functions, as the tileserver calls them: always through a table loaded from the backend, never through
// libGL. The functions that give and take names also count them, so that every object's life is seen in one place.
// Render thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>

#include "gen/glapi/gl_functions.gen.h"

namespace wall::tileserver {

/// Names that the driver has given and not got back.
struct DriverObjects {
    std::int64_t textures = 0, buffers = 0, lists = 0, programs = 0, shaders = 0, framebuffers = 0, renderbuffers = 0,
                 queries = 0, vertex_arrays = 0, samplers = 0, pipelines = 0, captures = 0, assembly_programs = 0;
    bool operator==(const DriverObjects&) const = default;
};

/// Copies share one count.
struct Gl : glapi::GlFunctions {
    void CreateTextures(GLenum target, GLsizei n, GLuint* names) const {
        GlFunctions::CreateTextures(target, n, names);
        objects->textures += named(n, names);
    }
    void GenTextures(GLsizei n, GLuint* names) const {
        GlFunctions::GenTextures(n, names);
        objects->textures += named(n, names);
    }
    void DeleteTextures(GLsizei n, const GLuint* names) const {
        objects->textures -= named(n, names);
        GlFunctions::DeleteTextures(n, names);
    }
    void CreateBuffers(GLsizei n, GLuint* names) const {
        GlFunctions::CreateBuffers(n, names);
        objects->buffers += named(n, names);
    }
    void DeleteBuffers(GLsizei n, const GLuint* names) const {
        objects->buffers -= named(n, names);
        GlFunctions::DeleteBuffers(n, names);
    }
    void CreateFramebuffers(GLsizei n, GLuint* names) const {
        GlFunctions::CreateFramebuffers(n, names);
        objects->framebuffers += named(n, names);
    }
    void DeleteFramebuffers(GLsizei n, const GLuint* names) const {
        objects->framebuffers -= named(n, names);
        GlFunctions::DeleteFramebuffers(n, names);
    }
    void CreateRenderbuffers(GLsizei n, GLuint* names) const {
        GlFunctions::CreateRenderbuffers(n, names);
        objects->renderbuffers += named(n, names);
    }
    void DeleteRenderbuffers(GLsizei n, const GLuint* names) const {
        objects->renderbuffers -= named(n, names);
        GlFunctions::DeleteRenderbuffers(n, names);
    }
    void CreateVertexArrays(GLsizei n, GLuint* names) const {
        GlFunctions::CreateVertexArrays(n, names);
        objects->vertex_arrays += named(n, names);
    }
    void DeleteVertexArrays(GLsizei n, const GLuint* names) const {
        objects->vertex_arrays -= named(n, names);
        GlFunctions::DeleteVertexArrays(n, names);
    }
    void CreateSamplers(GLsizei n, GLuint* names) const {
        GlFunctions::CreateSamplers(n, names);
        objects->samplers += named(n, names);
    }
    void DeleteSamplers(GLsizei n, const GLuint* names) const {
        objects->samplers -= named(n, names);
        GlFunctions::DeleteSamplers(n, names);
    }
    void CreateProgramPipelines(GLsizei n, GLuint* names) const {
        GlFunctions::CreateProgramPipelines(n, names);
        objects->pipelines += named(n, names);
    }
    void DeleteProgramPipelines(GLsizei n, const GLuint* names) const {
        objects->pipelines -= named(n, names);
        GlFunctions::DeleteProgramPipelines(n, names);
    }
    void CreateTransformFeedbacks(GLsizei n, GLuint* names) const {
        GlFunctions::CreateTransformFeedbacks(n, names);
        objects->captures += named(n, names);
    }
    void DeleteTransformFeedbacks(GLsizei n, const GLuint* names) const {
        objects->captures -= named(n, names);
        GlFunctions::DeleteTransformFeedbacks(n, names);
    }
    void GenProgramsARB(GLsizei n, GLuint* names) const {
        GlFunctions::GenProgramsARB(n, names);
        objects->assembly_programs += named(n, names);
    }
    void DeleteProgramsARB(GLsizei n, const GLuint* names) const {
        objects->assembly_programs -= named(n, names);
        GlFunctions::DeleteProgramsARB(n, names);
    }
    void GenQueries(GLsizei n, GLuint* names) const {
        GlFunctions::GenQueries(n, names);
        objects->queries += named(n, names);
    }
    void DeleteQueries(GLsizei n, const GLuint* names) const {
        objects->queries -= named(n, names);
        GlFunctions::DeleteQueries(n, names);
    }
    GLuint GenLists(GLsizei range) const {
        const GLuint first = GlFunctions::GenLists(range);
        if (first != 0) objects->lists += range;
        return first;
    }
    void DeleteLists(GLuint first, GLsizei range) const {
        if (first != 0) objects->lists -= range;
        GlFunctions::DeleteLists(first, range);
    }
    GLuint CreateProgram() const {
        const GLuint name = GlFunctions::CreateProgram();
        if (name != 0) ++objects->programs;
        return name;
    }
    void DeleteProgram(GLuint name) const {
        if (name != 0) --objects->programs;
        GlFunctions::DeleteProgram(name);
    }
    GLuint CreateShader(GLenum type) const {
        const GLuint name = GlFunctions::CreateShader(type);
        if (name != 0) ++objects->shaders;
        return name;
    }
    void DeleteShader(GLuint name) const {
        if (name != 0) --objects->shaders;
        GlFunctions::DeleteShader(name);
    }

    // These would give names that nobody counts.
    void GenBuffers(GLsizei, GLuint*) const = delete;
    void GenFramebuffers(GLsizei, GLuint*) const = delete;
    void GenRenderbuffers(GLsizei, GLuint*) const = delete;
    void GenVertexArrays(GLsizei, GLuint*) const = delete;
    void GenSamplers(GLsizei, GLuint*) const = delete;
    void GenProgramPipelines(GLsizei, GLuint*) const = delete;
    void GenTransformFeedbacks(GLsizei, GLuint*) const = delete;
    void CreateQueries(GLenum, GLsizei, GLuint*) const = delete;
    GLuint CreateShaderProgramv(GLenum, GLsizei, const GLchar* const*) const = delete;

    std::shared_ptr<DriverObjects> objects = std::make_shared<DriverObjects>();

private:
    /// OpenGL passes over names of 0.
    static std::int64_t named(GLsizei n, const GLuint* names) {
        const auto all = std::span(names, static_cast<std::size_t>(n));
        return n - std::ranges::count(all, 0u);
    }
};

}  // namespace wall::tileserver
