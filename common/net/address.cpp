// SPDX-License-Identifier: MIT
#include "common/net/address.h"

namespace wall::net {

Result<SocketAddress> resolve_for_listening(const Address& address, Peers peers) {
    const auto refusal = [&] {
        return fail("listen address " + address.text() +
                    " can be reached from other machines, and there is no key to know them by: use unix:PATH or a "
                    "loopback address (127.0.0.1:PORT), or give the daemon a place for its key (walld: "
                    "'state_directory' in [wall] of "
                    "wall.toml; tileserver: --state)");
    };
    const bool any = peers == Peers::with_keys;
    if (!any && !address.local()) return refusal();  // before a name service is asked
    auto resolved = resolve(address);
    // A `localhost` that is none would be listened on without keys.
    if (resolved && !resolved->local() && (!any || address.local())) return refusal();
    return resolved;
}

}  // namespace wall::net
