// SPDX-License-Identifier: MIT
// What the driver makes of a picture, beside what OpenCV makes of it.
#include "tileserver/render/output_pass.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "gen/glstate/samples.gen.h"
#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver {
namespace {

constexpr int kSeed = 7;

/// Every pixel of its own colour.
cv::Mat noise(int width, int height) {
    cv::Mat out(height, width, CV_8UC4);
    cv::RNG random(kSeed);
    random.fill(out, cv::RNG::UNIFORM, 0, 256);
    for (auto& pixel : cv::Mat_<cv::Vec4b>(out)) pixel[3] = 255;
    return out;
}

/// At most some levels from pixel to pixel: OpenCV's remap knows places to 1/32 pixel only.
cv::Mat hills(int width, int height) {
    cv::Mat small = noise(std::max(2, width / 24), std::max(2, height / 24)), out;
    cv::resize(small, out, {width, height}, 0, 0, cv::INTER_CUBIC);
    for (auto& pixel : cv::Mat_<cv::Vec4b>(out)) pixel[3] = 255;
    return out;
}

struct Difference {
    int most = 0;           ///< levels
    double beyond_one = 0;  ///< share of all values
};

Difference difference(const cv::Mat& a, const cv::Mat& b) {
    EXPECT_EQ(a.size(), b.size());
    if (a.size() != b.size()) return {256, 1};
    cv::Mat apart;
    cv::absdiff(a, b, apart);
    double most = 0;
    cv::minMaxLoc(apart.reshape(1), nullptr, &most);
    return {static_cast<int>(most), cv::countNonZero(apart.reshape(1) > 1) / static_cast<double>(apart.total() * 4)};
}

class Outputs : public ::testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no " << GetParam() << " here";
        before_ = held();
        pass_.emplace(*node_.driver);
    }
    void TearDown() override {
        if (!node_.usable()) return;
        pass_.reset();
        drop(canvas_);
        drop(of_right_eye_);
        EXPECT_EQ(node_.driver->drain_errors(), 0u);
        EXPECT_EQ(held(), before_) << "objects of the driver";
    }
    std::int64_t held() const {
        const auto& objects = *node_.driver->gl().objects;
        return objects.textures + objects.framebuffers + objects.programs + objects.shaders + objects.buffers;
    }
    void drop(PictureTexture& canvas) {
        const auto& gl = node_.driver->gl();
        node_.driver->forget_texture(canvas.texture);
        gl.DeleteTextures(1, &canvas.texture);
        canvas = {};
    }
    void set(PictureTexture& canvas, const cv::Mat& picture) {
        const auto& gl = node_.driver->gl();
        drop(canvas);
        gl.CreateTextures(GL_TEXTURE_2D, 1, &canvas.texture);
        gl.TextureStorage2D(canvas.texture, 1, GL_RGBA8, picture.cols, picture.rows);
        node_.driver->neutral_pixel_transfer();
        gl.TextureSubImage2D(canvas.texture, 0, 0, 0, picture.cols, picture.rows, GL_RGBA, GL_UNSIGNED_BYTE,
                             picture.data);
        canvas.width = picture.cols;
        canvas.height = picture.rows;
        canvas.version = ++version_;
    }
    void set_canvas(const cv::Mat& picture) { set(canvas_, picture); }
    cv::Mat shown(const geom::TileOutput& output) { return shown(std::make_shared<const geom::TileOutput>(output)); }
    cv::Mat shown(const std::shared_ptr<const geom::TileOutput>& output) {
        const auto picture = pass_->show(0, output, canvas_, of_right_eye_);
        EXPECT_TRUE(picture) << picture.error().message;
        if (!picture) return {};
        cv::Mat out(picture->height, picture->width, CV_8UC4);
        node_.driver->gl().GetTextureImage(picture->texture, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                                           static_cast<GLsizei>(out.total() * 4), out.data);
        return out;
    }
    cv::Mat shown(const geom::TileOutput& output, const cv::Mat& canvas) {
        set_canvas(canvas);
        return shown(output);
    }

    test::TestNode node_{GetParam()};
    std::int64_t before_ = 0;
    std::optional<OutputPass> pass_;
    PictureTexture canvas_, of_right_eye_;
    std::uint64_t version_ = 0;
};

TEST_P(Outputs, ThatAreTurnedHaveEveryPixelWhereItBelongs) {
    const cv::Mat canvas = noise(45, 28);
    constexpr std::array<std::pair<std::uint32_t, cv::RotateFlags>, 3> kTurns{
        {{90, cv::ROTATE_90_COUNTERCLOCKWISE}, {180, cv::ROTATE_180}, {270, cv::ROTATE_90_CLOCKWISE}}};
    for (const auto& [rotation, by_opencv] : kTurns) {
        cv::Mat expected;
        cv::rotate(canvas, expected, by_opencv);
        const geom::TileOutput output{.rotation = rotation, .width = expected.cols, .height = expected.rows};
        EXPECT_EQ(difference(shown(output, canvas), expected).most, 0) << rotation;
    }
}

TEST_P(Outputs, OfMorePixelsAreLinearBetweenThoseOfTheCanvas) {
    const cv::Mat canvas = noise(40, 30);
    cv::Mat exact, expected;
    canvas.convertTo(exact, CV_32F);
    cv::resize(exact, expected, {100, 90}, 0, 0, cv::INTER_LINEAR);
    expected.convertTo(expected, CV_8U);
    EXPECT_LE(difference(shown({.width = 100, .height = 90}, canvas), expected).most, 1);
}

TEST_P(Outputs, OfFewerPixelsMissNoneOfTheCanvas) {
    const cv::Mat canvas = noise(120, 90);
    cv::Mat halved;
    cv::resize(canvas, halved, {60, 30}, 0, 0, cv::INTER_AREA);
    EXPECT_LE(difference(shown({.width = 60, .height = 30}, canvas), halved).most, 1) << "means of 2 x 3 pixels";
    // As docs/walls.md says: as many taps as pixels are covered, rounded up, each linear.
    cv::Mat exact, taps, expected;
    canvas.convertTo(exact, CV_32F);
    cv::resize(exact, taps, {2 * 80, 2 * 50}, 0, 0, cv::INTER_LINEAR);
    cv::resize(taps, expected, {80, 50}, 0, 0, cv::INTER_AREA);
    expected.convertTo(expected, CV_8U);
    EXPECT_LE(difference(shown({.width = 80, .height = 50}, canvas), expected).most, 1);
}

/// Where the centre of a pixel is, of `pixels` in a row.
float center(int pixel, int pixels) { return (static_cast<float>(pixel) + 0.5f) / static_cast<float>(pixels); }

/// What cv::remap makes of places that are fractions of the canvas.
cv::Mat remapped(const cv::Mat& canvas, const cv::Mat& x, const cv::Mat& y) {
    cv::Mat exact, out;
    canvas.convertTo(exact, CV_32F);
    cv::remap(exact, out, x * canvas.cols - 0.5, y * canvas.rows - 0.5, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    for (int row = 0; row < x.rows; ++row) {
        for (int column = 0; column < x.cols; ++column) {
            const float u = x.at<float>(row, column), v = y.at<float>(row, column);
            if (u < 0 || u > 1 || v < 0 || v > 1) out.at<cv::Vec4f>(row, column) = {0, 0, 0, 255};
        }
    }
    out.convertTo(out, CV_8U);
    return out;
}

/// The places of an output's pixels, one map for x and one for y.
std::pair<cv::Mat, cv::Mat> places(const geom::TileOutput& output) {
    cv::Mat x(output.height, output.width, CV_32F), y(output.height, output.width, CV_32F);
    for (int row = 0; row < output.height; ++row) {
        for (int column = 0; column < output.width; ++column) {
            const auto at = geom::place_in_tile(output, {center(column, output.width), center(row, output.height)});
            x.at<float>(row, column) = at.x;
            y.at<float>(row, column) = at.y;
        }
    }
    return {x, y};
}

/// A pixel at the very edge may be black in one and not in the other.
constexpr double kAtTheEdge = 0.001;

TEST_P(Outputs, BehindAHomographyShowWhatOpenCVFinds) {
    // Corners of the output in the tile: a keystone, partly beyond it.
    const std::vector<cv::Point2f> output{{0, 0}, {1, 0}, {1, 1}, {0, 1}},
        tile{{0.1f, -0.05f}, {0.95f, 0.08f}, {1.02f, 0.97f}, {0.02f, 0.9f}};
    const cv::Mat found = cv::getPerspectiveTransform(output, tile);
    geom::Warp warp;
    for (int i = 0; i < 9; ++i) warp.homography[i] = static_cast<float>(found.at<double>(i / 3, i % 3));
    const cv::Mat canvas = hills(400, 300);
    const geom::TileOutput warped{.width = 420, .height = 330, .warp = std::make_shared<const geom::Warp>(warp)};
    // OpenCV's own transform of the places, not ours.
    std::vector<cv::Point2f> pixels, there;
    for (int row = 0; row < warped.height; ++row)
        for (int column = 0; column < warped.width; ++column)
            pixels.emplace_back(center(column, warped.width), center(row, warped.height));
    cv::perspectiveTransform(pixels, there, found);
    std::array<cv::Mat, 2> maps;
    cv::split(cv::Mat(there).reshape(2, warped.height), maps.data());
    const auto apart = difference(shown(warped, canvas), remapped(canvas, maps[0], maps[1]));
    EXPECT_LE(apart.beyond_one, kAtTheEdge) << "at most " << apart.most << " levels";
}

TEST_P(Outputs, BehindAMeshShowWhatItsCellsSay) {
    geom::Warp warp;
    warp.columns = 9;
    warp.rows = 7;
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<float> shift(-0.02f, 0.02f);
    cv::Mat x(7, 9, CV_32F), y(7, 9, CV_32F);
    for (int row = 0; row < 7; ++row) {
        for (int column = 0; column < 9; ++column) {
            const geom::Point at{static_cast<float>(column) / 8 + shift(random),
                                 static_cast<float>(row) / 6 + shift(random)};
            warp.points.push_back(at);
            x.at<float>(row, column) = at.x;
            y.at<float>(row, column) = at.y;
        }
    }
    ASSERT_EQ(geom::wrong_with(warp), nullptr);
    const cv::Mat canvas = hills(400, 300);
    for (const std::uint32_t rotation : {0u, 270u}) {
        const geom::TileOutput output{.rotation = rotation,
                                      .width = rotation == 0 ? 440 : 330,
                                      .height = rotation == 0 ? 330 : 440,
                                      .warp = std::make_shared<const geom::Warp>(warp)};
        const auto [u, v] = places(output);
        const auto apart = difference(shown(output, canvas), remapped(canvas, u, v));
        EXPECT_LE(apart.beyond_one, kAtTheEdge) << rotation << ": at most " << apart.most << " levels";
        if (rotation != 0) continue;
        // The places themselves, from OpenCV: a cell of the mesh is a linear part of a larger grid.
        const int middle_row = output.height / 2, middle_column = output.width / 3;
        const float column = 8 * center(middle_column, output.width), row = 6 * center(middle_row, output.height);
        cv::Mat there;
        cv::remap(x, there, cv::Mat(1, 1, CV_32F, cv::Scalar(column)), cv::Mat(1, 1, CV_32F, cv::Scalar(row)),
                  cv::INTER_LINEAR);
        EXPECT_NEAR(u.at<float>(middle_row, middle_column), there.at<float>(0), 1e-3);
    }
}

/// Light of a value.
double light(double value, double gamma) { return std::pow(value / 255, gamma); }

TEST_P(Outputs, ThatOverlapShineTogetherAsOneAlone) {
    constexpr int kWidth = 200, kHeight = 40, kOverlap = 50;
    constexpr float kGamma = 2.2f;
    const cv::Mat whole(kHeight, 2 * kWidth - kOverlap, CV_8UC4, cv::Scalar(200, 120, 255, 255));
    const auto side = [&](geom::Blend::Edge edge, int x) {
        geom::TileOutput output{.width = kWidth, .height = kHeight, .blend = geom::Blend{.gamma = kGamma}};
        output.blend->ramps[edge] = kOverlap;
        return shown(output, whole(cv::Rect(x, 0, kWidth, kHeight)).clone());
    };
    const cv::Mat left = side(geom::Blend::right, 0), right = side(geom::Blend::left, kWidth - kOverlap);
    for (int x = 0; x < whole.cols; ++x) {
        for (int channel = 0; channel < 3; ++channel) {
            double sum = 0;
            if (x < kWidth) sum += light(left.at<cv::Vec4b>(9, x)[channel], kGamma);
            if (x >= kWidth - kOverlap) sum += light(right.at<cv::Vec4b>(9, x - kWidth + kOverlap)[channel], kGamma);
            const double wanted = light(whole.at<cv::Vec4b>(9, x)[channel], kGamma);
            EXPECT_NEAR(sum, wanted, 0.01) << "at " << x << ", channel " << channel;
        }
    }
    EXPECT_LT(left.at<cv::Vec4b>(9, kWidth - 1)[0], 10) << "the edge itself is all the other one's";
}

/// Four projectors around one point, each with a black that is not quite dark.
TEST_P(Outputs, HaveOneBlackWhereverManyShine) {
    constexpr int kSize = 120, kOverlap = 40;
    constexpr float kGamma = 2.2f, kBlack = 0.02f;
    const cv::Mat dark(kSize, kSize, CV_8UC4, cv::Scalar(0, 0, 0, 255));
    constexpr int kWhole = 2 * kSize - kOverlap;
    cv::Mat sum(kWhole, kWhole, CV_64F, cv::Scalar(0));
    for (const int x : {0, kSize - kOverlap}) {
        for (const int y : {0, kSize - kOverlap}) {
            geom::TileOutput output{
                .width = kSize, .height = kSize, .blend = geom::Blend{.gamma = kGamma, .black = kBlack}};
            output.blend->ramps[x == 0 ? geom::Blend::right : geom::Blend::left] = kOverlap;
            output.blend->ramps[y == 0 ? geom::Blend::bottom : geom::Blend::top] = kOverlap;
            const cv::Mat picture = shown(output, dark);
            for (int row = 0; row < kSize; ++row)
                for (int column = 0; column < kSize; ++column)
                    sum.at<double>(y + row, x + column) +=
                        kBlack + light(picture.at<cv::Vec4b>(row, column)[0], kGamma);
        }
    }
    double least = 0, most = 0;
    cv::minMaxLoc(sum, &least, &most);
    EXPECT_NEAR(least, 4 * kBlack, 0.01);
    EXPECT_NEAR(most, 4 * kBlack, 0.01);
}

/// A map over all of the output, as OpenCV enlarges it.
cv::Mat enlarged(const geom::LightMap::Map& map, int width, int height) {
    const cv::Mat small(static_cast<int>(map.height), static_cast<int>(map.width),
                        map.channels == 1 ? CV_8UC1 : CV_8UC3, const_cast<std::uint8_t*>(map.values.data()));
    cv::Mat values, out;
    small.convertTo(values, CV_MAKETYPE(CV_32F, static_cast<int>(map.channels)), 1 / 255.0);
    cv::resize(values, out, {width, height}, 0, 0, cv::INTER_LINEAR);
    if (map.channels == 1) cv::cvtColor(out, out, cv::COLOR_GRAY2RGB);
    return out;
}

TEST_P(Outputs, ShareAndLiftLightByMaps) {
    const auto map = [](std::uint32_t width, std::uint32_t height, std::uint32_t channels, unsigned least) {
        geom::LightMap::Map out{width, height, channels, {}};
        std::mt19937 random(kSeed);
        std::uniform_int_distribution<unsigned> value(least, 255);
        for (std::uint32_t i = 0; i < width * height * channels; ++i)
            out.values.push_back(static_cast<std::uint8_t>(value(random)));
        return out;
    };
    const cv::Mat canvas = hills(150, 90);
    for (const auto& light :
         {geom::LightMap{map(150, 90, 1, 0), {}}, geom::LightMap{map(7, 5, 3, 100), {}},
          geom::LightMap{{}, map(9, 4, 1, 0)}, geom::LightMap{map(31, 17, 3, 0), map(5, 6, 3, 0)}}) {
        const geom::TileOutput output{
            .width = 150, .height = 90, .light = std::make_shared<const geom::LightMap>(light)};
        const cv::Mat got = shown(output, canvas);
        const cv::Mat all(90, 150, CV_32FC3, cv::Scalar(1, 1, 1)), none(90, 150, CV_32FC3, cv::Scalar(0, 0, 0));
        const cv::Mat share = light.share.width != 0 ? enlarged(light.share, 150, 90) : all;
        const cv::Mat lift = light.lift.width != 0 ? enlarged(light.lift, 150, 90) : none;
        cv::Mat expected(90, 150, CV_8UC4);
        for (int y = 0; y < 90; ++y)
            for (int x = 0; x < 150; ++x) {
                for (int i = 0; i < 3; ++i) {
                    const double value = canvas.at<cv::Vec4b>(y, x)[i] / 255.0 * share.at<cv::Vec3f>(y, x)[i];
                    const double least = lift.at<cv::Vec3f>(y, x)[i];
                    expected.at<cv::Vec4b>(y, x)[i] =
                        static_cast<std::uint8_t>(std::lround(255 * (value * (1 - least) + least)));
                }
                expected.at<cv::Vec4b>(y, x)[3] = 255;
            }
        EXPECT_LE(difference(got, expected).most, 1) << light.share.width << " and " << light.lift.width;
    }
}

TEST_P(Outputs, AreBlackWhereAMeshHasNoPoint) {
    geom::Warp warp;
    warp.columns = warp.rows = 5;
    for (int i = 0; i < 25; ++i) warp.points.push_back({static_cast<float>(i % 5) / 4, static_cast<float>(i / 5) / 4});
    warp.points[0] = {NAN, NAN};
    ASSERT_EQ(geom::wrong_with(warp), nullptr);
    const cv::Mat canvas(80, 120, CV_8UC4, cv::Scalar(90, 180, 255, 255));
    const cv::Mat got = shown({.width = 120, .height = 80, .warp = std::make_shared<const geom::Warp>(warp)}, canvas);
    cv::Mat expected = canvas.clone();
    expected(cv::Rect(0, 0, 30, 20)) = cv::Scalar(0, 0, 0, 255);
    EXPECT_EQ(difference(got, expected).most, 0);
}

TEST_P(Outputs, HaveTheirColoursMixedInLight) {
    const cv::Mat canvas = noise(16, 16);
    geom::ColorCorrection color{.matrix = {0.8f, 0.1f, 0, 0, 0.9f, 0.05f, 0.2f, 0, 0.7f}, .gamma = 2};
    const cv::Mat picture = shown({.width = 16, .height = 16, .color = color}, canvas);
    for (int i = 0; i < 16; ++i) {
        const auto from = canvas.at<cv::Vec4b>(i, i), to = picture.at<cv::Vec4b>(i, i);
        for (int row = 0; row < 3; ++row) {
            double mixed = 0;
            for (int column = 0; column < 3; ++column)
                mixed += color.matrix[3 * row + column] * light(from[column], color.gamma);
            EXPECT_NEAR(to[row], 255 * std::sqrt(std::min(1.0, mixed)), 1.01) << i;
        }
    }
}

TEST_P(Outputs, HaveTheirToneCurves) {
    cv::Mat canvas(1, 256, CV_8UC4);
    for (int i = 0; i < 256; ++i) canvas.at<cv::Vec4b>(0, i) = cv::Vec4b(cv::Vec4i(i, i, i, 255));
    geom::ColorCorrection color;
    color.curves = {geom::ColorCorrection::Curve{1, 0}, {0, 0.5f, 0.6f}, {}};
    const cv::Mat picture = shown({.width = 256, .height = 1, .color = color}, canvas);
    for (int i = 0; i < 256; ++i) {
        const auto to = picture.at<cv::Vec4b>(0, i);
        EXPECT_NEAR(to[0], 255 - i, 1) << "inverted";
        EXPECT_NEAR(to[1], i < 127.5 ? i : 127.5 + (i - 127.5) * 0.2, 1) << "bent in the middle";
        EXPECT_NEAR(to[2], i, 1) << "as it is";
    }
}

TEST_P(Outputs, ShowTwoEyes) {
    using geom::StereoLayout;
    constexpr int kWidth = 64, kHeight = 48;
    const cv::Mat left = noise(kWidth, kHeight);
    cv::Mat right;
    cv::flip(left, right, 1);
    const cv::Rect whole(0, 0, kWidth, kHeight);
    // Half of a picture has each two pixels as one.
    const auto halved = [](const cv::Mat& picture, int width, int height) {
        cv::Mat out;
        cv::resize(picture, out, {width, height}, 0, 0, cv::INTER_AREA);
        return out;
    };
    cv::Mat sides, halves, rows = left.clone(), glasses = left.clone();
    cv::hconcat(halved(left, kWidth / 2, kHeight), halved(right, kWidth / 2, kHeight), sides);
    cv::vconcat(halved(left, kWidth, kHeight / 2), halved(right, kWidth, kHeight / 2), halves);
    for (int y = 1; y < kHeight; y += 2) right.row(y).copyTo(rows.row(y));
    for (const int channel : {1, 2}) cv::mixChannels(std::vector{right}, std::vector{glasses}, {channel, channel});
    const auto shown_as = [&](StereoLayout layout, std::int32_t width = 64) {
        geom::TileOutput output{.width = width, .height = kHeight};
        output.stereo = layout;
        output.right_slot = 1;
        return shown(output);
    };
    set(canvas_, left);
    set(of_right_eye_, right);
    EXPECT_LE(difference(shown_as(StereoLayout::side_by_side), sides).most, 1);
    EXPECT_LE(difference(shown_as(StereoLayout::over_under), halves).most, 1);
    EXPECT_EQ(difference(shown_as(StereoLayout::rows), rows).most, 0);
    EXPECT_EQ(difference(shown_as(StereoLayout::anaglyph), glasses).most, 0);
    // Where the output has pixels for both, none is lost.
    const cv::Mat full = shown_as(StereoLayout::side_by_side, 2 * kWidth);
    EXPECT_EQ(difference(full(whole), left).most, 0);
    EXPECT_EQ(difference(full(whole + cv::Point(kWidth, 0)), right).most, 0);
}

TEST_P(Outputs, ShowTheOtherEyeAnewWhenOnlyThatHasChanged) {
    const cv::Mat left = noise(32, 24);
    cv::Mat right;
    cv::flip(left, right, 0);
    geom::TileOutput output{.width = 32, .height = 24};
    output.stereo = geom::StereoLayout::rows;
    const auto what = std::make_shared<const geom::TileOutput>(output);
    set(canvas_, left);
    set(of_right_eye_, left);
    EXPECT_EQ(difference(shown(what), left).most, 0);
    cv::Mat mixed = left.clone();
    for (int y = 1; y < 24; y += 2) right.row(y).copyTo(mixed.row(y));
    set(of_right_eye_, right);
    EXPECT_EQ(difference(shown(what), mixed).most, 0);
}

TEST_P(Outputs, AreMadeOnceForEachPicture) {
    const geom::TileOutput output{.rotation = 180, .width = 8, .height = 8};
    const auto same = std::make_shared<const geom::TileOutput>(output);
    set_canvas(noise(8, 8));
    const auto first = pass_->show(0, same, canvas_);
    ASSERT_TRUE(first);
    const auto& gl = node_.driver->gl();
    constexpr float kOther[] = {0, 0, 1, 1};
    gl.ClearTexImage(first->texture, 0, GL_RGBA, GL_FLOAT, kOther);
    const auto again = pass_->show(0, same, canvas_);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->texture, first->texture);
    std::array<std::uint8_t, 8 * 8 * 4> pixels{};
    gl.GetTextureImage(again->texture, 0, GL_RGBA, GL_UNSIGNED_BYTE, sizeof pixels, pixels.data());
    EXPECT_EQ(pixels[2], 255) << "nothing has changed";
    EXPECT_NE(pixels[0], 255);
    canvas_.version = ++version_;
    const auto next = pass_->show(0, same, canvas_);
    gl.GetTextureImage(next->texture, 0, GL_RGBA, GL_UNSIGNED_BYTE, sizeof pixels, pixels.data());
    cv::Mat turned;
    cv::rotate(noise(8, 8), turned, cv::ROTATE_180);
    EXPECT_EQ(pixels[0], turned.data[0]);
    EXPECT_EQ(pixels[1], turned.data[1]);
}

/// Every element of the categories that a switch tells at its n-th sample.
void set_samples(glstate::State& state, std::size_t n) {
    glstate::for_each_element([&]<class E>() {
        constexpr auto kKept =
            glstate::kLayerCategories | ~glstate::kSentCategories | glstate::mask_of(glstate::Category::textures) |
            glstate::mask_of(glstate::Category::objects) | glstate::mask_of(glstate::Category::modelview_origin);
        if ((kKept & glstate::mask_of(E::category)) != 0) return;
        for (unsigned i = 0; i < E::count; ++i) glstate::assign<E>(state, i, glstate::Samples<E>::values[(n + i) % 3]);
    });
    for (unsigned i = 0; i < 32; ++i)  // not every coordinate has every mode
        if (i % 4 > 1) state.texture_gen.tex_gen_mode[i] = GL_OBJECT_LINEAR;
}

TEST_P(Outputs, AreTheSameWhateverAProgramHasLeftInTheDriver) {
    const cv::Mat canvas = noise(30, 20);
    cv::Mat turned;
    cv::rotate(canvas, turned, cv::ROTATE_180);
    const geom::TileOutput output{.rotation = 180, .width = 30, .height = 20};
    auto& driver = *node_.driver;
    for (std::size_t n = 0; n < 3; ++n) {
        glstate::State state;
        set_samples(state, n);
        driver.sync(state);
        driver.sync_current(state);
        driver.disable_scissor();  // as the compositor does
        EXPECT_EQ(difference(shown(output, canvas), turned).most, 0) << "sample " << n;
        EXPECT_EQ(driver.drain_errors(), 0u) << "sample " << n;
    }
}

/// A program that draws with everything bound goes on as if nothing had been between.
TEST_P(Outputs, LeaveNothingThatAProgramSees) {
    constexpr geom::Rect kTile{0, 0, 16, 16};
    node_.node->tiles = {{0, kTile}};
    test::TestSession session(*node_.node, SessionId(1));
    session.open_surface(16, 16, kTile);
    const auto draw = [&](float red) {
        test::Batch batch;
        batch.set<test::el::color>({red, 0.5f, 0, 1}).set<test::el::depth_test>(1);
        batch.block(1, [](wire::PackBuffer& buffer) {
            test::pack::Begin(buffer, GL_TRIANGLE_FAN);
            for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}})
                test::pack::Vertex2f(buffer, x, y);
            test::pack::End(buffer);
        });
        session.expect_run(batch);
    };
    test::Batch clear;
    clear.block(1,
                [](wire::PackBuffer& buffer) { test::pack::Clear(buffer, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT); });
    session.expect_run(clear);
    draw(1);
    const auto before = session.read(0, kTile);
    shown({.rotation = 180, .width = 30, .height = 20}, noise(30, 20));
    EXPECT_EQ(session.read(0, kTile), before) << "what it has drawn";
    session.expect_run(clear);
    EXPECT_NE(session.read(0, kTile), before);
    draw(1);
    EXPECT_EQ(session.read(0, kTile), before) << "and what it draws";
}

INSTANTIATE_TEST_SUITE_P(Backends, Outputs, ::testing::Values("egl", "osmesa"),
                         [](const auto& backend) { return std::string(backend.param); });

}  // namespace
}  // namespace wall::tileserver
