// SPDX-License-Identifier: MIT
// The modelview matrix as a driver should hold it. Mesa remembers how a matrix was made and chooses by it how to invert
// it for normals; a matrix that is merely loaded may be inverted another way, with another last bit, and a pixel in ten
// thousand differs. So where it matters the state also tells the matrix' origin: an earlier matrix that can be loaded,
// what Mesa knew of it beyond its values, and the steps from there. An origin belongs to one matrix, named by its tag;
// with any other it is ignored. Pure.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "gen/glstate/state.gen.h"

namespace wall::glstate {

/// ModelviewStep::kind; then the parameters of the command.
enum class StepKind : std::uint32_t { none, rotate, translate, scale };

/// The elements of category modelview_origin together.
struct ModelviewOrigin {
    Mat4 base;
    std::array<ModelviewStep, el::modelview_step::count> steps;
    ModelviewForm form;
};

inline constexpr std::uint32_t kNoTag = 0;  ///< of a form that was never told: it belongs to no matrix

/// MurmurHash3 of the values, a lane for each column, so that their multiplications overlap: it is taken at each switch
/// between contexts with such an origin. Never kNoTag.
inline std::uint32_t modelview_tag(const Mat4& m) {
    std::array<std::uint32_t, 16> words;
    std::memcpy(words.data(), m.data(), sizeof m);
    const auto mixed = [](std::uint32_t hash, std::uint32_t word) {
        hash ^= std::rotl(word * 0xcc9e2d51u, 15) * 0x1b873593u;
        return std::rotl(hash, 13) * 5 + 0xe6546b64u;
    };
    std::array<std::uint32_t, 4> lanes = {1, 2, 3, 4};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 4; ++column)
            lanes[column] = mixed(lanes[column], words[column * 4 + row]);
    const std::uint32_t tag = mixed(mixed(mixed(lanes[0], lanes[1]), lanes[2]), lanes[3]);
    return tag != kNoTag ? tag : 1;
}

/// Does `form` belong to the matrix?
inline bool is_origin_of(const ModelviewForm& form, const Mat4& m) {
    return form.tag != kNoTag && form.tag == modelview_tag(m);
}

namespace detail {

/// Bits of ModelviewForm::missing; as in Mesa's m_matrix.c.
inline constexpr std::uint32_t kRotation = 2, kTranslation = 4, kUniformScale = 8, kGeneralScale = 16;

/// Commands that change no value, only what is known.
template <class Gl>
void add_form(Gl& gl, std::uint32_t missing) {
    if (missing & kRotation) gl.Rotatef(1.4e-45f, 0, 0, 1);  // the smallest angle that is not zero; its sine is
    if (missing & kTranslation) gl.Translatef(0, 0, 0);
    if (missing & kUniformScale) gl.Scalef(1, 1, 1);
    if (missing & kGeneralScale) gl.Scalef(2, 1, 1), gl.Scalef(0.5f, 1, 1);
}

template <class Gl>
void take_step(Gl& gl, const ModelviewStep& step) {
    switch (static_cast<StepKind>(step.kind)) {
        case StepKind::none: return;
        case StepKind::rotate: return gl.Rotatef(step.a, step.b, step.c, step.d);
        case StepKind::translate: return gl.Translatef(step.a, step.b, step.c);
        case StepKind::scale: return gl.Scalef(step.a, step.b, step.c);
    }
}

}  // namespace detail

/// Loads the state's modelview matrix. `had_origin`: what this function returned the last time.
template <class Gl>
bool load_modelview(Gl& gl, const State& state, bool had_origin) {
    const Mat4& m = el::modelview::ref(state);
    const ModelviewForm& form = el::modelview_form::ref(state);
    const bool has_origin = is_origin_of(form, m);
    gl.MatrixMode(GL_MODELVIEW);
    if (has_origin || had_origin) gl.LoadMatrixf(Mat4{}.data());  // loading equal values would forget nothing
    gl.LoadMatrixf(has_origin ? el::modelview_base::ref(state).data() : m.data());
    if (!has_origin) return false;
    gl.PushMatrix();  // Mesa looks at the values now
    gl.PopMatrix();
    detail::add_form(gl, form.missing);
    for (unsigned i = 0; i < el::modelview_step::count; ++i) detail::take_step(gl, el::modelview_step::ref(state, i));
    return true;
}

}  // namespace wall::glstate
