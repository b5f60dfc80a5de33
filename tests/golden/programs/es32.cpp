// SPDX-License-Identifier: MIT
// OpenGL ES 3.1 and 3.2: what compute shaders write is drawn indirectly, patches go through all stages, advanced
// blending, and textures in blocks of ASTC. All of it reaches over tiles' borders.
#include <array>
#include <iterator>
#include <utility>
#include <vector>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr Needs kEs{.es = 3};
constexpr const char* kHead = "#version 320 es\nprecision highp float;\nprecision highp int;\n";

GLuint program_of(const std::vector<std::pair<GLenum, const char*>>& shaders) {
    const GLuint program = glCreateProgram();
    for (const auto& [type, text] : shaders) {
        const char* const parts[] = {kHead, text};
        const GLuint shader = glCreateShader(type);
        glShaderSource(shader, 2, parts, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
    }
    glLinkProgram(program);
    GLint status = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &status);
    GLchar log[500] = "";
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    if (!status) say("does not link: %s", log);
    return program;
}

GLuint buffer_of(GLenum target, std::size_t bytes, const void* content = nullptr) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(target, name);
    glBufferData(target, static_cast<GLsizeiptr>(bytes), content, GL_DYNAMIC_DRAW);
    return name;
}

void clear_window(Size canvas, float red, float green, float blue) {
    glViewport(0, 0, canvas.width, canvas.height);
    glClearColor(red, green, blue, 1);
    glClear(GL_COLOR_BUFFER_BIT);
}

constexpr const char* kWhole = R"(
    out vec2 at;
    void main() {
        at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
        gl_Position = vec4(at * 2.0 - 1.0, 0, 1);
    })";

void draw_whole() { glDrawArrays(GL_TRIANGLE_STRIP, 0, 4); }

// ---- compute ----

constexpr GLuint kPoints = 96;
constexpr GLsizei kSide = 32;

constexpr const char* kCompute = R"(
    layout(local_size_x = 8, local_size_y = 8) in;
    layout(std430, binding = 1) writeonly buffer Points { vec4 points[]; };
    layout(std430, binding = 2) buffer Commands { uint count, instances, first, zero; };
    layout(binding = 0, rgba8) writeonly uniform highp image2D picture;
    layout(binding = 0, offset = 0) uniform atomic_uint drawn;
    uniform float time;
    shared vec4 row[8];
    void main() {
        uvec2 at = gl_GlobalInvocationID.xy;
        uint i = at.y * 32u + at.x;
        if (gl_LocalInvocationID.y == 0u) row[gl_LocalInvocationID.x] = vec4(float(at.x) / 31.0, 0.3, 0.6, 1);
        barrier();
        vec4 color = row[7u - gl_LocalInvocationID.x];
        color.g = float(at.y) / 31.0;
        imageStore(picture, ivec2(at), (at.x ^ at.y) % 5u == 0u ? vec4(1) : color);
        if (i < 96u) {
            float t = float(i / 2u) * 0.13 + time;
            points[i] = vec4(vec2(cos(t), sin(t)) * (i % 2u == 0u ? 0.9 : 0.5), float(i) / 96.0, 1);
            atomicCounterIncrement(drawn);
        }
        if (i == 0u) { instances = 2u; first = 0u; zero = 0u; }
    })";
constexpr const char* kCount = R"(
    layout(local_size_x = 1) in;
    layout(std430, binding = 2) buffer Commands { uint count, instances, first, zero; };
    layout(binding = 0, offset = 0) uniform atomic_uint drawn;
    void main() { count = atomicCounter(drawn); })";
constexpr const char* kRingVertex = R"(
    layout(location = 3) in vec4 point;
    out vec2 at;
    out float shade;
    void main() {
        float size = gl_InstanceID == 0 ? 1.0 : 0.5;
        at = point.xy * size * 0.5 + 0.5;
        shade = point.z;
        gl_Position = vec4(point.xy * size, 0, 1);
    })";
constexpr const char* kRingFragment = R"(
    in vec2 at;
    in float shade;
    uniform sampler2D picture;
    layout(location = 0) out vec4 result;
    void main() { result = texture(picture, at) * vec4(vec3(0.4 + 0.6 * shade), 1); })";

SCENE(es32_compute, 3, kEs) {
    static GLuint compute, count, ring, points, commands, counter, object, picture;
    if (frame == 0) {
        compute = program_of({{GL_COMPUTE_SHADER, kCompute}});
        count = program_of({{GL_COMPUTE_SHADER, kCount}});
        ring = program_of({{GL_VERTEX_SHADER, kRingVertex}, {GL_FRAGMENT_SHADER, kRingFragment}});
        points = buffer_of(GL_SHADER_STORAGE_BUFFER, kPoints * 4 * sizeof(GLfloat));
        commands = buffer_of(GL_SHADER_STORAGE_BUFFER, 4 * sizeof(GLuint));
        counter = buffer_of(GL_ATOMIC_COUNTER_BUFFER, sizeof(GLuint));
        glGenTextures(1, &picture);
        glBindTexture(GL_TEXTURE_2D, picture);
        glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, kSide, kSide);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glGenVertexArrays(1, &object);
        glBindVertexArray(object);
        glVertexAttribFormat(3, 4, GL_FLOAT, GL_FALSE, 0);
        glVertexAttribBinding(3, 1);
        glBindVertexBuffer(1, points, 0, 4 * sizeof(GLfloat));
        glEnableVertexAttribArray(3);
    }
    const GLuint zero = 0;
    glBindBuffer(GL_ATOMIC_COUNTER_BUFFER, counter);
    glBufferSubData(GL_ATOMIC_COUNTER_BUFFER, 0, sizeof zero, &zero);
    glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, counter);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, points);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, commands);
    glBindImageTexture(0, picture, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    glProgramUniform1f(compute, glGetUniformLocation(compute, "time"), 0.2f * static_cast<GLfloat>(frame));
    glUseProgram(compute);
    glDispatchCompute(kSide / 8, kSide / 8, 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glUseProgram(count);
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    clear_window(canvas, 0.1f, 0.1f, 0.2f);
    glUseProgram(ring);
    glBindVertexArray(object);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands);
    glDrawArraysIndirect(GL_TRIANGLE_STRIP, nullptr);
    const auto* read =
        static_cast<const GLuint*>(glMapBufferRange(GL_DRAW_INDIRECT_BUFFER, 0, 4 * sizeof(GLuint), GL_MAP_READ_BIT));
    if (read) say("%u of %u instances", read[0], read[1]);
    glUnmapBuffer(GL_DRAW_INDIRECT_BUFFER);
    say_error("compute");
}

// ---- stages ----

constexpr const char* kPatchVertex = R"(
    layout(location = 0) in vec2 corner;
    layout(location = 0) out vec2 place;
    out gl_PerVertex { vec4 gl_Position; };
    void main() {
        place = corner;
        gl_Position = vec4(corner, 0, 1);
    })";
constexpr const char* kPatchControl = R"(
    layout(vertices = 3) out;
    in gl_PerVertex { vec4 gl_Position; } gl_in[];
    out gl_PerVertex { vec4 gl_Position; } gl_out[];
    layout(location = 0) in vec2 place[];
    layout(location = 1) out vec2 corner[];
    uniform float level;
    void main() {
        corner[gl_InvocationID] = place[gl_InvocationID];
        gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
        gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = level;
        gl_TessLevelInner[0] = level;
    })";
constexpr const char* kPatchEvaluation = R"(
    layout(triangles, equal_spacing, ccw) in;
    layout(location = 1) in vec2 corner[];
    layout(location = 2) out vec2 spot;
    in gl_PerVertex { vec4 gl_Position; } gl_in[];
    out gl_PerVertex { vec4 gl_Position; };
    void main() {
        spot = gl_TessCoord.x * corner[0] + gl_TessCoord.y * corner[1] + gl_TessCoord.z * corner[2];
        gl_Position = vec4(spot * (0.8 + 0.2 * cos(spot.yx * 3.0)), 0, 1);
    })";
constexpr const char* kPatchGeometry = R"(
    layout(triangles, invocations = 2) in;
    layout(triangle_strip, max_vertices = 3) out;
    in gl_PerVertex { vec4 gl_Position; } gl_in[];
    out gl_PerVertex { vec4 gl_Position; };
    layout(location = 2) in vec2 spot[];
    layout(location = 3) out vec2 shown;
    layout(location = 4) flat out int number;
    void main() {
        for (int i = 0; i < 3; ++i) {
            shown = spot[i];
            number = gl_PrimitiveIDIn * 2 + gl_InvocationID;
            gl_Position = gl_in[i].gl_Position * vec4(gl_InvocationID == 0 ? vec2(1) : vec2(-0.4), 1, 1);
            EmitVertex();
        }
        EndPrimitive();
    })";
constexpr const char* kPatchFragment = R"(
    layout(location = 3) in vec2 shown;
    layout(location = 4) flat in int number;
    uniform highp samplerBuffer colors;
    layout(location = 0) out vec4 result;
    void main() { result = vec4(texelFetch(colors, number % 7).rgb * (0.7 + 0.3 * shown.x), 1); })";

SCENE(es32_stages, 3, kEs) {
    static GLuint program, colors;
    if (frame == 0) {
        program = program_of({{GL_VERTEX_SHADER, kPatchVertex},
                              {GL_TESS_CONTROL_SHADER, kPatchControl},
                              {GL_TESS_EVALUATION_SHADER, kPatchEvaluation},
                              {GL_GEOMETRY_SHADER, kPatchGeometry},
                              {GL_FRAGMENT_SHADER, kPatchFragment}});
        glUseProgram(program);
        const auto bytes = random_image(4 * 7);
        const GLuint buffer = buffer_of(GL_TEXTURE_BUFFER, bytes.size(), bytes.data());
        glGenTextures(1, &colors);
        glBindTexture(GL_TEXTURE_BUFFER, colors);
        glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA8, buffer);
        const GLfloat corners[] = {-0.9f, -0.9f, 0.9f, -0.9f, 0.9f, 0.9f, -0.9f, -0.9f, 0.9f, 0.9f, -0.9f, 0.9f};
        buffer_of(GL_ARRAY_BUFFER, sizeof corners, corners);
        GLuint object = 0;
        glGenVertexArrays(1, &object);
        glBindVertexArray(object);
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
        glPatchParameteri(GL_PATCH_VERTICES, 3);
    }
    clear_window(canvas, 0.2f, 0.1f, 0.1f);
    glUniform1f(glGetUniformLocation(program, "level"), 2.0f + static_cast<GLfloat>(frame));
    glDrawArrays(GL_PATCHES, 0, 6);
    say_error("stages");
}

// ---- blending ----

constexpr GLenum kEquations[] = {GL_FUNC_ADD,      GL_MULTIPLY_KHR,       GL_SCREEN_KHR,     GL_OVERLAY_KHR,
                                 GL_DARKEN_KHR,    GL_LIGHTEN_KHR,        GL_COLORDODGE_KHR, GL_COLORBURN_KHR,
                                 GL_HARDLIGHT_KHR, GL_SOFTLIGHT_KHR,      GL_DIFFERENCE_KHR, GL_EXCLUSION_KHR,
                                 GL_HSL_HUE_KHR,   GL_HSL_SATURATION_KHR, GL_HSL_COLOR_KHR,  GL_HSL_LUMINOSITY_KHR};

constexpr const char* kBlendedFragment = R"(
    in vec2 at;
    uniform int turn;
    layout(blend_support_all_equations) out;
    layout(location = 0) out vec4 result;
    void main() {
        float alpha = turn == 0 ? 1.0 : 0.25 + 0.75 * at.x;
        vec3 color = turn % 2 == 0 ? vec3(at, 0.3) : vec3(0.6, at.yx);
        result = vec4(color * alpha, alpha);
    })";

SCENE(es32_blending, 3, kEs) {
    static GLuint program, object;
    if (frame == 0) {
        program = program_of({{GL_VERTEX_SHADER, kWhole}, {GL_FRAGMENT_SHADER, kBlendedFragment}});
        glGenVertexArrays(1, &object);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
    clear_window(canvas, 0.5f, 0.2f, 0.1f);
    glUseProgram(program);
    glBindVertexArray(object);
    const GLint turn = glGetUniformLocation(program, "turn");
    for (int i = 0; i < 16; ++i) {
        const int width = canvas.width / 4, height = canvas.height / 4;
        glViewport(i % 4 * width, i / 4 * height, width - 2, height - 2);
        glDisable(GL_BLEND);
        glUniform1i(turn, 0);
        draw_whole();
        glEnable(GL_BLEND);
        glBlendEquation(kEquations[i]);
        for (int k = 1; k <= frame + 1; ++k) {
            glUniform1i(turn, k);
            draw_whole();
        }
    }
    glDisable(GL_BLEND);
    say_error("blending");
}

// ---- textures ----

struct BlockFormat {
    GLenum format;
    GLsizei width, height;
};
constexpr BlockFormat kBlocks[] = {
    {GL_COMPRESSED_RGBA_ASTC_4x4_KHR, 4, 4},     {GL_COMPRESSED_RGBA_ASTC_5x4_KHR, 5, 4},
    {GL_COMPRESSED_RGBA_ASTC_5x5_KHR, 5, 5},     {GL_COMPRESSED_RGBA_ASTC_6x5_KHR, 6, 5},
    {GL_COMPRESSED_RGBA_ASTC_6x6_KHR, 6, 6},     {GL_COMPRESSED_RGBA_ASTC_8x5_KHR, 8, 5},
    {GL_COMPRESSED_RGBA_ASTC_8x6_KHR, 8, 6},     {GL_COMPRESSED_RGBA_ASTC_8x8_KHR, 8, 8},
    {GL_COMPRESSED_RGBA_ASTC_10x5_KHR, 10, 5},   {GL_COMPRESSED_RGBA_ASTC_10x6_KHR, 10, 6},
    {GL_COMPRESSED_RGBA_ASTC_10x8_KHR, 10, 8},   {GL_COMPRESSED_RGBA_ASTC_10x10_KHR, 10, 10},
    {GL_COMPRESSED_RGBA_ASTC_12x10_KHR, 12, 10}, {GL_COMPRESSED_RGBA_ASTC_12x12_KHR, 12, 12},
};
constexpr std::size_t kFormats = std::size(kBlocks);
constexpr GLsizei kWidth = 37, kHeight = 26;

constexpr const char* kBlockFragment = R"(
    in vec2 at;
    uniform highp sampler2DArray image;
    layout(location = 0) out vec4 result;
    void main() {
        vec4 texel = texture(image, vec3(at * 1.2 - 0.1, floor(at.y * 2.0 + 0.005)));
        result = vec4(mix(vec3(0.1, 0.2, 0.3), texel.rgb, texel.a), 1);
    })";

GLsizei blocks_in(GLsizei texels, GLsizei side) { return (texels + side - 1) / side; }

/// Two layers of random blocks, of which one is changed by a part.
void make_image(const BlockFormat& each, bool srgb) {
    const GLenum format =
        each.format + (srgb ? GL_COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR - GL_COMPRESSED_RGBA_ASTC_4x4_KHR : 0);
    const GLsizei bytes = 2 * 16 * blocks_in(kWidth, each.width) * blocks_in(kHeight, each.height);
    auto content = random_image(static_cast<std::size_t>(bytes));
    for (std::size_t i = 0; i < content.size(); i += 32) {  // every other block has one colour
        content[i] = 0xfc, content[i + 1] = 0xfd;
        for (std::size_t k = 2; k < 8; ++k) content[i + k] = 0xff;
    }
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, format, kWidth, kHeight, 2);
    glCompressedTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, kWidth, kHeight, 2, format, bytes, content.data());
    glCompressedTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, each.width, each.height, 1, each.width, each.height, 1, format,
                              16, content.data());
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

SCENE(es32_textures, 2, kEs) {
    static GLuint program, object;
    static std::array<GLuint, 2 * kFormats> textures;
    if (frame == 0) {
        program = program_of({{GL_VERTEX_SHADER, kWhole}, {GL_FRAGMENT_SHADER, kBlockFragment}});
        glGenVertexArrays(1, &object);
        glGenTextures(static_cast<GLsizei>(textures.size()), textures.data());
        for (std::size_t i = 0; i < textures.size(); ++i) {
            glBindTexture(GL_TEXTURE_2D_ARRAY, textures[i]);
            make_image(kBlocks[i % kFormats], i >= kFormats);
        }
        say_error("images");
    }
    clear_window(canvas, 0.3f, 0.3f, 0.3f);
    glUseProgram(program);
    glBindVertexArray(object);
    for (std::size_t i = 0; i < kFormats; ++i) {
        const int width = canvas.width / 5, height = canvas.height / 3, place = static_cast<int>(i);
        glViewport(place % 5 * width, place / 5 * height, width - 3, height - 3);
        glBindTexture(GL_TEXTURE_2D_ARRAY, textures[i + (frame == 0 ? 0 : kFormats)]);
        draw_whole();
    }
    say_error("textures");
}

}  // namespace
}  // namespace golden
