// SPDX-License-Identifier: MIT
// The generated state and its difference, for both ends of a stream.
#pragma once

#include "cmake/precompiled/standard.h"
#include "common/glstate/diff.h"
#include "gen/glapi/wire.gen.h"
#include "gen/glstate/state.gen.h"
