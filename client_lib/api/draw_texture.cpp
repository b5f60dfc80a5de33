// SPDX-License-Identifier: MIT
// GL_OES_draw_texture: a rectangle of the window with the parts of textures that GL_TEXTURE_CROP_RECT_OES names. It is
// drawn as two triangles with the state that the extension leaves alone, and what it does not heed put aside.
#include <algorithm>
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/context/matrix.h"
#include "client_lib/context/program_use.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/follow/draw_target.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

/// Elements of the state that have another value for a while.
class Borrowed {
public:
    explicit Borrowed(Context& c)
        : c_(c), form_(std::exchange(c.modelview_stack.form, form::kIdentity)), origin_(c.modelview_stack.origin) {}
    ~Borrowed() {
        for (auto undo = undo_.rbegin(); undo != undo_.rend(); ++undo) (*undo)();
        c_.modelview_stack.form = form_;
        c_.modelview_stack.origin = origin_;
    }
    Borrowed(const Borrowed&) = delete;
    template <class E>
    void set(unsigned i, const typename E::type& value) {
        undo_.push_back([this, i, before = c_.get<E>(i)] { c_.set<E>(i, before); });
        c_.set<E>(i, value);
    }

private:
    Context& c_;
    std::uint32_t form_;  ///< of the modelview matrix, which is another one meanwhile
    MatrixOrigin origin_;
    std::vector<std::function<void()>> undo_;
};

struct Rectangle {
    float left, bottom, right, top;
};

/// Where a unit's texture is read, in its own coordinates; one that has no content is read nowhere.
Rectangle crop_of(Context& c, unsigned unit) {
    const auto texture = bound_texture_of(c, unit, glapi::TextureTarget::t2d);
    std::lock_guard lock(c.share().mutex);
    const TextureLevel* base = texture ? texture->find_level(0, texture->parameters.base_level) : nullptr;
    if (!base || base->width <= 0 || base->height <= 0) return {};
    const auto& crop = texture->parameters.crop_rectangle;
    const auto width = static_cast<float>(base->width), height = static_cast<float>(base->height);
    return {static_cast<float>(crop[0]) / width, static_cast<float>(crop[1]) / height,
            static_cast<float>(crop[0] + crop[2]) / width, static_cast<float>(crop[1] + crop[3]) / height};
}

/// What it does not heed: lights, clip planes, fog, generated coordinates, matrices and the viewport.
void put_aside(Context& c, Borrowed& borrowed) {
    const Extent size = c.draw_target().size();
    const auto width = static_cast<float>(size.width), height = static_cast<float>(size.height);
    borrowed.set<el::viewport>(0, {0, 0, width, height});
    borrowed.set<el::lighting_enabled>(0, 0);
    borrowed.set<el::fog_enabled>(0, 0);
    borrowed.set<el::cull_face_enabled>(0, 0);
    borrowed.set<el::polygon_offset_fill>(0, 0);
    for (unsigned i = 0; i < el::clip_plane_enabled::count; ++i) borrowed.set<el::clip_plane_enabled>(i, 0);
    for (unsigned i = 0; i < el::tex_gen_enabled::count; ++i) borrowed.set<el::tex_gen_enabled>(i, 0);
    for (unsigned i = 0; i < el::texture_matrix::count; ++i) borrowed.set<el::texture_matrix>(i, glstate::kIdentity);
    borrowed.set<el::modelview>(0, glstate::kIdentity);
    FormedMatrix window{glstate::kIdentity};
    ortho(window, 0, width, 0, height, 0, -1);  // depths as they are given
    borrowed.set<el::projection>(0, window.m);
}

}  // namespace

void DrawTexfOES(Context& c, GLfloat x, GLfloat y, GLfloat z, GLfloat width, GLfloat height) {
    if (!(width > 0 && height > 0)) return c.error(GL_INVALID_VALUE);
    if (!may_draw(c) || !c.draw_target()) return;
    c.flush_block();  // the current attributes are in `state` after it
    const float depth = std::clamp(z, 0.0f, 1.0f);
    std::vector<std::pair<GLenum, Rectangle>> units;
    for (unsigned unit = 0; unit < kTextureUnits; ++unit)
        if (c.get<el::texture_2d_enabled>(unit)) units.emplace_back(GL_TEXTURE0 + unit, crop_of(c, unit));
    const auto coordinates = c.state.current.texcoord;
    {
        Borrowed borrowed(c);
        put_aside(c, borrowed);
        const auto corner = [&](bool right, bool top) {
            for (const auto& [unit, part] : units)
                MultiTexCoord4f(c, unit, right ? part.right : part.left, top ? part.top : part.bottom, 0, 1);
            Vertex3f(c, right ? x + width : x, top ? y + height : y, depth);
        };
        c.begin_primitive(GL_TRIANGLE_FAN);
        corner(false, false), corner(true, false), corner(true, true), corner(false, true);
        c.end_primitive();
        c.flush_block();
    }
    for (const auto& [unit, part] : units) {
        const auto& v = coordinates[unit - GL_TEXTURE0];
        MultiTexCoord4f(c, unit, v[0], v[1], v[2], v[3]);
    }
}

}  // namespace wall::client::api
