// SPDX-License-Identifier: MIT
#include "tileserver/kms/card.h"

#include <algorithm>

namespace wall::tileserver {

const Connector* Card::find(const std::string& connector) const {
    const auto found = std::ranges::find(connectors, connector, &Connector::name);
    return found == connectors.end() ? nullptr : &*found;
}

std::string text_of(const Mode& mode) {
    std::string out = std::to_string(mode.width) + "x" + std::to_string(mode.height);
    const std::uint32_t hundredths = (mode.millihertz + 5) / 10;  // of a Hz
    out += "@" + std::to_string(hundredths / 100);
    if (hundredths % 100 != 0) {
        out += "." + std::to_string(hundredths % 100 / 10);
        if (hundredths % 10 != 0) out += std::to_string(hundredths % 10);
    }
    return out;
}

std::string text_of(const Connector& connector) {
    return connector.name + (connector.monitor.empty() ? "" : " (" + connector.monitor + ")");
}

std::string connected_monitors(const Card& card) {
    std::string out;
    for (const Connector& connector : card.connectors)
        if (connector.connected) out += (out.empty() ? "connected are " : ", ") + text_of(connector);
    return out.empty() ? "nothing is connected to " + card.name : out;
}

}  // namespace wall::tileserver
