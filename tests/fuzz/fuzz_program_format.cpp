// SPDX-License-Identifier: MIT
// Programs as clients define them, and what nodes and compilers say of them: what is read is written as it was read,
// and a position that is valid can be evaluated. The first byte says which of the three it is.
#include <array>
#include <vector>

#include "common/base/assert.h"
#include "common/glapi/program_format.h"

namespace {

using namespace wall::glapi;

void evaluate_position(const PositionProgram& position) {
    if (!position.known()) return;
    static constexpr std::array<float, 16> kOnes = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const std::vector<std::span<const float>> uniforms(position.uniforms.size(), kOnes);
    if (const auto found = evaluate(position, {uniforms, kOnes, kOnes})) (void)found->matrix();
}

/// Numbers may be none, so the bytes are compared.
template <class Decoded>
bool stays(const std::optional<Decoded>& decoded, std::optional<Decoded> (*decode)(std::span<const std::byte>)) {
    const auto bytes = encode(*decoded);
    const auto again = decode(bytes);
    return again && encode(*again) == bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 1) return 0;
    const auto bytes = std::as_bytes(std::span(data + 1, size - 1));
    if (data[0] % 3 == 0) {
        const auto definition = decode_definition(bytes);
        if (!definition) return 0;
        WALL_ASSERT(stays(definition, decode_definition));
        evaluate_position(definition->position);
    } else if (data[0] % 3 == 1) {
        const auto reflection = decode_reflection(bytes);
        if (!reflection) return 0;
        WALL_ASSERT(stays(reflection, decode_reflection));
        evaluate_position(reflection->position);
        (void)number_uniforms(reflection->uniforms);
    } else {
        const auto result = decode_compile_result(bytes);
        WALL_ASSERT(!result || stays(result, decode_compile_result));
    }
    return 0;
}
