// SPDX-License-Identifier: MIT
// wallctl record --commands: what a program draws, as its commands, which wallplay shows on any wall
// (docs/recordings.md).
#pragma once

#include "tools/request/request.h"

namespace wall::wallctl {

struct CommandRecording {
    std::string file, session;
    double seconds = 10;
    double snapshot = 10;  ///< seconds between two places from which on it can be read
    bool progress = true;  ///< on standard error, once a second
};

/// {"file", "frames", "bytes", "seconds", "segments", "plain_bytes", "windows", "ended"}. Ctrl-C and the program's end
/// end it early and leave a whole file.
request::Outcome<request::Answer> record_commands(const request::Walld& walld, const CommandRecording& recording);

}  // namespace wall::wallctl
