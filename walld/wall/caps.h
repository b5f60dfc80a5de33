// SPDX-License-Identifier: MIT
// What every node of the wall can do: the capabilities that an application sees. Pure.
#pragma once

#include <span>

#include "proto/control.pb.h"

namespace wall::walld {

/// Names from the first node; the lowest versions, the common extensions, the tightest limits. Limits that a node does
/// not know are left out.
proto::GlCaps common_caps(std::span<const proto::GlCaps* const> nodes);

}  // namespace wall::walld
