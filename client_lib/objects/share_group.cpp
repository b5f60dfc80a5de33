// SPDX-License-Identifier: MIT
#include "client_lib/objects/share_group.h"

#include <set>

namespace wall::client {
namespace {

struct Groups {
    std::mutex mutex;  // taken before a group's
    std::set<ShareGroup*> all;
};

/// Never destroyed: contexts may live longer than what the process destroys at its end.
Groups& groups() {
    static auto& groups = *new Groups;
    return groups;
}

}  // namespace

ShareGroup::ShareGroup() {
    std::lock_guard lock(groups().mutex);
    groups().all.insert(this);
}

ShareGroup::~ShareGroup() {
    std::lock_guard lock(groups().mutex);
    groups().all.erase(this);
}

void for_each_share_group(const std::function<void(ShareGroup&)>& use) {
    std::lock_guard lock(groups().mutex);
    for (ShareGroup* const group : groups().all) use(*group);
}

}  // namespace wall::client
