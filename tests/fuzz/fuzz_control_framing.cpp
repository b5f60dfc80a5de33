// SPDX-License-Identifier: MIT
// The control connection's bytes, in portions whose sizes the input says itself.
#include <algorithm>
#include <cstring>

#include "common/net/framing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    wall::net::Unframer unframer;
    while (size > 0) {
        const std::size_t portion = std::min<std::size_t>(size, 1 + data[0] % 64);
        std::memcpy(unframer.prepare(portion).data(), data, portion);
        unframer.commit(portion);
        data += portion;
        size -= portion;
        for (auto message = unframer.next();; message = unframer.next()) {
            if (!message) return 0;
            if (!*message) break;
            // What came in whole must go out and come in again.
            if (!wall::net::frame(**message)) __builtin_trap();
        }
    }
    return 0;
}
