// SPDX-License-Identifier: MIT
#include "client_lib/context/version.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <iterator>

#include "client_lib/context/node_words.h"
#include "client_lib/context/texture_units.h"
#include "gen/client_lib/api.gen.h"

namespace wall::client {
namespace {

bool implemented(const char* command) {
    return std::none_of(std::begin(kUnsupportedNames), std::end(kUnsupportedNames),
                        [&](const char* name) { return std::strcmp(name, command) == 0; });
}

/// What a version asks for besides its commands, as far as it is known to be missing, and its shading language.
struct Beyond {
    int major, minor;
    const char* shading_language;
    bool met;
};
constexpr Beyond kBeyond[] = {
    {2, 0, "1.10", true},
    {2, 1, "1.20", true},
    {3, 0, "1.30", kTextureImageUnits >= 16},
    {3, 1, "1.40", true},
    {3, 2, "1.50", kTextureImageUnits >= 48},
    {3, 3, "3.30", true},
    {4, 0, "4.00", kTextureImageUnits >= 80},
    {4, 1, "4.10", true},
    {4, 2, "4.20", true},
    {4, 3, "4.30", true},
    {4, 4, "4.40", true},
    {4, 5, "4.50", true},
};

/// What no driver need have: it is between the programs and the nodes.
constexpr const char* kOwnExtensions[] = {"GL_CR_synchronization", "GL_WALLGL_global_texture", "GL_WALLGL_views"};

/// Core profiles do not list extensions of what they have removed (NV_primitive_restart's client state), nor those that
/// were part of OpenGL before there were profiles: a program would take them for the fixed functions that came along.
enum class Where : std::uint8_t { everywhere, not_in_core };
constexpr Where kNotInCore = Where::not_in_core;

/// An extension and a command that it stands or falls with; null: words only.
struct Extension {
    const char* name;
    const char* command;
    Where where = Where::everywhere;
};
constexpr Extension kExtensions[] = {
    {"GL_ARB_arrays_of_arrays", "glUseProgram"},
    {"GL_ARB_cull_distance", "glUseProgram"},
    {"GL_ARB_enhanced_layouts", "glGetProgramResourceiv"},
    {"GL_ARB_ES2_compatibility", "glGetShaderPrecisionFormat"},
    {"GL_ARB_ES3_compatibility", "glCompressedTexImage3D"},
    {"GL_ARB_ES3_1_compatibility", "glMemoryBarrierByRegion"},
    {"GL_ARB_ES3_2_compatibility", "glPrimitiveBoundingBox"},
    {"GL_ARB_base_instance", "glDrawArraysInstancedBaseInstance"},
    {"GL_ARB_buffer_storage", "glBufferStorage"},
    {"GL_ARB_clear_buffer_object", "glClearBufferSubData"},
    {"GL_ARB_clear_texture", "glClearTexSubImage"},
    {"GL_ARB_clip_control", "glClipControl"},
    {"GL_ARB_compressed_texture_pixel_storage", "glCompressedTexImage2D"},
    {"GL_ARB_compute_shader", "glDispatchCompute"},
    {"GL_ARB_conditional_render_inverted", "glBeginConditionalRender"},
    {"GL_ARB_conservative_depth", nullptr},
    {"GL_ARB_copy_buffer", "glCopyBufferSubData"},
    {"GL_ARB_copy_image", "glCopyImageSubData"},
    {"GL_ARB_debug_output", "glDebugMessageCallback"},
    {"GL_ARB_depth_buffer_float", nullptr},
    {"GL_ARB_depth_clamp", nullptr},
    {"GL_ARB_depth_texture", nullptr, kNotInCore},
    {"GL_ARB_derivative_control", "glUseProgram"},
    {"GL_ARB_direct_state_access", "glCreateTextures"},
    {"GL_ARB_draw_buffers", "glDrawBuffers"},
    {"GL_ARB_draw_buffers_blend", "glBlendFuncSeparatei"},
    {"GL_ARB_draw_elements_base_vertex", "glDrawElementsInstancedBaseVertex"},
    {"GL_ARB_draw_indirect", "glDrawArraysIndirect"},
    {"GL_ARB_draw_instanced", "glDrawArraysInstanced"},
    {"GL_ARB_explicit_attrib_location", "glBindFragDataLocation"},
    {"GL_ARB_explicit_uniform_location", "glUniform1f"},
    {"GL_ARB_fragment_coord_conventions", nullptr},
    {"GL_ARB_fragment_layer_viewport", "glViewportArrayv"},
    {"GL_ARB_fragment_program", "glProgramStringARB", kNotInCore},
    {"GL_ARB_fragment_program_shadow", "glProgramStringARB", kNotInCore},
    {"GL_ARB_fragment_shader", "glUseProgram"},
    {"GL_ARB_framebuffer_no_attachments", "glFramebufferParameteri"},
    {"GL_ARB_framebuffer_object", "glGenFramebuffers"},
    {"GL_ARB_framebuffer_sRGB", nullptr},
    {"GL_ARB_get_program_binary", "glProgramBinary"},
    {"GL_ARB_get_texture_sub_image", "glGetTextureSubImage"},
    {"GL_ARB_gpu_shader5", "glUseProgram"},
    {"GL_ARB_gpu_shader_fp64", "glUniform1d"},
    {"GL_ARB_half_float_pixel", nullptr},
    {"GL_ARB_half_float_vertex", nullptr},
    {"GL_ARB_instanced_arrays", "glVertexAttribDivisor"},
    {"GL_ARB_internalformat_query", "glGetInternalformativ"},
    {"GL_ARB_internalformat_query2", "glGetInternalformati64v"},
    {"GL_ARB_invalidate_subdata", "glInvalidateFramebuffer"},
    {"GL_ARB_map_buffer_alignment", "glMapBuffer"},
    {"GL_ARB_map_buffer_range", "glMapBufferRange"},
    {"GL_ARB_multi_bind", "glBindVertexBuffers"},
    {"GL_ARB_multi_draw_indirect", "glMultiDrawArraysIndirect"},
    {"GL_ARB_multisample", "glSampleCoverage", kNotInCore},
    {"GL_ARB_multitexture", "glMultiTexCoord4f", kNotInCore},
    {"GL_ARB_occlusion_query", "glBeginQuery", kNotInCore},
    {"GL_ARB_occlusion_query2", "glBeginQuery"},
    {"GL_ARB_pixel_buffer_object", "glBindBuffer"},
    {"GL_ARB_point_parameters", nullptr, kNotInCore},
    {"GL_ARB_point_sprite", nullptr},
    {"GL_ARB_program_interface_query", "glGetProgramResourceiv"},
    {"GL_ARB_provoking_vertex", "glProvokingVertex"},
    {"GL_ARB_query_buffer_object", "glGetQueryObjectiv"},
    {"GL_ARB_sample_shading", "glMinSampleShading"},
    {"GL_ARB_shader_atomic_counter_ops", "glGetActiveAtomicCounterBufferiv"},
    {"GL_ARB_shader_atomic_counters", "glGetActiveAtomicCounterBufferiv"},
    {"GL_ARB_shader_bit_encoding", "glUseProgram"},
    {"GL_ARB_sampler_objects", "glBindSampler"},
    {"GL_ARB_seamless_cube_map", nullptr},
    {"GL_ARB_separate_shader_objects", "glBindProgramPipeline"},
    {"GL_ARB_shader_image_load_store", "glBindImageTexture"},
    {"GL_ARB_shader_image_size", "glBindImageTexture"},
    {"GL_ARB_shader_objects", "glDeleteObjectARB"},
    {"GL_ARB_shader_precision", "glUseProgram"},
    {"GL_ARB_shader_storage_buffer_object", "glShaderStorageBlockBinding"},
    {"GL_ARB_shader_subroutine", "glUniformSubroutinesuiv"},
    {"GL_ARB_shader_texture_image_samples", "glUseProgram"},
    {"GL_ARB_shader_texture_lod", "glUseProgram"},
    {"GL_ARB_shading_language_100", "glUseProgram", kNotInCore},
    {"GL_ARB_shading_language_420pack", "glUseProgram"},
    {"GL_ARB_shading_language_packing", "glUseProgram"},
    {"GL_ARB_shadow", nullptr, kNotInCore},
    {"GL_ARB_stencil_texturing", nullptr},
    {"GL_ARB_sync", "glFenceSync"},
    {"GL_ARB_tessellation_shader", "glPatchParameteri"},
    {"GL_ARB_texture_barrier", "glTextureBarrier"},
    {"GL_ARB_texture_border_clamp", nullptr, kNotInCore},
    {"GL_ARB_texture_buffer_object", "glTexBuffer"},
    {"GL_ARB_texture_buffer_object_rgb32", "glTexBuffer"},
    {"GL_ARB_texture_buffer_range", "glTexBufferRange"},
    {"GL_ARB_texture_compression", "glCompressedTexImage2D", kNotInCore},
    {"GL_ARB_texture_compression_bptc", "glCompressedTexImage2D"},
    {"GL_ARB_texture_compression_rgtc", "glCompressedTexImage2D"},
    {"GL_ARB_texture_cube_map", nullptr, kNotInCore},
    {"GL_ARB_texture_cube_map_array", nullptr},
    {"GL_ARB_texture_env_add", nullptr, kNotInCore},
    {"GL_ARB_texture_env_combine", nullptr, kNotInCore},
    {"GL_ARB_texture_env_crossbar", nullptr, kNotInCore},
    {"GL_ARB_texture_env_dot3", nullptr, kNotInCore},
    {"GL_ARB_texture_float", nullptr},
    {"GL_ARB_texture_gather", "glUseProgram"},
    {"GL_ARB_texture_mirror_clamp_to_edge", nullptr},
    {"GL_ARB_texture_mirrored_repeat", nullptr, kNotInCore},
    {"GL_ARB_texture_multisample", "glGetMultisamplefv"},
    {"GL_ARB_texture_non_power_of_two", nullptr},
    {"GL_ARB_texture_query_levels", "glUseProgram"},
    {"GL_ARB_texture_query_lod", "glUseProgram"},
    {"GL_ARB_texture_rectangle", nullptr},
    {"GL_ARB_texture_rg", nullptr},
    {"GL_ARB_texture_rgb10_a2ui", nullptr},
    {"GL_ARB_texture_stencil8", nullptr},
    {"GL_ARB_texture_storage", "glTexStorage3D"},
    {"GL_ARB_texture_storage_multisample", "glTexStorage3DMultisample"},
    {"GL_ARB_texture_swizzle", nullptr},
    {"GL_ARB_texture_view", "glTextureView"},
    {"GL_ARB_timer_query", "glQueryCounter"},
    {"GL_ARB_transform_feedback2", "glDrawTransformFeedback"},
    {"GL_ARB_transform_feedback3", "glDrawTransformFeedbackStream"},
    {"GL_ARB_transform_feedback_instanced", "glDrawTransformFeedbackInstanced"},
    {"GL_ARB_transpose_matrix", nullptr, kNotInCore},
    {"GL_ARB_uniform_buffer_object", "glUniformBlockBinding"},
    {"GL_ARB_vertex_array_bgra", nullptr},
    {"GL_ARB_vertex_attrib_64bit", "glVertexAttribL4d"},
    {"GL_ARB_vertex_attrib_binding", "glBindVertexBuffer"},
    {"GL_ARB_vertex_array_object", "glGenVertexArrays"},
    {"GL_ARB_vertex_buffer_object", "glBindBuffer"},
    {"GL_ARB_vertex_program", "glProgramStringARB", kNotInCore},
    {"GL_ARB_vertex_shader", "glUseProgram"},
    {"GL_ARB_vertex_type_10f_11f_11f_rev", nullptr},
    {"GL_ARB_vertex_type_2_10_10_10_rev", "glVertexP3ui"},
    {"GL_ARB_viewport_array", "glViewportArrayv"},
    {"GL_ARB_window_pos", nullptr, kNotInCore},
    {"GL_EXT_abgr", nullptr},
    {"GL_EXT_bgra", nullptr, kNotInCore},
    {"GL_EXT_blend_color", nullptr, kNotInCore},
    {"GL_EXT_blend_equation_separate", nullptr},
    {"GL_EXT_blend_func_separate", nullptr, kNotInCore},
    {"GL_EXT_blend_minmax", nullptr, kNotInCore},
    {"GL_EXT_blend_subtract", nullptr, kNotInCore},
    {"GL_EXT_compiled_vertex_array", "glLockArraysEXT", kNotInCore},
    {"GL_EXT_copy_texture", nullptr, kNotInCore},
    {"GL_EXT_draw_buffers2", "glColorMaski"},
    {"GL_EXT_draw_range_elements", nullptr, kNotInCore},
    {"GL_EXT_draw_instanced", "glDrawArraysInstanced"},
    {"GL_EXT_fog_coord", nullptr, kNotInCore},
    {"GL_EXT_framebuffer_blit", "glBlitFramebuffer"},
    {"GL_EXT_framebuffer_multisample", "glRenderbufferStorageMultisample"},
    {"GL_EXT_framebuffer_object", "glGenFramebuffers"},
    {"GL_EXT_framebuffer_sRGB", nullptr},
    {"GL_EXT_gpu_program_parameters", "glProgramLocalParameters4fvEXT", kNotInCore},
    {"GL_EXT_multi_draw_arrays", "glMultiDrawElements", kNotInCore},
    {"GL_EXT_packed_depth_stencil", "glGenFramebuffers"},
    {"GL_EXT_packed_float", nullptr},
    {"GL_EXT_packed_pixels", nullptr, kNotInCore},
    {"GL_EXT_pixel_buffer_object", "glBindBuffer"},
    {"GL_EXT_point_parameters", nullptr, kNotInCore},
    {"GL_EXT_polygon_offset", nullptr, kNotInCore},
    {"GL_EXT_provoking_vertex", "glProvokingVertex"},
    {"GL_EXT_rescale_normal", nullptr, kNotInCore},
    {"GL_EXT_secondary_color", nullptr, kNotInCore},
    {"GL_EXT_separate_specular_color", nullptr, kNotInCore},
    {"GL_EXT_shader_framebuffer_fetch", "glUseProgram"},
    {"GL_EXT_shader_framebuffer_fetch_non_coherent", "glBlendBarrier"},
    {"GL_EXT_stencil_wrap", nullptr, kNotInCore},
    {"GL_EXT_subtexture", nullptr, kNotInCore},
    {"GL_EXT_texture", nullptr, kNotInCore},
    {"GL_EXT_texture3D", "glTexImage3D", kNotInCore},
    {"GL_EXT_texture_array", "glFramebufferTextureLayer"},
    {"GL_EXT_texture_compression_rgtc", "glCompressedTexImage2D"},
    {"GL_EXT_texture_compression_s3tc", "glCompressedTexImage2D"},
    {"GL_EXT_texture_cube_map", nullptr, kNotInCore},
    {"GL_EXT_texture_edge_clamp", nullptr, kNotInCore},
    {"GL_EXT_texture_env_add", nullptr, kNotInCore},
    {"GL_EXT_texture_env_combine", nullptr, kNotInCore},
    {"GL_EXT_texture_env_dot3", nullptr, kNotInCore},
    {"GL_EXT_texture_filter_anisotropic", nullptr},
    {"GL_EXT_texture_lod_bias", nullptr, kNotInCore},
    {"GL_EXT_texture_object", nullptr, kNotInCore},
    {"GL_EXT_texture_rectangle", nullptr, kNotInCore},
    {"GL_EXT_texture_sRGB", nullptr},
    {"GL_EXT_texture_sRGB_decode", nullptr},
    {"GL_EXT_texture_shared_exponent", nullptr},
    {"GL_EXT_texture_snorm", nullptr},
    {"GL_EXT_texture_swizzle", nullptr},
    {"GL_EXT_timer_query", "glQueryCounter"},
    {"GL_EXT_transform_feedback", "glBindBufferOffsetEXT"},
    {"GL_EXT_vertex_array", nullptr, kNotInCore},
    {"GL_EXT_vertex_array_bgra", nullptr},
    {"GL_KHR_blend_equation_advanced", "glBlendBarrier"},
    {"GL_KHR_blend_equation_advanced_coherent", "glBlendBarrier"},
    {"GL_KHR_context_flush_control", nullptr},
    {"GL_KHR_debug", "glDebugMessageCallback"},
    {"GL_KHR_robust_buffer_access_behavior", nullptr},
    {"GL_KHR_robustness", "glGetGraphicsResetStatus"},
    {"GL_KHR_texture_compression_astc_ldr", "glCompressedTexImage2D"},
    {"GL_KHR_texture_compression_astc_sliced_3d", "glCompressedTexImage3D"},
    {"GL_NV_blend_square", nullptr, kNotInCore},
    {"GL_NV_conditional_render", "glBeginConditionalRender"},
    {"GL_NV_primitive_restart", "glPrimitiveRestartNV", kNotInCore},
    {"GL_NV_texture_barrier", "glTextureBarrier"},
    {"GL_NV_texgen_reflection", nullptr, kNotInCore},
    {"GL_NV_texture_rectangle", nullptr, kNotInCore},
    {"GL_SGIS_generate_mipmap", nullptr, kNotInCore},
    {"GL_SGIS_texture_edge_clamp", nullptr, kNotInCore},
    {"GL_SGIS_texture_lod", nullptr, kNotInCore},
};

GlVersion node_version(const Caps& caps) {
    GlVersion version;
    if (std::sscanf(caps.version.c_str(), "%d.%d", &version.major, &version.minor) != 2) return {};
    return version;
}

bool at_most(const GlVersion& a, const GlVersion& b) {
    return a.major < b.major || (a.major == b.major && a.minor <= b.minor);
}

}  // namespace

// By construction: a version is there when all of its commands are, and what else it asks for.
GlVersion implemented_version() {
    GlVersion offered;
    for (const VersionCommands& version : kVersions) {
        if (version.missing) break;
        const auto* beyond = std::ranges::find_if(
            kBeyond, [&](const Beyond& b) { return b.major == version.major && b.minor == version.minor; });
        const bool known = beyond != std::end(kBeyond);
        if ((known && !beyond->met) || (!known && version.major > 1)) break;
        offered = {version.major, version.minor, known ? beyond->shading_language : nullptr};
    }
    return offered;
}

bool is_implemented(int major, int minor) { return at_most({major, minor, nullptr}, implemented_version()); }

GlVersion offered_version(const Caps& caps) {
    const GlVersion implemented = implemented_version(), node = node_version(caps);
    if (at_most(implemented, node)) return implemented;
    GlVersion offered = node;
    offered.shading_language = nullptr;
    for (const Beyond& beyond : kBeyond)
        if (at_most({beyond.major, beyond.minor, nullptr}, node)) offered.shading_language = beyond.shading_language;
    return offered;
}

std::vector<std::string> offered_extensions(const Caps& caps, const ContextProfile& profile) {
    const NodeWords node(caps);
    std::vector<std::string> offered(std::begin(kOwnExtensions), std::end(kOwnExtensions));
    for (const Extension& extension : kExtensions)
        if ((!extension.command || implemented(extension.command)) &&
            (!profile.core || extension.where == Where::everywhere) && node.have(extension.name))
            offered.emplace_back(extension.name);
    return offered;
}

std::vector<std::string> shading_languages(const Caps& caps, const ContextProfile& profile) {
    const GlVersion offered = offered_version(caps), first = profile.core ? GlVersion{3, 1} : GlVersion{2, 0};
    std::vector<std::string> out;
    for (const Beyond& beyond : kBeyond) {
        const GlVersion version{beyond.major, beyond.minor, nullptr};
        if (!at_most(first, version) || !at_most(version, offered)) continue;
        std::string digits = beyond.shading_language;
        std::erase(digits, '.');
        if (digits == "110") digits.clear();  // without a #version
        out.insert(out.begin(), std::move(digits));
    }
    return out;
}

std::string version_string(const Caps& caps, const ContextProfile& profile) {
    const GlVersion version = offered_version(caps);
    const bool has_profiles = version.major > 3 || (version.major == 3 && version.minor >= 2);
    const char* words = !has_profiles ? " " : profile.core ? " (Core Profile) " : " (Compatibility Profile) ";
    return std::to_string(version.major) + "." + std::to_string(version.minor) + words + kWallVersion;
}

}  // namespace wall::client
