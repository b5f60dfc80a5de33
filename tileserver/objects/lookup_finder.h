// SPDX-License-Identifier: MIT
// Finds in the source of fragment shaders the samplers that are looked up only where an earlier stage says, and nowhere
// else: `texture(s, place)`. What is drawn with such a one reads of an image what lies under it, if the place is that
// of the fragment (client_lib/context/sampled_parts.h); so do programs that draw a picture in a framebuffer object and
// then bring it to the window. The source is parsed by glslang; what is not of that form is not found. Any thread.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "tileserver/objects/shader_variables.h"

namespace wall::tileserver {

struct FoundLookup {
    std::string sampler;  ///< a uniform of two dimensions, no array
    HandedOn place;       ///< its x and y are where it is looked up
};

/// Of all fragment shaders of a program together. Longer ones than a few pages do more than to copy, and are not
/// parsed.
std::vector<FoundLookup> find_lookups(const std::vector<const std::string*>& fragment_shaders);

/// Those that a shader does anything with.
std::set<std::string> used_samplers(glslang::TIntermediate& shader);

}  // namespace wall::tileserver
