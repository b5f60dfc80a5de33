// SPDX-License-Identifier: MIT
#include "walld/wall/caps.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "common/base/tight_limits.h"

namespace wall::walld {
namespace {

/// "4.5 (Compatibility Profile) Mesa" -> {4, 5}
std::pair<int, int> number_of(const std::string& version) {
    std::pair<int, int> out{};
    std::sscanf(version.c_str(), "%d.%d", &out.first, &out.second);
    return out;
}

void keep_lower(std::string& ours, const std::string& theirs) {
    if (number_of(theirs) < number_of(ours)) ours = theirs;
}

std::string common_words(const std::string& ours, const std::string& theirs) {
    std::istringstream their_words(theirs), our_words(ours);
    const std::set<std::string> known(std::istream_iterator<std::string>(their_words), {});
    std::string out, word;
    while (our_words >> word) {
        if (known.contains(word)) out += (out.empty() ? "" : " ") + word;
    }
    return out;
}

const proto::GlLimit* find(const proto::GlCaps& caps, std::uint32_t name) {
    const auto found = std::ranges::find(caps.limits(), name, &proto::GlLimit::name);
    return found == caps.limits().end() ? nullptr : &*found;
}

void tighten(proto::GlLimit& ours, const proto::GlLimit& theirs) {
    for (int i = 0; i < std::min(ours.values_size(), theirs.values_size()); ++i) {
        const double a = ours.values(i), b = theirs.values(i);
        ours.set_values(i,
                        larger_is_tighter(ours.name(), static_cast<std::size_t>(i)) ? std::max(a, b) : std::min(a, b));
    }
}

void narrow(proto::GlCaps& ours, const proto::GlCaps& theirs) {
    keep_lower(*ours.mutable_version(), theirs.version());
    keep_lower(*ours.mutable_shading_language_version(), theirs.shading_language_version());
    ours.set_extensions(common_words(ours.extensions(), theirs.extensions()));
    auto& limits = *ours.mutable_limits();
    limits.erase(
        std::remove_if(limits.begin(), limits.end(), [&](const auto& limit) { return !find(theirs, limit.name()); }),
        limits.end());
    for (auto& limit : limits) tighten(limit, *find(theirs, limit.name()));
}

}  // namespace

proto::GlCaps common_caps(std::span<const proto::GlCaps* const> nodes) {
    proto::GlCaps out;
    for (const auto* caps : nodes) {
        if (caps == nodes.front()) out = *caps;
        else narrow(out, *caps);
    }
    return out;
}

}  // namespace wall::walld
