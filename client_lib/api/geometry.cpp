// SPDX-License-Identifier: MIT
// glBegin .. glEnd and everything between, as fast as it goes: one compare, one opcode, the operands, the box
// (W3.1). The entry points here do not go through the context's table; a closed packer
// (no context, list compilation) has a limit that sends them to it.
#include <cstring>

#include "client_lib/api/entry_guard.h"
#include "client_lib/context/context.h"
#include "client_lib/context/program_use.h"
#include "common/glapi/primitive.h"

namespace wall::client {
namespace {

using glapi::Op;

template <std::size_t kFloats>
std::byte* put(Packer& packer, Op op) {
    std::byte* at = packer.next_operand();
    *--packer.next_opcode() = static_cast<std::byte>(op);
    packer.next_operand() = at + kFloats * sizeof(float);
    return at;
}

void store(std::byte* at, float x) { std::memcpy(at, &x, sizeof x); }

template <class... Floats>
std::byte* put_floats(Packer& packer, Op op, Floats... values) {
    std::byte* at = put<sizeof...(Floats)>(packer, op);
    std::byte* next = at;
    ((store(next, values), next += sizeof(float)), ...);
    return at;
}

template <class... Floats>
void put_attribute(Packer& packer, Attribute attribute, Op op, Floats... values) {
    const auto index = static_cast<std::size_t>(attribute);
    packer.last[index] = put_floats(packer, op, values...);
    packer.last_op[index] = op;
}

bool full(const Packer& packer, const std::byte* next) { return next >= packer.limit; }
bool full(Packer& packer) { return full(packer, packer.next_operand()); }

/// Room in an open packer.
Packer& room(Context& context) {
    if (full(context.packer)) [[unlikely]]
        context.packer.make_room();
    return context.packer;
}

/// The thread's packer if it takes a command right now, else null: then the context's table decides.
Packer* open_packer() {
    Packer& packer = *tls_packer;
    return full(packer) ? nullptr : &packer;
}

/// The slow way of an entry point: whatever the context's mode makes of the call. Kept out of line, so that the fast
/// way needs no stack frame.
template <class Function, class... Args>
[[gnu::noinline, gnu::cold]] void through_table(const char* name, Function GlTable::*entry, Args... args) {
    if (!tls_context) return;
    try {
        (tls_context->table->*entry)(*tls_context, args...);
    } catch (...) {
        entry_failed(name);
    }
}

void add_vertex(Packer& packer, float x, float y, float z) {
    packer.box.add(_mm_movelh_ps(_mm_unpacklo_ps(_mm_set_ss(x), _mm_set_ss(y)), _mm_set_ss(z)));
}

void pack_vertex2(Packer& packer, float x, float y) {
    add_vertex(packer, x, y, 0);
    put_floats(packer, Op::Vertex2f, x, y);
}

void pack_vertex3(Packer& packer, float x, float y, float z) {
    add_vertex(packer, x, y, z);
    put_floats(packer, Op::Vertex3f, x, y, z);
}

void pack_vertex4(Packer& packer, float x, float y, float z, float w) {
    if (w > 0) add_vertex(packer, x / w, y / w, z / w);
    else packer.mark_unbounded();
    if (w != 1) packer.note_w();
    put_floats(packer, Op::Vertex4f, x, y, z, w);
}

void pack_color4ub(Packer& packer, GLubyte r, GLubyte g, GLubyte b, GLubyte a) {
    const std::uint32_t rgba = r | std::uint32_t{g} << 8 | std::uint32_t{b} << 16 | std::uint32_t{a} << 24;
    float bits;
    std::memcpy(&bits, &rgba, sizeof bits);
    put_attribute(packer, Attribute::color, Op::Color4ub, bits);
}

}  // namespace

// ---- entry points ----
// The packer is full, closed or absent: the table's function makes room, or records, or does nothing.

void GLAPIENTRY gl_entry_Vertex2f(GLfloat x, GLfloat y) {
    if (Packer* p = open_packer()) [[likely]]
        return pack_vertex2(*p, x, y);
    through_table("glVertex2f", &GlTable::Vertex2f, x, y);
}
void GLAPIENTRY gl_entry_Vertex3f(GLfloat x, GLfloat y, GLfloat z) {
    if (Packer* p = open_packer()) [[likely]]
        return pack_vertex3(*p, x, y, z);
    through_table("glVertex3f", &GlTable::Vertex3f, x, y, z);
}
void GLAPIENTRY gl_entry_Vertex4f(GLfloat x, GLfloat y, GLfloat z, GLfloat w) {
    if (Packer* p = open_packer()) [[likely]]
        return pack_vertex4(*p, x, y, z, w);
    through_table("glVertex4f", &GlTable::Vertex4f, x, y, z, w);
}
void GLAPIENTRY gl_entry_Normal3f(GLfloat x, GLfloat y, GLfloat z) {
    if (Packer* p = open_packer()) [[likely]]
        return put_attribute(*p, Attribute::normal, Op::Normal3f, x, y, z);
    through_table("glNormal3f", &GlTable::Normal3f, x, y, z);
}
void GLAPIENTRY gl_entry_Color3f(GLfloat r, GLfloat g, GLfloat b) {
    if (Packer* p = open_packer()) [[likely]]
        return put_attribute(*p, Attribute::color, Op::Color3f, r, g, b);
    through_table("glColor3f", &GlTable::Color3f, r, g, b);
}
void GLAPIENTRY gl_entry_Color4f(GLfloat r, GLfloat g, GLfloat b, GLfloat a) {
    if (Packer* p = open_packer()) [[likely]]
        return put_attribute(*p, Attribute::color, Op::Color4f, r, g, b, a);
    through_table("glColor4f", &GlTable::Color4f, r, g, b, a);
}
void GLAPIENTRY gl_entry_Color4ub(GLubyte r, GLubyte g, GLubyte b, GLubyte a) {
    if (Packer* p = open_packer()) [[likely]]
        return pack_color4ub(*p, r, g, b, a);
    through_table("glColor4ub", &GlTable::Color4ub, r, g, b, a);
}
void GLAPIENTRY gl_entry_TexCoord2f(GLfloat s, GLfloat t) {
    if (Packer* p = open_packer()) [[likely]]
        return put_attribute(*p, Attribute::texcoord, Op::TexCoord2f, s, t);
    through_table("glTexCoord2f", &GlTable::TexCoord2f, s, t);
}

void GLAPIENTRY gl_entry_Vertex2fv(const GLfloat* v) { gl_entry_Vertex2f(v[0], v[1]); }
void GLAPIENTRY gl_entry_Vertex3fv(const GLfloat* v) { gl_entry_Vertex3f(v[0], v[1], v[2]); }
void GLAPIENTRY gl_entry_Vertex4fv(const GLfloat* v) { gl_entry_Vertex4f(v[0], v[1], v[2], v[3]); }
void GLAPIENTRY gl_entry_Normal3fv(const GLfloat* v) { gl_entry_Normal3f(v[0], v[1], v[2]); }
void GLAPIENTRY gl_entry_Color3fv(const GLfloat* v) { gl_entry_Color3f(v[0], v[1], v[2]); }
void GLAPIENTRY gl_entry_Color4fv(const GLfloat* v) { gl_entry_Color4f(v[0], v[1], v[2], v[3]); }
void GLAPIENTRY gl_entry_Color4ubv(const GLubyte* v) { gl_entry_Color4ub(v[0], v[1], v[2], v[3]); }
void GLAPIENTRY gl_entry_TexCoord2fv(const GLfloat* v) { gl_entry_TexCoord2f(v[0], v[1]); }

// ---- the same through the table ----

namespace api {

void Begin(Context& c, GLenum mode) {
    if (!glapi::is_primitive(mode)) return c.error(GL_INVALID_ENUM);
    if (c.packer.inside()) return c.error(GL_INVALID_OPERATION);
    if (may_draw(c) && fits_program(c, mode)) c.begin_primitive(mode);
}

void End(Context& c) {
    if (!c.packer.inside()) return c.error(GL_INVALID_OPERATION);
    c.end_primitive();
}

/// GL_NV_primitive_restart.
void PrimitiveRestartNV(Context& c) {
    if (!c.packer.inside()) return c.error(GL_INVALID_OPERATION);
    const GLenum mode = c.packer.mode();
    c.end_primitive();
    c.begin_primitive(mode);
}

void Vertex2f(Context& c, GLfloat x, GLfloat y) { pack_vertex2(room(c), x, y); }
void Vertex3f(Context& c, GLfloat x, GLfloat y, GLfloat z) { pack_vertex3(room(c), x, y, z); }
void Vertex4f(Context& c, GLfloat x, GLfloat y, GLfloat z, GLfloat w) { pack_vertex4(room(c), x, y, z, w); }
void Normal3f(Context& c, GLfloat x, GLfloat y, GLfloat z) {
    put_attribute(room(c), Attribute::normal, Op::Normal3f, x, y, z);
}
void Color3f(Context& c, GLfloat r, GLfloat g, GLfloat b) {
    put_attribute(room(c), Attribute::color, Op::Color3f, r, g, b);
}
void Color4f(Context& c, GLfloat r, GLfloat g, GLfloat b, GLfloat a) {
    put_attribute(room(c), Attribute::color, Op::Color4f, r, g, b, a);
}
void Color4ub(Context& c, GLubyte r, GLubyte g, GLubyte b, GLubyte a) { pack_color4ub(room(c), r, g, b, a); }
void SecondaryColor3f(Context& c, GLfloat r, GLfloat g, GLfloat b) {
    put_attribute(room(c), Attribute::secondary_color, Op::SecondaryColor3f, r, g, b);
}
void TexCoord1f(Context& c, GLfloat s) { put_attribute(room(c), Attribute::texcoord, Op::TexCoord1f, s); }
void TexCoord2f(Context& c, GLfloat s, GLfloat t) { put_attribute(room(c), Attribute::texcoord, Op::TexCoord2f, s, t); }
void TexCoord3f(Context& c, GLfloat s, GLfloat t, GLfloat r) {
    put_attribute(room(c), Attribute::texcoord, Op::TexCoord3f, s, t, r);
}
void TexCoord4f(Context& c, GLfloat s, GLfloat t, GLfloat r, GLfloat q) {
    put_attribute(room(c), Attribute::texcoord, Op::TexCoord4f, s, t, r, q);
}
void FogCoordf(Context& c, GLfloat coord) { put_attribute(room(c), Attribute::fog_coord, Op::FogCoordf, coord); }
void EdgeFlag(Context& c, GLboolean flag) {
    const std::uint32_t word = flag ? 1 : 0;
    float bits;
    std::memcpy(&bits, &word, sizeof bits);
    put_attribute(room(c), Attribute::edge_flag, Op::EdgeFlag, bits);
}

void MultiTexCoord4f(Context& c, GLenum unit, GLfloat s, GLfloat t, GLfloat r, GLfloat q) {
    if (unit < GL_TEXTURE0 || unit >= GL_TEXTURE0 + kTextureCoords) return c.error(GL_INVALID_ENUM);
    if (unit == GL_TEXTURE0) return TexCoord4f(c, s, t, r, q);
    const std::uint32_t index = unit - GL_TEXTURE0;
    std::byte* at = c.packer.append_attribute(Attribute::texcoord + index, Op::MultiTexCoord4f, 20);
    std::memcpy(at, &index, sizeof index);
    const float values[4] = {s, t, r, q};
    std::memcpy(at + 4, values, sizeof values);
}

void VertexAttrib4f(Context& c, GLuint index, GLfloat x, GLfloat y, GLfloat z, GLfloat w) {
    if (index >= kVertexAttributes) return c.error(GL_INVALID_VALUE);
    if (index == 0 && c.packer.inside()) return Vertex4f(c, x, y, z, w);
    std::byte* at = c.packer.append_attribute(Attribute::vertex_attrib + index, Op::VertexAttrib4f, 20);
    std::memcpy(at, &index, sizeof index);
    const float values[4] = {x, y, z, w};
    std::memcpy(at + 4, values, sizeof values);
}

void Indexf(Context& c, GLfloat index) { put_attribute(room(c), Attribute::color_index, Op::Indexf, index); }

void Rectf(Context& c, GLfloat x1, GLfloat y1, GLfloat x2, GLfloat y2) {
    if (!may_draw(c)) return;
    c.begin_primitive(GL_QUADS);
    Vertex2f(c, x1, y1);
    Vertex2f(c, x2, y1);
    Vertex2f(c, x2, y2);
    Vertex2f(c, x1, y2);
    c.end_primitive();
}

}  // namespace api
}  // namespace wall::client
