// SPDX-License-Identifier: MIT
// How small what a program sends becomes, and how fast (common/wire/history_coder.h; A5.3, T6.2): codes the batches of
// recorded streams one after the other, as a client does, and decodes them.
//
// coding_bench STREAM...      a file of batches, each with its length in front (u32), as bench/coding.py records them;
//                             one JSON line for each, rates in MB of plain bytes a second of one thread
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "common/wire/history_coder.h"

namespace {

using namespace wall;
using Clock = std::chrono::steady_clock;
using Batches = std::vector<std::vector<std::byte>>;

constexpr auto kLeast = std::chrono::milliseconds(500);  // that each way is measured

Batches read(const char* path) {
    std::ifstream file(path, std::ios::binary);
    const std::string all((std::istreambuf_iterator<char>(file)), {});
    Batches out;
    for (std::size_t at = 0; at + 4 <= all.size();) {
        std::uint32_t bytes = 0;
        std::memcpy(&bytes, all.data() + at, 4);
        at += 4;
        const auto* begin = reinterpret_cast<const std::byte*>(all.data()) + at;
        if (at + bytes > all.size()) break;
        out.emplace_back(begin, begin + bytes);
        at += bytes;
    }
    return out;
}

/// False: it could not be coded.
bool encode(const Batches& plain, std::vector<RawBytes>& coded) {
    auto encoder = wire::HistoryEncoder::create();
    for (std::size_t i = 0; i < plain.size(); ++i) {
        coded[i].clear();
        const std::array<std::span<const std::byte>, 1> pieces{plain[i]};
        if (!encoder || !encoder->encode(pieces, coded[i])) return false;
    }
    return true;
}

/// False: something else comes out.
bool decode(const Batches& plain, const std::vector<RawBytes>& coded, RawBytes& room) {
    wire::HistoryDecoder decoder;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        room.clear();
        if (!decoder.decode(coded[i], plain[i].size(), room) ||
            std::memcmp(room.data(), plain[i].data(), plain[i].size()) != 0)
            return false;
    }
    return true;
}

template <class Work>
double seconds_of(Work&& work) {
    const auto begin = Clock::now();
    int times = 0;
    do {
        if (!work()) return -1;
        ++times;
    } while (Clock::now() - begin < kLeast);
    return std::chrono::duration<double>(Clock::now() - begin).count() / times;
}

}  // namespace

int main(int count, char** arguments) {
    for (int i = 1; i < count; ++i) {
        const Batches plain = read(arguments[i]);
        std::vector<RawBytes> coded(plain.size());
        RawBytes room;
        const double encoding = seconds_of([&] { return encode(plain, coded); });
        const double decoding = seconds_of([&] { return decode(plain, coded, room); });
        if (plain.empty() || encoding < 0 || decoding < 0) {
            std::fprintf(stderr, "%s: no batches, or they do not come back\n", arguments[i]);
            return 1;
        }
        double bytes = 0, small = 0;
        for (const auto& batch : plain) bytes += static_cast<double>(batch.size());
        for (const auto& batch : coded) small += static_cast<double>(batch.size());
        std::printf(
            "{\"stream\": \"%s\", \"batches\": %zu, \"bytes\": %.0f, \"ratio\": %.2f, \"encode_mb_s\": %.0f, "
            "\"decode_mb_s\": %.0f}\n",
            std::filesystem::path(arguments[i]).stem().c_str(), plain.size(), bytes, bytes / small,
            1e-6 * bytes / encoding, 1e-6 * bytes / decoding);
    }
    return 0;
}
