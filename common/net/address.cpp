// SPDX-License-Identifier: MIT
#include "common/net/address.h"

namespace wall::net {

Result<SocketAddress> resolve_for_listening(const Address& address) {
    const auto refusal = [&] {
        return fail("listen address " + address.text() +
                    " can be reached from other machines, and authentication and TLS for them are not there yet: "
                    "use unix:PATH or a loopback address (127.0.0.1:PORT)");
    };
    if (!address.local()) return refusal();  // before a name service is asked
    auto resolved = resolve(address);
    if (resolved && !resolved->local()) return refusal();  // a `localhost` that is none
    return resolved;
}

}  // namespace wall::net
