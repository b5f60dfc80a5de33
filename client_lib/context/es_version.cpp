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
    const char* shading_language;  ///< null: it has none
    const char* node_word;         ///< what a node's driver must have for it; empty: nothing
    const char* other_word = "";   ///< likewise
};
constexpr Beyond kBeyond[] = {
    {11, nullptr, ""},
    {20, "1.00", "GL_ARB_ES2_compatibility"},
    {30, "3.00", "GL_ARB_ES3_compatibility"},
    {31, "3.10", "GL_ARB_ES3_1_compatibility"},
    {32, "3.20", "GL_ARB_ES3_2_compatibility", "GL_KHR_texture_compression_astc_ldr"},
};

struct WordVersions {
    std::uint8_t since : 7;  ///< the first one of those with shaders; 0: none
    std::uint8_t first : 1;  ///< whether OpenGL ES 1.1 has it
};
static_assert(sizeof(WordVersions) == 1);

const std::array<WordVersions, 0x10000>& word_versions() {
    static const auto* table = [] {
        auto* made = new std::array<WordVersions, 0x10000>{};  // never destroyed: programs draw in exit handlers
        for (const EsWord& word : kEsWords)
            (*made)[word.value] = {static_cast<std::uint8_t>(word.since & 0x7F), word.first};
        return made;
    }();
    return *table;
}

bool has_word(const NodeWords& node, const char* word) { return *word == '\0' || node.have(word); }
bool can_do(const NodeWords& node, const Beyond& version) {
    return has_word(node, version.node_word) && has_word(node, version.other_word);
}

std::vector<std::string> es_extensions(unsigned version, const Caps& caps) {
    const NodeWords node(caps);
    std::vector<std::string> offered;
    for (const EsExtension& extension : kEsExtensions)
        if (extension.implemented && (is_first_es(version) ? extension.first : extension.later) &&
            has_word(node, extension.node_word))
            offered.emplace_back(extension.name);
    return offered;
}

/// The last version of a context's kind, up to its own, that a node's driver can do; the first one is never missing.
const Beyond& offered_beyond(unsigned version, const Caps& caps) {
    const NodeWords node(caps);
    const Beyond* offered = nullptr;
    for (const Beyond& beyond : kBeyond) {
        const auto number = static_cast<unsigned>(beyond.version);
        if (is_first_es(number) != is_first_es(version) || number > version) continue;
        if (!offered || can_do(node, beyond)) offered = &beyond;
    }
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

// OpenGL ES 1.1 does for 1.0 (EGL 1.5, 3.7.1.1).
unsigned es_version_for(int major, int minor) {
    if (major == 1 && minor == 0) minor = 1;
    const auto known = std::ranges::any_of(
        kEsVersions, [&](const EsVersion& each) { return each.version == major * 10 + minor && minor < 10; });
    const unsigned latest = implemented_es_version(), wanted = static_cast<unsigned>(major * 10 + minor);
    if (!known || wanted > latest) return 0;
    return is_first_es(wanted) ? wanted : latest;
}

const GlTable& es_table(unsigned version) {
    const auto found = std::ranges::find(kEsVersions, static_cast<int>(version), &EsVersion::version);
    return found == kEsVersions.end() ? *kEsVersions.back().table : *found->table;
}

bool is_es_word(unsigned version, GLenum word) {
    if (word >= word_versions().size()) return false;
    const auto [since, first] = word_versions()[word];
    return is_first_es(version) ? first != 0 : since != 0 && since <= version;
}

GlVersion version_in(const ContextProfile& profile, const Caps& caps) {
    if (!profile.is_es()) return offered_version(caps);
    const Beyond& beyond = offered_beyond(profile.es, caps);
    return {beyond.version / 10, beyond.version % 10, beyond.shading_language};
}

std::string version_text_in(const ContextProfile& profile, const Caps& caps) {
    if (!profile.is_es()) return version_string(caps, profile);
    const GlVersion version = version_in(profile, caps);
    const char* kind = profile.is_es1() ? "OpenGL ES-CM " : "OpenGL ES ";  // OpenGL ES 1.1, 6.1.4
    return kind + std::to_string(version.major) + "." + std::to_string(version.minor) + " " + kWallVersion;
}

std::string shading_language_in(const ContextProfile& profile, const Caps& caps) {
    const char* language = version_in(profile, caps).shading_language;
    if (!language) return {};
    return !profile.is_es() ? language : std::string("OpenGL ES GLSL ES ") + language;
}

std::vector<std::string> shading_languages_in(const ContextProfile& profile, const Caps& caps) {
    std::vector<std::string> out;
    if (profile.es == 0) out = shading_languages(caps, profile);
    for (const Beyond& beyond : kBeyond) {
        const bool has = profile.es != 0 ? static_cast<unsigned>(beyond.version) <= profile.es
                                         : static_cast<unsigned>(beyond.version) <= implemented_es_version();
        if (has && *beyond.node_word != '\0' && can_do(NodeWords(caps), beyond))
            out.push_back(beyond.version == 20 ? "100" : std::to_string(beyond.version * 10) + " es");
    }
    return out;
}

std::vector<GLenum> listed_block_formats(const ContextProfile& profile, const Caps& caps) {
    const NodeWords node(caps);
    std::vector<GLenum> formats;
    const auto add = [&](const char* node_word, std::initializer_list<GLenum> more) {
        if (node.have(node_word)) formats.insert(formats.end(), more);
    };
    add("GL_EXT_texture_compression_s3tc",
        {GL_COMPRESSED_RGB_S3TC_DXT1_EXT, GL_COMPRESSED_RGBA_S3TC_DXT3_EXT, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT});
    if (profile.is_es()) add("GL_EXT_texture_compression_s3tc", {GL_COMPRESSED_RGBA_S3TC_DXT1_EXT});
    if (profile.is_es()) add("GL_ARB_ES3_compatibility", {GL_ETC1_RGB8_OES});
    if (profile.is_es1()) {
        for (GLenum format = GL_PALETTE4_RGB8_OES; format <= GL_PALETTE8_RGB5_A1_OES; ++format)
            formats.push_back(format);
        return formats;
    }
    add("GL_ARB_ES3_compatibility",
        {GL_COMPRESSED_RGB8_ETC2, GL_COMPRESSED_RGBA8_ETC2_EAC, GL_COMPRESSED_R11_EAC, GL_COMPRESSED_RG11_EAC,
         GL_COMPRESSED_SIGNED_R11_EAC, GL_COMPRESSED_SIGNED_RG11_EAC, GL_COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2});
    if (!profile.is_es()) return formats;
    add("GL_ARB_ES3_compatibility",
        {GL_COMPRESSED_SRGB8_ETC2, GL_COMPRESSED_SRGB8_ALPHA8_ETC2_EAC, GL_COMPRESSED_SRGB8_PUNCHTHROUGH_ALPHA1_ETC2});
    add("GL_ARB_texture_compression_rgtc", {GL_COMPRESSED_RED_RGTC1, GL_COMPRESSED_SIGNED_RED_RGTC1,
                                            GL_COMPRESSED_RG_RGTC2, GL_COMPRESSED_SIGNED_RG_RGTC2});
    add("GL_ARB_texture_compression_bptc",
        {GL_COMPRESSED_RGBA_BPTC_UNORM, GL_COMPRESSED_SRGB_ALPHA_BPTC_UNORM, GL_COMPRESSED_RGB_BPTC_SIGNED_FLOAT,
         GL_COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT});
    if (!node.have("GL_KHR_texture_compression_astc_ldr")) return formats;
    for (GLenum size = 0; size <= GL_COMPRESSED_RGBA_ASTC_12x12_KHR - GL_COMPRESSED_RGBA_ASTC_4x4_KHR; ++size)
        for (const GLenum first : {GL_COMPRESSED_RGBA_ASTC_4x4_KHR, GL_COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR})
            formats.push_back(first + size);
    return formats;
}

std::vector<std::string> extensions_in(const ContextProfile& profile, const Caps& caps) {
    return !profile.is_es() ? offered_extensions(caps, profile) : es_extensions(profile.es, caps);
}

}  // namespace wall::client
