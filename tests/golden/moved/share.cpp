// SPDX-License-Identifier: MIT
#include "tests/golden/moved/share.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <thread>

#include "tests/golden/moved/place.h"

namespace golden::moved {
namespace {

constexpr std::size_t kShareBytes = std::size_t{16} << 20;
constexpr std::chrono::seconds kPatience{60};  // until the others must have come as far
constexpr std::chrono::microseconds kPause{50};

/// Lies at the file's start; the image follows. The file is all zero at first.
struct Header {
    std::atomic<std::uint32_t> arrived, round;
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

Header* map_share() {
    const int file = open(place().share.c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0 || ftruncate(file, static_cast<off_t>(kShareBytes)) != 0) stop("opening GOLDEN_SHARE");
    void* at = mmap(nullptr, kShareBytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (at == MAP_FAILED) stop("mapping GOLDEN_SHARE");
    close(file);
    return static_cast<Header*>(at);
}

Header& header() {
    static Header* const mapped = map_share();
    return *mapped;
}

/// Until every process has called it as often as this one.
void wait_for_all() {
    Header& h = header();
    const std::uint32_t round = h.round.load();
    if (h.arrived.fetch_add(1) + 1 == place().tiles.size()) {
        h.arrived = 0;
        ++h.round;
        return;
    }
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (h.round.load() == round) {
        if (std::chrono::steady_clock::now() > end) stop("another tile's process does not come");
        std::this_thread::sleep_for(kPause);
    }
}

/// Calls `row(in the image, in the share, bytes)` for the rows that `part` has of `area`.
template <class Row>
void for_each_row(const Rows& image, const Box& area, const Box& part, Row&& row) {
    const Box common = intersect(area, part);
    if (common.empty()) return;
    auto* const shared = reinterpret_cast<std::byte*>(&header()) + sizeof(Header);
    const auto column = static_cast<std::size_t>(common.x - area.x) * image.pixel_bytes;
    for (int y = common.y; y < common.y + common.height; ++y) {
        const auto line = static_cast<std::size_t>(y - area.y);
        row(image.first + line * image.stride + column,
            shared + line * static_cast<std::size_t>(area.width) * image.pixel_bytes + column,
            static_cast<std::size_t>(common.width) * image.pixel_bytes);
    }
}

}  // namespace

void exchange(const Rows& image, const Box& area) {
    const std::size_t bytes =
        static_cast<std::size_t>(area.width) * static_cast<std::size_t>(area.height) * image.pixel_bytes;
    if (bytes > kShareBytes - sizeof(Header)) stop("an image larger than the share");
    for_each_row(image, area, place().part(),
                 [](std::byte* mine, std::byte* shared, std::size_t count) { std::memcpy(shared, mine, count); });
    wait_for_all();
    for (const Box& tile : place().tiles)
        for_each_row(image, area, tile,
                     [](std::byte* mine, std::byte* shared, std::size_t count) { std::memcpy(mine, shared, count); });
    wait_for_all();  // nobody writes the next image while somebody reads this one
}

}  // namespace golden::moved
