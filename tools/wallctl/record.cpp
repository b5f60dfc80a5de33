// SPDX-License-Identifier: MIT
#include "tools/wallctl/record.h"

#include <filesystem>
#include <iomanip>
#include <iostream>

#include "common/codec/avi.h"
#include "common/codec/huffyuv.h"
#include "tools/view/live_view.h"
#include "tools/wallctl/interrupts.h"

namespace wall::wallctl {
namespace {

using request::failed;

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kFirstPictures{5};
constexpr const char* kCodec = "huffyuv-tiles";  // between walld and here

/// The file and its encoder, made with the first frame.
class Film {
public:
    explicit Film(const Recording& recording) : recording_(recording) {}

    Result<void> add(const codec::FrameView& frame) {
        if (!encoder_) {
            auto made = codec::huffyuv::make_stream_encoder({frame.width, frame.height, frame.layout, false}, {});
            if (!made) return tl::unexpected(made.error());
            encoder_ = std::move(*made);
            width_ = frame.width;
            height_ = frame.height;
        }
        packet_.clear();
        if (auto done = encoder_->encode(frame, codec::PacketKind::key, packet_); !done)
            return tl::unexpected(done.error());
        if (!avi_) {
            const auto header = encoder_->stream_header();
            auto avi = codec::AviWriter::create(recording_.file, {frame.width,
                                                                  frame.height,
                                                                  {'H', 'F', 'Y', 'U'},
                                                                  codec::huffyuv::bit_count(encoder_->stream()),
                                                                  recording_.fps,
                                                                  1,
                                                                  {header.begin(), header.end()}});
            if (!avi) return tl::unexpected(avi.error());
            avi_.emplace(std::move(*avi));
        }
        bytes_ += packet_.size();
        return avi_->add(packet_);
    }
    Result<void> finish() { return avi_ ? avi_->finish() : Result<void>(); }
    std::uint64_t frames() const { return avi_ ? avi_->frames() : 0; }
    std::uint64_t bytes() const { return bytes_; }
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }

private:
    const Recording& recording_;
    std::unique_ptr<codec::huffyuv::StreamEncoder> encoder_;
    std::optional<codec::AviWriter> avi_;
    std::vector<std::byte> packet_;
    std::uint64_t bytes_ = 0;
    std::uint32_t width_ = 0, height_ = 0;
};

void say(const Recording& recording, const Film& film) {
    const double seconds = static_cast<double>(film.frames()) / recording.fps;
    std::cerr << "\rrecording: " << std::fixed << std::setprecision(1) << seconds << " of " << recording.seconds
              << " s, " << film.frames() << " frames, " << static_cast<double>(film.bytes()) / 1e6 << " MB"
              << std::flush;
}

/// The picture as it is now. The error says why there will be no more.
Outcome<codec::Picture> picture_of(const view::LiveView& wall) {
    codec::Picture picture;
    std::string failure;
    wall.look([&](const view::Looked& now) {
        failure = now.failure;
        if (failure.empty()) picture = now.builder.picture();
    });
    if (!failure.empty()) return tl::unexpected<Failure>({"unavailable", failure});
    return picture;
}

}  // namespace

Outcome<Answer> record(const Walld& walld, const Recording& recording) {
    nlohmann::json entry{{"codec", kCodec}, {"fps", recording.fps}};
    if (recording.tile.empty()) entry["wall"] = true;
    else entry["tile"] = recording.tile;
    if (recording.output) entry["output"] = true;
    view::LiveView wall(
        [&walld](const nlohmann::json& what) { return view::open_control_feed(walld, nlohmann::json::array({what})); },
        entry, view::LiveView::AfterFailure::stay);
    if (!wall.wait_complete(kFirstPictures)) return failed("not every tile sent a picture within 5 s (wallctl tiles)");
    if (const auto first = picture_of(wall); !first) return tl::unexpected(first.error());
    watch_for_interrupts();
    Film film(recording);
    const auto frames = static_cast<std::uint64_t>(std::max(1.0, recording.seconds * recording.fps + 0.5));
    const auto begin = Clock::now();
    while (film.frames() < frames && !interrupted()) {
        const auto picture = picture_of(wall);
        if (!picture) {
            static_cast<void>(film.finish());
            return failed(recording.file + " ends after " + std::to_string(film.frames()) +
                          " frames: " + picture.error().message);
        }
        if (auto added = film.add(picture->view()); !added) return failed(added.error().message);
        if (recording.progress && film.frames() % recording.fps == 0) say(recording, film);
        std::this_thread::sleep_until(begin + std::chrono::microseconds(film.frames() * 1'000'000 / recording.fps));
    }
    if (recording.progress) say(recording, film), std::cerr << '\n';
    if (auto finished = film.finish(); !finished) return failed(finished.error().message);
    return Answer{{{"file", recording.file},
                   {"frames", film.frames()},
                   {"bytes", film.bytes()},
                   {"width", film.width()},
                   {"height", film.height()},
                   {"fps", recording.fps}},
                  {}};
}

}  // namespace wall::wallctl
