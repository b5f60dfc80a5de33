// SPDX-License-Identifier: MIT
#include "client_lib/context/es_version.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>

#include "client_lib/context/es_words.h"

namespace wall::client {
namespace {

/// What a version asks for besides its commands, as far as it is known to be missing, and its shading language.
struct Beyond {
    int version;
    const char* shading_language;
    bool met;
};
constexpr Beyond kBeyond[] = {
    {20, "1.00", true}, {30, "3.00", false},  // images in the blocks of ETC2 and EAC
};

const Beyond* beyond_of(int version) {
    const auto* found = std::ranges::find(kBeyond, version, &Beyond::version);
    return found == std::end(kBeyond) ? nullptr : found;
}

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
    std::istringstream words(caps.extensions);
    const std::vector<std::string> node{std::istream_iterator<std::string>(words), {}};
    std::vector<std::string> offered;
    for (const EsExtension& extension : kEsExtensions)
        if (extension.implemented &&
            (*extension.node_word == '\0' || std::ranges::find(node, extension.node_word) != node.end()))
            offered.emplace_back(extension.name);
    return offered;
}

std::string as_text(unsigned version) { return std::to_string(version / 10) + "." + std::to_string(version % 10); }

}  // namespace

unsigned implemented_es_version() {
    unsigned offered = 0;
    for (const EsVersion& each : kEsVersions) {
        const Beyond* beyond = beyond_of(each.version);
        if (each.missing || !beyond || !beyond->met) break;
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
    const auto version = static_cast<int>(profile.es);
    const Beyond* beyond = beyond_of(version);
    return {version / 10, version % 10, beyond ? beyond->shading_language : nullptr};
}

std::string version_text_in(const ContextProfile& profile, const Caps& caps) {
    if (profile.es == 0) return version_string(caps, profile);
    return "OpenGL ES " + as_text(profile.es) + " " + kWallVersion;
}

std::string shading_language_in(const ContextProfile& profile, const Caps& caps) {
    const char* language = version_in(profile, caps).shading_language;
    if (!language) return {};
    return profile.es == 0 ? language : std::string("OpenGL ES GLSL ES ") + language;
}

std::vector<std::string> extensions_in(const ContextProfile& profile, const Caps& caps) {
    return profile.es == 0 ? offered_extensions(caps, profile) : es_extensions(caps);
}

}  // namespace wall::client
