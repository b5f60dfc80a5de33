// SPDX-License-Identifier: MIT
// When much has come and little comes any more. A program that starts sends its textures and meshes through memory that
// the allocator keeps afterwards, for each thread and each session that loads at the same time; then is the time to
// give it back to the system. Pure; one thread.
#pragma once

#include <cstdint>
#include <utility>

namespace wall::tileserver {

class BurstWatch {
public:
    static constexpr std::uint64_t kBurst = 8 << 20, kQuiet = 1 << 20;  ///< bytes

    /// Told about once a second how many bytes have come in all. True: a burst is over.
    bool tick(std::uint64_t bytes) {
        const auto came = bytes - std::exchange(before_, bytes);
        since_ += came;
        if (came > kQuiet || since_ < kBurst) return false;
        since_ = 0;
        return true;
    }

private:
    std::uint64_t before_ = 0;
    std::uint64_t since_ = 0;  ///< the last burst's end
};

}  // namespace wall::tileserver
