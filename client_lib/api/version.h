// SPDX-License-Identifier: MIT
// What the library says it implements: versions and extensions, in one place. Both follow from commands.toml: a step is
// offered as soon as the commands that it stands for are implemented, and never more than every node can do.
#pragma once

#include <string>
#include <vector>

#include "client_lib/link/control_messages.h"

namespace wall::client {

struct GlVersion {
    int major = 1, minor = 1;
    const char* shading_language = nullptr;  ///< null: no shaders
};

GlVersion offered_version(const Caps& caps);
std::vector<std::string> offered_extensions(const Caps& caps);

/// glGetString(GL_VERSION).
std::string version_string(const Caps& caps);

}  // namespace wall::client
