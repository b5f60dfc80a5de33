// SPDX-License-Identifier: MIT
// Being one of several processes that draw one picture: which of them, and the barrier between them. It is no call that
// waits, but a command in the stream of each process: what the others draw behind it comes after what this one has
// drawn before it, on every tile.
#pragma once

#include <GL/glx.h>

namespace march {

struct Rank {
    int own = 0;  ///< from 0
    int all = 1;
};

/// As WALLGL_PARALLEL says, which `wallrun --parallel` sets; one process alone without it.
Rank rank_from_environment();

class Team {
public:
    /// With a current context. Ends the program if there are several processes, but no GL_CR_synchronization.
    explicit Team(const Rank& rank);

    const Rank& rank() const { return rank_; }
    bool first() const { return rank_.own == 0; }
    /// All processes of the team.
    void barrier() const;

private:
    Rank rank_;
    void (*exec_)(GLuint name) = nullptr;
};

}  // namespace march
