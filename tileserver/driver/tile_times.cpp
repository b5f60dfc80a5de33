// SPDX-License-Identifier: MIT
#include "tileserver/driver/tile_times.h"

#include <algorithm>
#include <utility>

namespace wall::tileserver {

TileTimes::~TileTimes() {
    for (const Mark& mark : marks_) free_.push_back(mark.query);
    if (!free_.empty()) gl_.DeleteQueries(static_cast<GLsizei>(free_.size()), free_.data());
}

void TileTimes::tick(Clock::time_point now) {
    if (looking_ && now - begun_ >= kLook) end_look(now);
    if (!looking_ && !marks_.empty()) take_marks();
    if (on_ && !looking_ && marks_.empty() && now >= next_) begin_look(now);
}

void TileTimes::begin_look(Clock::time_point now) {
    looking_ = true;
    begun_ = now;
    next_ = now + kEvery;
    at_ = 0;
    slot_.reset();
}

/// It may have ended early, or late where the driver held the thread up.
void TileTimes::end_look(Clock::time_point now) {
    add_mark(std::nullopt);
    looking_ = false;
    next_ = std::max(next_, now);
    const auto taken = std::max<Clock::duration>(now - begun_, std::chrono::microseconds(1));
    scale_ = std::chrono::duration<double>(next_ - begun_) / std::chrono::duration<double>(taken);
}

/// The look ends where it is full, since what comes later would count as part of its time.
void TileTimes::put(std::optional<std::uint32_t> slot) {
    if (marks_.size() + 1 < kMostMarks) add_mark(slot);
    else end_look(Clock::now());
}

void TileTimes::add_mark(std::optional<std::uint32_t> slot) {
    GLuint query = 0;
    if (free_.empty()) {
        gl_.GenQueries(1, &query);
    } else {
        query = free_.back();
        free_.pop_back();
    }
    gl_.QueryCounter(query, GL_TIMESTAMP);
    marks_.push_back({query, slot});
}

void TileTimes::take_marks() {
    while (!marks_.empty()) {
        const Mark mark = marks_.front();
        GLuint there = GL_FALSE;
        gl_.GetQueryObjectuiv(mark.query, GL_QUERY_RESULT_AVAILABLE, &there);
        if (there == GL_FALSE) return;
        GLuint64 at = 0;
        gl_.GetQueryObjectui64v(mark.query, GL_QUERY_RESULT, &at);
        if (slot_ && at_ != 0 && at > at_)
            all_[*slot_] += std::chrono::nanoseconds(static_cast<std::int64_t>(static_cast<double>(at - at_) * scale_));
        at_ = at;
        slot_ = mark.slot;
        free_.push_back(mark.query);
        marks_.pop_front();
    }
}

}  // namespace wall::tileserver
