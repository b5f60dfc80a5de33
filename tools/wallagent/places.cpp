// SPDX-License-Identifier: MIT
#include "tools/wallagent/places.h"

#include <vector>

namespace wall::wallagent {

std::shared_ptr<Places::Place> Places::take() {
    if (taken_->size() >= most_) return nullptr;
    return std::shared_ptr<Place>(new Place(taken_));
}

void Places::end_all() {
    std::vector<std::function<void()>> ends;  // an end may free its place
    for (const auto* place : *taken_) ends.push_back(place->end_);
    for (const auto& end : ends)
        if (end) end();
}

}  // namespace wall::wallagent
