// SPDX-License-Identifier: MIT
#include "tileserver/gpu/caps.h"

#include <algorithm>
#include <array>

#include "tileserver/gpu/extensions.h"

namespace wall::tileserver {
namespace {

struct LimitRow {
    GLenum name;
    std::size_t count;  // values
};

/// Every glGet value of OpenGL 4.5 compatibility that is the implementation's own and not a context's state.
constexpr LimitRow kLimits[] = {
    // OpenGL 1.x
    {GL_MAX_LIGHTS, 1},
    {GL_MAX_CLIP_PLANES, 1},
    {GL_MAX_TEXTURE_SIZE, 1},
    {GL_MAX_PIXEL_MAP_TABLE, 1},
    {GL_MAX_ATTRIB_STACK_DEPTH, 1},
    {GL_MAX_CLIENT_ATTRIB_STACK_DEPTH, 1},
    {GL_MAX_MODELVIEW_STACK_DEPTH, 1},
    {GL_MAX_PROJECTION_STACK_DEPTH, 1},
    {GL_MAX_TEXTURE_STACK_DEPTH, 1},
    {GL_MAX_NAME_STACK_DEPTH, 1},
    {GL_MAX_LIST_NESTING, 1},
    {GL_MAX_EVAL_ORDER, 1},
    {GL_MAX_VIEWPORT_DIMS, 2},
    {GL_SUBPIXEL_BITS, 1},
    {GL_POINT_SIZE_RANGE, 2},
    {GL_POINT_SIZE_GRANULARITY, 1},
    {GL_LINE_WIDTH_RANGE, 2},
    {GL_LINE_WIDTH_GRANULARITY, 1},
    {GL_ALIASED_POINT_SIZE_RANGE, 2},
    {GL_ALIASED_LINE_WIDTH_RANGE, 2},
    {GL_MAX_3D_TEXTURE_SIZE, 1},
    {GL_MAX_ELEMENTS_VERTICES, 1},
    {GL_MAX_ELEMENTS_INDICES, 1},
    {GL_MAX_TEXTURE_UNITS, 1},
    {GL_MAX_CUBE_MAP_TEXTURE_SIZE, 1},
    {GL_MAX_TEXTURE_LOD_BIAS, 1},
    {GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, 1},
    {GL_MAX_RECTANGLE_TEXTURE_SIZE, 1},
    {GL_RGBA_MODE, 1},
    {GL_INDEX_MODE, 1},
    // OpenGL 2.x
    {GL_MAX_DRAW_BUFFERS, 1},
    {GL_MAX_TEXTURE_COORDS, 1},
    {GL_MAX_TEXTURE_IMAGE_UNITS, 1},
    {GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, 1},
    {GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS, 1},
    {GL_MAX_VERTEX_ATTRIBS, 1},
    {GL_MAX_VERTEX_UNIFORM_COMPONENTS, 1},
    {GL_MAX_FRAGMENT_UNIFORM_COMPONENTS, 1},
    {GL_MAX_VARYING_FLOATS, 1},
    // OpenGL 3.x
    {GL_MAJOR_VERSION, 1},
    {GL_MINOR_VERSION, 1},
    {GL_NUM_EXTENSIONS, 1},
    {GL_CONTEXT_FLAGS, 1},
    {GL_CONTEXT_PROFILE_MASK, 1},
    {GL_MAX_COLOR_ATTACHMENTS, 1},
    {GL_MAX_RENDERBUFFER_SIZE, 1},
    {GL_MAX_SAMPLES, 1},
    {GL_MAX_ARRAY_TEXTURE_LAYERS, 1},
    {GL_MAX_CLIP_DISTANCES, 1},
    {GL_MIN_PROGRAM_TEXEL_OFFSET, 1},
    {GL_MAX_PROGRAM_TEXEL_OFFSET, 1},
    {GL_MAX_VARYING_COMPONENTS, 1},
    {GL_MAX_TRANSFORM_FEEDBACK_INTERLEAVED_COMPONENTS, 1},
    {GL_MAX_TRANSFORM_FEEDBACK_SEPARATE_ATTRIBS, 1},
    {GL_MAX_TRANSFORM_FEEDBACK_SEPARATE_COMPONENTS, 1},
    {GL_MAX_TEXTURE_BUFFER_SIZE, 1},
    {GL_MAX_UNIFORM_BUFFER_BINDINGS, 1},
    {GL_MAX_UNIFORM_BLOCK_SIZE, 1},
    {GL_MAX_VERTEX_UNIFORM_BLOCKS, 1},
    {GL_MAX_FRAGMENT_UNIFORM_BLOCKS, 1},
    {GL_MAX_GEOMETRY_UNIFORM_BLOCKS, 1},
    {GL_MAX_COMBINED_UNIFORM_BLOCKS, 1},
    {GL_MAX_COMBINED_VERTEX_UNIFORM_COMPONENTS, 1},
    {GL_MAX_COMBINED_FRAGMENT_UNIFORM_COMPONENTS, 1},
    {GL_MAX_COMBINED_GEOMETRY_UNIFORM_COMPONENTS, 1},
    {GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, 1},
    {GL_MAX_GEOMETRY_TEXTURE_IMAGE_UNITS, 1},
    {GL_MAX_GEOMETRY_OUTPUT_VERTICES, 1},
    {GL_MAX_GEOMETRY_TOTAL_OUTPUT_COMPONENTS, 1},
    {GL_MAX_GEOMETRY_UNIFORM_COMPONENTS, 1},
    {GL_MAX_GEOMETRY_INPUT_COMPONENTS, 1},
    {GL_MAX_GEOMETRY_OUTPUT_COMPONENTS, 1},
    {GL_MAX_VERTEX_OUTPUT_COMPONENTS, 1},
    {GL_MAX_FRAGMENT_INPUT_COMPONENTS, 1},
    {GL_MAX_SERVER_WAIT_TIMEOUT, 1},
    {GL_MAX_SAMPLE_MASK_WORDS, 1},
    {GL_MAX_COLOR_TEXTURE_SAMPLES, 1},
    {GL_MAX_DEPTH_TEXTURE_SAMPLES, 1},
    {GL_MAX_INTEGER_SAMPLES, 1},
    {GL_MAX_DUAL_SOURCE_DRAW_BUFFERS, 1},
    {GL_QUADS_FOLLOW_PROVOKING_VERTEX_CONVENTION, 1},
    // OpenGL 4.x
    {GL_MAX_PATCH_VERTICES, 1},
    {GL_MAX_TESS_GEN_LEVEL, 1},
    {GL_MAX_TESS_CONTROL_UNIFORM_COMPONENTS, 1},
    {GL_MAX_TESS_EVALUATION_UNIFORM_COMPONENTS, 1},
    {GL_MAX_TESS_CONTROL_TEXTURE_IMAGE_UNITS, 1},
    {GL_MAX_TESS_EVALUATION_TEXTURE_IMAGE_UNITS, 1},
    {GL_MAX_TESS_CONTROL_OUTPUT_COMPONENTS, 1},
    {GL_MAX_TESS_PATCH_COMPONENTS, 1},
    {GL_MAX_TESS_CONTROL_TOTAL_OUTPUT_COMPONENTS, 1},
    {GL_MAX_TESS_EVALUATION_OUTPUT_COMPONENTS, 1},
    {GL_MAX_TESS_CONTROL_INPUT_COMPONENTS, 1},
    {GL_MAX_TESS_EVALUATION_INPUT_COMPONENTS, 1},
    {GL_MAX_TESS_CONTROL_UNIFORM_BLOCKS, 1},
    {GL_MAX_TESS_EVALUATION_UNIFORM_BLOCKS, 1},
    {GL_MAX_COMBINED_TESS_CONTROL_UNIFORM_COMPONENTS, 1},
    {GL_MAX_COMBINED_TESS_EVALUATION_UNIFORM_COMPONENTS, 1},
    {GL_MAX_GEOMETRY_SHADER_INVOCATIONS, 1},
    {GL_MIN_FRAGMENT_INTERPOLATION_OFFSET, 1},
    {GL_MAX_FRAGMENT_INTERPOLATION_OFFSET, 1},
    {GL_FRAGMENT_INTERPOLATION_OFFSET_BITS, 1},
    {GL_MIN_PROGRAM_TEXTURE_GATHER_OFFSET, 1},
    {GL_MAX_PROGRAM_TEXTURE_GATHER_OFFSET, 1},
    {GL_MAX_TRANSFORM_FEEDBACK_BUFFERS, 1},
    {GL_MAX_VERTEX_STREAMS, 1},
    {GL_MAX_SUBROUTINES, 1},
    {GL_MAX_SUBROUTINE_UNIFORM_LOCATIONS, 1},
    {GL_MAX_VIEWPORTS, 1},
    {GL_VIEWPORT_SUBPIXEL_BITS, 1},
    {GL_VIEWPORT_BOUNDS_RANGE, 2},
    {GL_LAYER_PROVOKING_VERTEX, 1},
    {GL_VIEWPORT_INDEX_PROVOKING_VERTEX, 1},
    {GL_MAX_VERTEX_UNIFORM_VECTORS, 1},
    {GL_MAX_VARYING_VECTORS, 1},
    {GL_MAX_FRAGMENT_UNIFORM_VECTORS, 1},
    {GL_SHADER_COMPILER, 1},
    {GL_IMPLEMENTATION_COLOR_READ_FORMAT, 1},
    {GL_IMPLEMENTATION_COLOR_READ_TYPE, 1},
    {GL_NUM_PROGRAM_BINARY_FORMATS, 1},
    {GL_NUM_SHADER_BINARY_FORMATS, 1},
    {GL_MIN_MAP_BUFFER_ALIGNMENT, 1},
    {GL_MAX_IMAGE_UNITS, 1},
    {GL_MAX_COMBINED_SHADER_OUTPUT_RESOURCES, 1},
    {GL_MAX_IMAGE_SAMPLES, 1},
    {GL_MAX_VERTEX_IMAGE_UNIFORMS, 1},
    {GL_MAX_TESS_CONTROL_IMAGE_UNIFORMS, 1},
    {GL_MAX_TESS_EVALUATION_IMAGE_UNIFORMS, 1},
    {GL_MAX_GEOMETRY_IMAGE_UNIFORMS, 1},
    {GL_MAX_FRAGMENT_IMAGE_UNIFORMS, 1},
    {GL_MAX_COMBINED_IMAGE_UNIFORMS, 1},
    {GL_MAX_ATOMIC_COUNTER_BUFFER_BINDINGS, 1},
    {GL_MAX_ATOMIC_COUNTER_BUFFER_SIZE, 1},
    {GL_MAX_COMBINED_ATOMIC_COUNTERS, 1},
    {GL_MAX_COMBINED_ATOMIC_COUNTER_BUFFERS, 1},
    {GL_MAX_VERTEX_ATOMIC_COUNTERS, 1},
    {GL_MAX_FRAGMENT_ATOMIC_COUNTERS, 1},
    {GL_MAX_VERTEX_ATOMIC_COUNTER_BUFFERS, 1},
    {GL_MAX_FRAGMENT_ATOMIC_COUNTER_BUFFERS, 1},
    {GL_MAX_TESS_CONTROL_ATOMIC_COUNTERS, 1},
    {GL_MAX_TESS_EVALUATION_ATOMIC_COUNTERS, 1},
    {GL_MAX_GEOMETRY_ATOMIC_COUNTERS, 1},
    {GL_MAX_TESS_CONTROL_ATOMIC_COUNTER_BUFFERS, 1},
    {GL_MAX_TESS_EVALUATION_ATOMIC_COUNTER_BUFFERS, 1},
    {GL_MAX_GEOMETRY_ATOMIC_COUNTER_BUFFERS, 1},
    {GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, 1},
    {GL_MAX_SHADER_STORAGE_BLOCK_SIZE, 1},
    {GL_MAX_COMBINED_SHADER_STORAGE_BLOCKS, 1},
    {GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, 1},
    {GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS, 1},
    {GL_MAX_TESS_CONTROL_SHADER_STORAGE_BLOCKS, 1},
    {GL_MAX_TESS_EVALUATION_SHADER_STORAGE_BLOCKS, 1},
    {GL_MAX_GEOMETRY_SHADER_STORAGE_BLOCKS, 1},
    {GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT, 1},
    {GL_MAX_COMPUTE_UNIFORM_BLOCKS, 1},
    {GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS, 1},
    {GL_MAX_COMPUTE_SHARED_MEMORY_SIZE, 1},
    {GL_MAX_COMPUTE_UNIFORM_COMPONENTS, 1},
    {GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, 1},
    {GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, 1},
    {GL_MAX_COMPUTE_ATOMIC_COUNTERS, 1},
    {GL_MAX_COMPUTE_ATOMIC_COUNTER_BUFFERS, 1},
    {GL_MAX_COMPUTE_IMAGE_UNIFORMS, 1},
    {GL_MAX_COMBINED_COMPUTE_UNIFORM_COMPONENTS, 1},
    {GL_MAX_UNIFORM_LOCATIONS, 1},
    {GL_MAX_FRAMEBUFFER_WIDTH, 1},
    {GL_MAX_FRAMEBUFFER_HEIGHT, 1},
    {GL_MAX_FRAMEBUFFER_LAYERS, 1},
    {GL_MAX_FRAMEBUFFER_SAMPLES, 1},
    {GL_MAX_ELEMENT_INDEX, 1},
    {GL_MAX_DEBUG_MESSAGE_LENGTH, 1},
    {GL_MAX_DEBUG_LOGGED_MESSAGES, 1},
    {GL_MAX_DEBUG_GROUP_STACK_DEPTH, 1},
    {GL_MAX_LABEL_LENGTH, 1},
    {GL_TEXTURE_BUFFER_OFFSET_ALIGNMENT, 1},
    {GL_MAX_VERTEX_ATTRIB_RELATIVE_OFFSET, 1},
    {GL_MAX_VERTEX_ATTRIB_BINDINGS, 1},
    {GL_MAX_VERTEX_ATTRIB_STRIDE, 1},
    {GL_PRIMITIVE_RESTART_FOR_PATCHES_SUPPORTED, 1},
    {GL_MAX_CULL_DISTANCES, 1},
    {GL_MAX_COMBINED_CLIP_AND_CULL_DISTANCES, 1},
    {GL_NUM_SHADING_LANGUAGE_VERSIONS, 1},
    {GL_CONTEXT_RELEASE_BEHAVIOR, 1},
    // GL_ARB_vertex_program, GL_ARB_fragment_program
    {GL_MAX_PROGRAM_MATRICES_ARB, 1},
    {GL_MAX_PROGRAM_MATRIX_STACK_DEPTH_ARB, 1},
    // OpenGL ES 3.2 (GL_ARB_ES3_2_compatibility)
    {GL_MULTISAMPLE_LINE_WIDTH_RANGE_ARB, 2},
    {GL_MULTISAMPLE_LINE_WIDTH_GRANULARITY_ARB, 1},
};

constexpr std::size_t kMaxFormats = 512;

/// A list whose length is another value.
void add_list(const Gl& gl, GLenum count_name, GLenum name, GlCaps& caps) {
    GLint count = 0;
    gl.GetIntegerv(count_name, &count);
    if (gl.GetError() != GL_NO_ERROR || count < 0 || static_cast<std::size_t>(count) > kMaxFormats) return;
    std::vector<GLint> values(kMaxFormats);
    gl.GetIntegerv(name, values.data());
    caps.limits.push_back({count_name, {static_cast<double>(count)}});
    caps.limits.push_back({name, {values.begin(), values.begin() + count}});
}

/// Of each stage of assembly programs one.
void add_assembly_limits(const Gl& gl, GlCaps& caps) {
    if (!has_assembly(gl)) return;
    using glapi::AssemblyStage;
    const auto add = [&](GLenum name, auto&& value) {
        const double vertices = value(AssemblyStage::vertex), fragments = value(AssemblyStage::fragment);
        caps.limits.push_back({name, {vertices, fragments}});
    };
    for (const glapi::AssemblyWord& word : glapi::kAssemblyWords)
        add(word.most, [&](AssemblyStage stage) { return word.of(stage) ? assembly_value(gl, stage, word.most) : 0; });
    add(GL_MAX_PROGRAM_LOCAL_PARAMETERS_ARB,
        [&](AssemblyStage stage) { return assembly_value(gl, stage, GL_MAX_PROGRAM_LOCAL_PARAMETERS_ARB); });
    add(GL_MAX_PROGRAM_ENV_PARAMETERS_ARB,
        [&](AssemblyStage stage) { return static_cast<GLint>(environment_parameters(gl, stage)); });
    while (gl.GetError() != GL_NO_ERROR) {
    }
}

std::string text(const GLubyte* string) { return string != nullptr ? reinterpret_cast<const char*>(string) : ""; }

}  // namespace

GlCaps query_caps(const Gl& gl) {
    GlCaps caps{text(gl.GetString(GL_VENDOR)),     text(gl.GetString(GL_RENDERER)),
                text(gl.GetString(GL_VERSION)),    text(gl.GetString(GL_SHADING_LANGUAGE_VERSION)),
                text(gl.GetString(GL_EXTENSIONS)), {}};
    while (gl.GetError() != GL_NO_ERROR) {
    }
    for (const LimitRow& row : kLimits) {
        std::array<GLdouble, 4> values{};
        gl.GetDoublev(row.name, values.data());
        if (gl.GetError() == GL_NO_ERROR)
            caps.limits.push_back(
                {row.name, {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(row.count)}});
    }
    add_assembly_limits(gl, caps);
    add_list(gl, GL_NUM_COMPRESSED_TEXTURE_FORMATS, GL_COMPRESSED_TEXTURE_FORMATS, caps);
    for (const GLenum dimension : {GL_MAX_COMPUTE_WORK_GROUP_COUNT, GL_MAX_COMPUTE_WORK_GROUP_SIZE}) {
        std::vector<double> values;
        for (GLuint i = 0; i < 3; ++i) {
            GLint value = 0;
            gl.GetIntegeri_v(dimension, i, &value);
            values.push_back(value);
        }
        if (gl.GetError() == GL_NO_ERROR) caps.limits.push_back({dimension, values});
    }
    return caps;
}

bool is_software(const GlCaps& caps) {
    constexpr std::array kNames = {"llvmpipe", "softpipe", "SWR", "Software Rasterizer", "swrast"};
    return std::ranges::any_of(kNames, [&](const char* name) { return caps.renderer.find(name) != std::string::npos; });
}

}  // namespace wall::tileserver
