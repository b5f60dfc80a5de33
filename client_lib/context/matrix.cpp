// SPDX-License-Identifier: MIT
// Facts about the order of operations: Mesa 22.3, src/mesa/math/m_matrix.c and util/u_math.c.
// tests/unit/client_lib/context/matrix_test.cpp compares with the Mesa of the machine.
#include "client_lib/context/matrix.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace wall::client {
namespace {

float at(const Mat4& m, int row, int column) { return m[static_cast<std::size_t>(4 * column + row)]; }
float& at(Mat4& m, int row, int column) { return m[static_cast<std::size_t>(4 * column + row)]; }
float square(float x) { return x * x; }

constexpr float kTiny = 1e-6f * 1e-6f;

bool same_bits(const Mat4& a, const Mat4& b) { return std::memcmp(a.data(), b.data(), sizeof a) == 0; }
bool only(std::uint32_t form, std::uint32_t allowed) { return (form & ~form::kUnknown & ~allowed) == 0; }

Mat4 product_full(const Mat4& a, const Mat4& b) {
    Mat4 p;
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c)
            at(p, r, c) = at(a, r, 0) * at(b, 0, c) + at(a, r, 1) * at(b, 1, c) + at(a, r, 2) * at(b, 2, c) +
                          at(a, r, 3) * at(b, 3, c);
    return p;
}

// Both last rows are 0 0 0 1.
Mat4 product_affine(const Mat4& a, const Mat4& b) {
    Mat4 p = kIdentity;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            at(p, r, c) = at(a, r, 0) * at(b, 0, c) + at(a, r, 1) * at(b, 1, c) + at(a, r, 2) * at(b, 2, c);
        at(p, r, 3) = at(a, r, 0) * at(b, 0, 3) + at(a, r, 1) * at(b, 1, 3) + at(a, r, 2) * at(b, 2, 3) + at(a, r, 3);
    }
    return p;
}

std::uint32_t form_of(const Mat4& m);

/// After a change: where the matrix comes from.
void remember(FormedMatrix& matrix, glstate::StepKind kind, float a = 0, float b = 0, float c = 0, float d = 0) {
    MatrixOrigin& origin = matrix.origin;
    if (matrix.form & form::kUnknown) {
        origin.known = false;
    } else if ((form_of(matrix.m) & ~matrix.form) == 0) {
        origin.known = true;
        origin.base = matrix.m;
        origin.count = 0;
    } else if (origin.known && kind != glstate::StepKind::none && origin.count < MatrixOrigin::kMostSteps) {
        origin.steps[origin.count++] = {static_cast<std::uint32_t>(kind), a, b, c, d};
    } else {
        origin.known = false;
    }
}

void multiply_formed(FormedMatrix& matrix, const Mat4& right, std::uint32_t right_form) {
    matrix.form |= right_form;
    matrix.m = only(matrix.form, form::kAffine) ? product_affine(matrix.m, right) : product_full(matrix.m, right);
}

// ---- form from values ----

bool affine(const Mat4& m) { return m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1; }
bool flat(const Mat4& m) {
    return affine(m) && m[2] == 0 && m[6] == 0 && m[8] == 0 && m[9] == 0 && m[10] == 1 && m[14] == 0;
}
bool diagonal(const Mat4& m) { return m[1] == 0 && m[2] == 0 && m[4] == 0 && m[6] == 0 && m[8] == 0 && m[9] == 0; }

float dot(const float* a, const float* b, int n) {
    float sum = a[0] * b[0] + a[1] * b[1];
    return n == 3 ? sum + a[2] * b[2] : sum;
}

std::uint32_t form_2d(const Mat4& m) {
    std::uint32_t form = 0;
    if (square(dot(&m[0], &m[0], 2) - 1) > kTiny || square(dot(&m[4], &m[4], 2) - 1) > kTiny)
        form |= form::kGeneralScale;
    return form | (square(dot(&m[0], &m[4], 2)) > kTiny ? form::kGeneral3d : form::kRotation);
}

std::uint32_t form_3d_diagonal(const Mat4& m) {
    if (!(square(m[0] - m[5]) < kTiny && square(m[0] - m[10]) < kTiny)) return form::kGeneralScale;
    return square(m[0] - 1.0f) > kTiny ? form::kUniformScale : 0;
}

bool is_cross_product(const Mat4& m) {  // third column = first x second
    const float x = m[1] * m[6] - m[2] * m[5] - m[8];
    const float y = m[2] * m[4] - m[0] * m[6] - m[9];
    const float z = m[0] * m[5] - m[1] * m[4] - m[10];
    return x * x + y * y + z * z < kTiny;
}

std::uint32_t form_3d(const Mat4& m) {
    const float c1 = dot(&m[0], &m[0], 3), c2 = dot(&m[4], &m[4], 3), c3 = dot(&m[8], &m[8], 3);
    std::uint32_t form = 0;
    if (!(square(c1 - c2) < kTiny && square(c1 - c3) < kTiny)) form |= form::kGeneralScale;
    else if (square(c1 - 1.0f) > kTiny) form |= form::kUniformScale;
    const bool rotation = square(dot(&m[0], &m[4], 3)) < kTiny && is_cross_product(m);
    return form | (rotation ? form::kRotation : form::kGeneral3d);
}

std::uint32_t form_of(const Mat4& m) {
    const std::uint32_t moved = m[12] != 0 || m[13] != 0 || m[14] != 0 ? form::kTranslation : 0;
    if (flat(m) && diagonal(m)) return moved | (m[0] != 1 || m[5] != 1 ? form::kGeneralScale : 0);
    if (flat(m)) return moved | form_2d(m);
    if (affine(m) && diagonal(m)) return moved | form_3d_diagonal(m);
    if (affine(m)) return moved | form_3d(m);
    return moved | form::kGeneral;
}

// ---- inverses; false: singular ----

bool invert_diagonal(const Mat4& in, Mat4& out, int rows) {
    for (int i = 0; i < rows; ++i) {
        if (at(in, i, i) == 0) return false;
        at(out, i, i) = 1.0f / at(in, i, i);
    }
    for (int i = 0; i < rows; ++i) at(out, i, 3) = -(at(in, i, 3) * at(out, i, i));
    return true;
}

void invert_translation(const Mat4& in, Mat4& out) {
    for (int r = 0; r < 3; ++r)
        at(out, r, 3) = -(at(in, 0, 3) * at(out, r, 0) + at(in, 1, 3) * at(out, r, 1) + at(in, 2, 3) * at(out, r, 2));
}

float determinant3(const Mat4& m) {
    const float terms[] = {at(m, 0, 0) * at(m, 1, 1) * at(m, 2, 2),  at(m, 1, 0) * at(m, 2, 1) * at(m, 0, 2),
                           at(m, 2, 0) * at(m, 0, 1) * at(m, 1, 2),  -at(m, 2, 0) * at(m, 1, 1) * at(m, 0, 2),
                           -at(m, 1, 0) * at(m, 0, 1) * at(m, 2, 2), -at(m, 0, 0) * at(m, 2, 1) * at(m, 1, 2)};
    float positive = 0, negative = 0;
    for (const float term : terms) (term >= 0 ? positive : negative) += term;
    return positive + negative;
}

bool invert_affine(const Mat4& in, Mat4& out) {
    const float determinant = determinant3(in);
    if (std::fabs(determinant) < 1e-25f) return false;
    const float scale = 1.0f / determinant;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
            const int r0 = c == 0 ? 1 : 0, r1 = c == 2 ? 1 : 2;  // the minor of (c, r)
            const int c0 = r == 0 ? 1 : 0, c1 = r == 2 ? 1 : 2;
            const float minor = at(in, r0, c0) * at(in, r1, c1) - at(in, r1, c0) * at(in, r0, c1);
            at(out, r, c) = ((r + c) % 2 == 0 ? minor : -minor) * scale;
        }
    invert_translation(in, out);
    return true;
}

bool invert_angle_preserving(const Mat4& in, std::uint32_t form, Mat4& out) {
    if (form & (form::kUniformScale | form::kRotation)) {
        float factor = 1;
        if (form & form::kUniformScale) {
            factor = at(in, 0, 0) * at(in, 0, 0) + at(in, 0, 1) * at(in, 0, 1) + at(in, 0, 2) * at(in, 0, 2);
            if (factor == 0) return false;
            factor = 1.0f / factor;
        }
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) at(out, r, c) = factor * at(in, c, r);
    }
    if (form & form::kTranslation) invert_translation(in, out);
    return true;
}

// Gaussian elimination; one row may bubble up by more than one place, one compare each.
bool eliminate(float (&row)[4][8], float* (&r)[4]) {
    for (int i = 0; i < 4; ++i) r[i] = row[i];
    for (int k = 0; k < 4; ++k) {
        for (int i = 3; i > k; --i)
            if (std::fabs(r[i][k]) > std::fabs(r[i - 1][k])) std::swap(r[i], r[i - 1]);
        if (r[k][k] == 0) return false;
        float factor[4];
        for (int i = k + 1; i < 4; ++i) factor[i] = r[i][k] / r[k][k];
        for (int i = k + 1; i < 4; ++i)
            for (int j = k + 1; j < 8; ++j) r[i][j] -= factor[i] * r[k][j];
    }
    return true;
}

bool invert_full(const Mat4& in, Mat4& out) {
    float row[4][8]{};
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) row[i][j] = at(in, i, j);
        row[i][4 + i] = 1;
    }
    float* r[4];
    if (!eliminate(row, r)) return false;
    for (int k = 3; k >= 0; --k) {
        const float scale = 1.0f / r[k][k];
        for (int j = 4; j < 8; ++j) {
            if (k < 3) r[k][j] -= r[k + 1][j] * r[k][k + 1];
            r[k][j] = scale * r[k][j];
            for (int i = 0; i < k - 1; ++i) r[i][j] -= r[k][j] * r[i][k];
        }
    }
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) at(out, i, j) = r[i][4 + j];
    return true;
}

enum class Way : std::uint8_t { identity, diagonal, angle_preserving, affine, full };

Way way_to_invert(std::uint32_t form) {
    if (form == form::kIdentity) return Way::identity;
    if (only(form, form::kTranslation | form::kUniformScale | form::kGeneralScale)) return Way::diagonal;
    if (!only(form, form::kAffine)) return Way::full;
    return only(form, form::kRotation | form::kTranslation | form::kUniformScale) ? Way::angle_preserving : Way::affine;
}

Mat4 inverse_by_form(const Mat4& m, std::uint32_t form) {
    Mat4 out = kIdentity;
    bool regular = true;
    switch (way_to_invert(form)) {
        case Way::identity: break;
        case Way::diagonal: regular = invert_diagonal(m, out, m[10] == 1 && m[14] == 0 ? 2 : 3); break;
        case Way::angle_preserving: regular = invert_angle_preserving(m, form, out); break;
        case Way::affine: regular = invert_affine(m, out); break;
        case Way::full: regular = invert_full(m, out); break;
    }
    return regular ? out : kIdentity;
}

/// Around one axis: the plane's two other axes, in the order in which the angle turns.
Mat4 axis_rotation(int from, int to, float s, float c) {
    Mat4 m = kIdentity;
    at(m, from, from) = at(m, to, to) = c;
    at(m, to, from) = s;
    at(m, from, to) = -s;
    return m;
}

Mat4 general_rotation(float x, float y, float z, float s, float c) {
    const float xx = x * x, yy = y * y, zz = z * z, xy = x * y, yz = y * z, zx = z * x;
    const float xs = x * s, ys = y * s, zs = z * s, rest = 1.0f - c;
    return {rest * xx + c,
            rest * xy + zs,
            rest * zx - ys,
            0,  //
            rest * xy - zs,
            rest * yy + c,
            rest * yz + xs,
            0,  //
            rest * zx + ys,
            rest * yz - xs,
            rest * zz + c,
            0,  //
            0,
            0,
            0,
            1};
}

constexpr double kPi = 3.14159265358979323846;

}  // namespace

void load(FormedMatrix& matrix, const Mat4& values) {
    if (same_bits(matrix.m, values)) return;
    matrix.m = values;
    matrix.form = form::kGeneral | form::kUnknown;
    matrix.origin.known = false;
}

void load_identity(FormedMatrix& matrix) {
    matrix.m = kIdentity;
    matrix.form &= ~form::kUnknown;
    remember(matrix, glstate::StepKind::none);
}

void multiply(FormedMatrix& matrix, const Mat4& right) {
    if (same_bits(right, kIdentity)) return;  // with a -0 it is not the identity to Mesa
    matrix.form |= form::kGeneral | form::kUnknown;
    matrix.m = product_full(matrix.m, right);
    matrix.origin.known = false;
}

void rotate(FormedMatrix& matrix, float degrees, float x, float y, float z) {
    if (degrees == 0) return;
    const float s = sinf(static_cast<float>(degrees * kPi / 180.0)),
                c = cosf(static_cast<float>(degrees * kPi / 180.0));
    Mat4 m;
    if (x == 0 && y == 0 && z != 0) {
        m = axis_rotation(0, 1, z < 0 ? -s : s, c);
    } else if (x == 0 && y != 0 && z == 0) {
        m = axis_rotation(2, 0, y < 0 ? -s : s, c);
    } else if (x != 0 && y == 0 && z == 0) {
        m = axis_rotation(1, 2, x < 0 ? -s : s, c);
    } else {
        const float length = sqrtf(x * x + y * y + z * z);
        if (length <= 1.0e-4f) return;
        m = general_rotation(x / length, y / length, z / length, s, c);
    }
    multiply_formed(matrix, m, form::kRotation);
    remember(matrix, glstate::StepKind::rotate, degrees, x, y, z);
}

void translate(FormedMatrix& matrix, float x, float y, float z) {
    Mat4& m = matrix.m;
    for (std::size_t r = 0; r < 4; ++r) m[12 + r] = m[r] * x + m[4 + r] * y + m[8 + r] * z + m[12 + r];
    matrix.form |= form::kTranslation;
    remember(matrix, glstate::StepKind::translate, x, y, z);
}

void scale(FormedMatrix& matrix, float x, float y, float z) {
    for (std::size_t r = 0; r < 4; ++r) {
        matrix.m[r] *= x;
        matrix.m[4 + r] *= y;
        matrix.m[8 + r] *= z;
    }
    const bool uniform = std::fabs(x - y) < 1e-8f && std::fabs(x - z) < 1e-8f;
    matrix.form |= uniform ? form::kUniformScale : form::kGeneralScale;
    remember(matrix, glstate::StepKind::scale, x, y, z);
}

void frustum(FormedMatrix& matrix, float left, float right, float bottom, float top, float near, float far) {
    Mat4 m{};
    m[0] = (2.0f * near) / (right - left);
    m[5] = (2.0f * near) / (top - bottom);
    m[8] = (right + left) / (right - left);
    m[9] = (top + bottom) / (top - bottom);
    m[10] = -(far + near) / (far - near);
    m[11] = -1.0f;
    m[14] = -(2.0f * far * near) / (far - near);
    multiply_formed(matrix, m, form::kPerspective);
    remember(matrix, glstate::StepKind::none);
}

void ortho(FormedMatrix& matrix, float left, float right, float bottom, float top, float near, float far) {
    Mat4 m = kIdentity;
    m[0] = 2.0f / (right - left);
    m[5] = 2.0f / (top - bottom);
    m[10] = -2.0f / (far - near);
    m[12] = -(right + left) / (right - left);
    m[13] = -(top + bottom) / (top - bottom);
    m[14] = -(far + near) / (far - near);
    multiply_formed(matrix, m, form::kGeneralScale | form::kTranslation);
    remember(matrix, glstate::StepKind::none);
}

void determine_form(FormedMatrix& matrix) {
    if (!(matrix.form & form::kUnknown)) return;
    matrix.form = form_of(matrix.m);
    remember(matrix, glstate::StepKind::none);
}

Mat4 inverse(FormedMatrix& matrix) {
    determine_form(matrix);
    return inverse_by_form(matrix.m, matrix.form);
}

bool needs_origin(const FormedMatrix& matrix) {
    if (matrix.form & form::kUnknown) return false;
    const std::uint32_t found = form_of(matrix.m);
    if (found == matrix.form) return false;
    return inverse_by_form(matrix.m, found) != inverse_by_form(matrix.m, matrix.form);
}

bool describe_origin(const FormedMatrix& matrix, glstate::ModelviewOrigin& out) {
    const std::uint32_t missing = matrix.form & ~form_of(matrix.origin.base);
    constexpr std::uint32_t kAddable = form::kRotation | form::kTranslation | form::kUniformScale | form::kGeneralScale;
    if (!matrix.origin.known || (missing & ~kAddable)) return false;
    out = {matrix.origin.base, {}, {missing, glstate::modelview_tag(matrix.m)}};
    std::copy_n(matrix.origin.steps.begin(), matrix.origin.count, out.steps.begin());
    return true;
}

Mat4 transposed(const Mat4& matrix) {
    Mat4 out;
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) at(out, r, c) = at(matrix, c, r);
    return out;
}

Vec4 transform_point(const Mat4& m, const Vec4& p) {
    Vec4 out;
    for (std::size_t r = 0; r < 4; ++r) out[r] = m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r] * p[3];
    return out;
}

Vec3 transform_direction(const Mat4& m, const Vec4& d) {
    Vec3 out;
    for (std::size_t r = 0; r < 3; ++r) out[r] = d[0] * m[r] + d[1] * m[4 + r] + d[2] * m[8 + r];
    return out;
}

Vec4 transform_plane(const Vec4& v, const Mat4& m) {
    Vec4 out;
    for (std::size_t c = 0; c < 4; ++c)
        out[c] = v[0] * m[4 * c] + v[1] * m[4 * c + 1] + v[2] * m[4 * c + 2] + v[3] * m[4 * c + 3];
    return out;
}

}  // namespace wall::client
