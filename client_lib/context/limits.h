// SPDX-License-Identifier: MIT
// What the wall's nodes can do, as numbers. Pure.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "client_lib/context/profile.h"
#include "client_lib/link/control_messages.h"
#include "common/glapi/gl_types.h"

namespace wall::client {

/// Of one texture level: 1 GiB of 4-byte texels, which is llvmpipe's limit as well.
inline constexpr std::size_t kMostTexels = std::size_t{1} << 28;

/// Component `i` of the nodes' answer to glGet(name), or `otherwise`.
inline double limit_of(const Caps& caps, GLenum name, double otherwise, std::size_t i = 0) {
    const auto found = caps.limits.find(name);
    return found == caps.limits.end() || found->second.size() <= i ? otherwise : found->second[i];
}

/// Samples of a texel where no node says how many there may be.
inline constexpr GLsizei kUsualSamples = 4;

/// Whole numbers have one sample a pixel in OpenGL ES 3.0 (4.4.2).
inline bool has_samples_of_integers(const ContextProfile& profile) { return !profile.is_es() || profile.es > 30; }

/// What a driver makes of a number of samples that it may not have, `most` being its largest.
inline std::uint32_t rounded_samples(GLsizei samples, GLsizei most) {
    if (samples == 0) return 0;
    return most <= kUsualSamples ? static_cast<std::uint32_t>(most)
                                 : std::bit_ceil(static_cast<std::uint32_t>(samples));
}

/// The numbers of samples that it has, the largest first.
inline std::vector<GLsizei> sample_counts(GLsizei most) {
    std::vector<GLsizei> counts;
    for (GLsizei samples = most; samples > 1 && (counts.empty() || most > kUsualSamples); samples /= 2)
        counts.push_back(samples);
    return counts;
}

}  // namespace wall::client
