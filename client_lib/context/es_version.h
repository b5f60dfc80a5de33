// SPDX-License-Identifier: MIT
// What contexts of OpenGL ES offer: as version.h does for OpenGL, by construction out of gl.xml and proto/gl/es.toml.
// Any thread.
#pragma once

#include <string>
#include <vector>

#include "client_lib/context/profile.h"
#include "client_lib/context/version.h"
#include "client_lib/link/control_messages.h"
#include "gen/client_lib/es.gen.h"

namespace wall::client {

/// The latest version of OpenGL ES whose every command is implemented, and what else it asks for, times ten.
unsigned implemented_es_version();
/// The version, times ten, of a context that was asked for: the latest of those with shaders for each of them, 1.1 for
/// the first ones. 0: no such version, or later than ours.
unsigned es_version_for(int major, int minor);
/// The mode of a context of a version, times ten.
const GlTable& es_table(unsigned version);

/// What glGetString and its like answer in a context, of OpenGL or OpenGL ES.
GlVersion version_in(const ContextProfile& profile, const Caps& caps);
std::string version_text_in(const ContextProfile& profile, const Caps& caps);
/// Empty: there are no shaders.
std::string shading_language_in(const ContextProfile& profile, const Caps& caps);
/// What GL_NUM_SHADING_LANGUAGE_VERSIONS counts, in the words of #version (OpenGL 4.3, 22.2).
std::vector<std::string> shading_languages_in(const ContextProfile& profile, const Caps& caps);
std::vector<std::string> extensions_in(const ContextProfile& profile, const Caps& caps);
/// GL_COMPRESSED_TEXTURE_FORMATS: in OpenGL only those for general use (of RGBA in DXT1 one bit is alpha), in OpenGL ES
/// all, where the nodes' drivers have what they are of.
std::vector<GLenum> listed_block_formats(const ContextProfile& profile, const Caps& caps);

}  // namespace wall::client
