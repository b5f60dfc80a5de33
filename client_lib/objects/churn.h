// SPDX-License-Identifier: MIT
// Whether the content of a buffer is worth keeping on the nodes. Kept, every change travels to each node that draws
// with it, and a draw is some bytes; not kept, every draw brings its vertices along, sorted, each to the nodes that it
// touches. What each would have cost between the last two changes tells which is better until the next. Pure.
#pragma once

#include <cstdint>

#include "common/glapi/gl_types.h"

namespace wall::client {

class Churn {
public:
    /// What the program says of a buffer before anything is known: a GL_STREAM_* one is drawn a few times at most.
    void expect(GLenum usage) { keep_ = (usage & ~GLenum{3}) != GL_STREAM_DRAW; }

    /// Content was written, whether or not any node has it.
    void changed(std::uint64_t bytes) {
        if (drawn_ != 0) judge();
        changed_ += bytes;
    }
    /// A draw that would bring `inline_bytes` along, to `nodes` nodes in all.
    void drawn(std::uint64_t inline_bytes, std::uint64_t nodes) {
        drawn_ += inline_bytes;
        if (nodes > nodes_) nodes_ = nodes;
        if (!keep_ && worth_keeping()) judge();  // what does not change any more need not wait for a change
    }
    bool keep() const { return keep_; }

private:
    /// Twice, so that what is about equal does not go to and fro.
    bool worth_keeping() const { return drawn_ > 2 * changed_ * nodes_; }
    bool worthless() const { return changed_ * nodes_ > 2 * drawn_; }
    void judge() {
        if (worth_keeping()) keep_ = true;
        else if (worthless()) keep_ = false;
        changed_ = drawn_ = nodes_ = 0;
    }

    bool keep_ = true;
    std::uint64_t changed_ = 0, drawn_ = 0;  ///< bytes since it was judged last
    std::uint64_t nodes_ = 0;                ///< the most that drew with it
};

}  // namespace wall::client
