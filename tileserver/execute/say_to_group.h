// SPDX-License-Identifier: MIT
// What a member of a parallel program says to the others on this node. Render thread.
#pragma once

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

/// `say(GroupSync&, Rank)` gives a Result; its error refuses the stream.
template <class Say>
void say_to_group(Execution& execution, Say&& say) {
    ParallelGroup* group = execution.session.group();
    if (group == nullptr) return execution.refuse("not of a parallel program");
    if (const Result<void> done = say(group->sync, execution.session.rank()); !done)
        execution.refuse(done.error().message);
}

}  // namespace wall::tileserver
