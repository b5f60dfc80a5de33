// SPDX-License-Identifier: MIT
// Codecs out of shared objects (wallgl_codec.h), loaded when they are named first. They run in this process: whoever
// may write to their folder may do what it does. Thread-safe.
#pragma once

#include <string_view>

#include "common/codec/codec.h"

namespace wall::codec {

/// The longest name that is looked for.
inline constexpr std::size_t kMaxLoadedName = 32;

/// That of WALLGL_CODECS (or, without it, of the folder that was set when this was built) with this name. An error says
/// why there is none: no file, or one that is no codec.
Result<const Codec*> find_loaded_codec(std::string_view name);

}  // namespace wall::codec
