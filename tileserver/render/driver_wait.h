// SPDX-License-Identifier: MIT
// Waiting for the driver to have drawn what a stream told it. Render thread.
#pragma once

#include <limits>

#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

class DriverWait {
public:
    explicit DriverWait(const Gl& gl) : gl_(gl) {}
    ~DriverWait() { forget(); }
    DriverWait(const DriverWait&) = delete;

    /// For everything.
    void finish() {
        gl_.Finish();
        forget();
    }
    /// For what was told before the last call: the driver draws what has come since while this thread goes on telling.
    /// At most two calls' worth is on its way.
    void finish_before() {
        const GLsync told = gl_.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
        gl_.Flush();
        if (before_ != nullptr) gl_.ClientWaitSync(before_, 0, std::numeric_limits<GLuint64>::max());
        forget();
        before_ = told;
    }

private:
    void forget() {
        if (before_ != nullptr) gl_.DeleteSync(before_);
        before_ = nullptr;
    }
    const Gl& gl_;
    GLsync before_ = nullptr;
};

}  // namespace wall::tileserver
