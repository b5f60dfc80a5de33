// SPDX-License-Identifier: MIT
#include "tests/golden/moved/calls.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "tests/golden/moved/mesa.h"
#include "tests/golden/moved/place.h"
#include "tests/golden/moved/reads.h"
#include "tests/golden/moved/views.h"

namespace golden::moved {
namespace {

Lookup g_lookup = nullptr;

/// What is added to a position in what is drawn to.
int dx() { return draws_to_window() ? place().dx() : 0; }
int dy() { return draws_to_window() ? place().dy() : 0; }

void Viewport(GLint x, GLint y, GLsizei width, GLsizei height) { mesa().Viewport(x + dx(), y + dy(), width, height); }

void Scissor(GLint x, GLint y, GLsizei width, GLsizei height) { mesa().Scissor(x + dx(), y + dy(), width, height); }

void DrawTexfOES(GLfloat x, GLfloat y, GLfloat z, GLfloat width, GLfloat height) {
    mesa().DrawTexfOES(x + static_cast<GLfloat>(dx()), y + static_cast<GLfloat>(dy()), z, width, height);
}

void PolygonStipple(const GLubyte* mask) {
    if (integer(GL_UNPACK_ROW_LENGTH) != 0 || integer(GL_UNPACK_SKIP_ROWS) != 0 ||
        integer(GL_UNPACK_SKIP_PIXELS) != 0 || integer(GL_UNPACK_LSB_FIRST) != 0 || integer(GL_UNPACK_ALIGNMENT) > 4)
        stop("glPolygonStipple out of an image that is not stored plainly");
    std::array<GLubyte, 128> moved{};
    for (unsigned row = 0; row < 32; ++row) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, mask + std::size_t{4} * row, 4);
        const std::uint32_t rotated = __builtin_bswap32(std::rotr(__builtin_bswap32(bits), place().dx() & 31));
        std::memcpy(&moved[std::size_t{4} * ((row + static_cast<unsigned>(place().dy())) % 32)], &rotated, 4);
    }
    mesa().PolygonStipple(moved.data());
}

template <class T>
void WindowPos3(T x, T y, T z) {
    mesa().WindowPos3d(static_cast<GLdouble>(x) + dx(), static_cast<GLdouble>(y) + dy(), static_cast<GLdouble>(z));
}
template <class T>
void WindowPos3v(const T* at) {
    WindowPos3(at[0], at[1], at[2]);
}
template <class T>
void WindowPos2(T x, T y) {
    WindowPos3(x, y, T{0});
}
template <class T>
void WindowPos2v(const T* at) {
    WindowPos3(at[0], at[1], T{0});
}

template <class T>
void answer_in_window_pixels(GLenum name, T* values) {
    if (name != GL_VIEWPORT && name != GL_SCISSOR_BOX && name != GL_CURRENT_RASTER_POSITION) return;
    values[0] -= static_cast<T>(dx());
    values[1] -= static_cast<T>(dy());
}
void GetIntegerv(GLenum name, GLint* values) {
    mesa().GetIntegerv(name, values);
    answer_in_window_pixels(name, values);
}
void GetFloatv(GLenum name, GLfloat* values) {
    if (own_projection(name, values)) return;
    mesa().GetFloatv(name, values);
    answer_in_window_pixels(name, values);
}
void GetDoublev(GLenum name, GLdouble* values) {
    if (std::array<GLfloat, 16> own{}; own_projection(name, own.data())) {
        std::ranges::copy(own, values);
        return;
    }
    mesa().GetDoublev(name, values);
    answer_in_window_pixels(name, values);
}

bool g_moves_fragments = false;                 ///< a shader does
constexpr const char* kMoved = "golden_moved";  ///< the uniform by which it does

bool g_moves_assembly = false;           ///< an assembly program of fragments is
constexpr GLuint kMovedParameter = 255;  ///< the parameter of all of them by which it is

/// Tells the current program how far gl_FragCoord is moved in what is drawn to.
void tell_program() {
    if (g_moves_assembly)
        mesa().ProgramEnvParameter4f(GL_FRAGMENT_PROGRAM_ARB, kMovedParameter, static_cast<GLfloat>(dx()),
                                     static_cast<GLfloat>(dy()), 0.0F, 0.0F);
    const int program = g_moves_fragments ? integer(GL_CURRENT_PROGRAM) : 0;
    const GLint location = program != 0 ? mesa().GetUniformLocation(static_cast<GLuint>(program), kMoved) : -1;
    if (location >= 0) mesa().Uniform4f(location, static_cast<GLfloat>(dx()), static_cast<GLfloat>(dy()), 0.0F, 0.0F);
}

void UseProgram(GLuint program) {
    mesa().UseProgram(program);
    tell_program();
}
void LinkProgram(GLuint program) {
    mesa().LinkProgram(program);
    tell_program();
}

/// What is drawn into a framebuffer object stays where it is: positions are set anew.
void BindFramebuffer(GLenum target, GLuint framebuffer) {
    std::array<GLint, 4> viewport{}, scissor{};
    GetIntegerv(GL_VIEWPORT, viewport.data());
    GetIntegerv(GL_SCISSOR_BOX, scissor.data());
    mesa().BindFramebuffer(target, framebuffer);
    Viewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    Scissor(scissor[0], scissor[1], scissor[2], scissor[3]);
    tell_program();
}

void BlitFramebuffer(GLint from_x0, GLint from_y0, GLint from_x1, GLint from_y1, GLint to_x0, GLint to_y0, GLint to_x1,
                     GLint to_y1, GLbitfield mask, GLenum filter) {
    if (reads_from_window()) stop("glBlitFramebuffer out of a window");
    mesa().BlitFramebuffer(from_x0, from_y0, from_x1, from_y1, to_x0 + dx(), to_y0 + dy(), to_x1 + dx(), to_y1 + dy(),
                           mask, filter);
}

/// Whether only the depth or w of gl_FragCoord is taken, by the text that follows its name.
bool takes_no_place(std::string_view after) {
    if (!after.starts_with('.')) return false;
    const std::string_view taken = after.substr(1, after.find_first_not_of("xyzwrgbastpq", 1) - 1);
    return taken.find_first_not_of("zwbapq") == taken.npos;
}

/// The uniform's declaration, behind #version, which must be first. (Mesa is told that #extension may follow.)
void declare_moved(std::string& source) {
    const bool es =
        std::string_view(reinterpret_cast<const char*>(mesa().GetString(GL_VERSION))).starts_with("OpenGL ES");
    const std::size_t version = source.find("#version");
    const std::size_t at = version == source.npos ? 0 : source.find('\n', version) + 1;
    if (at == 0 && version != source.npos) stop("#version without an end of its line");
    source.insert(at, std::string(es ? "uniform highp vec4 " : "uniform vec4 ") + kMoved + ";\n");
}

/// gl_FragCoord of the window, out of that of this process.
void ShaderSource(GLuint shader, GLsizei count, const GLchar* const* strings, const GLint* lengths) {
    std::string source;
    for (GLsizei i = 0; i < count; ++i)
        source.append(strings[i], lengths != nullptr && lengths[i] >= 0 ? static_cast<std::size_t>(lengths[i])
                                                                        : std::strlen(strings[i]));
    constexpr std::string_view kName = "gl_FragCoord";
    if (source.find("origin_upper_left") != source.npos) stop("origin_upper_left");
    const std::string moved = std::string("(gl_FragCoord - ") + kMoved + ")";
    bool moves = false;
    for (std::size_t at = 0; (at = source.find(kName, at)) != source.npos;) {
        const bool stays = takes_no_place(std::string_view(source).substr(at + kName.size()));
        if (!stays) source.replace(at, kName.size(), moved);
        at += stays ? kName.size() : moved.size();
        moves = moves || !stays;
    }
    if (moves) declare_moved(source);
    g_moves_fragments = g_moves_fragments || moves;
    const GLchar* whole = source.c_str();
    mesa().ShaderSource(shader, 1, &whole, nullptr);
}

/// The same of fragment.position in an assembly program.
void ProgramString(GLenum target, GLenum format, GLsizei length, const void* text) {
    std::string source(static_cast<const char*>(text), static_cast<std::size_t>(length));
    constexpr std::string_view kName = "fragment.position", kTemporary = "golden_moved";
    const std::size_t spaced = source.find("fragment . position");
    if (spaced != source.npos) source.replace(spaced, kName.size() + 2, kName);
    if (target == GL_FRAGMENT_PROGRAM_ARB && source.find(kName) != source.npos) {
        if (source.find("OPTION") != source.npos) stop("fragment.position with an option");
        for (std::size_t at = 0; (at = source.find(kName, at)) != source.npos; at += kTemporary.size())
            source.replace(at, kName.size(), kTemporary);
        if (const std::size_t at = source.find("ATTRIB here"); at != source.npos) source.replace(at, 6, "ALIAS");
        source.insert(source.find('\n') + 1, "TEMP golden_moved;\nSUB golden_moved, fragment.position, program.env[" +
                                                 std::to_string(kMovedParameter) + "];\n");
        g_moves_assembly = true;
    }
    mesa().ProgramString(target, format, static_cast<GLsizei>(source.size()), source.data());
    tell_program();
}

/// In the place of what nothing here moves. A program that calls it has no moved reference.
void never() { stop("a function that works in window pixels and is not known here"); }

struct Replacement {
    std::string_view name;
    void (*function)();
};

template <class Function>
Replacement with(std::string_view name, Function* function) {
    return {name, reinterpret_cast<void (*)()>(function)};
}

constexpr std::array<std::string_view, 9> kNeverStart = {
    "glViewportIndexed",   "glViewportArray", "glScissorIndexed",      "glScissorArray",    "glBlitNamed",
    "glCopyTexSubImage3D", "glReadnPixels",   "glCopyTextureSubImage", "glUseProgramStages"};

/// The name without what marks it as an extension's.
std::string_view core_name(std::string_view name) {
    for (const std::string_view suffix : {"ARB", "EXT", "MESA", "KHR"})
        if (name.ends_with(suffix)) return name.substr(0, name.size() - suffix.size());
    return name;
}

}  // namespace

Found find(const char* name) { return {g_lookup(name)}; }

const Mesa& mesa() {
    static const Mesa table;
    return table;
}

int integer(GLenum name) {
    GLint value = 0;
    mesa().GetIntegerv(name, &value);
    return value;
}

bool draws_to_window() { return integer(GL_DRAW_FRAMEBUFFER_BINDING) == 0; }
bool reads_from_window() { return is_es1() ? draws_to_window() : integer(GL_READ_FRAMEBUFFER_BINDING) == 0; }
bool is_es1() {
    const auto* version = reinterpret_cast<const char*>(mesa().GetString(GL_VERSION));
    return version != nullptr && std::strncmp(version, "OpenGL ES-CM", 12) == 0;
}

void use(Lookup lookup) { g_lookup = lookup; }

void* replacement(std::string_view name) {
    static const std::array replacements = {
        with("glViewport", Viewport),
        with("glScissor", Scissor),
        with("glDrawTexfOES", DrawTexfOES),
        with("glPolygonStipple", PolygonStipple),
        with("glWindowPos2s", WindowPos2<GLshort>),
        with("glWindowPos2i", WindowPos2<GLint>),
        with("glWindowPos2f", WindowPos2<GLfloat>),
        with("glWindowPos2d", WindowPos2<GLdouble>),
        with("glWindowPos2sv", WindowPos2v<GLshort>),
        with("glWindowPos2iv", WindowPos2v<GLint>),
        with("glWindowPos2fv", WindowPos2v<GLfloat>),
        with("glWindowPos2dv", WindowPos2v<GLdouble>),
        with("glWindowPos3s", WindowPos3<GLshort>),
        with("glWindowPos3i", WindowPos3<GLint>),
        with("glWindowPos3f", WindowPos3<GLfloat>),
        with("glWindowPos3d", WindowPos3<GLdouble>),
        with("glWindowPos3sv", WindowPos3v<GLshort>),
        with("glWindowPos3iv", WindowPos3v<GLint>),
        with("glWindowPos3fv", WindowPos3v<GLfloat>),
        with("glWindowPos3dv", WindowPos3v<GLdouble>),
        with("glBindFramebuffer", BindFramebuffer),
        with("glBlitFramebuffer", BlitFramebuffer),
        with("glGetIntegerv", GetIntegerv),
        with("glGetFloatv", GetFloatv),
        with("glGetDoublev", GetDoublev),
        with("glShaderSource", ShaderSource),
        with("glProgramString", ProgramString),
        with("glUseProgram", UseProgram),
        with("glUseProgramObject", UseProgram),
        with("glLinkProgram", LinkProgram),
        with("glReadPixels", ReadPixels),
        with("glCopyPixels", CopyPixels),
        with("glCopyTexImage1D", CopyTexImage1D),
        with("glCopyTexImage2D", CopyTexImage2D),
        with("glCopyTexSubImage1D", CopyTexSubImage1D),
        with("glCopyTexSubImage2D", CopyTexSubImage2D),
    };
    const std::string_view core = core_name(name);
    if (void* of_view = view_replacement(core)) return of_view;
    for (const Replacement& each : replacements)
        if (each.name == core) return reinterpret_cast<void*>(each.function);
    for (const std::string_view start : kNeverStart)
        if (core.starts_with(start)) return reinterpret_cast<void*>(&never);
    return nullptr;
}

void move_new_context() {
    std::array<GLint, 4> viewport{}, scissor{};
    mesa().GetIntegerv(GL_VIEWPORT, viewport.data());
    mesa().GetIntegerv(GL_SCISSOR_BOX, scissor.data());
    Viewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    Scissor(scissor[0], scissor[1], scissor[2], scissor[3]);
}

}  // namespace golden::moved
