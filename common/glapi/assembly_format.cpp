// SPDX-License-Identifier: MIT
#include "common/glapi/assembly_format.h"

#include <array>
#include <charconv>
#include <iterator>
#include <utility>

#include "common/glapi/format_stream.h"
#include "common/glapi/texture_target.h"

namespace wall::glapi {
namespace {

AssemblyTexture read_texture(FormatReader& from) {
    const std::uint32_t unit = from.word(), target = from.word();
    if (target >= kTextureTargets) from.fail();
    return {unit, target < kTextureTargets ? static_cast<TextureTarget>(target) : TextureTarget{}};
}

}  // namespace

LinkedPosition link_position(PositionProgram position) {
    std::vector<std::uint32_t> locations;
    for (const PositionUniform& parameter : position.uniforms) {
        if (parameter.element >= kMostLocalParameters) return {};
        if (parameter.name != kLocalParameter && parameter.name != kEnvParameter) return {};
        locations.push_back(parameter.element + (parameter.name == kEnvParameter ? kEnvLocations : 0));
    }
    LinkedPosition linked(std::move(position), locations);
    constexpr std::array<std::uint32_t, 4> kZero{};
    for (const std::uint32_t location : locations) linked.set(location, kZero.size(), kZero);
    return linked;
}

std::int32_t position_attribute(const PositionProgram& position) {
    const std::string& name = position.attribute;
    if (!position.known()) return -1;
    if (name == "gl_Vertex") return 0;
    std::int32_t index = -1;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
    return error == std::errc() && end == name.data() + name.size() ? index : -1;
}

std::vector<std::byte> encode(const AssemblyReflection& reflection) {
    FormatWriter to;
    to.put(reflection.compiled);
    to.put(reflection.error_position);
    to.put(reflection.message);
    to.put(reflection.counts);
    to.put(reflection.native);
    to.list(reflection.textures,
            [&](const AssemblyTexture& t) { to.put(t.unit), to.put(static_cast<std::uint32_t>(t.target)); });
    to.put(reflection.invariant);
    to.put(reflection.position);
    return std::move(to.out);
}

std::optional<AssemblyReflection> decode_assembly_reflection(std::span<const std::byte> bytes) {
    FormatReader from(bytes);
    AssemblyReflection out;
    out.compiled = from.flag();
    out.error_position = from.number();
    out.message = from.text();
    out.counts = from.words();
    if (out.counts.size() != (out.compiled ? std::size(kAssemblyWords) : 0)) from.fail();
    out.native = from.flag();
    from.list(out.textures, [&] { return read_texture(from); });
    out.invariant = from.flag();
    out.position = from.position();
    return if_complete(from, std::move(out));
}

std::vector<std::byte> encode(const AssemblyDefinition& definition) {
    FormatWriter to;
    to.put(definition.source);
    to.put(definition.invariant);
    to.put(definition.position);
    return std::move(to.out);
}

std::optional<AssemblyDefinition> decode_assembly_definition(std::span<const std::byte> bytes) {
    FormatReader from(bytes);
    AssemblyDefinition out{from.text(), from.flag(), from.position()};
    return if_complete(from, std::move(out));
}

}  // namespace wall::glapi
