// SPDX-License-Identifier: MIT
// The least that a packing vendor behind GLVND can do, to measure ours against: one opcode byte and the operands go
// into a buffer that starts anew when it is full; nothing is sent, drawn or answered. WALLBARE_BOX=1 also keeps an
// object-space box with SSE, WALLBARE_BOX=0 (the default) does not. The vendor above it is WallGL's own.
#include <GL/gl.h>
#include <immintrin.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "client_lib/context/core.h"

namespace wall::client {

class Context {};

class ClientSurface {
public:
    explicit ClientSurface(SurfaceOptions o) : options(std::move(o)) {}
    const SurfaceOptions options;
};

namespace {

constexpr std::size_t kOperandBytes = 256 << 10, kOpcodeBytes = 64 << 10;

struct Bare {
    std::byte* operands;
    std::byte* opcodes;
    std::byte* limit;
    __m128 low, high;
};

alignas(64) std::byte g_memory[kOpcodeBytes + kOperandBytes + 64];
[[gnu::tls_model("initial-exec")]] thread_local Bare tls_bare{};
thread_local std::shared_ptr<Context> tls_context;

[[gnu::noinline, gnu::cold]] void start_anew() {
    Bare& bare = tls_bare;
    bare.opcodes = bare.operands = g_memory + kOpcodeBytes;
    bare.limit = g_memory + kOpcodeBytes + kOpcodeBytes * 4;
    bare.low = _mm_set1_ps(3e38f);
    bare.high = _mm_set1_ps(-3e38f);
}

template <std::size_t kFloats>
std::byte* put(int opcode) {
    Bare& bare = tls_bare;
    if (bare.operands >= bare.limit) [[unlikely]]
        start_anew();
    std::byte* at = bare.operands;
    *--bare.opcodes = static_cast<std::byte>(opcode);
    bare.operands = at + kFloats * sizeof(float);
    return at;
}

/// Each from its register: together they would go over the stack and stall.
template <class... Floats>
void put_floats(int opcode, Floats... values) {
    std::byte* at = put<sizeof...(Floats)>(opcode);
    ((std::memcpy(at, &values, sizeof(float)), at += sizeof(float)), ...);
}

template <int kOpcode>
[[gnu::aligned(64)]] void GLAPIENTRY three_floats(GLfloat x, GLfloat y, GLfloat z) {
    put_floats(kOpcode, x, y, z);
}

template <int kOpcode>
[[gnu::aligned(64)]] void GLAPIENTRY three_floats_v(const GLfloat* v) {
    three_floats<kOpcode>(v[0], v[1], v[2]);
}

[[gnu::aligned(64)]] void GLAPIENTRY boxed_vertex(GLfloat x, GLfloat y, GLfloat z) {
    const __m128 at = _mm_movelh_ps(_mm_unpacklo_ps(_mm_set_ss(x), _mm_set_ss(y)), _mm_set_ss(z));
    tls_bare.low = _mm_min_ps(tls_bare.low, at);
    tls_bare.high = _mm_max_ps(tls_bare.high, at);
    three_floats<3>(x, y, z);
}
[[gnu::aligned(64)]] void GLAPIENTRY boxed_vertex_v(const GLfloat* v) { boxed_vertex(v[0], v[1], v[2]); }

[[gnu::aligned(64)]] void GLAPIENTRY color4ub(GLubyte r, GLubyte g, GLubyte b, GLubyte a) {
    const std::uint32_t rgba = r | std::uint32_t{g} << 8 | std::uint32_t{b} << 16 | std::uint32_t{a} << 24;
    std::memcpy(put<1>(6), &rgba, sizeof rgba);
}
[[gnu::aligned(64)]] void GLAPIENTRY texcoord2(GLfloat s, GLfloat t) { put_floats(7, s, t); }
void GLAPIENTRY begin(GLenum mode) { std::memcpy(put<1>(1), &mode, sizeof mode); }
void GLAPIENTRY end() { put<0>(2); }
const GLubyte* GLAPIENTRY get_string(GLenum name) {
    return reinterpret_cast<const GLubyte*>(name == GL_VENDOR ? "bare" : name == GL_VERSION ? "1.1 bare packer" : "");
}
long no_function() { return 0; }

template <class Function>
ProcAddress address(Function function) {
    return reinterpret_cast<ProcAddress>(function);
}

}  // namespace

std::shared_ptr<ClientSurface> create_surface(SurfaceOptions options) {
    return std::make_shared<ClientSurface>(std::move(options));
}
bool offers_es(int) { return false; }
std::shared_ptr<Context> create_context(const ContextOptions&) { return std::make_shared<Context>(); }
bool make_current(std::shared_ptr<Context> context, std::shared_ptr<ClientSurface>, std::shared_ptr<ClientSurface>) {
    start_anew();
    tls_context = std::move(context);
    return true;
}
Context* current_context() { return tls_context.get(); }
void swap_buffers(ClientSurface&) {}
Extent surface_size(const ClientSurface& surface) { return surface.options.size; }
void flush_current(bool) {}
void copy_context(Context&, Context&, std::uint32_t) {}

ProcAddress gl_proc_address(const char* name) {
    const auto is = [name](const char* other) { return std::strcmp(name, other) == 0; };
    const char* wanted = std::getenv("WALLBARE_BOX");
    const bool box = wanted && *wanted == '1';
    if (is("glVertex3f")) return box ? address(boxed_vertex) : address(three_floats<3>);
    if (is("glVertex3fv")) return box ? address(boxed_vertex_v) : address(three_floats_v<3>);
    if (is("glNormal3f")) return address(three_floats<4>);
    if (is("glColor3f")) return address(three_floats<5>);
    if (is("glColor4ub")) return address(color4ub);
    if (is("glTexCoord2f")) return address(texcoord2);
    if (is("glBegin")) return address(begin);
    if (is("glEnd")) return address(end);
    if (is("glGetString")) return address(get_string);
    return address(no_function);
}

}  // namespace wall::client
