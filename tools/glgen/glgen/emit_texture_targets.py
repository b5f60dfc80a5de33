# SPDX-License-Identifier: MIT
"""gen/glapi/texture_targets.gen.h: what is known of each texture target; gen/glstate/texture_elements.gen.h: its
elements of the state."""

from .text import header

SOURCE = "proto/gl/texture_targets.toml"
NOTES = """
The texture targets and what is known of each; common/glapi/texture_target.h finds one by GL's words.
"""
ELEMENT_NOTES = """
The state elements of the texture targets.
"""

_INFO = """\
/// What is known of a target; of GL's words, 0: there is none.
struct TextureTargetInfo {
    TextureTarget id;
    GLenum target;
    GLenum proxy;
    GLenum first_face;      ///< of six numbers in a row, one for each face that has images
    GLenum global;          ///< GL_GLOBAL_TEXTURE_...: a name of it means the same to all processes of a program
    GLenum size_limit;      ///< glGet's word for the largest image
    GLint usual_size;       ///< what that is where no node has said so
    std::uint8_t images;    ///< dimensions of the commands that give it images; 0: it gets none by such
    std::uint8_t layers;    ///< 0: none; else the last dimension counts them, by as many, and mipmaps keep them
    bool samples;           ///< texels have several samples
    bool square;            ///< an image is as high as it is wide
    bool mipmaps;           ///< false: it has level 0 only, and no border
    bool repeats;           ///< false: coordinates are texels, and nothing is outside but the edge
    bool blocks;            ///< images may be compressed in blocks
};

"""


def targets_header(targets):
    out = [header(SOURCE, NOTES, ["<array>", "<cstddef>", "<cstdint>"]),
           '\n#include "common/glapi/gl_types.h"\n\nnamespace wall::glapi {\n\n'
           "/// In the order of their bindings among the elements of the state.\n"
           "enum class TextureTarget : std::uint8_t {\n"]
    out += [f"    {t.constant},\n" for t in targets]
    out.append(f"}};\ninline constexpr std::size_t kTextureTargets = {len(targets)};\n\n")
    out.append(_INFO)
    out.append("inline constexpr std::array<TextureTargetInfo, kTextureTargets> kTextureTargetInfo = {{\n")
    out += [f"    {{{', '.join(_row(t))}}},\n" for t in targets]
    out.append("}};\n\n/// A type of GLSL that looks up a texture.\n"
               "struct SamplerType {\n    GLenum type;\n    TextureTarget target;\n};\n"
               "inline constexpr auto kSamplerTypes = std::to_array<SamplerType>({\n")
    out += [f"    {{{type_}, TextureTarget::{t.constant}}},\n"
            for t in targets for type_ in t.samplers]
    out.append("});\n\n/// The same of types that read and write single texels of one.\n"
               "inline constexpr auto kImageTypes = std::to_array<SamplerType>({\n")
    out += [f"    {{{type_.replace('SAMPLER', 'IMAGE')}, TextureTarget::{t.constant}}},\n"
            for t in targets for type_ in t.samplers if not type_.endswith("_SHADOW")]
    out.append("});\n\n}  // namespace wall::glapi\n")
    return "".join(out)


def _row(t):
    words = {"target": t.gl, "proxy": t.proxy, "first_face": t.first_face, "global": hex(t.says("global", 0)),
             "size_limit": t.size_name}
    flags = (("samples", False), ("square", False), ("mipmaps", True), ("repeats", True), ("blocks", False))
    return [f".id = TextureTarget::{t.constant}",
            *(f".{name} = {word or 0}" for name, word in words.items()),
            f".usual_size = {t.size_otherwise}", f".images = {t.says('images')}",
            f".layers = {t.says('layers', 0)}",
            *(f".{key} = {str(t.says(key, otherwise)).lower()}" for key, otherwise in flags)]


def elements_header(targets):
    first, switched = targets[0].binding.name, next(t.enabled.name for t in targets if t.enabled)
    out = [header(SOURCE, ELEMENT_NOTES, ["<array>"]),
           '\n#include "gen/glapi/texture_targets.gen.h"\n#include "gen/glstate/state.gen.h"\n'
           "\nnamespace wall::glstate {\n\n"
           "/// What is bound to each target, by texture unit: state.textures.*kTextureBindings[target].\n"
           f"using TextureBinding = decltype(&TexturesState::{first});\n"
           "inline constexpr std::array<TextureBinding, glapi::kTextureTargets> kTextureBindings = {\n"]
    out += [f"    &TexturesState::{t.binding.name},\n" for t in targets]
    out.append("};\n\n/// Whether fixed functions draw with each target, by texture unit; null: they never do.\n"
               f"using TextureSwitch = decltype(&TextureUnitsState::{switched});\n"
               "inline constexpr std::array<TextureSwitch, glapi::kTextureTargets> kTextureSwitches = {\n")
    out += [f"    &TextureUnitsState::{t.enabled.name},\n" if t.enabled else "    nullptr,\n" for t in targets]
    out.append("};\n\n/// Calls `use` with the element of what is bound to a target.\ntemplate <class Use>\n"
               "decltype(auto) with_binding(glapi::TextureTarget target, Use&& use) {\n    switch (target) {\n")
    out += [f"        case glapi::TextureTarget::{t.constant}: return use(el::{t.binding.name}{{}});\n"
            for t in targets[1:]]
    out.append("        default: break;\n    }\n"
               f"    return use(el::{first}{{}});\n}}\n\n}}  // namespace wall::glstate\n")
    return "".join(out)
