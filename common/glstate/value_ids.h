// SPDX-License-Identifier: MIT
// Value ids: what was proven equal once need not be compared again. They form two levels, as the bits of the hierarchy
// in Tracking Graphics State (section 4) do: one id for each category's values, and a version over all of them.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "common/glstate/values.h"

namespace wall::glstate {

/// A fresh value id; unique in the process, and neither 0, which names nothing, nor 1, the defaults'. A thread takes
/// them in blocks, so that most cost no atomic operation.
inline std::uint64_t next_value_id() {
    constexpr std::uint64_t kBlock = 1024;
    static std::atomic<std::uint64_t> taken{0};
    [[gnu::tls_model("initial-exec")]] constinit thread_local std::uint64_t next = 0;
    if (next % kBlock == 0) next = taken.fetch_add(kBlock, std::memory_order_relaxed) + 2;  // the block is used up
    return next++;
}

/// The ids of one state. Those of a category are equal only where its values are; 1: the defaults. The version names
/// what a follower of the state must hold, as far as it follows: one of the same version needs nothing to be told. One
/// thread at a time.
template <std::size_t Count>
class ValueIds {
public:
    const std::uint64_t& operator[](std::size_t category) const { return each_[category]; }
    /// The category has got values that no other id is known to name.
    void renew(std::size_t category) { each_[category] = version_ = next_value_id(); }
    /// The category has the values that another one's id names.
    void take(std::size_t category, std::uint64_t named) {
        if (each_[category] == named) return;
        each_[category] = named;
        version_ = kNoVersion;
    }
    /// This state has been brought to what the other one wants. If that changed nothing, the other one wants the same
    /// as the one before.
    void follow(ValueIds& other) {
        if (version_ != kNoVersion) {
            other.version_ = version_;
            return;
        }
        if (other.version_ == kNoVersion) other.version_ = next_value_id();
        version_ = other.version_;
    }
    bool follows(const ValueIds& other) const { return version_ != kNoVersion && version_ == other.version_; }
    /// By the ids alone.
    bool operator==(const ValueIds& other) const { return each_ == other.each_; }

private:
    static constexpr std::uint64_t kNoVersion = 0;  // changed, and not followed since
    std::array<std::uint64_t, Count> each_ = filled<std::array<std::uint64_t, Count>>(1);
    std::uint64_t version_ = 1;
};

}  // namespace wall::glstate
