// SPDX-License-Identifier: MIT
#include "client_lib/context/core.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/context.h"
#include "client_lib/context/es_version.h"
#include "client_lib/context/forget_objects.h"
#include "client_lib/context/let_go.h"
#include "client_lib/context/program_use.h"
#include "client_lib/context/version.h"
#include "client_lib/context/vertex_inputs.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/process/guard.h"
#include "client_lib/process/log.h"
#include "client_lib/process/process.h"

namespace wall::client {
namespace {

/// A thread without a context packs into this: closed, so that every entry point looks for a context and finds none.
Packer* closed_packer() {
    static Packer* packer = [] {
        auto* made = new Packer();  // never destroyed: threads may outlive static destructors
        made->set_closed(true);
        return made;
    }();
    return packer;
}

/// Keeps the thread's context and surfaces alive while they are current. Not destroyed at exit(): programs still draw
/// in their own exit handlers.
struct Current {
    std::shared_ptr<Context> context;
    std::shared_ptr<ClientSurface> draw, read;
};
constinit thread_local Current* current = nullptr;

/// A thread has the context; whatever is thrown, nobody has it any more when this goes without keep().
class Claim {
public:
    explicit Claim(Context& context) : context_(&context) {}
    ~Claim() {
        if (context_) context_->in_use = false;
    }
    Claim(const Claim&) = delete;
    void keep() { context_ = nullptr; }

private:
    Context* context_;
};

void release() {
    const std::unique_ptr<Current> last(std::exchange(current, nullptr));
    go_dark();
    if (!last) return;
    const Claim over(*last->context);
    last->context->flush_block();
    last->context->session().flush(DrawTarget(), false);
}

}  // namespace

void go_dark() {
    tls_context = nullptr;
    tls_packer = closed_packer();
}

std::shared_ptr<ClientSurface> create_surface(SurfaceOptions options) {
    auto id = options.visible ? next_window_id() : next_surface_id();
    if (!id) {
        complain_once("wallgl: a parallel program has too many windows; more are not shown on the wall", "windows");
        options.visible = false;
        id = next_surface_id();
    }
    return std::shared_ptr<ClientSurface>(new ClientSurface(id, std::move(options)), [](ClientSurface* surface) {
        try {
            if (surface->opened)
                if (auto session = ClientSession::get_if_open()) session->close_surface(*surface);
        } catch (...) {
            caught_exception("the end of a surface");
        }
        delete surface;
    });
}

namespace {

/// Lets go of what the context holds beside itself, on the nodes and in its share group.
void end_context(Context* context) {
    try {
        forget_inputs(*context, context->inputs->take_all());
        let_go_of_all_buffers(*context);
        if (context->attached()) {
            if (context->program) use_program(*context, nullptr);
            let_go_of_own_objects(*context);
            context->session().destroy_context(context->id);
        }
    } catch (...) {
        caught_exception("the end of a context");
    }
    delete context;
}

}  // namespace

bool offers_es(int major) { return es_version_for(major, 0) != 0; }

// A forward-compatible context is of the core profile, as in Mesa.
std::shared_ptr<Context> create_context(const ContextOptions& options) {
    const bool core = options.core_profile || options.forward_compatible;
    const unsigned es = options.es ? es_version_for(options.major, options.minor) : 0;
    if (options.es && es == 0) return nullptr;
    if (!options.es && (!is_implemented(options.major, options.minor) || (core && !is_implemented(3, 1))))
        return nullptr;
    auto share = options.share ? options.share->share_pointer() : std::make_shared<ShareGroup>();
    const ContextProfile profile{core,           options.forward_compatible, options.debug,
                                 options.robust, options.notifies_of_resets, es};
    return std::shared_ptr<Context>(new Context(std::move(share), profile), end_context);
}

bool make_current(std::shared_ptr<Context> context, std::shared_ptr<ClientSurface> draw,
                  std::shared_ptr<ClientSurface> read) {
    if (!context) {
        release();
        return true;
    }
    const bool again = current && context == current->context;
    if (!again && context->in_use.exchange(true)) return false;
    Claim claim(*context);
    if (again) {
        claim.keep();  // it has been made already
        context->flush_block();
    } else {
        release();
    }
    const auto session = ClientSession::get();
    if (!session) {
        release();
        return false;
    }
    context->attach(session);
    if (draw) session->open_surface(*draw);
    if (read && read != draw) session->open_surface(*read);
    if (draw) session->begin_frame(*draw);
    context->bind_surfaces(draw, read);
    if (!current) {
        current = new Current;
        at_thread_end(release);
    }
    claim.keep();
    *current = {std::move(context), std::move(draw), std::move(read)};
    if (current->context->lost()) {
        go_dark();
        return true;
    }
    tls_context = current->context.get();
    // Without glBegin no vertex is packed by itself: all entry points go through the table.
    tls_packer = current->context->profile.has_begin() ? &current->context->packer : closed_packer();
    return true;
}

Context* current_context() { return tls_context; }

void swap_buffers(ClientSurface& surface) {
    const auto session = ClientSession::get_if_open();
    if (!session || !surface.opened) return;
    if (tls_context) tls_context->flush_block();
    session->swap(tls_context ? tls_context->id : ContextId(), surface);
    session->begin_frame(surface);
}

Extent surface_size(const ClientSurface& surface) {
    if (surface.opened) return {surface.layout.width, surface.layout.height};
    return surface.options.size;
}

void flush_current(bool wait) {
    if (!tls_context) return;
    tls_context->flush(wait);
}

ProcAddress gl_proc_address(const char* name) {
    const auto before = [](const ProcEntry& entry, const char* wanted) { return std::strcmp(entry.name, wanted) < 0; };
    const auto found = std::lower_bound(kProcs.begin(), kProcs.end(), name, before);
    return found != kProcs.end() && std::strcmp(found->name, name) == 0 ? found->entry : nullptr;
}

}  // namespace wall::client
