// SPDX-License-Identifier: MIT
// Compute shaders (OpenGL 4.3, chapter 19): every node runs all of a dispatch.
#include <array>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/captured_content.h"
#include "client_lib/context/context.h"
#include "client_lib/context/indexed_buffers.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/list_state.h"
#include "client_lib/context/memory_use.h"
#include "client_lib/context/program_use.h"
#include "client_lib/objects/program.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/process/log.h"
#include "common/wire/limits.h"

namespace wall::client::api {
namespace {

using Groups = std::array<GLuint, 3>;

/// Draws go there while it lives.
class DispatchPass {
public:
    explicit DispatchPass(MemoryUse& use) : use_(use) {
        if (!use_.target) use_.target = std::make_unique<DispatchTarget>();
        use_.now = use_.target.get();
    }
    ~DispatchPass() { use_.now = nullptr; }
    DispatchPass(const DispatchPass&) = delete;

private:
    MemoryUse& use_;
};

/// Invocations in a group; 0, and an error: there is no compute shader, or it cannot run (may_run).
std::uint64_t group_of(Context& c) {
    std::lock_guard lock(c.share().mutex);
    const Executable* executable = c.program ? c.program->executable.get() : nullptr;
    if (!executable || !executable->computes() || !may_run(c)) return c.error(GL_INVALID_OPERATION), 0;
    std::uint64_t invocations = 1;
    for (const std::uint32_t size : executable->group_size) invocations *= size;
    return invocations;
}

/// How many invocations there are; a number beyond what may be, if it were too large.
std::uint64_t invocations_of(const Groups& groups, std::uint64_t in_each) {
    for (const GLuint count : groups) {
        if (count != 0 && in_each > wire::kMostInvocations / count) return wire::kMostInvocations + 1;
        in_each *= count;
    }
    return in_each;
}

void run(Context& c, const Groups& groups, std::uint64_t in_each) {
    const std::uint64_t invocations = invocations_of(groups, in_each);
    if (invocations == 0 || !c.attached() || c.draws_nothing) return;
    if (invocations > wire::kMostInvocations) {
        complain_once("a dispatch of more than 2^31 invocations was left out", "dispatch");
        return c.error(GL_OUT_OF_MEMORY);
    }
    c.flush_block();
    find_written_to_read(c);
    const DispatchPass pass(*c.memory);
    c.session().draw(c.draw_source(), std::nullopt, Needs{},
                     [&](wire::PackBuffer& buffer) { glapi::pack::Dispatch(buffer, groups[0], groups[1], groups[2]); });
}

/// Those that lie in the bound buffer; nothing, and an error: not all of it does.
std::optional<Groups> indirect_groups(Context& c, GLintptr offset) {
    if (offset < 0 || offset % static_cast<GLintptr>(sizeof(GLuint)) != 0)
        return c.error(GL_INVALID_VALUE), std::nullopt;
    const ClientName id(c.state.local.dispatch_indirect_buffer);
    if (id) fetch_captured(c, id, "glDispatchComputeIndirect");
    std::lock_guard lock(c.share().mutex);
    const Buffer* buffer = id ? buffer_of(c, id) : nullptr;
    const auto at = static_cast<std::size_t>(offset);
    Groups groups{};
    if (!buffer || buffer->blocked() || buffer->size() < sizeof groups || at > buffer->size() - sizeof groups)
        return c.error(GL_INVALID_OPERATION), std::nullopt;
    std::memcpy(groups.data(), buffer->data() + at, sizeof groups);
    return groups;
}

/// Whether a dimension has more groups than there may be.
bool too_many(const Context& c, const Groups& groups) {
    constexpr double kLeast = 65535;  // that every implementation allows
    for (std::size_t i = 0; i < groups.size(); ++i)
        if (groups[i] > limit_of(c.caps(), GL_MAX_COMPUTE_WORK_GROUP_COUNT, kLeast, i)) return true;
    return false;
}

}  // namespace

void DispatchCompute(Context& c, GLuint x, GLuint y, GLuint z) {
    const std::uint64_t in_each = group_of(c);
    if (in_each == 0) return;
    if (too_many(c, {x, y, z})) return c.error(GL_INVALID_VALUE);
    run(c, {x, y, z}, in_each);
}

// More groups than there may be are not defined there; they are left out. In a list it is an error, as in Mesa.
void DispatchComputeIndirect(Context& c, GLintptr offset) {
    if (c.lists->name != 0) return c.error(GL_INVALID_OPERATION);
    const std::uint64_t in_each = group_of(c);
    if (in_each == 0) return;
    const auto groups = indirect_groups(c, offset);
    if (groups && !too_many(c, *groups)) run(c, *groups, in_each);
}

}  // namespace wall::client::api
