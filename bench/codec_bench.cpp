// SPDX-License-Identifier: MIT
// Ratio and speed of the frame codecs beside FFmpeg's, on the same frames, in turn in one run.
//
//   codec_bench [--json FILE] [--rounds N] [--only SCENE] FOLDER     FOLDER/SCENE.bgra, as bench/codec_frames.py makes
//   them
//
// A round times every contender once. One thread is timed by its processor time, and the table shows the median over
// the rounds; two threads by the clock, and it shows the best round, the one least disturbed by other work. MB/s count
// 4 bytes a pixel. Exit code 1 when a bar of docs/codecs.md is missed.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bench/ffmpeg_codec.h"
#include "common/codec/codec.h"
#include "common/codec/worker_pool.h"

namespace {

using namespace wall;
using codec::FrameView;
using codec::PacketKind;

constexpr std::uint32_t kWidth = 1920, kHeight = 1080;
constexpr std::size_t kFrameBytes = std::size_t{kWidth} * kHeight * 4;

double seconds(int threads) {
    timespec now{};
    clock_gettime(threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

struct Contender {
    std::string name;
    int threads;
    std::function<void()> encode, decode;
    std::function<double()> bits_per_pixel;
    std::vector<double> encode_rates{}, decode_rates{};  ///< MB/s, one a round
};

template <class T>
T take(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

/// One of our codecs over a scene. `sequence`: deltas after the first frame; otherwise every frame by itself.
class OurCodec {
public:
    OurCodec(const std::string& name, bool sequence, codec::ParallelFor parallel, const std::vector<FrameView>& frames)
        : sequence_(sequence),
          frames_(frames),
          encoder_(take(codec::make_encoder(name, kFormat, parallel))),
          packets_(frames.size()) {
        encode();
        decoder_ = take(codec::make_decoder(name, kFormat, encoder_->stream_header(), parallel));
        check();
    }
    void encode() {
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            packets_[i].clear();
            take(encoder_->encode(frames_[i], sequence_ && i > 0 ? PacketKind::delta : PacketKind::key, packets_[i]));
        }
    }
    void decode() {
        for (const auto& packet : packets_) take(decoder_->decode(packet));
    }
    double bits_per_pixel() const {
        double bytes = 0;
        for (const auto& packet : packets_) bytes += static_cast<double>(packet.size());
        return 8 * bytes / (static_cast<double>(packets_.size()) * kWidth * kHeight);
    }

private:
    static constexpr codec::StreamFormat kFormat{kWidth, kHeight};

    void check() {
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            const auto view = take(decoder_->decode(packets_[i]));
            for (std::uint32_t y = 0; y < kHeight; ++y)
                if (std::memcmp(view.row(y), frames_[i].row(y), view.row_bytes()) != 0)
                    throw std::runtime_error("a frame decodes to another");
        }
    }

    const bool sequence_;
    const std::vector<FrameView> frames_;
    std::unique_ptr<codec::Encoder> encoder_;
    std::unique_ptr<codec::Decoder> decoder_;
    std::vector<std::vector<std::byte>> packets_;
};

template <class Codec>
Contender contender(std::string name, int threads, std::shared_ptr<Codec> codec) {
    return {std::move(name), threads, [codec] { codec->encode(); }, [codec] { codec->decode(); },
            [codec] { return codec->bits_per_pixel(); }};
}

std::vector<Contender> contenders(const std::vector<FrameView>& frames, codec::WorkerPool& pool) {
    std::vector<Contender> out;
    const std::pair<const char*, AVPixelFormat> theirs[] = {
        {"huffyuv", AV_PIX_FMT_RGB24}, {"ffvhuff", AV_PIX_FMT_RGB24}, {"utvideo", AV_PIX_FMT_GBRP}};
    for (const int threads : {1, 2}) {
        const codec::ParallelFor parallel = threads == 1 ? codec::ParallelFor{} : pool.parallel_for();
        for (const auto& [name, pixels] : theirs)
            out.push_back(contender(std::string("FFmpeg ") + name, threads,
                                    std::make_shared<bench::FfmpegCodec>(name, pixels, threads, frames)));
        out.push_back(contender("huffyuv", threads, std::make_shared<OurCodec>("huffyuv", false, parallel, frames)));
        if (threads == 1)
            for (const char* name : {"lz4", "zstd"})
                out.push_back(contender(name, threads, std::make_shared<OurCodec>(name, false, parallel, frames)));
        out.push_back(
            contender("huffyuv-tiles", threads, std::make_shared<OurCodec>("huffyuv-tiles", false, parallel, frames)));
        out.push_back(contender("huffyuv-tiles, sequence", threads,
                                std::make_shared<OurCodec>("huffyuv-tiles", true, parallel, frames)));
    }
    return out;
}

/// Of the rounds, what the table shows.
double typical(std::vector<double> rates, int threads) {
    std::sort(rates.begin(), rates.end());
    return threads == 1 ? rates[rates.size() / 2] : rates.back();
}

void time_round(std::vector<Contender>& all, std::size_t frames) {
    const double megabytes = static_cast<double>(frames * kFrameBytes) / 1e6;
    for (auto& one : all) {
        const double begin = seconds(one.threads);
        one.encode();
        const double middle = seconds(one.threads);
        one.decode();
        one.encode_rates.push_back(megabytes / (middle - begin));
        one.decode_rates.push_back(megabytes / (seconds(one.threads) - middle));
    }
}

struct Figures {
    double bits, encode, decode;
};
using Scene = std::map<std::pair<std::string, int>, Figures>;

Scene measure(const std::string& name, const std::vector<std::byte>& bytes, int rounds, codec::WorkerPool& pool) {
    std::vector<FrameView> frames;
    for (std::size_t at = 0; at + kFrameBytes <= bytes.size(); at += kFrameBytes)
        frames.push_back({bytes.data() + at, kWidth, kHeight, kWidth * 4});
    auto all = contenders(frames, pool);
    for (int round = 0; round < rounds; ++round) time_round(all, frames.size());
    std::printf("\n%-26s threads  bits/pixel  encode MB/s  decode MB/s\n", name.c_str());
    Scene out;
    for (auto& one : all) {
        const Figures figures{one.bits_per_pixel(), typical(one.encode_rates, one.threads),
                              typical(one.decode_rates, one.threads)};
        std::printf("  %-24s %7d %11.3f %12.0f %12.0f\n", one.name.c_str(), one.threads, figures.bits, figures.encode,
                    figures.decode);
        out[{one.name, one.threads}] = figures;
    }
    std::fflush(stdout);
    return out;
}

/// Prints what a bar wants and what there is; true if it is held.
bool bar(const std::string& scene, const char* what, double is, double wanted, bool at_least) {
    const bool held = at_least ? is >= wanted : is <= wanted;
    std::printf("%-14s %-52s %8.2f, %s %.2f wanted%s\n", scene.c_str(), what, is, at_least ? "at least" : "at most",
                wanted, held ? "" : "   MISSED");
    return held;
}

bool bars(const std::string& name, const Scene& scene) {
    const auto& theirs = scene.at({"FFmpeg huffyuv", 1});
    const auto& ours = scene.at({"huffyuv", 1});
    const auto& tiles = scene.at({"huffyuv-tiles", 1});
    bool held = bar(name, "huffyuv bits to FFmpeg's", ours.bits / theirs.bits, 1, false);
    held &= bar(name, "huffyuv encode to FFmpeg's", ours.encode / theirs.encode, 1.5, true);
    held &= bar(name, "huffyuv decode to FFmpeg's", ours.decode / theirs.decode, 1.2, true);
    held &= bar(name, "huffyuv-tiles bits to huffyuv's", tiles.bits / ours.bits, 1.02, false);
    if (name == "noise") return held;
    held &= bar(name, "huffyuv-tiles bits to FFmpeg's utvideo", tiles.bits / scene.at({"FFmpeg utvideo", 1}).bits, 0.8,
                false);
    held &= bar(name, "huffyuv-tiles encode, GB/s", tiles.encode / 1000, 1, true);
    held &= bar(name, "huffyuv-tiles decode, GB/s", tiles.decode / 1000, 1, true);
    return held;
}

/// What no codec can press: uniform noise, opaque.
std::vector<std::byte> noise(std::size_t frames) {
    std::vector<std::byte> out(frames * kFrameBytes);
    std::uint64_t state = 1;
    for (std::size_t i = 0; i < out.size(); ++i) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        out[i] = i % 4 == 3 ? std::byte{255} : static_cast<std::byte>(state >> 56);
    }
    return out;
}

std::vector<std::byte> read(const std::filesystem::path& path) {
    std::vector<std::byte> out(std::filesystem::file_size(path));
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
    return out;
}

std::vector<std::filesystem::path> scene_files(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".bgra") out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
}

nlohmann::json as_json(const std::map<std::string, Scene>& scenes) {
    nlohmann::json out;
    for (const auto& [name, scene] : scenes)
        for (const auto& [who, figures] : scene)
            out[name][who.first + ", " + std::to_string(who.second) + (who.second == 1 ? " thread" : " threads")] = {
                {"bits_per_pixel", figures.bits},
                {"encode_mb_per_s", figures.encode},
                {"decode_mb_per_s", figures.decode}};
    return out;
}

int run(int argc, char** argv) {
    std::string json, folder, only;
    int rounds = 7;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--json" && i + 1 < argc) json = argv[++i];
        else if (argument == "--rounds" && i + 1 < argc) rounds = std::max(1, std::atoi(argv[++i]));
        else if (argument == "--only" && i + 1 < argc) only = argv[++i];
        else folder = argument;
    }
    if (folder.empty() || !std::filesystem::is_directory(folder))
        throw std::runtime_error("expected [--json FILE] [--rounds N] [--only SCENE] FOLDER");
    std::map<std::string, Scene> scenes;
    codec::WorkerPool pool(1);  // and the thread that calls
    for (const auto& path : scene_files(folder)) {
        const auto name = path.stem().string();
        if (only.empty() || only == name) scenes[name] = measure(name, read(path), rounds, pool);
    }
    if (only.empty() || only == "noise") scenes["noise"] = measure("noise", noise(5), rounds, pool);
    bool held = true;
    std::printf("\n");
    for (const auto& [name, scene] : scenes) held &= bars(name, scene);
    if (!json.empty()) std::ofstream(json) << as_json(scenes).dump(1) << "\n";
    return held ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "codec_bench: %s\n", error.what());
        return 2;
    }
}
