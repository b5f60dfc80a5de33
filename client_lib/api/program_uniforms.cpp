// SPDX-License-Identifier: MIT
// Values of uniforms of any program (OpenGL 4.1, 2.14.7).
#include "client_lib/api/uniform_values.h"

namespace wall::client::api {

void ProgramUniform1f(Context& c, GLuint program, GLint location, GLfloat x) {
    set_one(c, uniform_target(c, program), location, x);
}
void ProgramUniform2f(Context& c, GLuint program, GLint location, GLfloat x, GLfloat y) {
    set_one(c, uniform_target(c, program), location, x, y);
}
void ProgramUniform3f(Context& c, GLuint program, GLint location, GLfloat x, GLfloat y, GLfloat z) {
    set_one(c, uniform_target(c, program), location, x, y, z);
}
void ProgramUniform4f(Context& c, GLuint program, GLint location, GLfloat x, GLfloat y, GLfloat z, GLfloat w) {
    set_one(c, uniform_target(c, program), location, x, y, z, w);
}
void ProgramUniform1fv(Context& c, GLuint program, GLint location, GLsizei count, const GLfloat* v) {
    set_vectors<1>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform2fv(Context& c, GLuint program, GLint location, GLsizei count, const GLfloat* v) {
    set_vectors<2>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform3fv(Context& c, GLuint program, GLint location, GLsizei count, const GLfloat* v) {
    set_vectors<3>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform4fv(Context& c, GLuint program, GLint location, GLsizei count, const GLfloat* v) {
    set_vectors<4>(c, uniform_target(c, program), location, count, v);
}

void ProgramUniform1i(Context& c, GLuint program, GLint location, GLint x) {
    set_one(c, uniform_target(c, program), location, x);
}
void ProgramUniform2i(Context& c, GLuint program, GLint location, GLint x, GLint y) {
    set_one(c, uniform_target(c, program), location, x, y);
}
void ProgramUniform3i(Context& c, GLuint program, GLint location, GLint x, GLint y, GLint z) {
    set_one(c, uniform_target(c, program), location, x, y, z);
}
void ProgramUniform4i(Context& c, GLuint program, GLint location, GLint x, GLint y, GLint z, GLint w) {
    set_one(c, uniform_target(c, program), location, x, y, z, w);
}
void ProgramUniform1iv(Context& c, GLuint program, GLint location, GLsizei count, const GLint* v) {
    set_vectors<1>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform2iv(Context& c, GLuint program, GLint location, GLsizei count, const GLint* v) {
    set_vectors<2>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform3iv(Context& c, GLuint program, GLint location, GLsizei count, const GLint* v) {
    set_vectors<3>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform4iv(Context& c, GLuint program, GLint location, GLsizei count, const GLint* v) {
    set_vectors<4>(c, uniform_target(c, program), location, count, v);
}

void ProgramUniform1ui(Context& c, GLuint program, GLint location, GLuint x) {
    set_one(c, uniform_target(c, program), location, x);
}
void ProgramUniform2ui(Context& c, GLuint program, GLint location, GLuint x, GLuint y) {
    set_one(c, uniform_target(c, program), location, x, y);
}
void ProgramUniform3ui(Context& c, GLuint program, GLint location, GLuint x, GLuint y, GLuint z) {
    set_one(c, uniform_target(c, program), location, x, y, z);
}
void ProgramUniform4ui(Context& c, GLuint program, GLint location, GLuint x, GLuint y, GLuint z, GLuint w) {
    set_one(c, uniform_target(c, program), location, x, y, z, w);
}
void ProgramUniform1uiv(Context& c, GLuint program, GLint location, GLsizei count, const GLuint* v) {
    set_vectors<1>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform2uiv(Context& c, GLuint program, GLint location, GLsizei count, const GLuint* v) {
    set_vectors<2>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform3uiv(Context& c, GLuint program, GLint location, GLsizei count, const GLuint* v) {
    set_vectors<3>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform4uiv(Context& c, GLuint program, GLint location, GLsizei count, const GLuint* v) {
    set_vectors<4>(c, uniform_target(c, program), location, count, v);
}

void ProgramUniform1d(Context& c, GLuint program, GLint location, GLdouble x) {
    set_one(c, uniform_target(c, program), location, x);
}
void ProgramUniform2d(Context& c, GLuint program, GLint location, GLdouble x, GLdouble y) {
    set_one(c, uniform_target(c, program), location, x, y);
}
void ProgramUniform3d(Context& c, GLuint program, GLint location, GLdouble x, GLdouble y, GLdouble z) {
    set_one(c, uniform_target(c, program), location, x, y, z);
}
void ProgramUniform4d(Context& c, GLuint program, GLint location, GLdouble x, GLdouble y, GLdouble z, GLdouble w) {
    set_one(c, uniform_target(c, program), location, x, y, z, w);
}
void ProgramUniform1dv(Context& c, GLuint program, GLint location, GLsizei count, const GLdouble* v) {
    set_vectors<1>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform2dv(Context& c, GLuint program, GLint location, GLsizei count, const GLdouble* v) {
    set_vectors<2>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform3dv(Context& c, GLuint program, GLint location, GLsizei count, const GLdouble* v) {
    set_vectors<3>(c, uniform_target(c, program), location, count, v);
}
void ProgramUniform4dv(Context& c, GLuint program, GLint location, GLsizei count, const GLdouble* v) {
    set_vectors<4>(c, uniform_target(c, program), location, count, v);
}

void ProgramUniformMatrix2fv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<2, 2>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix3fv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<3, 3>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix4fv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<4, 4>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix2x3fv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<2, 3>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix3x2fv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<3, 2>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix2x4fv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<2, 4>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix4x2fv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<4, 2>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix3x4fv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<3, 4>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix4x3fv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<4, 3>(c, uniform_target(c, program), l, n, t, v);
}

void ProgramUniformMatrix2dv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<2, 2>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix3dv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<3, 3>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix4dv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<4, 4>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix2x3dv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<2, 3>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix3x2dv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<3, 2>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix2x4dv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<2, 4>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix4x2dv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<4, 2>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix3x4dv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<3, 4>(c, uniform_target(c, program), l, n, t, v);
}
void ProgramUniformMatrix4x3dv(Context& c, GLuint program, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<4, 3>(c, uniform_target(c, program), l, n, t, v);
}

}  // namespace wall::client::api
