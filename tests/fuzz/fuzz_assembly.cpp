// SPDX-License-Identifier: MIT
// Assembly programs as clients send them: whatever their text is, what nodes look into takes it, and a position that is
// recognised has a meaning. The first byte says whether the rest is a text, a definition, or what a compiler says.
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/assert.h"
#include "common/glapi/assembly_format.h"
#include "tileserver/objects/assembly_patch.h"
#include "tileserver/objects/assembly_position.h"
#include "tileserver/objects/assembly_tokens.h"
#include "tileserver/objects/assembly_uses.h"

namespace {

using namespace wall;

void evaluate_position(const glapi::PositionProgram& position) {
    static constexpr std::array<float, 16> kOnes = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    glapi::LinkedPosition linked = glapi::link_position(position);
    if (const auto* transform = linked.transform(kOnes, kOnes)) (void)transform->matrix();
    (void)glapi::position_attribute(position);
}

void look_into(std::string_view text) {
    const auto tokens = tileserver::assembly_tokens(text);
    std::size_t behind = 0;
    for (const tileserver::AssemblyToken& token : tokens) {
        WALL_ASSERT(token.at >= behind && !token.text.empty() && token.behind() <= text.size());
        behind = token.behind();
    }
    (void)tileserver::find_textures(tokens);
    (void)tileserver::find_generic_attributes(tokens);
    (void)tileserver::patch_fragment_program(std::string(text), 254);
    const auto found = tileserver::recognise_assembly_position(text);
    WALL_ASSERT(glapi::is_valid(found.program));
    evaluate_position(found.program);
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
    if (data[0] == 1) {
        const auto definition = glapi::decode_assembly_definition(bytes);
        if (!definition) return 0;
        WALL_ASSERT(stays(definition, glapi::decode_assembly_definition));
        evaluate_position(definition->position);
    } else if (data[0] == 2) {
        const auto reflection = glapi::decode_assembly_reflection(bytes);
        if (!reflection) return 0;
        WALL_ASSERT(stays(reflection, glapi::decode_assembly_reflection));
        evaluate_position(reflection->position);
    } else {
        look_into({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
    return 0;
}
