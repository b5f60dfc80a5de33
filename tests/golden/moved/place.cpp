// SPDX-License-Identifier: MIT
#include "tests/golden/moved/place.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace golden::moved {
namespace {

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == 0) stop(name);
    return value;
}

/// The numbers between two semicolons.
std::vector<int> numbers(const std::string& text) {
    std::vector<int> out;
    std::istringstream stream(text);
    for (std::string word; std::getline(stream, word, ',');) out.push_back(std::atoi(word.c_str()));
    return out;
}

Place read_place() {
    Place out;
    std::istringstream stream(variable("GOLDEN_TILES"));
    std::string entry;
    std::getline(stream, entry, ';');
    const auto size = numbers(entry);
    if (size.size() != 2) stop("GOLDEN_TILES");
    out.window = {0, 0, size[0], size[1]};
    while (std::getline(stream, entry, ';')) {
        const auto tile = numbers(entry);
        if (tile.size() != 4) stop("GOLDEN_TILES");
        out.tiles.push_back({tile[0], size[1] - tile[1] - tile[3], tile[2], tile[3]});
    }
    out.own = static_cast<std::size_t>(std::atoi(variable("GOLDEN_TILE").c_str()));
    if (out.own >= out.tiles.size()) stop("GOLDEN_TILE");
    out.share = variable("GOLDEN_SHARE");
    return out;
}

}  // namespace

Box intersect(const Box& a, const Box& b) {
    const int left = std::max(a.x, b.x), low = std::max(a.y, b.y);
    const int right = std::min(a.x + a.width, b.x + b.width), high = std::min(a.y + a.height, b.y + b.height);
    return {left, low, right - left, high - low};
}

const Place& place() {
    static const Place* const the_place = new Place(read_place());  // never destroyed: programs draw while they exit
    return *the_place;
}

void stop(const char* what) {
    std::fprintf(stderr, "moved reference: cannot do this right: %s\n", what);
    std::fflush(stderr);
    _exit(3);
}

}  // namespace golden::moved
