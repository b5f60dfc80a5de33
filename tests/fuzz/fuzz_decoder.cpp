// SPDX-License-Identifier: MIT
// The decoder alone: bounds of every command, blocks, whole payloads.
#include "gen/glapi/null_handler.gen.h"
#include "tests/fuzz/batch_input.h"

namespace {

void decode(std::span<const std::byte> payload) {
    const auto batch = wall::wire::split_batch(payload);
    wall::glapi::NullHandler handler;
    if (batch) (void)wall::glapi::decode(batch->opcodes, batch->operands, handler);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    decode(std::as_bytes(std::span(data, size)));
    decode(wall::fuzz::batch_of(data, size, wall::ContextId(1)));
    return 0;
}
