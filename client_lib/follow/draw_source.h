// SPDX-License-Identifier: MIT
// What is read of a context while one of its commands is sent. Whoever follows contexts (this folder) knows them by
// this alone, and nothing of OpenGL's entry points.
#pragma once

#include <functional>
#include <memory>

#include "client_lib/follow/draw_target.h"
#include "client_lib/objects/object.h"
#include "client_lib/objects/share_group.h"
#include "common/base/ids.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

/// The objects that a context draws with, whoever keeps them.
class UsedObjects {
public:
    /// Calls `use` with each of them, in an order in which a node can get them; one that is used in two ways comes
    /// twice. The session's mutex is held, the share group's is taken.
    virtual void for_each_used(const std::function<void(const Object&)>& use) = 0;

    /// Whether the draw may write memory that its shaders address: then every node must do all of it, once.
    virtual bool writes() { return false; }
    /// Calls `use` with each object that it may write so. The share group's mutex is held.
    virtual void for_each_written(const std::function<void(const Object&)>& /*use*/) {}
    /// What these hold is on the nodes only from now on. The share group's mutex is held.
    virtual void note_written() {}

protected:
    ~UsedObjects() = default;
};

/// Made for one command, while which its context stays as it is but for what is said here.
struct DrawSource {
    ContextId id;
    glstate::State& state;  ///< default textures may come into being in it; behind a block it has its attributes
    DrawTarget draw, read;
    UseStamp used;  ///< of `objects`
    UsedObjects& objects;
    const std::shared_ptr<ShareGroup>& share;
};

}  // namespace wall::client
