// SPDX-License-Identifier: MIT
// Asks the kernel what a graphics card has (libdrm). Render thread.
#pragma once

#include <string>

#include "common/base/result.h"
#include "tileserver/kms/card.h"

namespace wall::tileserver {

/// `file`: the open card, of an atomic client. Monitors are asked anew. What goes while it is asked for is left out.
Result<Card> describe_card(int file, const std::string& name);

}  // namespace wall::tileserver
