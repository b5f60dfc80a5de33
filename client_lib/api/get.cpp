// SPDX-License-Identifier: MIT
// glGet* and the like, answered from the context's shadow; none of them asks a node.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "client_lib/context/assembly_binding.h"
#include "client_lib/context/attribute_stack.h"
#include "client_lib/context/context.h"
#include "client_lib/context/debug_state.h"
#include "client_lib/context/es_version.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/lists.h"
#include "client_lib/context/object_name.h"
#include "client_lib/context/param_commands.h"
#include "client_lib/context/query_result.h"
#include "client_lib/context/select.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/vertex_bindings.h"
#include "client_lib/objects/buffer.h"
#include "client_lib/objects/es_formats.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/program_pipeline.h"
#include "common/glapi/convert.h"
#include "common/glapi/program_format.h"
#include "common/glstate/draw_buffers.h"
#include "common/glstate/elements.h"
#include "common/glstate/queries.h"

namespace wall::client::api {
namespace {

/// A word that neither a state element nor a node's limit answers. Up to 16 components.
struct Special {
    GLenum pname;
    unsigned components;
    void (*read)(Context&, double* out);
};

const SurfaceFormat& format_of(Context& c) {
    static constexpr SurfaceFormat kNone;
    return c.draw_target() ? c.draw_target().format() : kNone;
}

double samples_of(Context& c) {
    const auto samples = static_cast<GLsizei>(samples_drawn(c));
    if (!c.framebuffers->draw) return samples;
    return rounded_samples(samples,
                           static_cast<GLsizei>(limit_of(c.caps(), GL_MAX_FRAMEBUFFER_SAMPLES, kUsualSamples)));
}

template <class T>
double name_of(const std::shared_ptr<T>& object) {
    return object ? object->name : 0;
}

template <int kValue>
void constant(Context&, double* out) {
    *out = kValue;
}

template <class Stack>
double depth_of(const Stack& stack) {
    return static_cast<double>(stack.below.size() + 1);
}

void put_transposed(const glstate::Mat4& m, double* out) {
    const Mat4 t = transposed(m);
    std::copy(t.begin(), t.end(), out);
}

template <unsigned kMap>
void pixel_map_size(Context& c, double* out) {
    *out = static_cast<double>(c.maps->pixel.tables[kMap].size());
}

/// The nodes' limit, but no more than the client keeps.
template <GLenum kName, int kMost>
void limited(Context& c, double* out) {
    *out = std::min<double>(kMost, limit_of(c.caps(), kName, kMost));
}

/// Of the colours that are drawn first: which can be negative (EXT_packed_float). One that has no bits is not.
void signed_components(Context& c, double* out) {
    const TextureFormat* format = first_draw_format(c);
    if (!format || format->internal_format == GL_R11F_G11F_B10F) return;
    const GLenum type = format->component_type;
    if (type != GL_FLOAT && type != GL_SIGNED_NORMALIZED && type != GL_INT) return;
    const ComponentBits& b = format->bits;
    const unsigned gray = b.luminance + b.intensity;
    const unsigned sizes[] = {b.red + gray, b.green + gray, b.blue + gray, unsigned{b.alpha} + b.intensity};
    std::ranges::transform(sizes, out, [](unsigned bits) { return bits != 0; });
}

/// Of the active unit's texture that is made of a buffer.
template <GLenum kName>
void part_of_buffer(Context& c, double* out) {
    const auto texture = bound_texture(c, GL_TEXTURE_BUFFER);
    const Texture::BufferPart part = texture ? texture->part : Texture::BufferPart();
    *out = kName == GL_TEXTURE_BUFFER_FORMAT_ARB ? part.internal_format : part.buffer ? part.buffer->name : 0;
}

/// What glReadPixels gives besides what it always does, out of what is read from.
template <GLenum PixelKind::*kWord>
void color_read(Context& c, double* out) {
    if (const TextureFormat* colors = read_color_format(c)) *out = es_read_kind(*colors).*kWord;
    else c.error(GL_INVALID_OPERATION);
}

/// Calls `use` with the active unit if it has a matrix.
template <class Use>
void of_texture_matrix(Context& c, Use&& use) {
    if (c.fixed_unit()) use(c.active_texture());
    else c.error(GL_INVALID_OPERATION);
}

/// Of the array that only OpenGL ES 1.1 has.
template <auto kField>
void of_point_sizes(Context& c, double* out) {
    if (c.profile.is_es1()) *out = static_cast<double>(c.state.vertex_arrays.point_size_array.*kField);
    else c.error(GL_INVALID_ENUM);
}

/// Calls `use(matrix, stack)` with that of the matrix mode.
template <class Use>
void of_current_matrix(Context& c, Use&& use) {
    const GLenum mode = c.state.local.matrix_mode;
    if (mode == GL_MODELVIEW) return use(c.state.matrix.modelview, c.modelview_stack);
    if (mode == GL_PROJECTION) return use(c.state.matrix.projection, c.projection_stack);
    if (const auto i = program_matrix_of(mode))
        return use(c.state.program_matrices.program_matrix[*i], c.program_stacks[*i]);
    of_texture_matrix(c, [&](unsigned unit) { use(c.state.matrix.texture_matrix[unit], c.texture_stacks[unit]); });
}

constexpr GLenum kGpuDisjoint = 0x8FBB;  // of GL_EXT_disjoint_timer_query, which only OpenGL ES has
constexpr int kUniformBuffers = glstate::el::uniform_buffer::count;
constexpr int kImageUnits = glstate::el::image_unit::count;
constexpr int kStorageBuffers = glstate::el::storage_buffer::count;
constexpr int kCounterBuffers = glstate::el::counter_buffer::count;

const Special kSpecials[] = {
    {GL_MODELVIEW_STACK_DEPTH, 1, [](Context& c, double* out) { *out = depth_of(c.modelview_stack); }},
    {GL_PROJECTION_STACK_DEPTH, 1, [](Context& c, double* out) { *out = depth_of(c.projection_stack); }},
    {GL_TEXTURE_STACK_DEPTH, 1,
     [](Context& c, double* out) {
         of_texture_matrix(c, [&](unsigned unit) { *out = depth_of(c.texture_stacks[unit]); });
     }},
    {GL_PROGRAM_PIPELINE_BINDING, 1,
     [](Context& c, double* out) { *out = c.pipelines->bound ? c.pipelines->bound->pipeline : 0; }},
    {GL_MAX_MODELVIEW_STACK_DEPTH, 1, [](Context& c, double* out) { *out = c.modelview_stack.limit; }},
    {GL_MAX_PROJECTION_STACK_DEPTH, 1, [](Context& c, double* out) { *out = c.projection_stack.limit; }},
    {GL_MAX_TEXTURE_STACK_DEPTH, 1, [](Context& c, double* out) { *out = c.texture_stacks[0].limit; }},
    {GL_TRANSPOSE_MODELVIEW_MATRIX, 16, [](Context& c, double* out) { put_transposed(c.state.matrix.modelview, out); }},
    {GL_TRANSPOSE_PROJECTION_MATRIX, 16,
     [](Context& c, double* out) { put_transposed(c.state.matrix.projection, out); }},
    {GL_TRANSPOSE_TEXTURE_MATRIX, 16,
     [](Context& c, double* out) {
         of_texture_matrix(c, [&](unsigned unit) { put_transposed(c.state.matrix.texture_matrix[unit], out); });
     }},

    {GL_CURRENT_MATRIX_ARB, 16,
     [](Context& c, double* out) {
         of_current_matrix(c, [&](const Mat4& m, const MatrixStack&) { std::copy(m.begin(), m.end(), out); });
     }},
    {GL_TRANSPOSE_CURRENT_MATRIX_ARB, 16,
     [](Context& c, double* out) {
         of_current_matrix(c, [&](const Mat4& m, const MatrixStack&) { put_transposed(m, out); });
     }},
    {GL_CURRENT_MATRIX_STACK_DEPTH_ARB, 1,
     [](Context& c, double* out) {
         of_current_matrix(c, [&](const Mat4&, const MatrixStack& stack) { *out = depth_of(stack); });
     }},
    {GL_MAX_PROGRAM_MATRICES_ARB, 1, constant<int{glstate::el::program_matrix::count}>},
    {GL_MAX_PROGRAM_MATRIX_STACK_DEPTH_ARB, 1, constant<int{kProgramStackLimit}>},
    {GL_PROGRAM_ERROR_POSITION_ARB, 1, [](Context& c, double* out) { *out = c.assembly->error_position; }},

    {GL_ATTRIB_STACK_DEPTH, 1,
     [](Context& c, double* out) { *out = static_cast<double>(c.attributes->server.size()); }},
    {GL_CLIENT_ATTRIB_STACK_DEPTH, 1,
     [](Context& c, double* out) { *out = static_cast<double>(c.attributes->client.size()); }},
    {GL_MAX_ATTRIB_STACK_DEPTH, 1, constant<kAttributeStackLimit>},
    {GL_MAX_CLIENT_ATTRIB_STACK_DEPTH, 1, constant<kAttributeStackLimit>},
    {GL_NAME_STACK_DEPTH, 1, [](Context& c, double* out) { *out = c.select->name_depth; }},
    {GL_MAX_NAME_STACK_DEPTH, 1, constant<kNameStackLimit>},
    {GL_SELECTION_BUFFER_SIZE, 1, [](Context& c, double* out) { *out = std::max(0, c.select->select_entries); }},
    {GL_FEEDBACK_BUFFER_SIZE, 1, [](Context& c, double* out) { *out = std::max(0, c.select->feedback_entries); }},
    {GL_FEEDBACK_BUFFER_TYPE, 1, [](Context& c, double* out) { *out = c.select->feedback_type; }},
    {GL_LIST_INDEX, 1, [](Context& c, double* out) { *out = c.lists->name; }},
    {GL_LIST_MODE, 1, [](Context& c, double* out) { *out = c.lists->mode; }},
    {GL_MAX_LIST_NESTING, 1, constant<kListNestingLimit>},

    {GL_MAP1_GRID_DOMAIN, 2,
     [](Context& c, double* out) { out[0] = c.state.evaluator.map_grid1.u1, out[1] = c.state.evaluator.map_grid1.u2; }},
    {GL_MAP2_GRID_SEGMENTS, 2,
     [](Context& c, double* out) { out[0] = c.state.evaluator.map_grid2.un, out[1] = c.state.evaluator.map_grid2.vn; }},
    {GL_MAP2_GRID_DOMAIN, 4,
     [](Context& c, double* out) {
         const auto& grid = c.state.evaluator.map_grid2;
         out[0] = grid.u1, out[1] = grid.u2, out[2] = grid.v1, out[3] = grid.v2;
     }},
    {GL_MAX_EVAL_ORDER, 1, constant<30>},
    {GL_MAX_PIXEL_MAP_TABLE, 1, constant<256>},

    {GL_PIXEL_MAP_I_TO_I_SIZE, 1, pixel_map_size<0>},
    {GL_PIXEL_MAP_S_TO_S_SIZE, 1, pixel_map_size<1>},
    {GL_PIXEL_MAP_I_TO_R_SIZE, 1, pixel_map_size<2>},
    {GL_PIXEL_MAP_I_TO_G_SIZE, 1, pixel_map_size<3>},
    {GL_PIXEL_MAP_I_TO_B_SIZE, 1, pixel_map_size<4>},
    {GL_PIXEL_MAP_I_TO_A_SIZE, 1, pixel_map_size<5>},
    {GL_PIXEL_MAP_R_TO_R_SIZE, 1, pixel_map_size<6>},
    {GL_PIXEL_MAP_G_TO_G_SIZE, 1, pixel_map_size<7>},
    {GL_PIXEL_MAP_B_TO_B_SIZE, 1, pixel_map_size<8>},
    {GL_PIXEL_MAP_A_TO_A_SIZE, 1, pixel_map_size<9>},

    {GL_MAX_LIGHTS, 1, constant<glstate::el::light_enabled::count>},
    {GL_MAX_CLIP_PLANES, 1, limited<GL_MAX_CLIP_PLANES, glstate::el::clip_plane::count>},
    {GL_MAX_TEXTURE_UNITS, 1, limited<GL_MAX_TEXTURE_UNITS, kTextureUnits>},
    {GL_MAX_TEXTURE_COORDS, 1, limited<GL_MAX_TEXTURE_COORDS, kTextureCoords>},
    {GL_MAX_TEXTURE_IMAGE_UNITS, 1, limited<GL_MAX_TEXTURE_IMAGE_UNITS, kTextureImageUnits>},
    {GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS, 1, limited<GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS, kTextureImageUnits>},
    {GL_MAX_GEOMETRY_TEXTURE_IMAGE_UNITS, 1, limited<GL_MAX_GEOMETRY_TEXTURE_IMAGE_UNITS, kTextureImageUnits>},
    {GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, 1, limited<GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, kTextureImageUnits>},
    {GL_MAX_DRAW_BUFFERS, 1, limited<GL_MAX_DRAW_BUFFERS, glstate::kColorAttachments>},
    {GL_RGBA_SIGNED_COMPONENTS_EXT, 4, signed_components},
    {GL_FRAMEBUFFER_SRGB_CAPABLE_EXT, 1,
     [](Context& c, double* out) {
         const TextureFormat* format = draw_color_format(c);
         const bool window = !c.framebuffers->draw && c.draw_target();
         *out = window ? c.draw_target().encodes_srgb() : format != nullptr && format->srgb;
     }},
    {GL_TEXTURE_BUFFER_DATA_STORE_BINDING, 1, part_of_buffer<GL_TEXTURE_BUFFER_DATA_STORE_BINDING>},
    {GL_TEXTURE_BUFFER_FORMAT_ARB, 1, part_of_buffer<GL_TEXTURE_BUFFER_FORMAT_ARB>},
    {GL_NUM_SHADER_BINARY_FORMATS, 1, constant<0>},
    {GL_SHADER_BINARY_FORMATS, 0, constant<0>},
    {GL_NUM_PROGRAM_BINARY_FORMATS, 1, constant<0>},
    {GL_PROGRAM_BINARY_FORMATS, 0, constant<0>},
    {GL_NUM_COMPRESSED_TEXTURE_FORMATS, 1,
     [](Context& c, double* out) { *out = static_cast<double>(listed_block_formats(c.profile, c.caps()).size()); }},
    {GL_CONTEXT_RELEASE_BEHAVIOR, 1, [](Context&, double* out) { *out = GL_CONTEXT_RELEASE_BEHAVIOR_FLUSH; }},
    {GL_MAX_FRAMEBUFFER_WIDTH, 1, limited<GL_MAX_FRAMEBUFFER_WIDTH, glstate::kMostDefaultSize>},
    {GL_MAX_FRAMEBUFFER_HEIGHT, 1, limited<GL_MAX_FRAMEBUFFER_HEIGHT, glstate::kMostDefaultSize>},
    {GL_MAX_FRAMEBUFFER_LAYERS, 1, limited<GL_MAX_FRAMEBUFFER_LAYERS, glstate::kMostDefaultLayers>},
    {GL_MAX_FRAMEBUFFER_SAMPLES, 1, limited<GL_MAX_FRAMEBUFFER_SAMPLES, 4>},
    {GL_MAX_VERTEX_ATTRIB_RELATIVE_OFFSET, 1, [](Context&, double* out) { *out = kFarthestAttribute; }},
    {GL_MAX_VERTEX_ATTRIB_BINDINGS, 1, [](Context&, double* out) { *out = kVertexBindings; }},
    {GL_MAX_VERTEX_ATTRIB_STRIDE, 1, [](Context&, double* out) { *out = kLongestStride; }},
    {GL_MAX_VERTEX_ATTRIBS, 1, limited<GL_MAX_VERTEX_ATTRIBS, kVertexAttributes>},
    {GL_MAX_UNIFORM_BUFFER_BINDINGS, 1, limited<GL_MAX_UNIFORM_BUFFER_BINDINGS, kUniformBuffers>},
    {GL_MAX_UNIFORM_LOCATIONS, 1, limited<GL_MAX_UNIFORM_LOCATIONS, int{glapi::kMostUniformLocations}>},
    {GL_MIN_MAP_BUFFER_ALIGNMENT, 1, constant<int{kMapAlignment}>},
    {GL_NUM_SHADING_LANGUAGE_VERSIONS, 1,
     [](Context& c, double* out) { *out = static_cast<double>(shading_languages_in(c.profile, c.caps()).size()); }},
    {GL_MAX_IMAGE_UNITS, 1, limited<GL_MAX_IMAGE_UNITS, kImageUnits>},
    {GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, 1, limited<GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, kStorageBuffers>},
    {GL_MAX_ATOMIC_COUNTER_BUFFER_BINDINGS, 1, limited<GL_MAX_ATOMIC_COUNTER_BUFFER_BINDINGS, kCounterBuffers>},
    {GL_MAX_COMBINED_UNIFORM_BLOCKS, 1, limited<GL_MAX_COMBINED_UNIFORM_BLOCKS, kUniformBuffers>},
    {GL_MAX_TRANSFORM_FEEDBACK_SEPARATE_ATTRIBS, 1,
     limited<GL_MAX_TRANSFORM_FEEDBACK_SEPARATE_ATTRIBS, glstate::el::feedback_buffer::count>},
    {GL_MAX_TRANSFORM_FEEDBACK_BUFFERS, 1,
     limited<GL_MAX_TRANSFORM_FEEDBACK_BUFFERS, glstate::el::feedback_buffer::count>},
    {GL_MAX_VIEWPORTS, 1, limited<GL_MAX_VIEWPORTS, glstate::kViewports>},
    {GL_MAX_VERTEX_STREAMS, 1, limited<GL_MAX_VERTEX_STREAMS, glstate::el::captured_query::count>},
    {GL_MAX_TESS_CONTROL_TEXTURE_IMAGE_UNITS, 1, limited<GL_MAX_TESS_CONTROL_TEXTURE_IMAGE_UNITS, kTextureImageUnits>},
    {GL_MAX_TESS_EVALUATION_TEXTURE_IMAGE_UNITS, 1,
     limited<GL_MAX_TESS_EVALUATION_TEXTURE_IMAGE_UNITS, kTextureImageUnits>},
    {GL_MAX_ELEMENTS_VERTICES, 1, constant<3000>},
    {GL_MAX_ELEMENTS_INDICES, 1, constant<3000>},

    {GL_RGBA_MODE, 1, constant<1>},
    {GL_INDEX_MODE, 1, constant<0>},
    {GL_INDEX_BITS, 1, constant<0>},
    {GL_AUX_BUFFERS, 1, constant<0>},
    {GL_STEREO, 1, [](Context& c, double* out) { *out = format_of(c).stereo; }},
    {GL_RED_BITS, 1, [](Context& c, double* out) { *out = draw_target_bits(c).red; }},
    {GL_GREEN_BITS, 1, [](Context& c, double* out) { *out = draw_target_bits(c).green; }},
    {GL_BLUE_BITS, 1, [](Context& c, double* out) { *out = draw_target_bits(c).blue; }},
    {GL_ALPHA_BITS, 1, [](Context& c, double* out) { *out = draw_target_bits(c).alpha; }},
    {GL_DEPTH_BITS, 1, [](Context& c, double* out) { *out = draw_target_bits(c).depth; }},
    {GL_STENCIL_BITS, 1, [](Context& c, double* out) { *out = draw_target_bits(c).stencil; }},
    {GL_ACCUM_RED_BITS, 1, [](Context& c, double* out) { *out = format_of(c).accum_bits; }},
    {GL_ACCUM_GREEN_BITS, 1, [](Context& c, double* out) { *out = format_of(c).accum_bits; }},
    {GL_ACCUM_BLUE_BITS, 1, [](Context& c, double* out) { *out = format_of(c).accum_bits; }},
    {GL_ACCUM_ALPHA_BITS, 1, [](Context& c, double* out) { *out = format_of(c).accum_bits; }},
    {GL_DOUBLEBUFFER, 1, [](Context& c, double* out) { *out = format_of(c).double_buffered; }},
    {GL_SAMPLES, 1, [](Context& c, double* out) { *out = samples_of(c); }},
    {GL_SAMPLE_BUFFERS, 1, [](Context& c, double* out) { *out = samples_of(c) > 0; }},
    {GL_DRAW_FRAMEBUFFER_BINDING, 1, [](Context& c, double* out) { *out = name_of(c.framebuffers->draw); }},
    {GL_READ_FRAMEBUFFER_BINDING, 1, [](Context& c, double* out) { *out = name_of(c.framebuffers->read); }},
    {GL_RENDERBUFFER_BINDING, 1, [](Context& c, double* out) { *out = name_of(c.framebuffers->renderbuffer); }},
    {GL_MAX_COLOR_ATTACHMENTS, 1, limited<GL_MAX_COLOR_ATTACHMENTS, glstate::kColorAttachments>},
    {GL_MAJOR_VERSION, 1, [](Context& c, double* out) { *out = version_in(c.profile, c.caps()).major; }},
    {GL_MINOR_VERSION, 1, [](Context& c, double* out) { *out = version_in(c.profile, c.caps()).minor; }},
    {GL_NUM_EXTENSIONS, 1,
     [](Context& c, double* out) { *out = static_cast<double>(extensions_in(c.profile, c.caps()).size()); }},
    {GL_DEBUG_LOGGED_MESSAGES, 1,
     [](Context& c, double* out) { *out = static_cast<double>(c.debug->log.logged.size()); }},
    {GL_DEBUG_NEXT_LOGGED_MESSAGE_LENGTH, 1,
     [](Context& c, double* out) {
         const auto& logged = c.debug->log.logged;
         *out = logged.empty() ? 0 : static_cast<double>(logged.front().text.size() + 1);
     }},
    {GL_DEBUG_GROUP_STACK_DEPTH, 1, [](Context& c, double* out) { *out = static_cast<double>(c.debug->log.depth()); }},
    {GL_MAX_DEBUG_MESSAGE_LENGTH, 1, constant<static_cast<int>(DebugLog::kMostText)>},
    {GL_MAX_DEBUG_LOGGED_MESSAGES, 1, constant<static_cast<int>(DebugLog::kMostLogged)>},
    {GL_MAX_DEBUG_GROUP_STACK_DEPTH, 1, constant<static_cast<int>(DebugLog::kMostGroups)>},
    {GL_MAX_LABEL_LENGTH, 1, constant<static_cast<int>(ObjectLabels::kMostText)>},
    {GL_TIMESTAMP, 1, [](Context&, double* out) { *out = static_cast<double>(timestamp(Fence::Clock::now())); }},
    {GL_CONTEXT_FLAGS, 1, [](Context& c, double* out) { *out = c.profile.flags(); }},
    {GL_FRAGMENT_SHADER_DISCARDS_SAMPLES_EXT, 1, constant<1>},
    {GL_CONTEXT_ROBUST_ACCESS, 1, [](Context& c, double* out) { *out = c.profile.robust; }},
    {GL_RESET_NOTIFICATION_STRATEGY, 1,
     [](Context& c, double* out) {
         *out = c.profile.notifies_of_resets ? GL_LOSE_CONTEXT_ON_RESET : GL_NO_RESET_NOTIFICATION;
     }},
    {GL_CONTEXT_PROFILE_MASK, 1, [](Context& c, double* out) { *out = c.profile.mask(); }},
    {GL_IMPLEMENTATION_COLOR_READ_FORMAT, 1, color_read<&PixelKind::format>},
    {GL_IMPLEMENTATION_COLOR_READ_TYPE, 1, color_read<&PixelKind::type>},
    {kGpuDisjoint, 1, constant<0>},
    {GL_POINT_SIZE_ARRAY_OES, 1, of_point_sizes<&glstate::ClientArray::enabled>},
    {GL_POINT_SIZE_ARRAY_TYPE_OES, 1, of_point_sizes<&glstate::ClientArray::type>},
    {GL_POINT_SIZE_ARRAY_STRIDE_OES, 1, of_point_sizes<&glstate::ClientArray::stride>},
    {GL_POINT_SIZE_ARRAY_BUFFER_BINDING_OES, 1,
     [](Context& c, double* out) {
         if (!c.profile.is_es1()) return c.error(GL_INVALID_ENUM);
         const ClientName buffer(c.state.vertex_arrays.point_size_array.buffer);
         *out = object_name(c, glstate::ValueKind::name_buffer, buffer);
     }},
};

/// Reals become integers by rounding, and anything but zero is true (OpenGL 1.2.1, 6.1.2).
template <class Out>
Out converted(double value) {
    if constexpr (std::is_same_v<Out, GLboolean>) return value != 0;
    else if constexpr (std::is_same_v<Out, GLint>)
        return static_cast<GLint>(std::clamp(std::round(value), -2147483648.0, 2147483647.0));
    else if constexpr (std::is_same_v<Out, GLint64>)
        return std::abs(value) < 9.2e18 ? static_cast<GLint64>(std::round(value))
               : value < 0              ? std::numeric_limits<GLint64>::min()
                                        : std::numeric_limits<GLint64>::max();
    else return static_cast<Out>(value);
}

unsigned index_of(const Context& c, glstate::IndexRule rule) {
    if (rule == glstate::IndexRule::unit) return c.active_texture();
    if (rule == glstate::IndexRule::client_unit) return c.state.local.client_active_texture - GL_TEXTURE0;
    return 0;
}

template <class Out>
void get_element(Context& c, const glstate::GetEntry& entry, Out* out) {
    const unsigned unit = index_of(c, entry.rule);
    if (unit != 0 && unit >= entry.units) return c.error(GL_INVALID_OPERATION);
    const std::uint32_t id = entry.id + unit * entry.unit_stride;
    const auto category = glstate::element_info(id).category;
    if (category == glstate::Category::current || category == glstate::Category::material)
        c.flush_block();  // folds attributes
    if (entry.kind > glstate::ValueKind::pointer) {
        GLint object = 0;
        glstate::read_components(c.state, id, entry.offset, glstate::ValueKind::unsigned_integer, 1, &object);
        *out = converted<Out>(object_name(c, entry.kind, ClientName(static_cast<std::uint32_t>(object))));
        return;
    }
    glstate::read_components(c.state, id, entry.offset, entry.kind, entry.components, out);
}

/// Colours that are kept as given and answered as they are used: by GL_FIXED_ONLY clamped, no framebuffer being of
/// floats (ARB_color_buffer_float).
bool answered_clamped(const Context& c, GLenum pname) {
    if (c.state.color_buffer.clamp_fragment_color == GL_FALSE) return false;
    return pname == GL_COLOR_CLEAR_VALUE || pname == GL_BLEND_COLOR || pname == GL_FOG_COLOR;
}

template <class Out>
void get_clamped(Context& c, const glstate::GetEntry& entry, Out* out) {
    double values[4];
    get_element(c, entry, values);
    for (unsigned i = 0; i < entry.components; ++i) {
        const double value = std::clamp(values[i], 0.0, 1.0);
        out[i] = std::is_same_v<Out, GLint> || std::is_same_v<Out, GLint64> ? static_cast<Out>(2147483647.0 * value)
                                                                            : converted<Out>(value);
    }
}

template <class Out>
bool get_special(Context& c, GLenum pname, Out* out) {
    for (const Special& special : kSpecials) {
        if (special.pname != pname) continue;
        double values[16]{};
        special.read(c, values);
        std::transform(values, values + special.components, out, converted<Out>);
        return true;
    }
    return false;
}

/// What a framebuffer object that is bound has of its own.
template <class Out>
bool get_of_framebuffer(Context& c, GLenum pname, Out* out) {
    const FramebufferUse& use = *c.framebuffers;
    const GLenum buffer = pname == GL_DRAW_BUFFER ? GLenum{GL_DRAW_BUFFER0} : pname;
    if (buffer >= GL_DRAW_BUFFER0 && buffer < GL_DRAW_BUFFER0 + glstate::kColorAttachments) {
        const unsigned i = buffer - GL_DRAW_BUFFER0;
        if (!use.draw && i == 0) return false;
        *out = converted<Out>(use.draw ? use.draw->draw_buffers()[i] : GLenum{GL_NONE});
        return true;
    }
    if (pname != GL_READ_BUFFER || !use.read) return false;
    *out = converted<Out>(use.read->read_buffer());
    return true;
}

template <class Out>
bool get_limit(Context& c, GLenum pname, Out* out) {
    const auto& limits = c.caps().limits;
    const auto found = limits.find(pname);
    if (found == limits.end() || is_assembly_limit(pname)) return false;
    std::transform(found->second.begin(), found->second.end(), out, converted<Out>);
    return true;
}

const std::uint32_t* flag_of(const Context& c, GLenum cap) {
    const auto* entry = glstate::find_cap(cap);
    if (!entry || (entry->rule != glstate::IndexRule::none && !c.profile.has_fixed_function())) return nullptr;
    const std::uint32_t id = entry->id + index_of(c, entry->rule) * entry->unit_stride;
    return reinterpret_cast<const std::uint32_t*>(reinterpret_cast<const std::byte*>(&c.state) +
                                                  glstate::element_offset(id));
}

template <class Out>
void get(Context& c, GLenum pname, Out* out) {
    if (is_removed(c, pname)) return c.error(GL_INVALID_ENUM);
    if (pname == GL_COMPRESSED_TEXTURE_FORMATS) {
        for (const GLenum format : listed_block_formats(c.profile, c.caps())) *out++ = converted<Out>(format);
        return;
    }
    if (get_of_framebuffer(c, pname, out)) return;
    if (const auto* entry = glstate::find_get(pname))
        return answered_clamped(c, pname) ? get_clamped(c, *entry, out) : get_element(c, *entry, out);
    if (const auto* flag = flag_of(c, pname)) *out = converted<Out>(*flag);
    else if (!get_special(c, pname, out) && !get_limit(c, pname, out)) c.error(GL_INVALID_ENUM);
}

}  // namespace

void GetBooleanv(Context& c, GLenum pname, GLboolean* params) { get(c, pname, params); }
void GetIntegerv(Context& c, GLenum pname, GLint* params) { get(c, pname, params); }
void GetFloatv(Context& c, GLenum pname, GLfloat* params) { get(c, pname, params); }
void GetInteger64v(Context& c, GLenum pname, GLint64* data) { get(c, pname, data); }
void GetDoublev(Context& c, GLenum pname, GLdouble* params) { get(c, pname, params); }

/// Numbers, words and colours alike have sixteen bits behind the point.
void GetFixedv(Context& c, GLenum pname, GLfixed* params) {
    constexpr auto kNothing = std::numeric_limits<double>::quiet_NaN();
    std::array<double, 64> values;
    values.fill(kNothing);
    get(c, pname, values.data());
    const auto behind = std::ranges::find_if(values, [](double value) { return std::isnan(value); });
    std::transform(values.begin(), behind, params, glapi::to_fixed);
}

GLenum GetError(Context& c) { return c.take_error(); }

void GetClipPlane(Context& c, GLenum plane, GLdouble* equation) {
    const unsigned i = plane - GL_CLIP_PLANE0;
    if (i >= glstate::el::clip_plane::count) return c.error(GL_INVALID_ENUM);
    const auto& values = c.get<glstate::el::clip_plane>(i);
    std::copy(values.begin(), values.end(), equation);
}

}  // namespace wall::client::api
