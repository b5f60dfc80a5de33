// SPDX-License-Identifier: MIT
// Plays a recording on a wall (docs/recordings.md): it is a program of the wall whose frames come from a file. Every
// node gets all of the stream, so that whatever tiles it has show the windows wherever they are moved. The main thread.
#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "client_lib/follow/session.h"
#include "common/recording/reader.h"
#include "tools/wallplay/rewrite.h"
#include "tools/wallplay/windows.h"

namespace wall::wallplay {

struct PlayOptions {
    std::string file;
    double from = 0;                          ///< seconds of the recording
    std::optional<std::uint64_t> from_frame;  ///< instead: the first one that is shown, from 1
    std::optional<std::uint64_t> frames;      ///< how many are shown
    double speed = 1;
    bool loop = false;
    bool stay = false;  ///< the last picture stays until somebody closes it
};

/// What was shown.
struct Played {
    std::uint64_t frames = 0;
    std::string skipped;  ///< what could not be read, and was gone over; empty: nothing
};

class Player {
public:
    /// Both outlive it. `stop`: set by whoever wants it to end.
    Player(client::ClientSession& session, const PlayOptions& options, const std::atomic<bool>& stop)
        : session_(session), options_(options), stop_(stop) {}

    /// To the end of the recording, or until it is stopped. An error names the place in the file.
    Result<Played> play();

private:
    using Clock = std::chrono::steady_clock;
    /// Of the segment that is being read, what has been sent.
    struct Position {
        std::size_t segment = 0;
        std::uint64_t batches = 0;
        std::size_t commands = 0;  ///< of the next batch
    };
    /// A command, and what its context draws to.
    struct Sent {
        glstate::Command command;
        SurfaceId drawn;
    };

    Result<void> open();
    void go_to(std::size_t segment);
    std::size_t segment_for_start() const;
    /// To the end of the file, or until it is over.
    Result<void> play_on();
    bool go_over(const std::string& why);
    void begin_segment();
    Result<void> show(const recording::Record& record);
    void send(ContextId context, const std::vector<Sent>& commands);
    void end_frame(ContextId context, SurfaceId surface);
    void catch_up(client::Node& node);
    void begin_again(client::Node& node);
    void forget_all();
    void refresh();
    void wait_until(recording::Time time);
    void stay();
    /// What comes now is shown, and not only the way to where showing begins.
    bool shows() const;
    bool is_over() const;

    client::ClientSession& session_;
    const PlayOptions& options_;
    const std::atomic<bool>& stop_;
    std::optional<recording::Reader> reader_;
    std::optional<Windows> windows_;
    DrawnSurfaces drawn_;
    Position at_;
    std::size_t next_segment_ = 0;
    std::size_t pictured_ = 0;  ///< the segment of the last frame that has ended
    bool began_again_ = false;  ///< the recording has said so
    std::uint64_t frame_ = 0;   ///< frames of the recording that have ended
    recording::Time time_{};    ///< of the last record
    Played played_;
    bool starts_at_ = true;  ///< the options say where showing begins; else it goes on
    ContextId last_context_;
    /// Nodes that have all that was sent of the segment, by their streams.
    std::map<NodeIndex, std::shared_ptr<const client::NodeStream>> known_;
    std::optional<Clock::time_point> begun_;  ///< when what is of `begun_at_` was due
    recording::Time begun_at_{};
};

}  // namespace wall::wallplay
