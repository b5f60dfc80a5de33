// SPDX-License-Identifier: MIT
// A wall of projectors that nobody has seen: a flat screen, projectors askew in front of it, and a camera whose lens
// bends lines, with noise and uneven light. What the calibration finds is held against what is known of the room.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

#include "common/config/read_warp.h"
#include "tests/unit/tools/room_camera.h"
#include "tools/wallcalibrate/flat_screen.h"

namespace wall::calibrate {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 800, kHeight = 600;  // of a projector
const cv::Size kPicture(1600, 1200);
constexpr double kGoodEnough = 0.5;  // pixels, 95 %

/// The screen is measured in pixels of an upright projector that fills its place in the grid.
struct Room {
    int columns = 2, rows = 2;
    double overlap = 120, askew = 35, noise = 3, k1 = 0.06, k2 = -0.015;
    std::uint64_t seed = 5;

    std::vector<cv::Matx33d> to_screen;  // of each projector, from its pixels
    cv::Matx33d camera;                  // from the screen to the ideal camera's pixels

    void build() {
        cv::RNG random(seed);
        const auto jitter = [&] { return static_cast<float>(random.uniform(-askew, askew)); };
        const std::vector<cv::Point2f> pixels{{0, 0}, {kWidth, 0}, {kWidth, kHeight}, {0, kHeight}};
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                const auto x = static_cast<float>(column * (kWidth - overlap)),
                           y = static_cast<float>(row * (kHeight - overlap));
                std::vector<cv::Point2f> on_screen;
                for (const auto& corner : pixels)
                    on_screen.emplace_back(x + corner.x + jitter(), y + corner.y + jitter());
                to_screen.emplace_back(cv::getPerspectiveTransform(pixels, on_screen));
            }
        }
        const auto w = static_cast<float>(columns * (kWidth - overlap) + overlap),
                   h = static_cast<float>(rows * (kHeight - overlap) + overlap);
        const std::vector<cv::Point2f> screen{{-60, -60}, {w + 60, -60}, {w + 60, h + 60}, {-60, h + 60}},
            seen{{190, 130}, {1430, 170}, {1380, 1050}, {230, 1010}};  // from the side, a little from below
        camera = cv::getPerspectiveTransform(screen, seen);
    }
    /// Where the lens shows what an ideal camera shows at a place: the other way round by Newton's method.
    cv::Point2d bent(const cv::Point2d& ideal) const {
        const Lens lens{kPicture, k1, k2};
        cv::Point2d at = ideal;
        for (int i = 0; i < 30; ++i) at += ideal - lens.straight(at);
        return at;
    }
    /// For each pixel of the camera, the projector's pixel that lights what it sees.
    LightMaps light_of(std::size_t projector) const {
        const Lens lens{kPicture, k1, k2};
        const cv::Matx33d to_output = (camera * to_screen[projector]).inv();
        LightMaps out{cv::Mat(kPicture, CV_32F), cv::Mat(kPicture, CV_32F)};
        for (int row = 0; row < kPicture.height; ++row) {
            for (int column = 0; column < kPicture.width; ++column) {
                const auto at = apply(to_output, lens.straight({column + 0.5, row + 0.5}));
                out.x.at<float>(row, column) = static_cast<float>(at.x - 0.5);
                out.y.at<float>(row, column) = static_cast<float>(at.y - 0.5);
            }
        }
        return out;
    }
    /// What is photographed while a projector shows something, and the others are black.
    Photograph camera_at(std::size_t projector) const {
        return photograph(light_of(projector), kWidth, kHeight, noise, seed + 77 * projector);
    }
};

struct Found {
    std::vector<Projector> projectors;
    FlatScreen screen;
    std::vector<PlannedTile> tiles;
};

Result<Found> calibrate(const Room& room) {
    Found out;
    std::vector<std::vector<Match>> matches;
    for (std::size_t i = 0; i < room.to_screen.size(); ++i) {
        auto decoded = decode(kWidth, kHeight, room.camera_at(i));
        if (!decoded) return tl::unexpected(decoded.error());
        matches.push_back(std::move(*decoded));
    }
    auto screen = find_flat_screen(kPicture, matches);
    if (!screen) return tl::unexpected(screen.error());
    out.screen = std::move(*screen);
    for (int row = 0; row < room.rows; ++row) {
        for (int column = 0; column < room.columns; ++column) {
            const auto i = out.projectors.size();
            out.projectors.push_back({"tile " + std::to_string(i),
                                      {column * kWidth, row * kHeight, kWidth, kHeight},
                                      kWidth,
                                      kHeight,
                                      out.screen.from_output[i]});
        }
    }
    auto tiles = plan_wall(out.projectors);
    if (!tiles) return tl::unexpected(tiles.error());
    out.tiles = std::move(*tiles);
    return out;
}

/// Of a tile's warp, the other way: from the canvas to the output's pixels.
cv::Point2d output_at(const PlannedTile& tile, const cv::Point2d& canvas) {
    cv::Matx33d warp;
    for (int i = 0; i < 9; ++i) warp.val[i] = tile.warp.homography[static_cast<std::size_t>(i)];
    const auto at =
        apply(warp.inv(), {(canvas.x - tile.rect.x) / tile.rect.width, (canvas.y - tile.rect.y) / tile.rect.height});
    return {at.x * tile.width, at.y * tile.height};
}

TEST(Calibration, FindsARoomThatNobodyHasSeen) {
    Room room;
    room.build();
    const auto found = calibrate(room);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_LT(found->screen.error, 0.6) << "matches are whole pixels of the camera and of the projector";

    // Every place of the canvas through every tile that shows it, to where its light really falls.
    std::vector<cv::Point2d> canvas, screen;
    std::vector<double> apart;
    std::vector<std::vector<cv::Point2d>> of_tile(found->tiles.size());
    int width = 0, height = 0;
    for (const auto& tile : found->tiles) {
        width = std::max(width, tile.rect.right());
        height = std::max(height, tile.rect.bottom());
    }
    for (int y = 5; y < height; y += 11) {
        for (int x = 5; x < width; x += 11) {
            std::vector<cv::Point2d> lights;
            for (std::size_t i = 0; i < found->tiles.size(); ++i) {
                if (weight_at(found->tiles[i], cv::Point2d(x, y)) == 0) continue;
                const auto pixel = output_at(found->tiles[i], cv::Point2d(x, y));
                ASSERT_TRUE(pixel.x >= 0 && pixel.y >= 0 && pixel.x <= kWidth && pixel.y <= kHeight)
                    << "a projector cannot show all of its tile";
                lights.push_back(apply(room.to_screen[i], pixel));
                canvas.emplace_back(x, y);
                screen.push_back(lights.back());
            }
            ASSERT_FALSE(lights.empty()) << "nobody shows " << x << ", " << y;
            for (const auto& light : lights) apart.push_back(cv::norm(light - lights[0]));
        }
    }
    EXPECT_LT(percentile(apart, 95), kGoodEnough) << "two projectors that show the same";
    // Flat: some homography brings the canvas to the screen.
    const cv::Mat whole = cv::findHomography(canvas, screen, 0);
    std::vector<double> bent;
    for (std::size_t i = 0; i < canvas.size(); ++i)
        bent.push_back(cv::norm(apply(cv::Matx33d(whole), canvas[i]) - screen[i]));
    EXPECT_LT(percentile(bent, 95), kGoodEnough) << "straight lines";

    // Light that falls on places of the screen, from the projectors' pixels there.
    std::vector<double> brightness;
    const cv::Matx33d to_screen(whole);
    for (int y = 20; y < height - 20; y += 7) {
        for (int x = 20; x < width - 20; x += 7) {
            const auto place = apply(to_screen, cv::Point2d(x, y));
            double light = 0;
            for (std::size_t i = 0; i < found->tiles.size(); ++i) {
                const auto& tile = found->tiles[i];
                const auto pixel = apply(room.to_screen[i].inv(), place);
                light += weight_at(tile, canvas_at(tile, output_of(tile), pixel));
            }
            brightness.push_back(std::abs(light - 1));
        }
    }
    EXPECT_LT(percentile(brightness, 99), 0.02) << "even in the overlaps";
}

TEST(Calibration, OfARowAndOfTwoAboveEachOther) {
    for (const auto& [columns, rows] : {std::pair{3, 1}, {1, 2}}) {
        Room room{.columns = columns, .rows = rows, .seed = 9};
        room.build();
        std::vector<Projector> projectors;
        for (int i = 0; i < columns * rows; ++i)
            projectors.push_back({std::to_string(i),
                                  {i % columns * kWidth, i / columns * kHeight, kWidth, kHeight},
                                  kWidth,
                                  kHeight,
                                  room.camera * room.to_screen[static_cast<std::size_t>(i)]});
        const auto tiles = plan_wall(projectors);
        ASSERT_TRUE(tiles) << tiles.error().message;
        const auto& first = tiles->front();
        EXPECT_EQ(first.rect.x, 0);
        EXPECT_EQ(first.rect.y, 0);
        EXPECT_EQ(first.ramps[geom::Blend::left] + first.ramps[geom::Blend::top], 0);
        EXPECT_EQ(first.ramps[geom::Blend::right] > 20, columns > 1);
        EXPECT_EQ(first.ramps[geom::Blend::bottom] > 20, rows > 1);
        if (columns == 1) continue;
        const auto& second = tiles->at(1);
        EXPECT_EQ(first.ramps[geom::Blend::right], second.ramps[geom::Blend::left]);
        EXPECT_EQ(first.rect.right() - second.rect.x, second.ramps[geom::Blend::left]);
    }
}

TEST(Calibration, SaysWhatIsWrong) {
    const Photograph nothing = [](const Shot&) -> Result<cv::Mat> { return cv::Mat(kPicture, CV_8UC1, cv::Scalar(9)); };
    EXPECT_THAT(decode(kWidth, kHeight, nothing).error().message, HasSubstr("only 0 pixels"));
    const Photograph lost = [](const Shot& shot) -> Result<cv::Mat> {
        if (shot.kind == Shot::Kind::code) return fail("x-9.png: cannot be read");
        return cv::Mat(kPicture, CV_8UC1, cv::Scalar(shot.kind == Shot::Kind::white ? 200 : 5));
    };
    EXPECT_EQ(decode(kWidth, kHeight, lost).error().message, "x-9.png: cannot be read");
    const Photograph other_size = [](const Shot& shot) -> Result<cv::Mat> {
        return cv::Mat(shot.kind == Shot::Kind::code ? 5 : 9, 9, CV_8UC1,
                       cv::Scalar(shot.kind == Shot::Kind::white ? 200 : 5));
    };
    EXPECT_THAT(decode(kWidth, kHeight, other_size).error().message, HasSubstr("expected grey, 9x9"));

    std::vector<Match> curved;  // a cylinder
    for (double y = 20; y < 600; y += 8)
        for (double x = 20; x < 800; x += 8) curved.push_back({{x, y + 40 * std::sin(x / 120)}, {x, y}});
    EXPECT_THAT(find_flat_screen({800, 600}, std::vector<std::vector<Match>>{curved}).error().message,
                HasSubstr("fit no flat screen"));

    std::vector<Projector> apart;
    for (int i = 0; i < 2; ++i)
        apart.push_back({"t",
                         {i * kWidth, 0, kWidth, kHeight},
                         kWidth,
                         kHeight,
                         cv::Matx33d(1, 0, i * (kWidth + 10), 0, 1, 0, 0, 0, 1)});
    EXPECT_THAT(plan_wall(apart).error().message, HasSubstr("do not overlap"));
    apart.push_back(apart.back());
    apart.back().rect.y = kHeight;
    EXPECT_THAT(plan_wall(apart).error().message, HasSubstr("expected a full grid"));
}

TEST(Calibration, WritesWhatWallTomlReads) {
    PlannedTile tile{"a", {10, 20, 700, 500}, 800, 600, {}, {0, 60, 0, 0}};
    tile.warp.homography = {1.01f, 0.02f, 0.003f, -0.01f, 0.98f, 0.02f, 0.001f, 0.002f, 1};
    EXPECT_EQ(tile_lines(tile, "a.warp", 2.2),
              "rect = [10, 20, 700, 500]\npixels = [800, 600]\nwarp = \"a.warp\"\n"
              "blend = { left = 0, right = 60, top = 0, bottom = 0, gamma = 2.2 }\n");
    const auto read = config::parse_warp(warp_text(tile.warp), "a.warp");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, tile.warp);
}

TEST(GrayCode, NamesItsPhotographs) {
    const auto shots = shots_of(5, 2);  // 3 bits and 1
    ASSERT_EQ(shots.size(), 2u + 2 * 3 + 2 * 1);
    EXPECT_EQ(shots[0].name(), "white");
    EXPECT_EQ(shots[1].name(), "black");
    EXPECT_EQ(shots[2].name(), "x-2");
    EXPECT_EQ(shots[3].name(), "x-2-inverted");
    EXPECT_EQ(shots.back().name(), "y-0-inverted");
}

}  // namespace
}  // namespace wall::calibrate
