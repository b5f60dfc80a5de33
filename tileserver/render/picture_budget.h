// SPDX-License-Identifier: MIT
// How much memory pictures may take between the driver and walld: read back, encoded, waiting to be sent. Nothing more
// is read back while it is spent, so that viewers of many large tiles wait for each other and the node stays small.
// Render thread; what hold() gives may end on any thread.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

namespace wall::tileserver {

class PictureBudget {
public:
    static constexpr std::size_t kMost = std::size_t{512} << 20;  ///< bytes; the picture that reaches it may exceed it

    bool spent() const { return *bytes_ >= kMost; }
    /// A share, given back when the last copy is gone.
    std::shared_ptr<const void> hold(std::size_t bytes) {
        *bytes_ += bytes;
        return {bytes_.get(), [all = bytes_, bytes](const void*) { *all -= bytes; }};
    }

private:
    std::shared_ptr<std::atomic<std::size_t>> bytes_ = std::make_shared<std::atomic<std::size_t>>(0);
};

}  // namespace wall::tileserver
