// SPDX-License-Identifier: MIT
// wall.toml is an operator's own, but a slip in it must give a sentence, never a crash.
#include "common/config/load_config.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto config = wall::config::parse_config({reinterpret_cast<const char*>(data), size}, "wall.toml");
    if (!config && !config.error().message.starts_with("wall.toml:")) __builtin_trap();
    if (config && config->canvas().empty()) __builtin_trap();
    return 0;
}
