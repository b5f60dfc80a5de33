// SPDX-License-Identifier: MIT
// How long a stream's turn on the render thread is, and when its next one may begin. Pure; one thread.
//
// A turn should cost all others about kTurn. What the render thread spends on it is only a part of that: drivers gather
// what they are told and draw later (for llvmpipe a triangle is a tenth of a microsecond to take and, if it covers a
// window, a thousand times that to fill). So a stream that has used up its budget waits for the driver (RenderThread
// does that and says how long it took), and its budget becomes the part of kTurn that its commands take of their whole
// cost. Budgets begin small, since nobody knows yet, and grow by steps. While no other stream is active one waits less
// often, and if the driver keeps up only for what it had told when it waited last, so that the driver draws while more
// is told. A turn that could not be cut, such as one long call of the driver, is made up for: the stream then waits for
// as long, if others are active.
#pragma once

#include <algorithm>
#include <chrono>

namespace wall::tileserver {

class Pace {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr Clock::duration kTurn = std::chrono::milliseconds(5);
    static constexpr Clock::duration kAlone = std::chrono::milliseconds(25);  ///< instead, if no other is active
    static constexpr Clock::duration kFirst = std::chrono::microseconds(100);
    static constexpr int kStep = 4;  ///< the most by which a budget grows at once

    /// Of the render thread's time, for the next turn. `contended`: others are active.
    Clock::duration budget(bool contended) const { return std::min(kTurn, contended ? budget_ : alone_); }
    /// How many turns the stream gets where others get one: so much sooner a long one is made up for.
    void set_weight(double weight) { weight_ = weight; }
    /// Otherwise others come first, if there are any.
    bool may_run(Clock::time_point now) const { return now >= not_before_; }
    Clock::time_point not_before() const { return not_before_; }

    /// A turn took `spent` of the render thread's time. True: wait for the driver, and say so to finished().
    bool spend(Clock::duration spent, bool contended) {
        turn_ = spent;
        spent_ += spent;
        return spent_ >= (contended ? budget_ : alone_);
    }
    /// Whether the driver has lately needed no longer for what it was told than the stream to tell it. Known only when
    /// the budget has grown: the first turns may be anything, such as a shader that is compiled.
    bool driver_keeps_up() const { return keeps_up_; }
    /// All that the stream has told the driver is done, or all that it had told the last time; that took `waited`
    /// beyond what it has spent.
    void finished(Clock::duration waited, Clock::time_point now) {
        const auto whole = spent_ + waited;
        const auto share =
            static_cast<double>(spent_.count()) / static_cast<double>(std::max<Clock::rep>(1, whole.count()));
        keeps_up_ = waited <= spent_ && alone_ >= kGrown;
        budget_ = std::min(part(kTurn, share), kStep * budget_);
        alone_ = std::min(part(kAlone, share), kStep * alone_);
        spent_ = {};
        if (turn_ + waited > 2 * kTurn)
            not_before_ = now + std::chrono::duration_cast<Clock::duration>((turn_ + waited - kTurn) / weight_);
    }

private:
    static constexpr Clock::duration kGrown = kAlone / 8;
    static constexpr Clock::duration kShortest = std::chrono::microseconds(10);
    static Clock::duration part(Clock::duration of, double share) {
        return std::clamp<Clock::duration>(std::chrono::duration_cast<Clock::duration>(of * share), kShortest, of);
    }
    Clock::duration budget_ = kFirst, alone_ = kFirst;
    Clock::duration spent_{}, turn_{};  // since the driver was waited for; in the last turn
    Clock::time_point not_before_{};
    double weight_ = 1;
    bool keeps_up_ = false;
};

}  // namespace wall::tileserver
