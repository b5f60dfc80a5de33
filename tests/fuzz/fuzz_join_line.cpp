// SPDX-License-Identifier: MIT
// Join lines, which people type or paste: what is taken is written as it was read.
#include "common/base/assert.h"
#include "common/tls/join_line.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using wall::tls::JoinLine;
    const auto line = JoinLine::parse({reinterpret_cast<const char*>(data), size});
    if (!line) return 0;
    const auto again = JoinLine::parse(line->text());
    WALL_ASSERT(again && again->walld == line->walld && again->fingerprint == line->fingerprint &&
                again->secret == line->secret);
    return 0;
}
