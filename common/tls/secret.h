// SPDX-License-Identifier: MIT
// Secrets that somebody else sends. Any thread.
#pragma once

#include <string_view>

namespace wall::tls {

/// Takes as long for a wrong one that begins right as for any other of its length.
bool same_secret(std::string_view a, std::string_view b);

}  // namespace wall::tls
