// SPDX-License-Identifier: MIT
// One thread.
#pragma once

#include <string>

#include "common/base/result.h"

namespace wall::wallctl {

/// The X server answers, and has GLX, by which programs choose what their windows look like.
Result<void> check_display(const std::string& name);

}  // namespace wall::wallctl
