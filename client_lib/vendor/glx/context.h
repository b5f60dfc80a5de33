// SPDX-License-Identifier: MIT
// GLXContexts. A handle is the address of a GlxContext; destroying one that is current is deferred until it is
// released.
#pragma once

#include <GL/glx.h>

#include <memory>

#include "client_lib/context/core.h"
#include "client_lib/vendor/glx/config.h"
#include "client_lib/vendor/glx/drawable.h"

namespace wall::client::glx {

struct GlxContext {
    std::shared_ptr<Context> core;
    const Config* config = nullptr;
    bool current = false;    ///< in some thread
    bool destroyed = false;  ///< by the program, while current
    std::shared_ptr<Drawable> draw, read;

    GLXContext handle() const { return reinterpret_cast<GLXContext>(const_cast<GlxContext*>(this)); }
};

/// Null if the handle is none of ours.
std::shared_ptr<GlxContext> find_context(GLXContext handle);
/// The same, or this thread's current one although it was destroyed: it lasts until another is made current.
std::shared_ptr<GlxContext> find_usable_context(GLXContext handle);
/// Null if the core does not offer what is asked for.
std::shared_ptr<GlxContext> create_context(const Config& config, const ContextOptions& options);
void destroy_context(const std::shared_ptr<GlxContext>& context);

/// The calling thread's; null if there is none. It lives at least as long as it is current.
GlxContext* thread_context();

enum class MakeCurrentResult { done, context_in_use, no_wall };
/// Null context: releases.
MakeCurrentResult make_context_current(std::shared_ptr<GlxContext> context, std::shared_ptr<Drawable> draw,
                                       std::shared_ptr<Drawable> read);

}  // namespace wall::client::glx
