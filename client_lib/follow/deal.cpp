// SPDX-License-Identifier: MIT
#include "client_lib/follow/deal.h"

#include <algorithm>
#include <numeric>

namespace wall::client {
namespace {

constexpr double kNewest = 0.25;  // weight of what was measured last: frames differ, and so do their parts
constexpr double kFarthest = 8;   // times the mean: a node that stood still for a moment is not left out for long

}  // namespace

void NodePaces::note(NodeIndex node, double elements, std::chrono::nanoseconds took) {
    if (elements <= 0) return;
    const double pace = static_cast<double>(took.count()) / elements;
    const auto [known, anew] = paces_.try_emplace(node, pace);
    if (!anew) known->second += kNewest * (pace - known->second);
}

std::vector<double> NodePaces::ends(std::span<const NodeIndex> nodes) const {
    std::vector<double> paces;
    for (const NodeIndex node : nodes)
        if (const auto known = paces_.find(node); known != paces_.end()) paces.push_back(known->second);
    const double mean =
        paces.empty()
            ? 1
            : std::max(std::accumulate(paces.begin(), paces.end(), 0.0) / static_cast<double>(paces.size()), 1e-3);
    std::vector<double> ends;
    double sum = 0;
    for (const NodeIndex node : nodes) {
        const auto known = paces_.find(node);
        const double pace =
            known == paces_.end() ? mean : std::clamp(known->second, mean / kFarthest, mean * kFarthest);
        ends.push_back(sum += 1 / pace);
    }
    for (double& end : ends) end /= sum;
    return ends;
}

}  // namespace wall::client
