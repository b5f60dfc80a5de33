// SPDX-License-Identifier: MIT
#include "tileserver/objects/assembly_uses.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>

#include "gen/glstate/state.gen.h"

namespace wall::tileserver {
namespace {

using glapi::TextureTarget;

struct TargetWord {
    std::string_view word;
    TextureTarget target;
};
/// With those of GL_ARB_fragment_program_shadow, and of NVIDIA's and MESA's options.
constexpr TargetWord kTargetWords[] = {
    {"1D", TextureTarget::t1d},
    {"2D", TextureTarget::t2d},
    {"3D", TextureTarget::t3d},
    {"CUBE", TextureTarget::cube_map},
    {"RECT", TextureTarget::rectangle},
    {"SHADOW1D", TextureTarget::t1d},
    {"SHADOW2D", TextureTarget::t2d},
    {"SHADOWRECT", TextureTarget::rectangle},
    {"ARRAY1D", TextureTarget::t1d_array},
    {"ARRAY2D", TextureTarget::t2d_array},
    {"SHADOWARRAY1D", TextureTarget::t1d_array},
    {"SHADOWARRAY2D", TextureTarget::t2d_array},
    {"SHADOWCUBE", TextureTarget::cube_map},
    {"BUFFER", TextureTarget::buffer},
};

std::optional<TextureTarget> target_called(std::string_view word) {
    const auto* found = std::ranges::find(kTargetWords, word, &TargetWord::word);
    return found == std::end(kTargetWords) ? std::nullopt : std::optional(found->target);
}

}  // namespace

std::vector<glapi::AssemblyTexture> find_textures(std::span<const AssemblyToken> tokens) {
    std::vector<glapi::AssemblyTexture> found;
    AssemblyCursor at(tokens);
    while (!at.at_end()) {
        if (at.take() != "texture") continue;
        const unsigned unit = at.take_subscript().value_or(0);
        if (!at.take(",")) continue;
        const auto target = target_called(at.take());
        if (!target) continue;
        const glapi::AssemblyTexture texture{unit, *target};
        if (std::ranges::find(found, texture) == found.end()) found.push_back(texture);
    }
    return found;
}

std::uint32_t find_generic_attributes(std::span<const AssemblyToken> tokens) {
    std::uint32_t found = 0;
    AssemblyCursor at(tokens);
    while (!at.at_end()) {
        if (at.take() != "vertex" || !at.take(".") || !at.take("attrib")) continue;
        const auto index = at.take_subscript();
        if (index && *index < glstate::el::vertex_attrib::count) found |= 1u << *index;
    }
    return found;
}

}  // namespace wall::tileserver
