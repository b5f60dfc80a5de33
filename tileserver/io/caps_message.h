// SPDX-License-Identifier: MIT
// What a driver offers, as a node says it to walld. Pure; any thread.
#pragma once

#include "proto/control.pb.h"
#include "tileserver/gpu/caps.h"

namespace wall::tileserver {

void fill_caps(const GlCaps& caps, proto::GlCaps& out);

}  // namespace wall::tileserver
