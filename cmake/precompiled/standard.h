// SPDX-License-Identifier: MIT
// What most files include of the standard library, parsed once. Every file still includes what it uses: in the debug
// preset, without precompiled headers and batches, nothing is here by itself.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/base/result.h"
