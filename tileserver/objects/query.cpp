// SPDX-License-Identifier: MIT
#include "tileserver/objects/query.h"

#include <cmath>
#include <utility>

namespace wall::tileserver {
namespace {

constexpr std::size_t kMaxParts = 256;      // then the driver is asked, so that its queries do not pile up
constexpr std::uint64_t kPartBytes = 1024;  // of the driver's memory, by estimate

}  // namespace

void QuerySum::add(std::shared_ptr<const DriverQuery> query, double scale) {
    if (parts_.size() >= kMaxParts) collect();
    parts_.push_back({std::move(query), scale});
}

std::uint64_t QuerySum::bytes() const { return parts_.size() * kPartBytes; }

void QuerySum::collect() {
    for (const Part& part : parts_) sum_ += static_cast<double>(part.query->result()) / part.scale;
    parts_.clear();
}

std::uint64_t QuerySum::result() {
    collect();
    return static_cast<std::uint64_t>(std::llround(sum_));
}

}  // namespace wall::tileserver
