// SPDX-License-Identifier: MIT
// What the library says it implements: versions and extensions, in one place. Both follow from commands.toml: a version
// is offered as soon as all of its commands are implemented, and never more than every node can do.
#pragma once

#include <string>
#include <vector>

#include "client_lib/context/profile.h"
#include "client_lib/link/control_messages.h"

namespace wall::client {

inline constexpr const char* kWallVersion = "WallGL 0.1";

struct GlVersion {
    int major = 1, minor = 1;
    const char* shading_language = nullptr;  ///< null: no shaders
};

/// The latest version whose every command is implemented, and what else it asks for.
GlVersion implemented_version();
bool is_implemented(int major, int minor);
/// The same, but no more than nodes can do. Of the compatibility profile; of the core profile, if it is 3.1 or later.
GlVersion offered_version(const Caps& caps);
/// Of desktop OpenGL.
std::vector<std::string> offered_extensions(const Caps& caps, const ContextProfile& profile);

/// The shading languages of OpenGL, as numbers behind #version, the latest first; in a core profile from 140 on.
std::vector<std::string> shading_languages(const Caps& caps, const ContextProfile& profile);

/// glGetString(GL_VERSION).
std::string version_string(const Caps& caps, const ContextProfile& profile);

}  // namespace wall::client
