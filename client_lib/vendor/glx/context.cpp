// SPDX-License-Identifier: MIT
#include "client_lib/vendor/glx/context.h"

#include <mutex>
#include <unordered_map>
#include <utility>

#include "client_lib/process/process.h"

namespace wall::client::glx {
namespace {

struct Contexts {
    std::mutex mutex;
    std::unordered_map<const void*, std::shared_ptr<GlxContext>> all;
};

Contexts& contexts() {
    static Contexts& only = *new Contexts;  // lives for ever: no static destructors
    return only;
}

constinit thread_local GlxContext* current = nullptr;  // kept by Contexts::all while GlxContext::current is set

/// The thread's context is not current any more; what the program has destroyed meanwhile goes.
void let_go() {
    if (!current) return;
    auto& drawables = Drawables::get();
    drawables.no_longer_current(current->draw);
    drawables.no_longer_current(current->read);
    current->draw = current->read = nullptr;
    auto* context = std::exchange(current, nullptr);
    std::lock_guard lock(contexts().mutex);
    context->current = false;
    if (context->destroyed) contexts().all.erase(context);
}

void thread_ends() {
    client::make_current(nullptr, nullptr, nullptr);
    let_go();
}

}  // namespace

std::shared_ptr<GlxContext> find_context(GLXContext handle) {
    std::lock_guard lock(contexts().mutex);
    const auto found = contexts().all.find(handle);
    return found != contexts().all.end() && !found->second->destroyed ? found->second : nullptr;
}

std::shared_ptr<GlxContext> find_usable_context(GLXContext handle) {
    std::lock_guard lock(contexts().mutex);
    const auto found = contexts().all.find(handle);
    return found != contexts().all.end() && (!found->second->destroyed || found->second.get() == current)
               ? found->second
               : nullptr;
}

std::shared_ptr<GlxContext> create_context(const Config& config, const ContextOptions& options) {
    auto core = client::create_context(options);
    if (!core) return nullptr;
    auto context = std::make_shared<GlxContext>();
    context->core = std::move(core);
    context->config = &config;
    std::lock_guard lock(contexts().mutex);
    contexts().all[context.get()] = context;
    return context;
}

void destroy_context(const std::shared_ptr<GlxContext>& context) {
    std::lock_guard lock(contexts().mutex);
    if (context->current) context->destroyed = true;
    else contexts().all.erase(context.get());
}

GlxContext* thread_context() { return current; }

MakeCurrentResult make_context_current(std::shared_ptr<GlxContext> context, std::shared_ptr<Drawable> draw,
                                       std::shared_ptr<Drawable> read) {
    if (!context) {
        client::make_current(nullptr, nullptr, nullptr);
        let_go();
        return MakeCurrentResult::done;
    }
    {
        std::lock_guard lock(contexts().mutex);
        if (context->current && context.get() != current) return MakeCurrentResult::context_in_use;
        context->current = true;
    }
    const bool again = context.get() == current;
    const auto give_up = [&] {
        if (!again) {
            std::lock_guard lock(contexts().mutex);
            context->current = false;
        }
        let_go();
    };
    try {
        if (!client::make_current(context->core, draw ? draw->surface : nullptr, read ? read->surface : nullptr)) {
            give_up();
            return MakeCurrentResult::no_wall;
        }
    } catch (...) {
        if (!again) give_up();
        throw;
    }
    auto& drawables = Drawables::get();
    drawables.now_current(draw);
    drawables.now_current(read);
    if (again) {
        drawables.no_longer_current(current->draw);
        drawables.no_longer_current(current->read);
    } else {
        let_go();
    }
    context->draw = std::move(draw);
    context->read = std::move(read);
    current = context.get();
    at_thread_end(thread_ends);
    return MakeCurrentResult::done;
}

}  // namespace wall::client::glx
