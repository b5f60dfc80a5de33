// SPDX-License-Identifier: MIT
// Small files that are replaced whole: after a crash there is the old content or the new, never a part. Any thread.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string_view>

#include "common/base/result.h"

namespace wall {

/// Writes `text` beside `path` and gives it that name; `mode` as for open(2). The folder must be there.
Result<void> write_whole(const std::filesystem::path& path, std::string_view text, mode_t mode);

}  // namespace wall
