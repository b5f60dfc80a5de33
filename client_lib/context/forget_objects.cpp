// SPDX-License-Identifier: MIT
#include "client_lib/context/forget_objects.h"

#include "client_lib/objects/share_group.h"

namespace wall::client {
namespace {

void forget(Context& c, ClientName id) {
    c.forget_object(id);
    std::lock_guard lock(c.share().mutex);
    c.share().by_id.erase(id);
}

}  // namespace

void forget_ranges(Context& c, VertexInput& input) {
    for (const auto& pieces : input.take_pieces()) forget(c, pieces->id);
}

void forget_inputs(Context& c, const std::vector<std::shared_ptr<VertexInput>>& inputs) {
    for (const auto& input : inputs) {
        forget_ranges(c, *input);
        forget(c, input->id);
    }
}

}  // namespace wall::client
