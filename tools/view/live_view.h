// SPDX-License-Identifier: MIT
// A stream kept up to date and decoded on a thread of its own.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

#include "tools/view/feed.h"
#include "tools/view/picture_builder.h"

namespace wall::view {

/// What somebody looks at.
struct Looked {
    const PictureBuilder& builder;
    std::uint64_t frames = 0;    ///< decoded since the start
    const std::string& failure;  ///< why nothing comes; empty: connected, or about to be
};

class LiveView {
public:
    /// Opens a feed for one entry of a watch list.
    using Connect = std::function<Outcome<std::unique_ptr<Feed>>(const nlohmann::json& entry)>;
    enum class AfterFailure { stay, connect_again };

    /// `news`: called by the thread when look() has something else to show; must not block.
    LiveView(
        Connect connect, nlohmann::json entry, AfterFailure after, std::function<void()> news = [] {});
    ~LiveView();

    // ---- any thread ----
    /// Something else to watch from now on; keeps the picture until the new one comes.
    void watch(nlohmann::json entry);
    /// A paused view has no connection, so that nobody makes or decodes pictures for it.
    void pause(bool paused);
    /// Nothing is decoded while `look` runs.
    void look(const std::function<void(const Looked&)>& look) const;
    /// Waits until the picture is complete, or there is a failure; false if that takes longer.
    bool wait_complete(std::chrono::milliseconds limit);

private:
    void run();
    Result<void> receive(Feed& feed, std::uint64_t version);
    Result<void> take(const FeedMessage& message);
    bool current(std::uint64_t version);
    void set_failure(const std::string& failure);

    const Connect connect_;
    const AfterFailure after_;
    const std::function<void()> news_;
    mutable std::mutex mutex_;  // guards all that follow
    std::condition_variable changed_;
    nlohmann::json entry_;
    std::uint64_t version_ = 1;  ///< of entry_ and paused_
    bool paused_ = false, stop_ = false;
    PictureBuilder builder_;
    std::uint64_t frames_ = 0;
    std::string failure_;
    std::thread thread_;
};

}  // namespace wall::view
