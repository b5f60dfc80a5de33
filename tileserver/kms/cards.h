// SPDX-License-Identifier: MIT
// This machine's graphics cards, and which of them shows a node's tiles. Any thread.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "tileserver/kms/card.h"

namespace wall::tileserver {

struct CardFile {
    std::string path;  ///< such as /dev/dri/card0
    std::string pci;   ///< such as "0000:65:00.0"; empty: it is no PCI device
};
/// In the kernel's order.
std::vector<CardFile> card_files();

/// Those to try, one after the other. `gpu`: "auto" (all), or a PCI address, of which the domain "0000:" may be left
/// out. The error says which there are.
Result<std::vector<std::string>> choose_cards(std::span<const CardFile> cards, std::string_view gpu);

/// A table for people: connectors, monitors and modes of all cards.
std::string monitor_table();
/// The lines of one card.
std::string monitor_lines(const CardFile& file, const Card& card);

}  // namespace wall::tileserver
