// SPDX-License-Identifier: MIT
// A graphics card as the kernel's mode setting describes it (Linux, Documentation/gpu/drm-kms): connectors, to which
// monitors are plugged; CRTCs, each of which makes one monitor's signal; planes, which bring pictures to CRTCs. Values;
// any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/base/ids.h"

namespace wall::tileserver {

using ConnectorId = Id<struct ConnectorTag>;      ///< of the kernel, as all of these; 0: none
using CrtcId = Id<struct CrtcTag>;                ///< makes a signal
using PlaneId = Id<struct PlaneTag>;              ///< holds a picture
using FramebufferId = Id<struct FramebufferTag>;  ///< a picture in the card's memory
using BlobId = Id<struct BlobTag>;                ///< bytes that a property refers to
using PropertyId = Id<struct PropertyTag>;        ///< a property's name, as a number

struct Property {
    PropertyId id;
    std::uint64_t value = 0;  ///< when the card was described
};
using Properties = std::map<std::string, Property, std::less<>>;  ///< by name, such as "CRTC_ID"

struct Mode {
    std::int32_t width = 0, height = 0;  ///< pixels
    std::uint32_t millihertz = 0;        ///< pictures in 1000 seconds
    bool preferred = false;              ///< by the monitor
    bool interlaced = false;
    std::vector<std::byte> timing{};  ///< the kernel's drm_mode_modeinfo
    bool operator==(const Mode&) const = default;
};

struct Connector {
    ConnectorId id;
    std::string name;  ///< such as "DP-1"
    bool connected = false;
    bool desktop = true;      ///< else a headset or the like is plugged in, which is only used if it is named
    bool link_bad = false;    ///< the monitor has gone and come again, and waits for its mode to be set anew
    std::string monitor{};    ///< what it calls itself; empty: it does not say
    std::vector<Mode> modes;  ///< in the monitor's order
    std::vector<CrtcId> crtcs{};
    Properties properties{};
};

struct Crtc {
    CrtcId id;
    Properties properties{};
};

struct Plane {
    PlaneId id;
    bool primary = false;  ///< and neither a cursor nor an overlay
    bool plain = false;    ///< takes pixels of 8 bits a channel (XRGB8888)
    std::vector<CrtcId> crtcs{};
    Properties properties{};
};

struct Card {
    std::string name;  ///< such as /dev/dri/card0
    std::vector<Connector> connectors;
    std::vector<Crtc> crtcs;
    std::vector<Plane> planes;

    const Connector* find(const std::string& connector) const;
};

/// "1920x1080@60", "1920x1080@59.94".
std::string text_of(const Mode& mode);
/// "DP-1 (DELL U2720Q)"; without a monitor only its connector.
std::string text_of(const Connector& connector);
/// "connected are DP-1 (DELL U2720Q), HDMI-A-1", or that nothing is.
std::string connected_monitors(const Card& card);

}  // namespace wall::tileserver
