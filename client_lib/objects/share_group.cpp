// SPDX-License-Identifier: MIT
#include "client_lib/objects/share_group.h"

namespace wall::client {

ShareGroup::ShareGroup() = default;
ShareGroup::~ShareGroup() = default;

}  // namespace wall::client
