// SPDX-License-Identifier: MIT
#include "client_lib/context/es_version.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <string_view>

#include "client_lib/context/es_words.h"
#include "client_lib/context/node_words.h"

namespace wall::client {
namespace {

/// What a version asks for besides its commands; one without a line is not offered.
struct Beyond {
    int version;
    const char* shading_language;
    const char* node_word;  ///< what a node's driver must have for it
};
constexpr Beyond kBeyond[] = {
    {20, "1.00", "GL_ARB_ES2_compatibility"},
    {30, "3.00", "GL_ARB_ES3_compatibility"},
};

/// Of each word, the first version that has it; 0: none.
const std::array<std::uint8_t, 0x10000>& first_versions() {
    static const auto* table = [] {
        auto* made = new std::array<std::uint8_t, 0x10000>{};  // never destroyed: programs draw in exit handlers
        for (const EsWord& word : kEsWords) (*made)[word.value] = static_cast<std::uint8_t>(word.since);
        return made;
    }();
    return *table;
}

std::vector<std::string> es_extensions(const Caps& caps) {
    const NodeWords node(caps);
    std::vector<std::string> offered;
    for (const EsExtension& extension : kEsExtensions)
        if (extension.implemented && (*extension.node_word == '\0' || node.have(extension.node_word)))
            offered.emplace_back(extension.name);
    return offered;
}

/// The last version up to a context's that a node's driver can do; the first one is never missing.
const Beyond& offered_beyond(unsigned version, const Caps& caps) {
    const NodeWords node(caps);
    const Beyond* offered = kBeyond;
    for (const Beyond& beyond : kBeyond)
        if (static_cast<unsigned>(beyond.version) <= version && node.have(beyond.node_word)) offered = &beyond;
    return *offered;
}

}  // namespace

unsigned implemented_es_version() {
    unsigned offered = 0;
    for (const EsVersion& each : kEsVersions) {
        if (each.missing || std::ranges::find(kBeyond, each.version, &Beyond::version) == std::end(kBeyond)) break;
        offered = static_cast<unsigned>(each.version);
    }
    return offered;
}

bool is_es_implemented(int major, int minor) {
    const auto known = std::ranges::any_of(
        kEsVersions, [&](const EsVersion& each) { return each.version == major * 10 + minor && minor < 10; });
    return known && static_cast<unsigned>(major * 10 + minor) <= implemented_es_version();
}

const GlTable& es_table(unsigned version) {
    const auto found = std::ranges::find(kEsVersions, static_cast<int>(version), &EsVersion::version);
    return found == kEsVersions.end() ? *kEsVersions.front().table : *found->table;
}

bool is_es_word(unsigned version, GLenum word) {
    const unsigned since = word < first_versions().size() ? first_versions()[word] : 0u;
    return since != 0 && since <= version;
}

GlVersion version_in(const ContextProfile& profile, const Caps& caps) {
    if (profile.es == 0) return offered_version(caps);
    const Beyond& beyond = offered_beyond(profile.es, caps);
    return {beyond.version / 10, beyond.version % 10, beyond.shading_language};
}

std::string version_text_in(const ContextProfile& profile, const Caps& caps) {
    if (profile.es == 0) return version_string(caps, profile);
    const GlVersion version = version_in(profile, caps);
    return "OpenGL ES " + std::to_string(version.major) + "." + std::to_string(version.minor) + " " + kWallVersion;
}

std::string shading_language_in(const ContextProfile& profile, const Caps& caps) {
    const char* language = version_in(profile, caps).shading_language;
    if (!language) return {};
    return profile.es == 0 ? language : std::string("OpenGL ES GLSL ES ") + language;
}

std::vector<GLenum> listed_block_formats(const ContextProfile& profile, const Caps& caps) {
    const NodeWords node(caps);
    std::vector<GLenum> formats;
    const auto add = [&](const char* node_word, std::initializer_list<GLenum> more) {
        if (node.have(node_word)) formats.insert(formats.end(), more);
    };
    add("GL_EXT_texture_compression_s3tc",
        {GL_COMPRESSED_RGB_S3TC_DXT1_EXT, GL_COMPRESSED_RGBA_S3TC_DXT3_EXT, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT});
    if (profile.es != 0) add("GL_EXT_texture_compression_s3tc", {GL_COMPRESSED_RGBA_S3TC_DXT1_EXT});
    add("GL_ARB_ES3_compatibility",
        {GL_COMPRESSED_RGB8_ETC2, GL_COMPRESSED_RGBA8_ETC2_EAC, GL_COMPRESSED_R11_EAC, GL_COMPRESSED_RG11_EAC,
         GL_COMPRESSED_SIGNED_R11_EAC, GL_COMPRESSED_SIGNED_RG11_EAC, GL_COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2});
    if (profile.es != 0)
        add("GL_ARB_ES3_compatibility", {GL_COMPRESSED_SRGB8_ETC2, GL_COMPRESSED_SRGB8_ALPHA8_ETC2_EAC,
                                         GL_COMPRESSED_SRGB8_PUNCHTHROUGH_ALPHA1_ETC2});
    return formats;
}

std::vector<std::string> extensions_in(const ContextProfile& profile, const Caps& caps) {
    return profile.es == 0 ? offered_extensions(caps, profile) : es_extensions(caps);
}

}  // namespace wall::client
