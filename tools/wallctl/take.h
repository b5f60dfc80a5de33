// SPDX-License-Identifier: MIT
// wallctl take: a program off the wall and into its own X window while it runs, and back (docs/operation.md, "Programs
// in their own windows"). A wall of its own is started for it, whose tiles lie in its windows, and the program moves
// there.
#pragma once

#include "tools/request/request.h"

namespace wall::wallctl {

struct Take {
    std::string session;
    double seconds = 0;    ///< then it goes back; 0: when this program is asked to end
    bool progress = true;  ///< on standard error
};

/// {"session", "seconds", "ended"}: its number on the wall again; null if it has ended. Ctrl-C puts it back.
request::Outcome<request::Answer> take(const request::Walld& walld, const Take& options);

}  // namespace wall::wallctl
