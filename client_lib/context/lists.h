// SPDX-License-Identifier: MIT
// Display lists. While one is compiled the context's table is the compile table: listed commands are recorded. At
// glEndList the recording is taken apart into items: runs of whole primitives become packed streams that a node is told
// once and then only called by number (RunDefine, RunCall); all other commands are replayed through the immediate
// functions at each call, so that their effects reach the virtual context (T7.2, which WireGL left undone).
//
// Lists belong to the share group; they do not change once they are there. A context's thread.
#pragma once

#include <list>
#include <memory>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/context/list_state.h"
#include "client_lib/objects/object.h"
#include "common/geom/box.h"
#include "common/wire/pack_buffer.h"

namespace wall::client {

inline constexpr unsigned kListNestingLimit = 64;

/// Whole primitives and the attributes and materials between them.
struct ListRun : Object {
    ListRun();
    ~ListRun() override;

    // It is made once and never changes.
    std::uint64_t latest() const override { return 1; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;
    bool worth_asking() const override { return content.bytes() >= kLeastShared; }
    void pack_question(wire::PackBuffer& buffer, RequestId request) const override;

    wire::PackBuffer content;
    geom::Box box;  ///< object space
    /// What a current attribute is afterwards: a command in `content`.
    struct Effect {
        glapi::Op op;
        std::uint32_t operand;
    };
    /// What calling it leaves behind.
    struct Effects {
        std::vector<Effect> attributes;
        std::vector<MaterialChange> materials;  ///< in order
    };
    Effects in_driver;                     ///< the driver of a node that ran it holds these
    Effects in_context;                    ///< the program may see these (list_compile.cpp has the difference)
    std::uint32_t spared = 0;              ///< attributes that it sets before its first vertex, as in Needs::spared
    std::vector<std::size_t> array_draws;  ///< commands of `content`, each the Begin of what was drawn from arrays

private:
    std::list<ClientName> obituary_;  ///< its id, for DeadRuns: a destructor must not ask for memory
};

/// A run, or commands to be replayed.
struct ListItem {
    std::unique_ptr<ListRun> run;
    std::vector<std::byte> replay;
};

struct DisplayList {
    std::vector<ListItem> items;
};

/// Takes a recording apart. Leaves the context as it was.
std::shared_ptr<DisplayList> compile_list(Context& context, std::span<const std::byte> recording);
void execute_list(Context& context, const DisplayList& list);
/// Marks the next recorded primitive as drawn from arrays; `draws`: there will be one. False, and an error, if the
/// command is executed between glBegin and glEnd.
bool record_array_draw(Context& context, bool draws);
/// That mark, replayed or packed into a run.
void replay_array_draw(Context& context, std::span<const std::byte> payload);
/// Tells the nodes which runs have gone, whoever let go of them.
void forget_dead_runs(Context& context);

}  // namespace wall::client
