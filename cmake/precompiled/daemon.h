// SPDX-License-Identifier: MIT
// What speaks the control protocol, with logging and JSON: the daemons and the operator's programs.
#pragma once

#include <nlohmann/json.hpp>

#include "cmake/precompiled/net.h"
#include "common/log/log.h"
