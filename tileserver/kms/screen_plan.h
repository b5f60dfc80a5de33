// SPDX-License-Identifier: MIT
// Which connector, CRTC, plane and mode of a card show which tile. Pure; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "tileserver/kms/card.h"

namespace wall::tileserver {

struct ModeWish {
    std::int32_t width = 0, height = 0;  ///< pixels
    std::uint32_t millihertz = 0;        ///< 0: any
};

/// What wall.toml says of a tile on a monitor.
struct MonitorWish {
    std::uint32_t slot = 0;        ///< of the tile
    std::string tile;              ///< its name
    std::string connector;         ///< empty: the next one with a monitor that no other tile names
    std::optional<ModeWish> mode;  ///< none: that which the monitor likes best
};

/// What shows one of them from then on, with or without a monitor.
struct ScreenPlan {
    Connector connector;
    Crtc crtc;
    Plane plane;
};

/// One plan for each wish, in their order. Tiles that name a connector without a monitor get it all the same, so that
/// the monitor may come later; but one of them at least has a monitor, and each monitor has the mode that is wished.
/// The error says what there is instead.
Result<std::vector<ScreenPlan>> plan_screens(const Card& card, std::span<const MonitorWish> wishes);

/// The mode for what is plugged into the connector now. With a rate the nearest within half a Hz; of several the
/// monitor's favourite, else the fastest. Interlaced ones do not count. The error says what there is.
Result<Mode> choose_mode(const Connector& connector, const std::optional<ModeWish>& wish);

}  // namespace wall::tileserver
