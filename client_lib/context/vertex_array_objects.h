// SPDX-License-Identifier: MIT
// Vertex array objects (GL_ARB_vertex_array_object): which arrays are set, under a name. No context shares them, and no
// node knows of them: a draw names what it reads (vertex_inputs.h). What the bound one holds is in the context's state,
// category `vertex_arrays`; binding another one exchanges it. The context's thread.
#pragma once

#include <memory>
#include <optional>
#include <unordered_map>

#include "client_lib/context/vertex_bindings.h"
#include "client_lib/objects/share_group.h"
#include "common/glapi/gl_types.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

class VertexArrayObjects {
public:
    /// Reserves `count` names in a row; the first, or 0 when they run out.
    GLuint reserve(GLuint count) { return names_.reserve(count); }
    /// Whether the name may be bound: 0, or one that was reserved and is not deleted.
    bool may_be_bound(GLuint name) const { return name == 0 || names_.known(name); }
    /// Whether it was bound ever (glIsVertexArray).
    bool exists(GLuint name) const { return name != 0 && names_.find(name) != nullptr; }
    /// Exchanges the state's arrays for those of `name`, which may be bound.
    void bind(glstate::State& state, GLuint name);
    /// If it is bound, 0 is bound instead. False: there is none of that name.
    bool erase(glstate::State& state, GLuint name);

    /// How the attributes of the bound one are bound to buffers; null: each array is in the one that it was set with.
    std::unique_ptr<VertexBindings> bindings;

    std::size_t size() const { return kept_; }  ///< that are not bound
    /// Calls look(arrays, bindings) with those of each object that is not bound; bindings may be null.
    template <class Look>
    void for_each_kept(Look&& look) const {
        if (unnamed_) look(unnamed_->arrays, unnamed_->bindings.get());
        if (kept_ == 0) return;
        names_.for_each([&](const Kept& kept) {
            if (kept.arrays) look(kept.arrays->arrays, kept.arrays->bindings.get());
        });
    }

private:
    /// With the value id that they have had in the state: what was found out about them by it holds on.
    struct Arrays {
        glstate::VertexArraysState arrays;
        std::uint64_t values = 0;
        std::unique_ptr<VertexBindings> bindings;
    };
    struct Kept {
        std::unique_ptr<Arrays> arrays;  ///< null while it is bound
    };
    Arrays take(const glstate::State& state);
    void load(glstate::State& state, Arrays arrays);

    NameTable<Kept> names_;
    std::optional<Arrays> unnamed_;  ///< of name 0, while it is not bound
    std::size_t kept_ = 0;
};

}  // namespace wall::client
