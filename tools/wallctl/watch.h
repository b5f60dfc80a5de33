// SPDX-License-Identifier: MIT
// wallctl watch: the wall in a terminal, refreshed in place; elsewhere a block of text for each refresh, or a line of
// JSON.
#pragma once

#include "tools/request/request.h"

namespace wall::wallctl {

using request::Outcome;
using request::Walld;

struct Watching {
    std::chrono::milliseconds interval{1000};
    std::uint64_t count = 0;  ///< refreshes; 0: until Ctrl-C
    bool as_json = false;
};

/// Runs until it has refreshed `count` times, or until SIGINT or SIGTERM. A walld that goes away is said and waited
/// for; one that is not there in the beginning is an error.
Outcome<void> watch(const Walld& walld, const Watching& watching);

}  // namespace wall::wallctl
