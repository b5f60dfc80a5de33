// SPDX-License-Identifier: MIT
// Makes batches of a fuzzer's input: the first two bytes say how many opcodes follow, the rest are operands. So the
// sizes fit by themselves, and the fuzzer's work goes into the commands.
#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "common/wire/batch.h"
#include "gen/glapi/wire.gen.h"

namespace wall::fuzz {

inline std::vector<std::byte> batch_of(const std::uint8_t* data, std::size_t size, ContextId context) {
    if (size < 2) return {};
    const std::size_t opcodes = std::min<std::size_t>(data[0] | data[1] << 8, size - 2);
    std::vector<std::byte> codes(opcodes);
    for (std::size_t i = 0; i < opcodes; ++i)
        codes[i] = static_cast<std::byte>(data[2 + i] % (glapi::kOpCount + 1));  // one too many: unknown ones, too
    std::vector<std::byte> operands(wire::padded4(size - 2 - opcodes));
    if (!operands.empty()) std::memcpy(operands.data(), data + 2 + opcodes, size - 2 - opcodes);
    std::vector<std::byte> payload;
    wire::append_batch(payload, {context, codes, operands});
    return payload;
}

}  // namespace wall::fuzz
