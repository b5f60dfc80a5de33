// SPDX-License-Identifier: MIT
// GL_CR_synchronization: the order between the processes of a parallel program (docs/parallel-programs.md). The calls
// are commands of the stream: none waits.
#include "client_lib/context/context.h"

namespace wall::client::api {
namespace {

namespace pack = glapi::pack;

/// A driver in selection or feedback mode serves no other stream: who waits then would wait for ever.
bool may_hold(Context& c) {
    if (c.state.local.render_mode != GL_RENDER) c.error(GL_INVALID_OPERATION);
    return c.state.local.render_mode == GL_RENDER;
}

/// ClientSession::synchronize() behind what has been drawn.
template <class Note, class Pack>
void say(Context& c, bool at_once, Note&& note, Pack&& pack) {
    c.flush_block();
    const GLenum error = c.session().synchronize(c.id, at_once, std::forward<Note>(note), std::forward<Pack>(pack));
    if (error != GL_NO_ERROR) c.error(error);
}

}  // namespace

void BarrierCreateCR(Context& c, GLuint name, GLuint count) {
    say(
        c, false, [=](SyncObjects& own) { return own.barrier_create(name, count); },
        [=](wire::PackBuffer& to) { pack::BarrierCreate(to, name, count); });
}

void BarrierDestroyCR(Context& c, GLuint name) {
    say(
        c, false, [=](SyncObjects& own) { return own.barrier_destroy(name); },
        [=](wire::PackBuffer& to) { pack::BarrierDestroy(to, name); });
}

void BarrierExecCR(Context& c, GLuint name) {
    if (!may_hold(c)) return;
    say(
        c, true, [=](SyncObjects& own) { return own.barrier_exec(name); },
        [=](wire::PackBuffer& to) { pack::BarrierExec(to, name); });
}

void SemaphoreCreateCR(Context& c, GLuint name, GLuint count) {
    say(
        c, false, [=](SyncObjects& own) { return own.semaphore_create(name, count); },
        [=](wire::PackBuffer& to) { pack::SemaphoreCreate(to, name, count, 0); });
}

void SemaphoreDestroyCR(Context& c, GLuint name) {
    say(
        c, false, [=](SyncObjects& own) { return own.semaphore_destroy(name); },
        [=](wire::PackBuffer& to) { pack::SemaphoreDestroy(to, name); });
}

void SemaphorePCR(Context& c, GLuint name) {
    if (!may_hold(c)) return;
    c.flush_block();
    if (const GLenum error = c.session().take_semaphore(c.id, name); error != GL_NO_ERROR) c.error(error);
}

// Sent at once: somebody may wait for it.
void SemaphoreVCR(Context& c, GLuint name) {
    say(
        c, true, [=](SyncObjects& own) { return own.semaphore_v(name); },
        [=](wire::PackBuffer& to) { pack::SemaphoreV(to, name); });
}

}  // namespace wall::client::api
