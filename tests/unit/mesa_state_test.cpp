// SPDX-License-Identifier: MIT
// The state's defaults, glGet answers and conversions against what plain Mesa says.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "common/glapi/convert.h"
#include "common/glstate/diff.h"
#include "common/glstate/elements.h"
#include "common/glstate/queries.h"
#include "gen/glstate/driver_emit.gen.h"
#include "gen/glstate/samples.gen.h"
#include "tests/unit/mesa_context.h"

namespace wall {
namespace {

using glstate::GetEntry;

class MesaState : public testing::Test {
protected:
    void SetUp() override {
        mesa_ = test::MesaContext::open();
        if (!mesa_) GTEST_SKIP() << "no Mesa with a surfaceless compatibility context";
    }
    glapi::GlFunctions& gl() { return mesa_->gl; }

    std::unique_ptr<test::MesaContext> mesa_;
};

/// Words that Mesa's surfaceless context must answer in another way.
bool differs_for_a_reason(GLenum pname) {
    switch (pname) {
        case GL_DRAW_BUFFER0:
        case GL_DRAW_BUFFER:  // no default framebuffer here
        case GL_READ_BUFFER:
        case GL_STENCIL_REF:  // no stencil bits here: clamped to 0
        case GL_STENCIL_BACK_REF:
        case GL_INDEX_CLEAR_VALUE: return true;  // Mesa keeps an integer
        default: return false;
    }
}

template <class T, class Get>
std::vector<T> ask(Get get, GLenum pname, unsigned count) {
    std::vector<T> values(64, T{});
    get(pname, values.data());
    values.resize(count);
    return values;
}

template <class T>
std::vector<T> ours(const glstate::State& state, const GetEntry& e) {
    std::vector<T> values(e.components);
    glstate::read_components(state, e.id, e.offset, e.kind, e.components, values.data());
    return values;
}

template <class Wanted>
void expect_same_answers(glapi::GlFunctions& gl, const glstate::State& state, const char* when, Wanted&& wanted) {
    for (const GetEntry& e : glstate::kGetEntries) {
        if (differs_for_a_reason(e.pname) || !wanted(e.id)) continue;
        SCOPED_TRACE(std::string(when) + ": " + glstate::element_info(e.id).name + " " + std::to_string(e.pname));
        EXPECT_EQ(ask<GLfloat>(gl.GetFloatv, e.pname, e.components), ours<GLfloat>(state, e));
        EXPECT_EQ(ask<GLint>(gl.GetIntegerv, e.pname, e.components), ours<GLint>(state, e));
        EXPECT_EQ(ask<GLdouble>(gl.GetDoublev, e.pname, e.components), ours<GLdouble>(state, e));
        EXPECT_EQ(ask<GLboolean>(gl.GetBooleanv, e.pname, e.components), ours<GLboolean>(state, e));
        EXPECT_EQ(gl.GetError(), static_cast<GLenum>(GL_NO_ERROR));
    }
}

/// Parameters that glGet* does not answer.
template <class Wanted>
void expect_same_parameters(glapi::GlFunctions& gl, const glstate::State& state, const char* when, Wanted&& wanted) {
    const auto compare = [&](const glstate::ParamEntry& e, unsigned index, auto&& get) {
        if (!wanted(e.id + index)) return;
        GLfloat mesa[4] = {}, mine[4] = {};
        get(e.pname, mesa);
        glstate::read_components(state, e.id + index, 0, e.kind, e.components, mine);
        for (unsigned k = 0; k < e.components; ++k)
            EXPECT_EQ(mesa[k], mine[k]) << when << ": " << glstate::element_info(e.id).name << " " << index;
    };
    for (const auto& e : glstate::kParamEntries) {
        using enum glstate::ParamFamily;
        if (e.family == Light)
            for (unsigned i = 0; i < 8; ++i)
                compare(e, i, [&](GLenum p, GLfloat* v) { gl.GetLightfv(GL_LIGHT0 + i, p, v); });
        if (e.family == Material)
            for (unsigned i = 0; i < 2; ++i)
                compare(e, i, [&](GLenum p, GLfloat* v) { gl.GetMaterialfv(i ? GL_BACK : GL_FRONT, p, v); });
        if (e.family == TexEnv)
            for (unsigned i = 0; i < 8; ++i) {
                gl.ActiveTexture(GL_TEXTURE0 + i);
                compare(e, i, [&](GLenum p, GLfloat* v) { gl.GetTexEnvfv(e.target, p, v); });
            }
        if (e.family == TexGen)
            for (unsigned i = 0; i < 32; ++i) {
                gl.ActiveTexture(GL_TEXTURE0 + i / 4);
                compare(e, i, [&](GLenum p, GLfloat* v) { gl.GetTexGenfv(GL_S + i % 4, p, v); });
            }
    }
    gl.ActiveTexture(GL_TEXTURE0);
    EXPECT_EQ(gl.GetError(), static_cast<GLenum>(GL_NO_ERROR)) << when;
}

bool always(std::uint32_t) { return true; }

/// The driver sink without what tileserver does by hand.
struct DriverSink : glstate::DriverEmit<glapi::GlFunctions> {
    glapi::GlFunctions& gl;
    std::vector<bool> custom = std::vector<bool>(glstate::kLastId + 1, false);

    explicit DriverSink(glapi::GlFunctions& functions) : gl(functions) { mark(glstate::CustomElements{}); }
    template <class... E>
    void mark(glstate::ElementList<E...>) {
        ((std::fill_n(custom.begin() + E::id, E::count, true)), ...);
    }
    using DriverEmit::emit;
    template <class E>
    requires requires { E::id; }
    void emit(glapi::GlFunctions&, E, unsigned, const typename E::type&) {}
    template <class E>
    void set(unsigned i, const typename E::type& v) {
        emit(gl, E{}, i, v);
        const GLenum error = gl.GetError();
        EXPECT_EQ(error, static_cast<GLenum>(GL_NO_ERROR)) << E::name << " " << i;
    }
};

/// Everything at its n-th sample, indices apart from one another.
void set_samples(glstate::State& state, std::size_t n) {
    glstate::for_each_element([&]<class E>() {
        for (unsigned i = 0; i < E::count; ++i) glstate::assign<E>(state, i, glstate::Samples<E>::values[(n + i) % 3]);
    });
    state.current.secondary_color[3] = 1;
    for (unsigned i = 0; i < 32; ++i)  // not every coordinate has every mode
        if (i % 4 > 1) state.texture_gen.tex_gen_mode[i] = n == 0 ? GL_OBJECT_LINEAR : GL_EYE_LINEAR;
}

TEST_F(MesaState, DefaultsAreThoseOfAFreshContext) {
    expect_same_answers(gl(), glstate::State(), "fresh", always);
    expect_same_parameters(gl(), glstate::State(), "fresh", always);
}

TEST_F(MesaState, DriverHoldsWhatItIsTold) {
    glstate::State driver, wanted;
    DriverSink sink(gl());
    const auto told = [&](std::uint32_t id) {
        return id <= glstate::kLastSentId && !sink.custom[id] &&
               glstate::element_info(id).category != glstate::Category::material;
    };
    for (std::size_t n : {0, 1, 2, 0}) {
        set_samples(wanted, n);
        wanted.material.color_material_enabled = n == 1;
        glstate::diff(driver, wanted, sink);
        sink.unit(gl(), 0);
        const std::string when = "sample " + std::to_string(n);
        expect_same_answers(gl(), wanted, when.c_str(), told);
        expect_same_parameters(gl(), wanted, when.c_str(), told);
    }
    sink.active_unit = 0;
    glstate::diff(driver, glstate::State(), sink);
    sink.unit(gl(), 0);
    expect_same_answers(gl(), glstate::State(), "back", told);
    expect_same_parameters(gl(), glstate::State(), "back", told);
}

TEST_F(MesaState, MaterialsFollowTheColorAsInMesa) {
    glstate::State driver, wanted;
    DriverSink sink(gl());
    const auto step = [&](const char* when) {
        glstate::diff(driver, wanted, sink);
        expect_same_parameters(gl(), wanted, when, [&](std::uint32_t id) {
            const auto& info = glstate::element_info(id);
            if (info.category != glstate::Category::material) return false;
            const unsigned face = id - info.id;
            using namespace glstate;
            return !(follows_color<el::material_ambient>(wanted, face) && info.id == el::material_ambient::id) &&
                   !(follows_color<el::material_diffuse>(wanted, face) && info.id == el::material_diffuse::id) &&
                   !(follows_color<el::material_specular>(wanted, face) && info.id == el::material_specular::id) &&
                   !(follows_color<el::material_emission>(wanted, face) && info.id == el::material_emission::id);
        });
    };
    namespace el = glstate::el;
    step("fresh");
    glstate::assign<el::color>(wanted, 0, {0.5f, 0.25f, 0.125f, 1});
    glstate::assign<el::color_material_enabled>(wanted, 0, 1);
    step("on");
    glstate::assign<el::color>(wanted, 0, {0.75f, 0.25f, 0.125f, 1});
    step("colour");
    glstate::assign<el::color_material>(wanted, 0, {GL_FRONT, GL_SPECULAR});
    step("moved");
    glstate::assign<el::material_diffuse>(wanted, 0, {0, 0, 1, 1});
    glstate::assign<el::color>(wanted, 0, {0, 0.25f, 0.125f, 1});
    step("another");
    glstate::assign<el::color_material_enabled>(wanted, 0, 0);
    step("off");
    glstate::assign<el::color>(wanted, 0, {1, 1, 1, 1});
    step("after");
}

TEST_F(MesaState, IsEnabledKnowsEveryWord) {
    for (const auto& e : glstate::kCapEntries) {
        const GLboolean mesa = gl().IsEnabled(e.cap);
        GLboolean mine = 2;
        glstate::read_components(glstate::State(), e.id, 0, glstate::ValueKind::flag, 1, &mine);
        EXPECT_EQ(mesa, mine) << glstate::element_info(e.id).name;
        EXPECT_EQ(gl().GetError(), static_cast<GLenum>(GL_NO_ERROR)) << glstate::element_info(e.id).name;
    }
}

template <class T>
void expect_color(glapi::GlFunctions& gl, void(GLAPIENTRY* set)(const T*), T value) {
    const T values[4] = {value, value, value, value};
    set(values);
    GLfloat color[4];
    gl.GetFloatv(GL_CURRENT_COLOR, color);
    EXPECT_EQ(color[0], glapi::to_fraction(value)) << +value;
}

TEST_F(MesaState, IntegersBecomeTheSameFractions) {
    for (int v = -128; v < 128; ++v) expect_color<GLbyte>(gl(), gl().Color4bv, static_cast<GLbyte>(v));
    for (int v = 0; v < 256; ++v) expect_color<GLubyte>(gl(), gl().Color4ubv, static_cast<GLubyte>(v));
    for (int v = -32768; v < 32768; v += 7) expect_color<GLshort>(gl(), gl().Color4sv, static_cast<GLshort>(v));
    for (int v = 0; v < 65536; v += 7) expect_color<GLushort>(gl(), gl().Color4usv, static_cast<GLushort>(v));
    for (std::int64_t v = -2147483648ll; v <= 2147483647ll; v += 123456789)
        expect_color<GLint>(gl(), gl().Color4iv, static_cast<GLint>(v));
    for (std::int64_t v = 0; v <= 4294967295ll; v += 123456789)
        expect_color<GLuint>(gl(), gl().Color4uiv, static_cast<GLuint>(v));
}

TEST_F(MesaState, ParameterIntegersBecomeTheSameFractions) {
    for (std::int64_t v = -2147483648ll; v <= 2147483647ll; v += 123456789) {
        const auto i = static_cast<GLint>(v);
        const GLint values[4] = {i, i, i, i};
        GLfloat light[4], fog[4], material[4];
        gl().Lightiv(GL_LIGHT0, GL_AMBIENT, values);
        gl().GetLightfv(GL_LIGHT0, GL_AMBIENT, light);
        EXPECT_EQ(light[0], glapi::to_fraction(i)) << i;
        gl().Materialiv(GL_FRONT, GL_AMBIENT, values);
        gl().GetMaterialfv(GL_FRONT, GL_AMBIENT, material);
        EXPECT_EQ(material[0], glapi::to_fraction(i)) << i;
        gl().Fogiv(GL_FOG_COLOR, values);
        gl().GetFloatv(GL_FOG_COLOR, fog);
        EXPECT_EQ(fog[0], glapi::to_fraction(i)) << i;
    }
}

}  // namespace
}  // namespace wall
