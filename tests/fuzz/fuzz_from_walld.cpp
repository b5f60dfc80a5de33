// SPDX-License-Identifier: MIT
// What walld says to a program, which reads it in a process that is not ours: a message, or a sentence that it is none.
#include "client_lib/link/control_messages.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto message = wall::client::decode_from_walld({reinterpret_cast<const char*>(data), size});
    if (!message && message.error().message.empty()) __builtin_trap();
    return 0;
}
