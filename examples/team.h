// SPDX-License-Identifier: MIT
// Being one of several processes that draw one picture: which of them, and the order between them. None of this is a
// call that waits, but a command in the stream of each process: what others draw behind it comes after what this one
// has drawn before it, on every tile.
#pragma once

#include <GL/glx.h>

namespace example {

struct Rank {
    int own = 0;  ///< from 0
    int all = 1;
};

/// As WALLGL_PARALLEL says, which `wallrun --parallel` sets; one process alone without it.
Rank rank_from_environment();

class Team {
public:
    /// With a current context. Ends the program with a message, which begins with `title`, if there are several
    /// processes, but no GL_CR_synchronization.
    Team(const char* title, const Rank& rank);

    const Rank& rank() const { return rank_; }
    bool first() const { return rank_.own == 0; }
    /// All processes of the team.
    void barrier() const;
    /// Between the two each draws behind those of lower places, and before those of higher ones. Each process has
    /// another place, from 0, and takes one turn a frame.
    void begin_turn(int place) const;
    void end_turn(int place) const;

private:
    using Call = void (*)(GLuint name);

    Rank rank_;
    Call barrier_ = nullptr, take_ = nullptr, give_ = nullptr;
};

}  // namespace example
