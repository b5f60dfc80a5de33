// SPDX-License-Identifier: MIT
// Rooms with curved screens that nobody has seen: projectors and a camera with a lens that bends lines, in metres. What
// the calibration finds is held against where the light really falls, as seen from where the camera stands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "common/config/read_warp.h"
#include "tests/unit/tools/room_camera.h"
#include "tools/wallcalibrate/camera_lens.h"
#include "tools/wallcalibrate/curved_screen.h"
#include "tools/wallcalibrate/flat_screen.h"

namespace wall::calibrate {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 400, kHeight = 300;  // of a projector
const cv::Size kPicture(1000, 640);
constexpr double kGoodEnough = 0.5;  // pixels of the canvas, 95 %
constexpr double kNowhere = -1000;   // of LightMaps

const CameraLens kLens{
    kPicture, {620, 0, 508, 0, 620, 309, 0, 0, 1}, {-0.12, 0.03, 0.001, -0.0015, 0}, 0};  // a wide one

/// From an eye, or a lamp: x to the right, y down, z ahead.
struct Stand {
    cv::Vec3d place;
    cv::Matx33d turn = cv::Matx33d::eye();  ///< the room's axes in its own
    cv::Matx33d pixels;                     ///< from its own to pixels whose middles are halves

    cv::Vec3d ray(const cv::Point2d& pixel) const {
        return cv::normalize(turn.t() * (pixels.inv() * cv::Vec3d(pixel.x, pixel.y, 1)));
    }
    std::optional<cv::Point2d> pixel(const cv::Vec3d& point) const {
        const cv::Vec3d at = pixels * (turn * (point - place));
        if (at[2] <= 0) return std::nullopt;
        return cv::Point2d(at[0] / at[2], at[1] / at[2]);
    }
};

/// The screen's point on a ray.
using Screen = std::function<std::optional<cv::Vec3d>(const cv::Vec3d& from, const cv::Vec3d& way)>;

/// The far side, where (p . weights . p) is radius²: a vertical cylinder, or a sphere, around `middle`.
Screen round(cv::Vec3d middle, double radius, cv::Vec3d weights, double top, double bottom) {
    return [=](const cv::Vec3d& from, const cv::Vec3d& way) -> std::optional<cv::Vec3d> {
        const cv::Vec3d p = from - middle, w = weights.mul(way);
        const double a = w.dot(way), b = w.dot(p), c = weights.mul(p).dot(p) - radius * radius;
        if (b * b < a * c) return std::nullopt;
        const cv::Vec3d at = from + way * ((-b + std::sqrt(b * b - a * c)) / a);
        if (at[1] < top || at[1] > bottom) return std::nullopt;
        return at;
    };
}
const Screen kCylinder = round({0, 0, 0}, 3, {1, 0, 1}, -100, 100);
/// Projectors shine past its rims.
const Screen kBand = round({0, 0, 0}, 3, {1, 0, 1}, -0.5, 0.55);
const Screen kSphere = round({0, 0, 0}, 3, {1, 1, 1}, -100, 100);

cv::Matx33d turned(double yaw, double pitch, double roll) {
    cv::Matx33d x, y, z;
    cv::Rodrigues(cv::Vec3d(-pitch, 0, 0), x);
    cv::Rodrigues(cv::Vec3d(0, -yaw, 0), y);
    cv::Rodrigues(cv::Vec3d(0, 0, -roll), z);
    return z * x * y;
}

/// The camera's, row by row.
std::vector<cv::Point2d> all_pixels() {
    std::vector<cv::Point2d> out;
    for (int y = 0; y < kPicture.height; ++y)
        for (int x = 0; x < kPicture.width; ++x) out.emplace_back(x + 0.5, y + 0.5);
    return out;
}

struct Room {
    Screen screen;
    std::vector<Stand> projectors;
    Stand camera{{0.1, 0.05, -0.6}, turned(0.02, -0.01, 0.01), {}};
    double noise = 3;
    cv::Mat lit;  ///< what each pixel of the camera sees of the screen, metres; NaN: nothing

    /// A row of them, near the middle, each a little askew.
    Room(Screen of, int columns, int rows) : screen(std::move(of)) {
        camera.pixels = kLens.matrix;
        camera.pixels(0, 2) += 0.5;
        camera.pixels(1, 2) += 0.5;
        cv::RNG random(11);
        const auto askew = [&] { return random.uniform(-0.02, 0.02); };
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                projectors.push_back({{askew(), askew(), askew() - 0.2},
                                      turned((column - (columns - 1) / 2.0) * 0.46 + askew(),
                                             -(row - (rows - 1) / 2.0) * 0.34 + askew(), askew()),
                                      {720, 0, kWidth / 2.0, 0, 720, kHeight / 2.0, 0, 0, 1}});
        const auto ideal = straight(kLens, all_pixels());
        std::vector<cv::Vec3d> ways, points;
        cv::convertPointsToHomogeneous(ideal, ways);
        cv::transform(ways, ways, camera.turn.t() * camera.pixels.inv());
        constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
        for (const cv::Vec3d& way : ways)
            points.push_back(
                screen(camera.place, cv::normalize(way)).value_or(cv::Vec3d(kNothing, kNothing, kNothing)));
        lit = cv::Mat(points, true).reshape(3, kPicture.height);
    }
    LightMaps light_of(const Stand& projector) const {
        const cv::Matx33d seen = projector.pixels * projector.turn;
        cv::Mat at;
        cv::transform(lit - cv::Scalar(projector.place[0], projector.place[1], projector.place[2]), at, seen);
        std::array<cv::Mat, 3> axes;
        cv::split(at, axes.data());
        LightMaps out;
        for (cv::Mat* map : {&out.x, &out.y}) {
            cv::Mat& axis = axes[map == &out.x ? 0 : 1];
            axis = axis / axes[2] - 0.5;
            axis.convertTo(*map, CV_32F);
            map->setTo(kNowhere, axes[2] != axes[2]);  // no number
            map->setTo(kNowhere, axes[2] <= 0);
        }
        return out;
    }
    Result<std::vector<Seen>> photographed() const {
        std::vector<Seen> out;
        for (std::size_t i = 0; i < projectors.size(); ++i) {
            auto matches =
                decode(kWidth, kHeight, photograph(light_of(projectors[i]), kWidth, kHeight, noise, 3 + 77 * i));
            if (!matches) return tl::unexpected(matches.error());
            out.push_back({kWidth, kHeight, std::move(*matches)});
        }
        return out;
    }
};

struct Found {
    double error = 0;
    std::vector<PlannedTile> tiles;
};

Result<Found> calibrate(const Room& room, int columns) {
    const auto seen = room.photographed();
    if (!seen) return tl::unexpected(seen.error());
    auto screen = find_curved_screen(&kLens, *seen);
    if (!screen) return tl::unexpected(screen.error());
    std::vector<Projector> projectors;
    for (int i = 0; i < static_cast<int>(room.projectors.size()); ++i) {
        projectors.push_back({"tile " + std::to_string(i),
                              {i % columns * kWidth, i / columns * kHeight, kWidth, kHeight},
                              kWidth,
                              kHeight,
                              {},
                              {}});
        put(projectors.back(), std::move(screen->seen[static_cast<std::size_t>(i)]));
    }
    auto tiles = plan_wall(projectors);
    if (!tiles) return tl::unexpected(tiles.error());
    return Found{screen->error, std::move(*tiles)};
}

/// What the camera sees of the wall: places of the canvas, and where they are in an ideal camera's picture.
struct Shown {
    std::vector<cv::Point2d> canvas, camera;
    std::vector<double> off;         // from the homography that is between both, pixels of the canvas
    std::vector<double> brightness;  // how much less or more light there is than one projector's
};

Shown show(const Room& room, const std::vector<PlannedTile>& tiles) {
    Shown out;
    std::vector<geom::TileOutput> outputs;
    for (const auto& tile : tiles) outputs.push_back(output_of(tile));
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        for (int y = 3; y < kHeight; y += 7) {
            for (int x = 3; x < kWidth; x += 7) {
                const cv::Point2d pixel(x, y);
                const auto canvas = canvas_at(tiles[i], outputs[i], pixel);
                if (weight_at(tiles[i], canvas) == 0) continue;
                const auto point = room.screen(room.projectors[i].place, room.projectors[i].ray(pixel));
                if (!point) continue;
                out.canvas.push_back(canvas);
                out.camera.push_back(*room.camera.pixel(*point));
                double light = 0;
                for (std::size_t k = 0; k < tiles.size(); ++k) {
                    const auto at = room.projectors[k].pixel(*point);
                    if (at && at->x >= 0 && at->y >= 0 && at->x <= kWidth && at->y <= kHeight)
                        light += weight_at(tiles[k], canvas_at(tiles[k], outputs[k], *at));
                }
                out.brightness.push_back(std::abs(light - 1));
            }
        }
    }
    const cv::Matx33d to_canvas(cv::findHomography(out.camera, out.canvas, 0));
    for (std::size_t i = 0; i < out.canvas.size(); ++i)
        out.off.push_back(cv::norm(apply(to_canvas, out.camera[i]) - out.canvas[i]));
    return out;
}

class CurvedCalibration : public ::testing::TestWithParam<std::tuple<const char*, Screen, int, int>> {};

TEST_P(CurvedCalibration, IsRightFromWhereTheCameraStands) {
    const auto& [name, screen, columns, rows] = GetParam();
    const Room room(screen, columns, rows);
    const auto found = calibrate(room, columns);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_LT(found->error, 1.0) << "matches are whole pixels of the camera and of the projector";
    const auto shown = show(room, found->tiles);
    ASSERT_GT(shown.canvas.size(), 2000u);
    EXPECT_LT(percentile(shown.off, 95), kGoodEnough);
    EXPECT_LT(percentile(shown.brightness, 99), 0.02) << "even in the overlaps";
    RecordProperty("off", std::to_string(percentile(shown.off, 95)));
    RecordProperty("brightness", std::to_string(percentile(shown.brightness, 99)));
    for (const auto& tile : found->tiles) {
        const auto read = config::parse_warp(warp_text(tile.warp), "a.warp");
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(read->points.size(), tile.warp.points.size());
    }
}

INSTANTIATE_TEST_SUITE_P(Rooms, CurvedCalibration,
                         ::testing::Values(std::tuple("cylinder", kCylinder, 3, 1), std::tuple("band", kBand, 2, 1),
                                           std::tuple("sphere", kSphere, 2, 2)),
                         [](const auto& room) { return std::string(std::get<0>(room.param)); });

TEST(CurvedScreen, ARimThatEndsBeforeTheLightIsBlackBeyond) {
    const Room room(kBand, 1, 1);
    const auto found = calibrate(room, 1);
    ASSERT_TRUE(found) << found.error().message;
    const auto& points = found->tiles[0].warp.points;
    EXPECT_TRUE(std::isnan(points.front().x)) << "light that misses the screen";
    EXPECT_FALSE(std::isnan(points[points.size() / 2].x));
}

TEST(CurvedScreen, SaysWhatIsWrong) {
    std::vector<Seen> seen(1, {kWidth, kHeight, {}});
    cv::RNG random(3);
    for (int i = 0; i < 60'000; ++i)  // as if the camera had moved between the photographs
        seen[0].matches.push_back(
            {{random.uniform(0.0, 1.0 * kPicture.width), random.uniform(0.0, 1.0 * kPicture.height)},
             {random.uniform(0.0, 1.0 * kWidth), random.uniform(0.0, 1.0 * kHeight)}});
    EXPECT_THAT(find_curved_screen(nullptr, seen).error().message, HasSubstr("fit no smooth screen"));
    seen[0].matches.resize(7);
    EXPECT_THAT(find_curved_screen(nullptr, seen).error().message, HasSubstr("no part is seen"));
}

/// A board of 9x6 inner corners, photographed from several sides through kLens.
std::vector<cv::Mat> boards(std::size_t count) {
    constexpr int kSquare = 60, kMargin = 60;
    cv::Mat board(7 * kSquare + 2 * kMargin, 10 * kSquare + 2 * kMargin, CV_8UC1, cv::Scalar(230));
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 10; ++x)
            if ((x + y) % 2 == 0)
                board(cv::Rect(kMargin + x * kSquare, kMargin + y * kSquare, kSquare, kSquare)).setTo(20);
    const cv::Mat ideal = cv::Mat(straight(kLens, all_pixels()), true) - cv::Scalar(0.5, 0.5);
    std::vector<cv::Mat> out;
    for (std::size_t i = 0; i < count; ++i) {
        const auto k = static_cast<double>(i);
        const cv::Matx33d turn = turned(0.5 * std::cos(k * 2.1), 0.45 * std::sin(k * 1.7), 0.05 * k);
        const cv::Vec3d place(250 * std::cos(k * 1.3), 110 * std::sin(k * 2.3), 850 + 80 * std::cos(k));
        // From the board's pixels (z = 0, its middle at the origin) to the ideal camera's.
        const cv::Matx33d to_board(1, 0, -board.cols / 2.0, 0, 1, -board.rows / 2.0, 0, 0, 1);
        cv::Matx33d plane = turn;
        for (int row = 0; row < 3; ++row) plane(row, 2) = place[row];
        const cv::Matx33d back = (kLens.matrix * plane * to_board).inv();
        cv::Mat at;
        cv::perspectiveTransform(ideal, at, back);
        at.reshape(2, kPicture.height).convertTo(at, CV_32F);
        cv::Mat photograph;
        cv::remap(board, photograph, at, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(128));
        cv::GaussianBlur(photograph, photograph, {5, 5}, 0.8);
        out.push_back(photograph);
    }
    return out;
}

TEST(CameraLens, IsFoundFromPhotographsOfABoard) {
    const auto found = find_lens(boards(16), {9, 6});
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_LT(found->error, 0.3);
    std::vector<cv::Point2d> seen, off;
    for (double y = 50; y < kPicture.height; y += 90)
        for (double x = 50; x < kPicture.width; x += 90) seen.emplace_back(x, y);
    // The focal length is not told apart from the picture's size by what is straight: compare up to a homography.
    const auto ideal = straight(*found, seen), truth = straight(kLens, seen);
    const cv::Matx33d between(cv::findHomography(ideal, truth, 0));
    std::vector<double> apart;
    for (std::size_t i = 0; i < seen.size(); ++i) apart.push_back(cv::norm(apply(between, ideal[i]) - truth[i]));
    EXPECT_LT(percentile(apart, 95), 0.3);

    EXPECT_THAT(find_lens(boards(3), {9, 6}).error().message, HasSubstr("3 of 3 photographs show a whole board"));
    const std::vector<cv::Mat> grey(6, cv::Mat(kPicture, CV_8UC1, cv::Scalar(99)));
    EXPECT_THAT(find_lens(grey, {9, 6}).error().message, HasSubstr("0 of 6"));
}

class LensFile : public ::testing::Test {
protected:
    ~LensFile() override { std::filesystem::remove(path_); }
    Result<CameraLens> read(const std::string& text) {
        std::ofstream(path_) << text;
        return read_lens(path_);
    }
    std::filesystem::path path_ = std::filesystem::path(::testing::TempDir()) / "curved_calibrate_test.yml";
};

TEST_F(LensFile, IsReadAsItWasWritten) {
    const auto again = read(lens_text(kLens));
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->picture, kLens.picture);
    EXPECT_EQ(again->matrix, kLens.matrix);
    EXPECT_EQ(again->distortion, kLens.distortion);
    EXPECT_TRUE(read(lens_text({kPicture, kLens.matrix, {}, 0}))) << "a lens that bends nothing";
}

TEST_F(LensFile, SaysWhatIsWrong) {
    EXPECT_THAT(read_lens("/nowhere/lens.yml").error().message, HasSubstr("cannot be read"));
    EXPECT_THAT(read("no file of OpenCV's").error().message, HasSubstr("expected what `wallctl calibrate lens`"));
    EXPECT_THAT(read("%YAML:1.0\n---\nimage_width: 5\n").error().message, HasSubstr("image_width and _height"));
    CameraLens wrong = kLens;
    wrong.matrix(0, 0) = -3;
    EXPECT_THAT(read(lens_text(wrong)).error().message, HasSubstr("sees nothing"));
    wrong = kLens;
    wrong.distortion.resize(3);
    EXPECT_THAT(read(lens_text(wrong)).error().message, HasSubstr("4, 5, 8, 12 or 14 numbers"));
    wrong = kLens;
    wrong.picture = {};
    EXPECT_THAT(read(lens_text(wrong)).error().message, HasSubstr("image_width"));
}

}  // namespace
}  // namespace wall::calibrate
