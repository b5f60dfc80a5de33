// SPDX-License-Identifier: MIT
#include "client_lib/context/context.h"
#include "client_lib/context/core.h"
#include "common/glstate/diff.h"

namespace wall::client {

void copy_context(Context& from, Context& to, std::uint32_t mask) {
    from.flush_block();  // current attributes are in `state` after it
    glstate::adopt_current_color(from.state);
    glstate::for_each_in_group(mask, [&]<class E>(unsigned i) { to.set<E>(i, E::ref(std::as_const(from.state), i)); });
}

}  // namespace wall::client
