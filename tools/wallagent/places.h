// SPDX-License-Identifier: MIT
// How many connections are served at once, and the way to end all of them. One thread.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <set>

namespace wall::wallagent {

class Places {
public:
    /// Of one connection; it is free again when its last owner has gone.
    class Place {
    public:
        Place(const Place&) = delete;
        Place& operator=(const Place&) = delete;
        ~Place() { taken_->erase(this); }
        /// What end_all() calls.
        void ends_with(std::function<void()> end) { end_ = std::move(end); }

    private:
        friend class Places;
        using Taken = std::set<Place*>;
        explicit Place(std::shared_ptr<Taken> taken) : taken_(std::move(taken)) { taken_->insert(this); }
        std::shared_ptr<Taken> taken_;
        std::function<void()> end_;
    };

    explicit Places(std::size_t most) : most_(most) {}

    /// Null: all are taken.
    std::shared_ptr<Place> take();
    void end_all();

private:
    const std::size_t most_;
    std::shared_ptr<Place::Taken> taken_ = std::make_shared<Place::Taken>();  // places may outlive us
};

}  // namespace wall::wallagent
