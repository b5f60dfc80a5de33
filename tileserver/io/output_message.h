// SPDX-License-Identifier: MIT
// What walld says of what a tile and its output show. Pure.
#pragma once

#include <memory>

#include "common/base/result.h"
#include "common/geom/tile_output.h"
#include "proto/control.pb.h"
#include "tileserver/render/test_pattern.h"

namespace wall::tileserver {

/// None: programs again.
std::shared_ptr<const TestPattern> pattern_of(const proto::TilePattern& told);
/// An error: what no output can be.
Result<std::shared_ptr<const geom::TileOutput>> output_of(const proto::TileOutput& told);

}  // namespace wall::tileserver
