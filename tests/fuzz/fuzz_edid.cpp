// SPDX-License-Identifier: MIT
// What a monitor sends of itself: a short name of printable characters, or none. The sum of its bytes is put right
// first, since nobody would hit upon it; as it came it is read as well. The same bytes as a message of the kernel.
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "common/base/assert.h"
#include "tileserver/kms/edid.h"
#include "tileserver/kms/uevents.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kBlock = 128, kLongestName = 13;
    std::vector<std::uint8_t> bytes(data, data + size);
    const auto read = [&bytes] {
        const std::string name = wall::tileserver::monitor_name(std::as_bytes(std::span(bytes)));
        WALL_ASSERT(name.size() <= kLongestName);
        WALL_ASSERT(std::ranges::all_of(name, [](char c) { return c >= ' ' && c <= '~'; }));
    };
    read();
    if (bytes.size() >= kBlock) {
        bytes[kBlock - 1] = 0;
        bytes[kBlock - 1] = static_cast<std::uint8_t>(-std::accumulate(bytes.begin(), bytes.begin() + kBlock, 0));
        read();
    }
    const std::string message(bytes.begin(), bytes.end());
    if (wall::tileserver::is_hot_plug(message, "dri/card0"))
        WALL_ASSERT(message.find("HOTPLUG=1") != std::string::npos);
    return 0;
}
