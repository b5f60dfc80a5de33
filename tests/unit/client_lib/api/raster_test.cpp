// SPDX-License-Identifier: MIT
// The raster position against Mesa's, bit by bit but for the colour of lights (Mesa may compute those in object space).
#include <random>

#include "tests/unit/client_lib/context_fixture.h"
#include "tests/unit/mesa_context.h"

namespace wall::client {
namespace {

class RasterTest : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        mesa_ = test::MesaContext::open();
        if (!mesa_) GTEST_SKIP() << "no Mesa here";
        both([&](const auto& g) { g.Viewport(7, 3, 311, 207); });
    }
    float number(float from, float to) { return std::uniform_real_distribution<float>(from, to)(random_); }

    /// The same calls on both sides.
    struct Ours {
        Context& c;
        void Viewport(GLint x, GLint y, GLsizei w, GLsizei h) const {
            glstate::assign<glstate::el::viewport>(
                c.state, 0,
                {static_cast<float>(x), static_cast<float>(y), static_cast<float>(w), static_cast<float>(h)});
        }
        void MatrixMode(GLenum m) const { c.table->MatrixMode(c, m); }
        void LoadIdentity() const { c.table->LoadIdentity(c); }
        void Frustum(double l, double r, double b, double t, double n, double f) const {
            c.table->Frustum(c, l, r, b, t, n, f);
        }
        void Translatef(float x, float y, float z) const { c.table->Translatef(c, x, y, z); }
        void Rotatef(float a, float x, float y, float z) const { c.table->Rotatef(c, a, x, y, z); }
        void Scalef(float x, float y, float z) const { c.table->Scalef(c, x, y, z); }
        void RasterPos4f(float x, float y, float z, float w) const { c.table->RasterPos4f(c, x, y, z, w); }
        void WindowPos3f(float x, float y, float z) const { c.table->WindowPos3f(c, x, y, z); }
        void Color4f(float r, float g, float b, float a) const { c.table->Color4f(c, r, g, b, a); }
        void Normal3f(float x, float y, float z) const { c.table->Normal3f(c, x, y, z); }
        void TexCoord4f(float s, float t, float r, float q) const { c.table->TexCoord4f(c, s, t, r, q); }
        void Enable(GLenum cap) const { c.table->Enable(c, cap); }
        void Disable(GLenum cap) const { c.table->Disable(c, cap); }
        void ClipPlane(GLenum p, const GLdouble* v) const { c.table->ClipPlane(c, p, v); }
        void Lightfv(GLenum l, GLenum p, const GLfloat* v) const { c.table->Lightfv(c, l, p, v); }
        void Materialfv(GLenum f, GLenum p, const GLfloat* v) const { c.table->Materialfv(c, f, p, v); }
    };
    template <class Calls>
    void both(Calls&& calls) {
        calls(Ours{c});
        calls(mesa_->gl);
    }

    void random_view() {
        const float a = number(0, 360), x = number(-1, 1), y = number(-1, 1), z = number(-1, 1), s = number(0.5f, 2);
        const float dx = number(-1, 1), dy = number(-1, 1);
        both([&](const auto& g) {
            g.MatrixMode(GL_PROJECTION);
            g.LoadIdentity();
            g.Frustum(-1, 1.2, -0.9, 1, 1, 30);
            g.MatrixMode(GL_MODELVIEW);
            g.LoadIdentity();
            g.Translatef(dx, dy, -5);
            g.Rotatef(a, x, y, z);
            g.Scalef(s, 1, 1);
        });
    }
    void random_position() {
        const float x = number(-3, 3), y = number(-3, 3), z = number(-3, 3);
        both([&](const auto& g) { g.RasterPos4f(x, y, z, 1); });
    }
    std::array<float, 4> theirs(GLenum pname) {
        std::array<float, 4> v{};
        mesa_->gl.GetFloatv(pname, v.data());
        return v;
    }
    void expect_same_place() {
        ASSERT_EQ(theirs(GL_CURRENT_RASTER_POSITION_VALID)[0] != 0, c.state.raster.raster_position_valid != 0);
        if (!c.state.raster.raster_position_valid) return;
        EXPECT_EQ(theirs(GL_CURRENT_RASTER_POSITION), c.state.raster.raster_position);
        EXPECT_EQ(theirs(GL_CURRENT_RASTER_DISTANCE)[0], c.state.raster.raster_distance);
        EXPECT_EQ(theirs(GL_CURRENT_RASTER_TEXTURE_COORDS), c.state.raster.raster_texcoord[0]);
    }

    std::unique_ptr<test::MesaContext> mesa_;
    std::mt19937 random_{1};
};

TEST_F(RasterTest, PositionIsMesas) {
    for (int i = 0; i < 300; ++i) {
        random_view();
        const float s = number(-2, 2), r = number(0, 1);
        both([&](const auto& g) { g.TexCoord4f(s, 1, 2, 1), g.Color4f(r, 0.5f, 0, 1); });
        random_position();
        expect_same_place();
        if (c.state.raster.raster_position_valid) {
            EXPECT_EQ(theirs(GL_CURRENT_RASTER_COLOR), c.state.raster.raster_color);
        }
    }
}

TEST_F(RasterTest, ClipPlanesMakeItInvalid) {
    for (int i = 0; i < 300; ++i) {
        random_view();
        const GLdouble plane[4] = {number(-1, 1), number(-1, 1), number(-1, 1), number(-1, 1)};
        both([&](const auto& g) { g.ClipPlane(GL_CLIP_PLANE1, plane), g.Enable(GL_CLIP_PLANE1); });
        random_position();
        expect_same_place();
    }
}

TEST_F(RasterTest, WindowPosition) {
    both([&](const auto& g) { g.Color4f(2, -1, 0.5f, 1), g.WindowPos3f(-7.25f, 12.5f, 0.25f); });
    expect_same_place();
    EXPECT_EQ(theirs(GL_CURRENT_RASTER_COLOR), c.state.raster.raster_color);
}

TEST_F(RasterTest, LitColorIsMesas) {
    for (int i = 0; i < 300; ++i) {
        random_view();
        const bool positional = i % 2;
        const float position[4] = {number(-3, 3), number(-3, 3), number(1, 5), positional ? 1.0f : 0.0f};
        const float diffuse[4] = {number(0, 1), number(0, 1), number(0, 1), 0.7f}, specular[4] = {0.5f, 0.6f, 0.7f, 1},
                    shininess = 12;
        const float x = number(-1, 1), y = number(-1, 1), red = number(0, 1), green = number(0, 1);
        const bool tracked = i % 3 == 0;  // materials follow the colour
        both([&](const auto& g) {
            g.Enable(GL_LIGHTING), g.Enable(GL_LIGHT0);
            g.Lightfv(GL_LIGHT0, GL_POSITION, position);
            g.Materialfv(GL_FRONT, GL_DIFFUSE, diffuse), g.Materialfv(GL_FRONT, GL_SPECULAR, specular),
                g.Materialfv(GL_FRONT, GL_SHININESS, &shininess);
            g.Normal3f(x, y, 0.8f);
            if (tracked) g.Enable(GL_COLOR_MATERIAL), g.Color4f(red, green, 0.3f, 0.6f);
            else g.Disable(GL_COLOR_MATERIAL);
        });
        random_position();
        expect_same_place();
        if (!c.state.raster.raster_position_valid) continue;
        const auto color = theirs(GL_CURRENT_RASTER_COLOR);
        for (unsigned k = 0; k < 4; ++k) EXPECT_NEAR(color[k], c.state.raster.raster_color[k], 1e-5f) << i;
    }
}

}  // namespace
}  // namespace wall::client
