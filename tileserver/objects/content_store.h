// SPDX-License-Identifier: MIT
// Equal content of several sessions is held once (A6: global share). Sessions ask for content by its name
// before they send it; what somebody is about to send is waited for by the others. The store itself keeps nothing
// alive, and knows a limited number of names: content beyond that is not shared. An asker (a session's stream) has one
// promise at a time. Pure; one thread.
#pragma once

#include <chrono>
#include <cstring>
#include <memory>
#include <unordered_map>
#include <utility>

#include "common/base/ids.h"
#include "common/glapi/content_hash.h"

namespace wall::tileserver {

/// A session, or a member of one.
using ContentAsker = Id<struct ContentAskerTag, std::uint64_t>;

/// `T`: what is shared.
template <class T>
class ContentStore {
public:
    using Clock = std::chrono::steady_clock;
    /// Who promised content and sends nothing of it for so long does not keep others waiting any more.
    static constexpr Clock::duration kPromiseLimit = std::chrono::seconds(1);
    /// Nor does one who has sent some of it now and then for so long: large content takes seconds at most.
    static constexpr Clock::duration kWholePromiseLimit = std::chrono::seconds(10);
    static constexpr std::size_t kMostNames = std::size_t{1} << 18;  ///< of a node, promised ones included

    /// `most_names`: instead of kMostNames.
    explicit ContentStore(std::size_t most_names = kMostNames) : most_names_(most_names) {}

    struct Answer {
        std::shared_ptr<T> have;  ///< the content
        bool send = false;        ///< the asker has to send it, and has promised to. Neither: wait
    };

    Answer ask(const glapi::ContentKey& key, ContentAsker asker, Clock::time_point now) {
        if (!has_room_for(key)) return {nullptr, true};
        Entry& entry = entries_[key];
        if (auto held = entry.held.lock()) return {std::move(held), false};
        const bool coming = now - entry.heard < kPromiseLimit && now - entry.promised < kWholePromiseLimit;
        if (entry.promised_by && entry.promised_by != asker && coming) return {};
        if (entry.promised_by != asker) {
            break_promise(asker);
            promises_[asker] = key;
        }
        entry.promised_by = asker;
        entry.heard = entry.promised = now;
        return {nullptr, true};
    }
    /// More of the promised content has come.
    void heard(const glapi::ContentKey& key, ContentAsker from, Clock::time_point now) {
        const auto at = entries_.find(key);
        if (at != entries_.end() && at->second.promised_by == from) at->second.heard = now;
    }
    /// The content is complete. If it was stored meanwhile, what is held already; use that.
    std::shared_ptr<T> store(const glapi::ContentKey& key, std::shared_ptr<T> content) {
        if (!has_room_for(key)) return content;
        prune();
        Entry& entry = entries_[key];
        promises_.erase(std::exchange(entry.promised_by, {}));
        if (auto held = entry.held.lock()) return held;
        entry.held = content;
        return content;
    }
    /// The content does not have this name any more: its only user changes it.
    void forget(const glapi::ContentKey& key, const T& content) {
        const auto at = entries_.find(key);
        if (at != entries_.end() && at->second.held.lock().get() == &content) entries_.erase(at);
    }
    /// It is gone, and its promise with it.
    void leave(ContentAsker asker) { break_promise(asker); }
    std::size_t size() const { return entries_.size(); }

private:
    struct Entry {
        std::weak_ptr<T> held;
        ContentAsker promised_by;
        Clock::time_point heard{}, promised{};
    };
    struct FirstBytes {  // of a cryptographic hash: as good as any
        std::size_t operator()(const glapi::ContentKey& key) const {
            std::size_t value;
            std::memcpy(&value, key.data(), sizeof value);
            return value;
        }
    };

    // Each asker has promised one thing, the latest: who asks for more and more fills no memory.
    void break_promise(ContentAsker asker) {
        const auto promise = promises_.find(asker);
        if (promise == promises_.end()) return;
        if (const auto at = entries_.find(promise->second); at != entries_.end() && at->second.promised_by == asker) {
            at->second.promised_by = {};
            if (at->second.held.expired()) entries_.erase(at);
        }
        promises_.erase(promise);
    }
    /// Whether the name is known, or one more may be.
    bool has_room_for(const glapi::ContentKey& key) {
        if (entries_.size() < most_names_ || entries_.contains(key)) return true;
        if (without_room_++ % kPruneEvery == 0) drop_expired();  // not for each: that would take longer than sending
        return entries_.size() < most_names_;
    }
    void drop_expired() {
        std::erase_if(entries_, [](const auto& e) { return e.second.held.expired() && !e.second.promised_by; });
    }
    // Names of what is gone, now and then: as many as there are in use do no harm.
    void prune() {
        if (entries_.size() < prune_at_) return;
        drop_expired();
        prune_at_ = std::max(kPruneFrom, 2 * entries_.size());
    }
    static constexpr std::size_t kPruneFrom = 256, kPruneEvery = 1024;

    std::unordered_map<glapi::ContentKey, Entry, FirstBytes> entries_;
    std::unordered_map<ContentAsker, glapi::ContentKey> promises_;
    std::size_t prune_at_ = kPruneFrom, without_room_ = 0;
    std::size_t most_names_;
};

}  // namespace wall::tileserver
