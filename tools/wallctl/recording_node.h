// SPDX-License-Identifier: MIT
// A node that shows nothing: a program sends it what a node would get that sees all of its windows, and it hands the
// batches on (docs/recordings.md). It speaks the data stream (common/wire/frame.h) on a Unix socket of its own, draws
// every frame at once, and answers nothing else. One thread.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"
#include "common/base/unique_fd.h"
#include "common/wire/frame_reader.h"

namespace wall::wallctl {

class RecordingNode {
public:
    /// What is done with a program's stream. An error ends the recording.
    struct Events {
        std::function<Result<void>()> begins;  ///< one that is told from nothing
        /// A batch's payload. Gives what is said to the program, whole frames of the stream.
        std::function<Result<std::vector<std::byte>>(std::span<const std::byte> payload)> batch;
    };

    /// In a folder of its own, which goes with it.
    static Result<RecordingNode> listen(Events events);
    RecordingNode(RecordingNode&&) = default;
    RecordingNode& operator=(RecordingNode&&) = delete;
    ~RecordingNode();

    const std::string& address() const { return address_; }
    /// Who comes must show it. Before the first serve().
    void expect(std::string ticket) { ticket_ = std::move(ticket); }
    /// Takes what comes, at most for so long. The error is one of Events.
    Result<void> serve(std::chrono::milliseconds limit);
    /// A program's stream is open.
    bool has_stream() const;
    /// The program is to tell everything anew from its next frame on.
    void ask_to_begin_again();

private:
    struct Peer {
        UniqueFd fd;
        wire::FrameReader reader;
        bool greeted = false;
    };
    RecordingNode(UniqueFd listener, std::filesystem::path folder, Events events);
    void accept();
    /// False: it is over.
    Result<bool> read(Peer& peer);
    Result<bool> take(Peer& peer, const wire::Frame& frame);
    bool greet(Peer& peer, std::span<const std::byte> hello);
    static bool send(const Peer& peer, std::span<const std::byte> bytes);

    UniqueFd listener_;
    std::filesystem::path folder_;
    std::string address_, ticket_;
    Events events_;
    std::vector<Peer> peers_;
};

}  // namespace wall::wallctl
