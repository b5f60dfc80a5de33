// SPDX-License-Identifier: MIT
// State commands, right and wrong ones, called at random through the library's entry points and in plain Mesa: after
// each the error is the same, and now and then every glGet answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/objects/share_group.h"
#include "common/glstate/elements.h"
#include "common/glstate/queries.h"
#include "tests/unit/mesa_context.h"

namespace wall::client {
namespace {

using Words = std::vector<GLenum>;

class Caller {
public:
    Caller(glapi::GlFunctions& mesa, Context& ours) : mesa_(mesa), ours_(ours) {}

    /// Calls one function in both with the same random arguments; enums come from `words`.
    template <class R, class... A>
    void call(R (GLAPIENTRY* glapi::GlFunctions::*member)(A...), const char* name, const Words& words) {
        words_ = &words;
        arrays_.assign(sizeof...(A), std::vector<double>(16));
        text_ = name;
        const auto args = [this]<std::size_t... I>(std::index_sequence<I...>) {
            return std::tuple<A...>{this->template make<A>(I)...};
        }
        (std::index_sequence_for<A...>{});
        const auto* proc =
            std::lower_bound(kProcs.data(), kProcs.data() + kProcs.size(), name,
                             [](const ProcEntry& p, const char* wanted) { return std::strcmp(p.name, wanted) < 0; });
        ASSERT_STREQ(proc->name, name);
        std::apply(reinterpret_cast<R(GLAPIENTRY*)(A...)>(proc->entry), args);
        std::apply(mesa_.*member, args);
        const GLenum mine = ours_.take_error(), theirs = mesa_.GetError();
        EXPECT_EQ(mine, theirs) << text_;
    }

    std::mt19937 random{5};

private:
    template <class T>
    T make(std::size_t n) {
        if constexpr (std::is_pointer_v<T>) {
            using Value = std::remove_const_t<std::remove_pointer_t<T>>;
            auto* to = reinterpret_cast<Value*>(arrays_[n].data());
            text_ += " {";
            for (int k = 0; k < 4; ++k) to[k] = make<Value>(n);
            text_ += " }";
            return to;
        } else {
            const T value = scalar<T>();
            text_ += " " + (std::is_same_v<T, GLenum> ? hex(static_cast<std::uint32_t>(value)) : std::to_string(value));
            return value;
        }
    }
    template <class T>
    T scalar() {
        static constexpr double kNumbers[] = {0,   1,   2,   4,   -1,  0.5, 0.25, 3,    8,   90,
                                              100, 128, 129, 180, 181, 255, 300,  -0.5, 1000};
        if constexpr (std::is_same_v<T, GLboolean>) return static_cast<GLboolean>(random() % 2);
        if constexpr (std::is_same_v<T, GLenum>)
            if (random() % 16) return word();
        if constexpr (std::is_same_v<T, GLint> || std::is_same_v<T, GLfloat> || std::is_same_v<T, GLdouble>)
            if (random() % 2) return static_cast<T>(word());
        const double number = kNumbers[random() % std::size(kNumbers)];
        if constexpr (std::is_unsigned_v<T>) return static_cast<T>(std::abs(number));
        return static_cast<T>(number);
    }
    GLenum word() { return (*words_)[random() % words_->size()]; }
    static std::string hex(std::uint32_t v) {
        char text[16];
        std::snprintf(text, sizeof text, "0x%x", v);
        return text;
    }

    glapi::GlFunctions& mesa_;
    Context& ours_;
    const Words* words_ = nullptr;
    std::vector<std::vector<double>> arrays_;
    std::string text_;
};

/// The parameters of a family, what they may be set to, and words that are none.
Words words_of(glstate::ParamFamily family, Words more) {
    for (const auto& e : glstate::kParamEntries) {
        if (e.family != family) continue;
        more.push_back(e.pname);
        if (e.target) more.push_back(e.target);
    }
    more.push_back(GL_TEXTURE_2D);
    return more;
}

Words range(GLenum first, GLenum last, Words more = {}) {
    for (GLenum word = first; word <= last; ++word) more.push_back(word);
    return more;
}

template <class Get>
void expect_same_parameter(Context& c, const glstate::ParamEntry& e, unsigned index, Get&& get, unsigned round) {
    GLfloat theirs[4] = {}, mine[4] = {};
    get(e.pname, theirs);
    glstate::read_components(c.state, e.id + index, 0, e.kind, e.components, mine);
    for (unsigned k = 0; k < e.components; ++k)
        EXPECT_EQ(mine[k], theirs[k]) << "round " << round << ": " << glstate::element_info(e.id).name << " " << index;
}

void expect_same_parameters(glapi::GlFunctions& mesa, Context& c, unsigned round) {
    const unsigned unit = c.active_texture();
    for (const auto& e : glstate::kParamEntries) {
        using enum glstate::ParamFamily;
        if (e.family == Light)
            for (unsigned i = 0; i < 8; ++i)
                expect_same_parameter(
                    c, e, i, [&](GLenum p, GLfloat* v) { mesa.GetLightfv(GL_LIGHT0 + i, p, v); }, round);
        if (e.family == TexEnv)
            expect_same_parameter(
                c, e, unit, [&](GLenum p, GLfloat* v) { mesa.GetTexEnvfv(e.target, p, v); }, round);
        if (e.family == TexGen)
            for (unsigned i = 0; i < 4; ++i)
                expect_same_parameter(
                    c, e, unit * 4 + i, [&](GLenum p, GLfloat* v) { mesa.GetTexGenfv(GL_S + i, p, v); }, round);
    }
}

void expect_same_answers(glapi::GlFunctions& mesa, Context& c, unsigned round) {
    for (const auto& e : glstate::kGetEntries) {
        if (e.pname == GL_DRAW_BUFFER || e.pname == GL_DRAW_BUFFER0 || e.pname == GL_READ_BUFFER ||
            e.pname == GL_STENCIL_REF || e.pname == GL_STENCIL_BACK_REF || e.pname == GL_INDEX_CLEAR_VALUE ||
            e.pname == GL_ALPHA_TEST_REF)
            continue;  // tests/unit/mesa_state_test.cpp says why; the last is clamped by the framebuffer's kind
        if (e.pname == GL_FOG_COLOR) continue;  // Mesa ignores a colour that equals the old one after clamping
        GLdouble theirs[64] = {}, mine[64] = {};
        mesa.GetDoublev(e.pname, theirs);
        const unsigned unit = e.rule == glstate::IndexRule::unit ? c.active_texture() * e.unit_stride : 0;
        glstate::read_components(c.state, e.id + unit, e.offset, e.kind, e.components, mine);
        for (unsigned k = 0; k < e.components; ++k)
            EXPECT_EQ(mine[k], theirs[k]) << "round " << round << ": " << glstate::element_info(e.id).name << " " << k;
    }
}

TEST(ClientState, RandomCommandsAreTakenAsInMesa) {
    const auto mesa = test::MesaContext::open();
    if (!mesa) GTEST_SKIP() << "no Mesa with a surfaceless compatibility context";
    Context c(std::make_shared<ShareGroup>());
    tls_context = &c;
    Caller caller(mesa->gl, c);
    using Gl = glapi::GlFunctions;
    using enum glstate::ParamFamily;

    Words caps = {GL_FRONT, GL_RENDER};
    for (const auto& e : glstate::kCapEntries)
        if (e.cap != GL_COLOR_MATERIAL && e.cap != GL_PRIMITIVE_RESTART) caps.push_back(e.cap);
    const Words faces = {GL_FRONT, GL_BACK, GL_FRONT_AND_BACK, GL_LEFT};
    const Words compare = range(GL_NEVER, GL_ALWAYS, {GL_FRONT});
    Words compare_faces = compare,
          stencil = {GL_ZERO, GL_KEEP, GL_REPLACE, GL_INCR, GL_DECR, GL_INVERT, GL_INCR_WRAP, GL_DECR_WRAP, GL_ONE};
    Words stencil_faces = stencil, fill = range(GL_POINT, GL_FILL);
    for (GLenum f : faces) compare_faces.push_back(f), stencil_faces.push_back(f), fill.push_back(f);
    const Words lights = words_of(Light, range(GL_LIGHT0, GL_LIGHT0 + 8));
    const Words light_model = words_of(LightModel, {GL_SINGLE_COLOR, GL_SEPARATE_SPECULAR_COLOR});
    const Words fog = words_of(Fog, {GL_EXP, GL_EXP2, GL_LINEAR, GL_FOG_COORDINATE, GL_FRAGMENT_DEPTH});
    const Words env = words_of(TexEnv, {GL_MODULATE,
                                        GL_BLEND,
                                        GL_DECAL,
                                        GL_REPLACE,
                                        GL_ADD,
                                        GL_COMBINE,
                                        GL_ADD_SIGNED,
                                        GL_INTERPOLATE,
                                        GL_SUBTRACT,
                                        GL_DOT3_RGB,
                                        GL_DOT3_RGBA,
                                        GL_TEXTURE,
                                        GL_CONSTANT,
                                        GL_PRIMARY_COLOR,
                                        GL_PREVIOUS,
                                        GL_TEXTURE0,
                                        GL_TEXTURE7,
                                        GL_SRC_COLOR,
                                        GL_ONE_MINUS_SRC_COLOR,
                                        GL_SRC_ALPHA,
                                        GL_ONE_MINUS_SRC_ALPHA});
    const Words gen = words_of(
        TexGen, range(GL_S, GL_Q, {GL_OBJECT_LINEAR, GL_EYE_LINEAR, GL_SPHERE_MAP, GL_NORMAL_MAP, GL_REFLECTION_MAP}));
    const Words point = words_of(PointParameter, {GL_LOWER_LEFT, GL_UPPER_LEFT});
    const Words transfer = words_of(PixelTransfer, {}), pixels = words_of(PixelStore, {}),
                hint = words_of(Hint, {GL_FASTEST, GL_NICEST, GL_DONT_CARE});
    const Words blend = range(GL_SRC_COLOR, GL_SRC_ALPHA_SATURATE,
                              range(GL_CONSTANT_COLOR, GL_ONE_MINUS_CONSTANT_ALPHA, {GL_ZERO, GL_ONE, GL_SRC1_COLOR}));
    const Words equation = {GL_FUNC_ADD, GL_FUNC_SUBTRACT, GL_FUNC_REVERSE_SUBTRACT, GL_MIN, GL_MAX, GL_ONE};
    const Words units = range(GL_TEXTURE0, GL_TEXTURE0 + 7), matrix = {GL_MODELVIEW, GL_PROJECTION};

    for (unsigned round = 0; round < 4000; ++round) {
#define WALL_CALL(NAME, WORDS) caller.call(&Gl::NAME, "gl" #NAME, WORDS)
        WALL_CALL(Enable, caps);
        WALL_CALL(Disable, caps);
        WALL_CALL(Lightf, lights), WALL_CALL(Lightfv, lights), WALL_CALL(Lighti, lights), WALL_CALL(Lightiv, lights);
        WALL_CALL(LightModelf, light_model), WALL_CALL(LightModelfv, light_model), WALL_CALL(LightModeli, light_model),
            WALL_CALL(LightModeliv, light_model);
        WALL_CALL(Fogf, fog), WALL_CALL(Fogfv, fog), WALL_CALL(Fogi, fog), WALL_CALL(Fogiv, fog);
        WALL_CALL(TexEnvf, env), WALL_CALL(TexEnvfv, env), WALL_CALL(TexEnvi, env), WALL_CALL(TexEnviv, env);
        WALL_CALL(TexGenf, gen), WALL_CALL(TexGenfv, gen), WALL_CALL(TexGeni, gen), WALL_CALL(TexGeniv, gen),
            WALL_CALL(TexGend, gen), WALL_CALL(TexGendv, gen);
        WALL_CALL(PointParameterf, point), WALL_CALL(PointParameterfv, point), WALL_CALL(PointParameteri, point),
            WALL_CALL(PointParameteriv, point);
        WALL_CALL(PixelTransferf, transfer), WALL_CALL(PixelTransferi, transfer), WALL_CALL(PixelStoref, pixels),
            WALL_CALL(PixelStorei, pixels);
        WALL_CALL(Hint, hint);
        WALL_CALL(AlphaFunc, compare), WALL_CALL(DepthFunc, compare), WALL_CALL(DepthMask, caps),
            WALL_CALL(DepthRange, caps), WALL_CALL(DepthRangef, caps);
        WALL_CALL(BlendFunc, blend), WALL_CALL(BlendFuncSeparate, blend), WALL_CALL(BlendEquation, equation),
            WALL_CALL(BlendEquationSeparate, equation);
        WALL_CALL(BlendColor, caps), WALL_CALL(ClearColor, caps), WALL_CALL(ClearDepth, caps),
            WALL_CALL(ClearStencil, caps), WALL_CALL(ClearAccum, caps);
        WALL_CALL(ColorMask, caps), WALL_CALL(ColorMaski, caps), WALL_CALL(Enablei, (Words{GL_BLEND, GL_FOG})),
            WALL_CALL(Disablei, (Words{GL_BLEND, GL_FOG})),
            WALL_CALL(ClampColor, (Words{GL_CLAMP_READ_COLOR, GL_TRUE, GL_FALSE, GL_FIXED_ONLY, GL_FOG}));
        WALL_CALL(IndexMask, caps), WALL_CALL(LogicOp, range(GL_CLEAR, GL_SET, {GL_ZERO}));
        WALL_CALL(CullFace, faces), WALL_CALL(FrontFace, (Words{GL_CW, GL_CCW, GL_FRONT})),
            WALL_CALL(PolygonMode, fill), WALL_CALL(PolygonOffset, caps);
        WALL_CALL(ShadeModel, (Words{GL_FLAT, GL_SMOOTH, GL_FILL})),
            WALL_CALL(ProvokingVertex, (Words{GL_FIRST_VERTEX_CONVENTION, GL_LAST_VERTEX_CONVENTION, GL_FILL}));
        WALL_CALL(LineWidth, caps), WALL_CALL(LineStipple, caps), WALL_CALL(PointSize, caps),
            WALL_CALL(PixelZoom, caps), WALL_CALL(SampleCoverage, caps);
        WALL_CALL(StencilFunc, compare), WALL_CALL(StencilFuncSeparate, compare_faces), WALL_CALL(StencilOp, stencil),
            WALL_CALL(StencilOpSeparate, stencil_faces);
        WALL_CALL(StencilMask, caps), WALL_CALL(StencilMaskSeparate, faces), WALL_CALL(Scissor, faces);
        WALL_CALL(MapGrid1f, faces), WALL_CALL(MapGrid1d, faces), WALL_CALL(MapGrid2f, faces),
            WALL_CALL(MapGrid2d, faces);
        WALL_CALL(ActiveTexture, units), WALL_CALL(MatrixMode, matrix);
#undef WALL_CALL
        if (round % 16 != 0) continue;
        expect_same_answers(mesa->gl, c, round);
        expect_same_parameters(mesa->gl, c, round);
    }
    tls_context = nullptr;
}

}  // namespace
}  // namespace wall::client
