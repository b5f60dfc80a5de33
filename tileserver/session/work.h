// SPDX-License-Identifier: MIT
// What executing a session's stream has cost, since the stream began. Render thread.
#pragma once

#include <chrono>
#include <cstdint>

namespace wall::tileserver {

struct Work {
    using Clock = std::chrono::steady_clock;

    std::uint64_t frames = 0, commands = 0, gl_errors = 0;
    std::uint64_t state_bytes = 0, geometry_bytes = 0;  ///< of commands: context differences, blocks
    std::uint64_t object_bytes = 0;                     ///< of all other commands
    std::uint64_t array_elements = 0;                   ///< of draws from buffers, as often as a tile drew them
    std::uint64_t context_switches = 0;                 ///< blocks that found another context in the driver
    std::uint64_t partial_bytes = 0, partials_merged = 0, partials_missed = 0;  ///< of sort-last: sent, and come
    Clock::duration partial{};       ///< reading, coding and merging partial pictures
    Clock::duration partial_wait{};  ///< waiting for them
    Clock::duration decode{};        ///< taking batches apart and calling the driver
    Clock::duration render{};        ///< waiting until the driver has ended a frame or an answer

    Work& operator+=(const Work& other) {
        frames += other.frames;
        commands += other.commands;
        gl_errors += other.gl_errors;
        state_bytes += other.state_bytes;
        geometry_bytes += other.geometry_bytes;
        object_bytes += other.object_bytes;
        array_elements += other.array_elements;
        context_switches += other.context_switches;
        partial_bytes += other.partial_bytes;
        partials_merged += other.partials_merged;
        partials_missed += other.partials_missed;
        partial += other.partial;
        partial_wait += other.partial_wait;
        decode += other.decode;
        render += other.render;
        return *this;
    }
};

/// Adds the time of its life to `total`.
class Timed {
public:
    explicit Timed(Work::Clock::duration& total) : total_(total), start_(Work::Clock::now()) {}
    ~Timed() { total_ += Work::Clock::now() - start_; }
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;

private:
    Work::Clock::duration& total_;
    Work::Clock::time_point start_;
};

}  // namespace wall::tileserver
