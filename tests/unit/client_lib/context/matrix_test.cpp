// SPDX-License-Identifier: MIT
// The client's matrix arithmetic against plain Mesa's, bit for bit, over random sequences of commands.
#include "client_lib/context/matrix.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/mesa_context.h"

namespace wall::client {
namespace {

class Sequence {
public:
    Sequence(glapi::GlFunctions& gl, unsigned seed) : gl_(gl), random_(seed) {}

    /// One random command to both sides. `affine`: none that gives a perspective.
    void step(bool affine) {
        switch (pick(affine ? 6 : 9)) {
            case 0: rotate_axis(); break;
            case 1: rotate_any(); break;
            case 2: do_translate(); break;
            case 3: do_scale(); break;
            case 4:
                gl_.LoadIdentity();
                load_identity(ours);
                break;
            case 5: do_ortho(); break;
            case 6: do_frustum(); break;
            case 7: do_multiply(); break;
            default: do_load(); break;
        }
    }
    /// A movement, sometimes with a scale: what programs do to objects.
    void step_rigid() {
        switch (pick(8)) {
            case 0: do_scale(); break;
            case 1:
            case 2: do_translate(); break;
            case 3: rotate_any(); break;
            default: rotate_axis(); break;
        }
    }
    FormedMatrix ours;

private:
    unsigned pick(unsigned n) { return std::uniform_int_distribution<unsigned>(0, n - 1)(random_); }
    float value(float span) { return std::uniform_real_distribution<float>(-span, span)(random_); }
    void rotate_axis() {
        float v[3]{};
        v[pick(3)] = value(2);
        const float angle = value(400);
        gl_.Rotatef(angle, v[0], v[1], v[2]);
        rotate(ours, angle, v[0], v[1], v[2]);
    }
    void rotate_any() {
        const float angle = value(400), x = value(1), y = value(1), z = pick(3) ? value(1) : 0;
        gl_.Rotatef(angle, x, y, z);
        rotate(ours, angle, x, y, z);
    }
    void do_translate() {
        const float x = value(20), y = value(20), z = value(20);
        gl_.Translatef(x, y, z);
        translate(ours, x, y, z);
    }
    void do_scale() {
        const float x = value(3), y = pick(2) ? value(3) : x, z = y == x ? x : value(3);
        gl_.Scalef(x, y, z);
        scale(ours, x, y, z);
    }
    void do_ortho() {
        const float l = value(9), b = value(9), n = value(9);
        gl_.Ortho(l, l + 3.7f, b, b + 2.1f, n, n + 11.3f);
        ortho(ours, l, l + 3.7f, b, b + 2.1f, n, n + 11.3f);
    }
    void do_frustum() {
        const float l = value(9), b = value(9);
        gl_.Frustum(l, l + 3.7f, b, b + 2.1f, 0.7f, 31.1f);
        frustum(ours, l, l + 3.7f, b, b + 2.1f, 0.7f, 31.1f);
    }
    Mat4 any() {
        Mat4 m;
        for (float& f : m) f = value(2);
        return m;
    }
    void do_multiply() {
        const Mat4 m = any();
        gl_.MultMatrixf(m.data());
        multiply(ours, m);
    }
    void do_load() {
        const Mat4 m = any();
        gl_.LoadMatrixf(m.data());
        load(ours, m);
    }
    glapi::GlFunctions& gl_;
    std::mt19937 random_;
};

// A zero's sign may differ: Mesa's choice of product depends on when it last drew. No pixel depends on it.
void expect_same(const Mat4& ours, const Mat4& mesas, unsigned seed, int step) {
    for (std::size_t i = 0; i < 16; ++i)
        ASSERT_EQ(ours[i], mesas[i]) << "seed " << seed << " step " << step << " element " << i;
}

TEST(Matrix, EqualsMesa) {
    const auto mesa = test::MesaContext::open();
    if (!mesa) GTEST_SKIP() << "no EGL surfaceless Mesa on this machine";
    mesa->gl.MatrixMode(GL_MODELVIEW);
    for (unsigned seed = 0; seed < 600; ++seed) {
        Sequence sequence(mesa->gl, seed);
        mesa->gl.LoadIdentity();
        for (int step = 0; step < 12; ++step) {
            sequence.step(seed % 2 == 0);
            Mat4 theirs;
            mesa->gl.GetFloatv(GL_MODELVIEW_MATRIX, theirs.data());
            expect_same(sequence.ours.m, theirs, seed, step);
            if (HasFatalFailure()) return;
        }
    }
}

// A clip plane is stored in eye coordinates: plane * inverse(modelview).
TEST(Matrix, InverseEqualsMesa) {
    const auto mesa = test::MesaContext::open();
    if (!mesa) GTEST_SKIP() << "no EGL surfaceless Mesa on this machine";
    std::uint32_t form_left = form::kIdentity;  // glLoadIdentity forgets no form bits
    for (unsigned seed = 0; seed < 600; ++seed) {
        mesa->gl.LoadIdentity();
        Sequence sequence(mesa->gl, seed);
        sequence.ours.form = form_left;
        for (int step = 0; step < 6; ++step) {
            sequence.step(seed % 3 != 0);
            const GLdouble plane[4] = {0.3, -0.7, 0.2, 1.5};
            mesa->gl.ClipPlane(GL_CLIP_PLANE0, plane);
            GLdouble theirs[4];
            mesa->gl.GetClipPlane(GL_CLIP_PLANE0, theirs);
            const Vec4 ours = transform_plane({0.3f, -0.7f, 0.2f, 1.5f}, inverse(sequence.ours));
            for (std::size_t i = 0; i < 4; ++i)
                ASSERT_EQ(ours[i], static_cast<float>(theirs[i])) << "seed " << seed << " step " << step;
        }
        form_left = sequence.ours.form;
    }
}

constexpr GLdouble kPlane[4] = {0.3, -0.7, 0.2, 1.5};

/// What the driver's inverse does to a plane.
std::array<GLdouble, 4> eye_plane_of(glapi::GlFunctions& gl) {
    std::array<GLdouble, 4> plane;
    gl.ClipPlane(GL_CLIP_PLANE0, kPlane);
    gl.GetClipPlane(GL_CLIP_PLANE0, plane.data());
    return plane;
}

// Long chains of rotations drift so far that Mesa no longer takes the values for a rotation's.
TEST(Matrix, AnOriginGivesTheDriverTheSameInverse) {
    const auto mesa = test::MesaContext::open();
    if (!mesa) GTEST_SKIP() << "no EGL surfaceless Mesa on this machine";
    int needed = 0, described = 0, differ_without = 0;
    bool had_origin = false;
    for (unsigned seed = 0; seed < 2000; ++seed) {
        mesa->gl.LoadMatrixf(Mat4{}.data());
        mesa->gl.LoadMatrixf(kIdentity.data());
        eye_plane_of(mesa->gl);  // its form is known: nothing
        Sequence sequence(mesa->gl, seed);
        for (int step = 0; step < 10; ++step) sequence.step_rigid();
        const auto wanted = eye_plane_of(mesa->gl);

        glstate::State state;
        state.matrix.modelview = sequence.ours.m;
        glstate::ModelviewOrigin origin;
        const bool needs = needs_origin(sequence.ours), known = describe_origin(sequence.ours, origin);
        had_origin = glstate::load_modelview(mesa->gl, state, true);
        if (eye_plane_of(mesa->gl) != wanted) ++differ_without;
        if (!needs) {
            ASSERT_EQ(eye_plane_of(mesa->gl), wanted) << "seed " << seed;
            continue;
        }
        ++needed;
        if (!known) continue;
        ++described;
        state.modelview_origin = {origin.base, origin.steps, origin.form};
        had_origin = glstate::load_modelview(mesa->gl, state, had_origin);
        ASSERT_TRUE(had_origin);
        Mat4 loaded;
        mesa->gl.GetFloatv(GL_MODELVIEW_MATRIX, loaded.data());
        expect_same(sequence.ours.m, loaded, seed, 10);
        ASSERT_EQ(eye_plane_of(mesa->gl), wanted) << "seed " << seed << " form " << sequence.ours.form;
    }
    RecordProperty("needed", needed);
    RecordProperty("described", described);
    EXPECT_GT(differ_without, 0);
    EXPECT_GT(described, needed * 9 / 10) << needed << " needed an origin";
}

TEST(Matrix, SingularInvertsToIdentity) {
    FormedMatrix zero;
    load(zero, Mat4{});
    EXPECT_EQ(inverse(zero), kIdentity);
}

}  // namespace
}  // namespace wall::client
