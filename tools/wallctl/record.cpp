// SPDX-License-Identifier: MIT
#include "tools/wallctl/record.h"

#include <signal.h>

#include <atomic>
#include <filesystem>
#include <iomanip>
#include <iostream>

#include "common/codec/avi.h"
#include "common/codec/huffyuv.h"
#include "tools/wallctl/live_wall.h"

namespace wall::wallctl {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kFirstPictures{5};

std::atomic<bool> interrupted = false;

tl::unexpected<Failure> failed(std::string message) { return tl::unexpected<Failure>({"failed", std::move(message)}); }

/// The file and its encoder, made with the first frame.
class Film {
public:
    explicit Film(const Recording& recording) : recording_(recording) {}

    Result<void> add(const codec::FrameView& frame) {
        if (!encoder_) {
            auto made = codec::huffyuv::make_stream_encoder({frame.width, frame.height, frame.layout, false}, {});
            if (!made) return tl::unexpected(made.error());
            encoder_ = std::move(*made);
        }
        packet_.clear();
        if (auto done = encoder_->encode(frame, codec::PacketKind::key, packet_); !done) return tl::unexpected(done.error());
        if (!avi_) {
            const auto header = encoder_->stream_header();
            auto avi = codec::AviWriter::create(recording_.file, {frame.width, frame.height, {'H', 'F', 'Y', 'U'}, codec::huffyuv::bit_count(encoder_->stream()),
                                                                  recording_.fps, 1, {header.begin(), header.end()}});
            if (!avi) return tl::unexpected(avi.error());
            avi_.emplace(std::move(*avi));
        }
        bytes_ += packet_.size();
        return avi_->add(packet_);
    }
    Result<void> finish() { return avi_ ? avi_->finish() : Result<void>(); }
    std::uint64_t frames() const { return avi_ ? avi_->frames() : 0; }
    std::uint64_t bytes() const { return bytes_; }

private:
    const Recording& recording_;
    std::unique_ptr<codec::huffyuv::StreamEncoder> encoder_;
    std::optional<codec::AviWriter> avi_;
    std::vector<std::byte> packet_;
    std::uint64_t bytes_ = 0;
};

void say(const Recording& recording, const Film& film) {
    const double seconds = static_cast<double>(film.frames()) / recording.fps;
    std::cerr << "\rrecording: " << std::fixed << std::setprecision(1) << seconds << " of " << recording.seconds << " s, " << film.frames() << " frames, "
              << static_cast<double>(film.bytes()) / 1e6 << " MB" << std::flush;
}

}  // namespace

Outcome<Answer> record(const Walld& walld, const Recording& recording) {
    auto wall = LiveWall::open(walld, recording.tile, recording.fps);
    if (!wall) return tl::unexpected(wall.error());
    if (!(*wall)->wait_complete(kFirstPictures)) return failed("not every tile sent a picture within 5 s (wallctl tiles)");
    ::signal(SIGINT, [](int) { interrupted = true; });
    Film film(recording);
    const auto frames = static_cast<std::uint64_t>(std::max(1.0, recording.seconds * recording.fps + 0.5));
    const auto begin = Clock::now();
    while (film.frames() < frames && !interrupted) {
        const auto picture = (*wall)->picture();
        if (!picture) {
            static_cast<void>(film.finish());
            return failed(recording.file + " ends after " + std::to_string(film.frames()) + " frames: " + picture.error().message);
        }
        if (auto added = film.add(picture->view()); !added) return failed(added.error().message);
        if (recording.progress && film.frames() % recording.fps == 0) say(recording, film);
        std::this_thread::sleep_until(begin + std::chrono::microseconds(film.frames() * 1'000'000 / recording.fps));
    }
    if (recording.progress) say(recording, film), std::cerr << '\n';
    if (auto finished = film.finish(); !finished) return failed(finished.error().message);
    return Answer{{{"file", recording.file}, {"frames", film.frames()}, {"bytes", film.bytes()}, {"width", (*wall)->width()}, {"height", (*wall)->height()}, {"fps", recording.fps}}, {}};
}

}  // namespace wall::wallctl
