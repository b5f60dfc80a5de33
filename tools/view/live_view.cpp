// SPDX-License-Identifier: MIT
#include "tools/view/live_view.h"

namespace wall::view {
namespace {

constexpr std::chrono::milliseconds kLook{50};  // how soon the thread sees that it shall do something else
constexpr std::chrono::milliseconds kFirstWait{250}, kMostWait{5000};

}  // namespace

LiveView::LiveView(Connect connect, nlohmann::json entry, AfterFailure after, std::function<void()> news)
    : connect_(std::move(connect)), after_(after), news_(std::move(news)), entry_(std::move(entry)), thread_([this] {
          run();
      }) {}

LiveView::~LiveView() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        ++version_;
    }
    changed_.notify_all();
    thread_.join();
}

void LiveView::watch(nlohmann::json entry) {
    {
        const std::lock_guard lock(mutex_);
        if (entry == entry_) return;
        entry_ = std::move(entry);
        ++version_;
    }
    changed_.notify_all();
}

void LiveView::pause(bool paused) {
    {
        const std::lock_guard lock(mutex_);
        if (paused == paused_) return;
        paused_ = paused;
        ++version_;
    }
    changed_.notify_all();
}

void LiveView::look(const std::function<void(const Looked&)>& look) const {
    const std::lock_guard lock(mutex_);
    look({builder_, frames_, failure_});
}

bool LiveView::wait_complete(std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, limit, [this] { return !failure_.empty() || builder_.complete(); });
}

void LiveView::run() {
    auto wait = kFirstWait;
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (paused_) {
            changed_.wait(lock);
            continue;
        }
        const auto version = version_;
        const auto entry = entry_;
        const auto frames_before = frames_;
        lock.unlock();
        auto feed = connect_(entry);
        const auto ended = feed ? receive(**feed, version) : Result<void>(fail(feed.error().message));
        if (!ended) set_failure(ended.error().message);
        lock.lock();
        if (ended) continue;
        if (after_ == AfterFailure::stay) return;
        if (frames_ != frames_before) wait = kFirstWait;
        changed_.wait_for(lock, wait, [&] { return version_ != version; });
        wait = std::min(2 * wait, kMostWait);
    }
}

/// Until something else is wanted, or the feed fails.
Result<void> LiveView::receive(Feed& feed, std::uint64_t version) {
    while (current(version)) {
        const auto message = feed.next(kLook);
        if (!message) return tl::unexpected(message.error());
        if (!*message) continue;
        if (auto taken = take(**message); !taken) return taken;
        changed_.notify_all();
        news_();
    }
    return {};
}

Result<void> LiveView::take(const FeedMessage& message) {
    const std::lock_guard lock(mutex_);
    auto taken = message.binary ? builder_.take_frame(message.data) : builder_.take_text(message.data);
    if (!taken) return taken;
    failure_.clear();
    frames_ += message.binary ? 1 : 0;
    return {};
}

bool LiveView::current(std::uint64_t version) {
    const std::lock_guard lock(mutex_);
    return version_ == version;
}

void LiveView::set_failure(const std::string& failure) {
    {
        const std::lock_guard lock(mutex_);
        failure_ = failure;
    }
    changed_.notify_all();
    news_();
}

}  // namespace wall::view
