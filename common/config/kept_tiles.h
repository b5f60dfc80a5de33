// SPDX-License-Identifier: MIT
// What a wall goes on with when it is described anew while it runs. Pure; any thread.
#pragma once

#include "common/config/wall_config.h"

namespace wall::config {

/// Tileservers that go on keep their tiles where they are: `next` gets the slots that `now` has for tiles of the same
/// name, so that what is being drawn for a tile is drawn for no other one, and tiles that were dealt out stay with the
/// GPU that has come to draw them. Where tiles are windows or monitors nothing is kept: what these were opened for are
/// the numbers of the file.
void keep_tiles(WallConfig& next, const WallConfig& now);

}  // namespace wall::config
