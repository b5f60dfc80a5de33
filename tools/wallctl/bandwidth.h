// SPDX-License-Identifier: MIT
// How fast what a program draws gets from this machine to each node: the doctor is a program without a window for a
// moment, and sends buffers over the ways that programs take. Blocks, about a second a node; one thread.
#pragma once

#include <functional>

#include "common/base/result.h"
#include "tools/request/request.h"
#include "tools/wallctl/diagnosis.h"

namespace wall::wallctl {

/// To all nodes that are up, from one to the next; `measured` is called after each. An error: walld takes no program
/// from here.
Result<void> measure_ways(const request::Walld& walld, const std::function<void(const Way&)>& measured);

}  // namespace wall::wallctl
