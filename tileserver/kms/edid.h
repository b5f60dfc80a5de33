// SPDX-License-Identifier: MIT
// What a monitor calls itself, in the data that it sends (VESA E-EDID 1.4: base block of 128 bytes). Foreign
// bytes. Pure; any thread.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace wall::tileserver {

/// Printable ASCII, at most 13 characters; without a name the maker's three letters and the product's number, such as
/// "DEL a0b1". Empty: these are no such data.
std::string monitor_name(std::span<const std::byte> edid);

}  // namespace wall::tileserver
