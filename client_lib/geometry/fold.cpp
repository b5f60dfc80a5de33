// SPDX-License-Identifier: MIT
#include "client_lib/geometry/fold.h"

#include "client_lib/geometry/needs.h"

namespace wall::client {
namespace {

using glstate::Category;

/// Whether there were any.
bool fold_attributes(const Packer& packer, glstate::State& state) {
    bool any = false;
    for (std::size_t i = 0; i < kAttributes; ++i) {
        if (!packer.last[i]) continue;
        glstate::apply_attribute(state, packer.last_op[i], packer.last[i]);
        any = true;
    }
    return any;
}

}  // namespace

void fold_block(const Packer& packer, glstate::State& state) {
    if (fold_attributes(packer, state)) state.ids.renew(static_cast<std::size_t>(Category::current));
    for (const MaterialChange& material : packer.materials)
        assign_material(state, material.face, material.pname, material.value);
}

void fold_block(const Packer& packer, glstate::State& mirror, const glstate::State& folded) {
    fold_attributes(packer, mirror);
    unify_id(mirror, folded, Category::current);
    if (packer.materials.empty()) return;
    mirror.material = folded.material;
    unify_id(mirror, folded, Category::material);
}

}  // namespace wall::client
