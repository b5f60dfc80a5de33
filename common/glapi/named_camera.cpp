// SPDX-License-Identifier: MIT
#include "common/glapi/named_camera.h"

#include <algorithm>
#include <optional>

namespace wall::glapi {
namespace {

/// The element of the uniform that is called so; nothing: it is another one.
std::optional<PositionUniform> named(const std::string& name, const ActiveUniform& uniform) {
    if (name == uniform.name) return PositionUniform{uniform.name, 0};
    for (std::uint32_t element = 0; uniform.array && element < uniform.size; ++element)
        if (name == uniform.name + '[' + std::to_string(element) + ']') return PositionUniform{uniform.name, element};
    return std::nullopt;
}

std::optional<PositionUniform> find(const std::vector<std::string>& names, const std::vector<ActiveUniform>& uniforms) {
    for (const std::string& name : names)
        for (const ActiveUniform& uniform : uniforms) {
            if (uniform.type != GL_FLOAT_MAT4 || !uniform.has_location()) continue;
            if (auto found = named(name, uniform)) return found;
        }
    return std::nullopt;
}

}  // namespace

void name_camera(PositionProgram& position, const std::vector<std::string>& names,
                 const std::vector<ActiveUniform>& uniforms) {
    if (position.camera) return;
    auto wanted = find(names, uniforms);
    if (!wanted) return;
    const auto at = std::ranges::find(position.uniforms, *wanted);
    position.camera = static_cast<std::uint32_t>(at - position.uniforms.begin());
    if (at == position.uniforms.end()) position.uniforms.push_back(*std::move(wanted));
}

}  // namespace wall::glapi
