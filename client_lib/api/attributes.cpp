// SPDX-License-Identifier: MIT
// glPushAttrib and glPopAttrib.
#include "client_lib/context/attribute_stack.h"
#include "client_lib/context/context.h"
#include "client_lib/context/texture_binding.h"
#include "common/glstate/diff.h"

namespace wall::client::api {

void PushAttrib(Context& c, GLbitfield mask) {
    auto& stack = c.attributes->server;
    if (stack.size() >= kAttributeStackLimit) return c.error(GL_STACK_OVERFLOW);
    if (mask & (GL_CURRENT_BIT | GL_LIGHTING_BIT)) c.flush_block();  // current attributes are in `state` after it
    glstate::adopt_current_color(c.state);
    stack.push_back(std::make_unique<SavedAttributes>(SavedAttributes{mask, c.state, {}}));
    if (mask & GL_TEXTURE_BIT) stack.back()->textures = bound_texture_parameters(c);
}

void PopAttrib(Context& c) {
    auto& stack = c.attributes->server;
    if (stack.empty()) return c.error(GL_STACK_UNDERFLOW);
    const auto saved = std::move(stack.back());
    stack.pop_back();
    if (saved->mask & (GL_CURRENT_BIT | GL_LIGHTING_BIT)) c.flush_block();
    glstate::for_each_in_group(saved->mask, [&]<class E>(unsigned i) {
        if (c.state.ids[static_cast<std::size_t>(E::category)] ==
            saved->state.ids[static_cast<std::size_t>(E::category)])
            return;
        c.set<E>(i, E::ref(std::as_const(saved->state), i));
    });
    unify_value_ids(c.state, saved->state);
    restore_texture_parameters(c, saved->textures);
}

}  // namespace wall::client::api
