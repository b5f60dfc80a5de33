// SPDX-License-Identifier: MIT
#include "tests/golden/moved/views.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "common/base/camera_names.h"
#include "common/glstate/view_change.h"
#include "tests/golden/moved/place.h"

namespace golden::moved {
namespace {

using wall::glstate::Mat4;

std::optional<wall::geom::EyeView> read_view() {
    const char* text = std::getenv("GOLDEN_VIEW");  // NOLINT: before the program's first thread draws
    if (text == nullptr) return std::nullopt;
    std::istringstream words(text);
    wall::geom::EyeViewValues values{};
    for (float& value : values) words >> value;
    const auto view = wall::geom::eye_view_of_values(values);
    if (!words || std::holds_alternative<const char*>(view)) stop("GOLDEN_VIEW is no view");
    return std::get<wall::geom::EyeView>(view);
}

const std::optional<wall::geom::EyeView>& view() {
    static const auto read = read_view();
    return read;
}

/// Of the one context that such a program has.
struct Projections {
    std::vector<Mat4> stack{Mat4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
};
Projections& own() {
    static Projections all;
    return all;
}

bool changes_projection() { return integer(GL_MATRIX_MODE) == GL_PROJECTION; }

void load_seen() {
    const Mat4& wanted = own().stack.back();
    const auto change = wall::glstate::view_change(*view(), wanted);
    const Mat4 seen = change ? wall::glstate::product(*change, wanted) : wanted;
    static const decltype(&glLoadMatrixf) load = find("glLoadMatrixf");
    load(seen.data());
}

/// A function that changes the current matrix.
template <class Call>
void change(Call&& call) {
    if (!changes_projection()) return call();
    static const decltype(&glLoadMatrixf) load = find("glLoadMatrixf");
    load(own().stack.back().data());
    call();
    mesa().GetFloatv(GL_PROJECTION_MATRIX, own().stack.back().data());
    load_seen();
}

/// In the place of one with these parameters; `Tag` tells those with the same apart.
template <class Tag, class... Parameters>
struct Changes {
    static inline void (*of_mesa)(Parameters...) = nullptr;
    static void call(Parameters... parameters) {
        change([&] { of_mesa(parameters...); });
    }
};

template <class Tag, class... Parameters>
void* changing(void (*)(Parameters...), const char* name) {
    using Replaced = Changes<Tag, Parameters...>;
    Replaced::of_mesa = find(name);
    return reinterpret_cast<void*>(&Replaced::call);
}

void PushMatrix() {
    static const decltype(&glPushMatrix) push = find("glPushMatrix");
    push();
    if (changes_projection()) own().stack.push_back(Mat4(own().stack.back()));
}
void PopMatrix() {
    static const decltype(&glPopMatrix) pop = find("glPopMatrix");
    pop();
    if (changes_projection() && own().stack.size() > 1) own().stack.pop_back();
}

/// The uniforms that are cameras (WALLGL_CAMERA on a wall); "A,B" is two.
const std::vector<std::string>& cameras() {
    static const auto names = [] {
        const char* text = std::getenv("GOLDEN_CAMERA");  // NOLINT: before the program's first thread draws
        auto read = text != nullptr ? wall::camera_names_of_text(text) : std::vector<std::string>();
        if (!read) stop("GOLDEN_CAMERA has something that is no name");
        return *std::move(read);
    }();
    return names;
}

void UniformMatrix4fv(GLint location, GLsizei count, GLboolean transpose, const GLfloat* values) {
    static const decltype(&glUniformMatrix4fv) set = find("glUniformMatrix4fv");
    if (transpose != GL_FALSE) stop("glUniformMatrix4fv of transposed matrices");
    std::vector<Mat4> matrices(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < matrices.size(); ++i) std::copy_n(values + 16 * i, 16, matrices[i].begin());
    const auto program = static_cast<GLuint>(integer(GL_CURRENT_PROGRAM));
    for (const std::string& name : cameras()) {
        const GLint at = mesa().GetUniformLocation(program, name.c_str());
        if (at < location || at >= location + count) continue;
        Mat4& camera = matrices[static_cast<std::size_t>(at - location)];
        if (const auto change = wall::glstate::view_change(*view(), camera))
            camera = wall::glstate::product(*change, camera);
    }
    set(location, count, GL_FALSE, matrices.front().data());
}

#define GOLDEN_CHANGES(function) \
    if (name == #function) return changing<struct function##Tag>(&function, #function)

}  // namespace

void* view_replacement(std::string_view name) {
    if (!view()) return nullptr;
    GOLDEN_CHANGES(glLoadIdentity);
    GOLDEN_CHANGES(glLoadMatrixf);
    GOLDEN_CHANGES(glLoadMatrixd);
    GOLDEN_CHANGES(glMultMatrixf);
    GOLDEN_CHANGES(glMultMatrixd);
    GOLDEN_CHANGES(glLoadTransposeMatrixf);
    GOLDEN_CHANGES(glMultTransposeMatrixf);
    GOLDEN_CHANGES(glFrustum);
    GOLDEN_CHANGES(glOrtho);
    GOLDEN_CHANGES(glRotatef);
    GOLDEN_CHANGES(glRotated);
    GOLDEN_CHANGES(glTranslatef);
    GOLDEN_CHANGES(glTranslated);
    GOLDEN_CHANGES(glScalef);
    GOLDEN_CHANGES(glScaled);
    if (name == "glPushMatrix") return reinterpret_cast<void*>(&PushMatrix);
    if (name == "glPopMatrix") return reinterpret_cast<void*>(&PopMatrix);
    if (name == "glUniformMatrix4fv" && !cameras().empty()) return reinterpret_cast<void*>(&UniformMatrix4fv);
    return nullptr;
}

bool own_projection(GLenum name, float* values) {
    if (!view() || name != GL_PROJECTION_MATRIX) return false;
    std::ranges::copy(own().stack.back(), values);
    return true;
}

}  // namespace golden::moved
