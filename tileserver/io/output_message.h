// SPDX-License-Identifier: MIT
// What walld says of a tile's output. Pure.
#pragma once

#include <memory>

#include "common/base/result.h"
#include "common/geom/tile_output.h"
#include "proto/control.pb.h"

namespace wall::tileserver {

/// An error: what no output can be.
Result<std::shared_ptr<const geom::TileOutput>> output_of(const proto::TileOutput& told);

}  // namespace wall::tileserver
