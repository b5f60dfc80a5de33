// SPDX-License-Identifier: MIT
// What drawing takes for each tile, by the driver's own clock: GL_TIMESTAMP where one tile's commands end and another's
// begin, so what the driver does later counts where it belongs, and nobody waits. It looks at a tenth of the time,
// which stands for all of it. OCTAVIS (5.3) measures its screens so to share them out among GPUs. Render thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

class TileTimes {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr Clock::duration kLook = std::chrono::milliseconds(100), kEvery = std::chrono::seconds(1);
    static constexpr std::size_t kMostMarks = 4096;  ///< of one look, which ends with the last

    explicit TileTimes(const Gl& gl) : gl_(gl) {}
    ~TileTimes();
    TileTimes(const TileTimes&) = delete;

    /// Off, which it is at first, costs nothing.
    void switch_on(bool on) { on_ = on; }
    /// What the driver is told from here on is for that tile; nothing: for none.
    void mark(std::optional<std::uint32_t> slot) {
        if (looking_) [[unlikely]]
            put(slot);
    }
    /// Begins and ends looks, and takes what the driver has come to. The more often, the sooner.
    void tick(Clock::time_point now);
    /// By slot, of all the time since the beginning, by estimate.
    const std::map<std::uint32_t, std::chrono::nanoseconds>& all() const { return all_; }

private:
    struct Mark {
        GLuint query = 0;
        std::optional<std::uint32_t> slot;  ///< of what is behind it
    };
    void put(std::optional<std::uint32_t> slot);
    void add_mark(std::optional<std::uint32_t> slot);
    void begin_look(Clock::time_point now);
    void end_look(Clock::time_point now);
    void take_marks();

    const Gl& gl_;
    bool on_ = false, looking_ = false;
    Clock::time_point begun_{}, next_{};
    double scale_ = 1;                   ///< the time that the last look stands for, to its own
    std::vector<GLuint> free_;           ///< queries
    std::deque<Mark> marks_;             ///< of the look; a look begins when the driver has come to all of the last one
    std::optional<std::uint32_t> slot_;  ///< of the last mark that was taken
    GLuint64 at_ = 0;                    ///< that mark's, ns by the driver's clock
    std::map<std::uint32_t, std::chrono::nanoseconds> all_;
};

}  // namespace wall::tileserver
