// SPDX-License-Identifier: MIT
// Whether shaders only read a block of storage, which no driver tells. Pure.
#pragma once

#include <string_view>

#include "common/glapi/program_format.h"

namespace wall::tileserver {

/// Whether every declaration of the block ("Name" or, of an array, "Name[2]") says `readonly` of the block itself.
/// False where that is not plain to see, as when macros declare it.
bool is_only_read(const glapi::ProgramDefinition& definition, std::string_view block);

}  // namespace wall::tileserver
