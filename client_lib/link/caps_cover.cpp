// SPDX-License-Identifier: MIT
#include "client_lib/link/caps_cover.h"

#include <stdio.h>

#include <iterator>
#include <set>
#include <sstream>
#include <utility>

#include "common/base/tight_limits.h"

namespace wall::client {
namespace {

/// "4.5 (Compatibility Profile) Mesa" -> {4, 5}
std::pair<int, int> number_of(const std::string& version) {
    std::pair<int, int> out{};
    sscanf(version.c_str(), "%d.%d", &out.first, &out.second);
    return out;
}

std::string text_of(std::pair<int, int> version) {
    return std::to_string(version.first) + "." + std::to_string(version.second);
}

std::string lacking_version(const std::string& name, const std::string& has, const std::string& promised) {
    if (number_of(has) >= number_of(promised)) return {};
    return name + " " + text_of(number_of(promised)) + " (it has " + text_of(number_of(has)) + ")";
}

std::string lacking_extension(const std::string& has, const std::string& promised) {
    std::istringstream has_words(has), promised_words(promised);
    const std::set<std::string> known(std::istream_iterator<std::string>(has_words), {});
    for (std::string word; promised_words >> word;)
        if (!known.contains(word)) return word;
    return {};
}

bool covers(std::uint32_t name, const std::vector<double>& has, const std::vector<double>& promised) {
    if (has.size() < promised.size()) return false;
    for (std::size_t i = 0; i < promised.size(); ++i)
        if (larger_is_tighter(name, i) ? has[i] > promised[i] : has[i] < promised[i]) return false;
    return true;
}

std::string lacking_limit(const Caps& wall, const Caps& promised) {
    for (const auto& [name, values] : promised.limits) {
        const auto found = wall.limits.find(name);
        if (found != wall.limits.end() && covers(name, found->second, values)) continue;
        char text[64];
        snprintf(text, sizeof text, "a limit (glGet 0x%04X) as large", static_cast<unsigned>(name));
        return text;
    }
    return {};
}

}  // namespace

std::string lacking(const Caps& wall, const Caps& promised) {
    if (auto version = lacking_version("OpenGL", wall.version, promised.version); !version.empty()) return version;
    if (auto version = lacking_version("GLSL", wall.shading_language_version, promised.shading_language_version);
        !version.empty())
        return version;
    if (auto extension = lacking_extension(wall.extensions, promised.extensions); !extension.empty()) return extension;
    return lacking_limit(wall, promised);
}

}  // namespace wall::client
