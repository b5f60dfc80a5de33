// SPDX-License-Identifier: MIT
// MPCDI files that the test writes: of each profile, and what is wrong with others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/config/load_config.h"
#include "tests/support/mpcdi_file.h"
#include "tests/support/temporary_folder.h"
#include "walld/mpcdi/load_mpcdi.h"
#include "walld/mpcdi/setup.h"
#include "walld/mpcdi/tile_maps.h"

namespace wall::mpcdi {
namespace {

using test::field_of;
using test::mpcdi_fileset;
using test::pfm_of;
using test::zip_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Value = Field::Value;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::string png_of(const cv::Mat& picture) {
    std::vector<std::uint8_t> out;
    cv::imencode(".png", picture, out);
    return {out.begin(), out.end()};
}

/// What a warp makes of each place's middle, against what the map says; fractions.
double farthest(const geom::Warp& warp, const Field& wanted) {
    geom::TileOutput output;
    output.warp = std::make_shared<const geom::Warp>(warp);
    double out = 0;
    for (std::uint32_t y = 0; y < wanted.height; ++y)
        for (std::uint32_t x = 0; x < wanted.width; ++x) {
            const auto& value = wanted.at(x, y);
            if (std::isnan(value[0])) continue;
            const auto got =
                geom::place_in_tile(output, {(static_cast<float>(x) + 0.5f) / static_cast<float>(wanted.width),
                                             (static_cast<float>(y) + 0.5f) / static_cast<float>(wanted.height)});
            const double off = std::max(std::abs(double{got.x} - value[0]), std::abs(double{got.y} - value[1]));
            out = std::max(out, std::isnan(off) ? INFINITY : off);
        }
    return out;
}

/// A wall of one tile "left" of 8x6 pixels, with the file beside wall.toml.
class MpcdiFile : public ::testing::Test {
protected:
    Result<config::WallConfig> load(const std::string& file, const std::string& keys = {},
                                    const std::string& wall = {}) const {
        std::ofstream(folder_.file("p.mpcdi"), std::ios::binary) << file;
        auto config =
            config::parse_config("[wall]\n" + wall + "\n[[node]]\nname = \"n\"\n[[node.tile]]\nname = \"left\"\n" +
                                     "rect = [0, 0, 8, 6]\nmpcdi = \"p.mpcdi\"\n" + keys + "\n",
                                 "wall.toml");
        if (!config) return config;
        if (auto loaded = files_.load(*config, folder_.file("")); !loaded) return tl::unexpected(loaded.error());
        return config;
    }
    config::TileConfig tile(const std::string& file, const std::string& keys = {}, const std::string& wall = {}) const {
        const auto config = load(file, keys, wall);
        EXPECT_TRUE(config) << config.error().message;
        return config ? config->nodes[0].tiles[0] : config::TileConfig{};
    }
    /// What was wrong, behind the file's name.
    std::string refusal(const std::string& file, const std::string& keys = {}) const {
        const auto config = load(file, keys);
        if (config) return "nothing";
        const auto& message = config.error().message;
        const auto name = folder_.file("p.mpcdi") + ": ";
        return message.starts_with(name) ? message.substr(name.size()) : message;
    }
    static std::string with(const test::MpcdiText& text, const Field& map, std::vector<test::MpcdiEntry> more = {}) {
        more.insert(more.begin(), {{"mpcdi.xml", text.text()}, {"left.pfm", pfm_of(map)}});
        return zip_of(more);
    }
    test::TemporaryFolder folder_;
    mutable DescribedFiles files_;
};

/// Bent as a projector's picture on a column is.
Value bent(double x, double y) {
    return {static_cast<float>(0.5 + 0.45 * std::sin((x - 0.5) * 1.8)),
            static_cast<float>(y + 0.06 * (x - 0.5) * (x - 0.5)), 0};
}

TEST_F(MpcdiFile, OfFlatMediaWarpsByItsMap) {
    const auto map = field_of(80, 60, bent);
    const auto shown = tile(with({.files = mpcdi_fileset("left.pfm")}, map));
    ASSERT_TRUE(shown.output.warp);
    EXPECT_LT(farthest(*shown.output.warp, map) * 8, 1.01 / 256) << "pixels of the tile";
    EXPECT_FALSE(shown.view);
    EXPECT_FALSE(shown.output.light);
}

TEST_F(MpcdiFile, OfASimulationSaysWhereTheTileLooks) {
    const auto map = field_of(16, 12, [](double x, double y) -> Value {
        return {static_cast<float>(x), static_cast<float>(y), 0};
    });
    test::MpcdiText text{.profile = "3d", .in_region = test::kMpcdiFrustum, .files = mpcdi_fileset("left.pfm")};
    const auto shown = tile(with(text, map));
    ASSERT_TRUE(shown.view && shown.output.warp);
    const auto wanted = geom::view_of_angles(30, -10, 5, -25, 20, -12, 15);
    EXPECT_EQ(*shown.view, wanted);
    EXPECT_NEAR(shown.view->right_edge, std::tan(20 * std::numbers::pi / 180), 1e-6);
    EXPECT_NEAR(shown.view->left, -std::tan(25 * std::numbers::pi / 180), 1e-6);
    EXPECT_LT(farthest(*shown.output.warp, map), 1e-6);
    // Without maps, as some programs write it: the description alone.
    text.files.clear();
    const auto alone = tile(text.text());
    EXPECT_EQ(*alone.view, wanted);
    EXPECT_FALSE(alone.output.warp);
}

/// A part of a cylinder of 3 m around the middle of the room, 2 m high, in millimetres; its axes are a surveyor's: x to
/// the right, y ahead, z up.
Value on_cylinder(double x, double y) {
    const double angle = (x - 0.5) * 80 * std::numbers::pi / 180 + 0.3;
    return {static_cast<float>(3000 * std::sin(angle)), static_cast<float>(3000 * std::cos(angle)),
            static_cast<float>(1000 - 2000 * y)};
}
constexpr const char* kSurveyor =
    "<coordinateFrame><posx>0</posx><posy>0</posy><posz>0</posz><yawx>0</yawx><yawy>0</yawy><yawz>-1</yawz>"
    "<pitchx>1</pitchx><pitchy>0</pitchy><pitchz>0</pitchz><rollx>0</rollx><rolly>1</rolly><rollz>0</rollz>"
    "</coordinateFrame>";

TEST_F(MpcdiFile, OfASurfaceIsSeenFromTheEye) {
    const auto map = field_of(160, 120, on_cylinder);
    for (const auto* profile : {"a3", "sl"}) {
        SCOPED_TRACE(profile);
        const test::MpcdiText text{.profile = profile, .in_region = kSurveyor, .files = mpcdi_fileset("left.pfm")};
        const auto shown = tile(with(text, map), {}, "eye = [0.5, -0.2, 1]");
        ASSERT_TRUE(shown.view && shown.output.warp);
        // Whatever a pixel looks at in the tile's picture lies behind the place that it lights, from where the eye is.
        const auto& view = *shown.view;
        geom::TileOutput output;
        output.warp = shown.output.warp;
        double apart = 0;
        for (double y = 0.05; y < 1; y += 0.1)
            for (double x = 0.05; x < 1; x += 0.1) {
                const auto at = geom::place_in_tile(output, {static_cast<float>(x), static_cast<float>(y)});
                const double right = view.left + at.x * (view.right_edge - view.left);
                const double up = view.top + at.y * (view.bottom - view.top);
                std::array<double, 3> looks{}, lit{};
                const auto place = on_cylinder(x, y);
                const std::array<double, 3> from_eye{place[0] / 1000 - 0.5, place[2] / 1000 + 0.2, place[1] / 1000 + 1};
                double length = 0, lit_length = 0, cosine = 0;
                for (std::size_t i = 0; i < 3; ++i) {
                    looks[i] = right * view.right[i] + up * view.up[i] + view.ahead[i];
                    lit[i] = from_eye[i];
                    length += looks[i] * looks[i], lit_length += lit[i] * lit[i], cosine += looks[i] * lit[i];
                }
                apart = std::max(apart, std::acos(std::min(1.0, cosine / std::sqrt(length * lit_length))));
            }
        EXPECT_LT(apart, 1e-3) << "radians; a tenth of a pixel of 8 on 80 degrees is 0.017";
        EXPECT_EQ(geom::wrong_with(view), nullptr);
        EXPECT_NEAR(view.up[1], 1, 0.1) << "upright";
    }
}

TEST_F(MpcdiFile, SharesAndLiftsLight) {
    cv::Mat alpha(6, 8, CV_16UC3, cv::Scalar(65535, 32768, 0)), beta(3, 4, CV_8UC1, cv::Scalar(51));
    const auto map = field_of(16, 12, [](double x, double y) -> Value {
        return {static_cast<float>(x), static_cast<float>(y), 0};
    });
    const auto maps = [](const std::string& gamma) {
        return "<alphaMap><path>a.png</path><gammaEmbedded>" + gamma +
               "</gammaEmbedded></alphaMap><betaMap><path>b.png</path><gammaEmbedded>2.2</gammaEmbedded></betaMap>";
    };
    const std::vector<test::MpcdiEntry> pictures{{"a.png", png_of(alpha)}, {"b.png", png_of(beta)}};
    const auto shown = tile(with({.files = mpcdi_fileset("left.pfm", maps("2.2"))}, map, pictures));
    ASSERT_TRUE(shown.output.light);
    const auto& [share, lift] = *shown.output.light;
    EXPECT_EQ(std::vector({share.width, share.height, share.channels}), std::vector({8u, 6u, 3u}));
    EXPECT_EQ(std::vector(share.values.begin(), share.values.begin() + 3), (std::vector<std::uint8_t>{0, 128, 255}))
        << "red, green and blue of values, as the projector has them";
    EXPECT_EQ(std::vector({lift.width, lift.height, lift.channels}), std::vector({4u, 3u, 1u}));
    EXPECT_EQ(lift.values, std::vector<std::uint8_t>(12, 51));
    // Factors of light itself: half of it is 0.73 of the value.
    const auto linear = tile(with({.files = mpcdi_fileset("left.pfm", maps("1.0"))}, map, pictures));
    EXPECT_EQ(linear.output.light->share.values[1], std::lround(255 * std::pow(0.5, 1 / 2.2)));
}

TEST_F(MpcdiFile, IsBlackWhereTheMapSaysNothing) {
    const auto map = field_of(160, 120, [](double x, double y) -> Value {
        const double from_middle = std::hypot(x - 0.5, y - 0.5);
        if (from_middle > 0.4) return {kNan, kNan, kNan};
        return bent(x, y);
    });
    const auto shown = tile(with({.files = mpcdi_fileset("left.pfm")}, map));
    ASSERT_TRUE(shown.output.warp && shown.output.light);
    EXPECT_LT(farthest(*shown.output.warp, map) * 8, 1.01 / 256) << "up to the border";
    const auto& corner = shown.output.warp->points.front();
    EXPECT_TRUE(std::isnan(corner.x) && std::isnan(corner.y));
    const auto& share = shown.output.light->share;
    ASSERT_EQ(share.values.size(), map.values.size());
    for (std::size_t i = 0; i < map.values.size(); ++i)
        ASSERT_EQ(share.values[i], std::isnan(map.values[i][0]) ? 0 : 255) << i;
}

TEST_F(MpcdiFile, IsReadAgainOnlyIfItHasChanged) {
    const auto map = field_of(80, 60, bent);
    const auto file = with({.files = mpcdi_fileset("left.pfm")}, map);
    const auto read = [&](const std::string& keys) {
        auto config = config::parse_config(
            "[[node]]\nname = \"n\"\n[[node.tile]]\nname = \"left\"\n" + keys + "mpcdi = \"p.mpcdi\"\n", "wall.toml");
        EXPECT_TRUE(files_.load(*config, folder_.file("")));
        return config->nodes[0].tiles[0].output.warp;
    };
    const std::string plain = "rect = [0, 0, 8, 6]\n", larger = "rect = [0, 0, 80, 60]\npixels = [8, 6]\n";
    tile(file);
    const auto first = read(plain);
    EXPECT_EQ(read(plain), first);
    EXPECT_NE(read(larger), first) << "which wants a finer mesh";
    EXPECT_NE(read(plain), first) << "and is known instead";
    const auto again = read(plain);
    std::ofstream(folder_.file("p.mpcdi"), std::ios::binary)
        << with({.files = mpcdi_fileset("left.pfm")}, field_of(60, 60, bent));
    EXPECT_NE(read(plain), again);
}

TEST_F(MpcdiFile, HasARegionForEachTile) {
    const auto two = [](const std::string& second) {
        test::MpcdiText text;
        text.in_region = "</region><region id=\"" + second + "\" xResolution=\"8\" yResolution=\"6\">";
        return text.text();
    };
    EXPECT_EQ(refusal(two("right")), "nothing");
    EXPECT_THAT(refusal(two("left")), HasSubstr(":6: region 'left' appears twice"));
    auto text = test::MpcdiText();
    text.region = "<region id=\"other\" Xresolution=\"8\" Yresolution=\"6\">";
    EXPECT_EQ(refusal(text.text()), "nothing") << "the only one";
    text.in_region = "</region><region id=\"another\" Xresolution=\"8\" Yresolution=\"6\">";
    EXPECT_THAT(refusal(text.text()),
                StartsWith("has no region 'left': expected a tile called as its region is: 'other', "
                           "'another'"));
}

TEST_F(MpcdiFile, SaysWhatIsWrongAndWhatWasExpected) {
    const auto map = field_of(4, 4, [](double x, double y) -> Value {
        return {static_cast<float>(x), static_cast<float>(y), 0};
    });
    const auto description = [](const test::MpcdiText& text) { return zip_of({{"mpcdi.xml", text.text()}}); };
    const auto with_pfm = [](const std::string& pfm) {
        return zip_of({{"mpcdi.xml", test::MpcdiText{.files = mpcdi_fileset("left.pfm")}.text()}, {"left.pfm", pfm}});
    };
    const auto angles = [](const std::string& from, const std::string& to) {
        auto frustum = test::kMpcdiFrustum;
        frustum.replace(frustum.find(from), from.size(), to);
        return test::MpcdiText{.profile = "3d", .in_region = frustum}.text();
    };
    std::string wrong_axes = kSurveyor;
    wrong_axes.replace(wrong_axes.find("<rolly>1"), 8, "<rolly>0");
    auto folded = map;
    std::swap(folded.values[5], folded.values[6]);
    const std::vector<std::pair<std::string, std::string>> rows{
        {"", "expected a description in it, mpcdi.xml"},
        {"anything", "expected an MPCDI file, a ZIP archive with a description in XML"},
        {"PK\x03\x04 and nothing", "expected an MPCDI file"},
        {zip_of({{"a.pfm", "x"}}), "expected a description in it, mpcdi.xml"},
        {zip_of({{"a.xml", "<a/>"}, {"b.xml", "<b/>"}}), "'a.xml' and 'b.xml': expected one description"},
        {zip_of({{"mpcdi.xml", "<MPCDI>\n<display>\n"}}), "mpcdi.xml:2: expected XML"},
        {zip_of({{"mpcdi.xml", "<SVG/>"}}), "mpcdi.xml:1: expected <MPCDI>"},
        {description({.profile = "4d"}), "mpcdi.xml:2: profile '4d': expected 2d, 3d, a3 or sl"},
        {description({.version = "3.0"}), "mpcdi.xml:2: version '3.0': expected 1.0 or 2.0"},
        {description({.profile = "3d"}), "mpcdi.xml:5: region 'left' has no <frustum>"},
        {description({.region = "<region Xresolution=\"8\" Yresolution=\"6\">"}),
         "mpcdi.xml:5: <region>: expected an 'id'"},
        {description({.region = "<region id=\"left\" Xresolution=\"8\">"}),
         "mpcdi.xml:5: 'Yresolution' of region 'left': expected a number from 1 to 16384"},
        {description({.region = "<region id=\"left\" Xresolution=\"9\" Yresolution=\"6\">"}),
         "region 'left' is of a projector of 9 x 6 pixels, tile 'left' of 8 x 6: expected pixels = [9, 6]"},
        {angles("<yaw>30", "<yaw>much"), "6: <yaw> of <frustum>: expected a number from -360 to 360"},
        {angles("<yaw>30</yaw>", ""), "6: <yaw> of <frustum> is missing"},
        {angles("<rightAngle>20", "<rightAngle>-30"), "6: <frustum>: expected 'leftAngle' less than 'rightAngle'"},
        {description({.files = "<fileset region=\"top\"/>"}), "mpcdi.xml:11: <fileset>: there is no region 'top'"},
        {description({.files = mpcdi_fileset("left.pfm")}), "'left.pfm' is not in the archive"},
        {test::MpcdiText{.files = mpcdi_fileset("left.pfm")}.text(),
         "'left.pfm' is not there: the file is a description"},
        {description({.profile = "a3"}), "region 'left' has no geometryWarpFile: expected one in profile \"a3\""},
        {description({.profile = "a3", .files = mpcdi_fileset("left.pfm", "", "furlong")}),
         "mpcdi.xml:11: <geometricUnit> 'furlong': expected mm"},
        {description({.files = mpcdi_fileset("", "<distortionMap><path>d.pfm</path></distortionMap>")}),
         "mpcdi.xml:11: <distortionMap>: expected what the lens does"},
        {description({.profile = "a3", .in_region = wrong_axes}),
         "mpcdi.xml:6: <coordinateFrame>: expected unit vectors at right angles"},
        {with_pfm("P6\n4 4\n"), "'left.pfm': expected a PFM file of three numbers a place (PF)"},
        {with_pfm("PF\n4 0\n-1.0\n"), "'left.pfm': expected a width and a height of 2 to 16384"},
        {with_pfm("PF\n99999 99999\n-1.0\n"), "'left.pfm': expected a width and a height"},
        {with_pfm("PF\n4 4\n0\n"), "'left.pfm': expected -1.0 (little endian) or 1.0"},
        {with_pfm(pfm_of(map) + "x"), "'left.pfm': expected 192 bytes behind its header, there are 193"},
        {with_pfm(pfm_of(folded)),
         "region 'left' has a geometryWarpFile that is folded: a cell of its mesh turns over"},
        {zip_of({{"mpcdi.xml",
                  test::MpcdiText{.files = mpcdi_fileset("", "<alphaMap><path>a.png</path></alphaMap>")}.text()},
                 {"a.png", "GIF89a"}}),
         "'a.png': expected a PNG file"},
    };
    for (const auto& [file, expected] : rows) {
        auto told = refusal(file);
        // A description alone is called as the file is.
        const auto name = folder_.file("p.mpcdi") + ":";
        if (told.starts_with(name)) told = told.substr(name.size());
        EXPECT_THAT(told, StartsWith(expected));
    }
    const auto good =
        with({.profile = "3d", .in_region = test::kMpcdiFrustum, .files = mpcdi_fileset("left.pfm")}, map);
    EXPECT_THAT(refusal(good, "fov = 50"),
                HasSubstr("says where tile 'left' looks (profile \"3d\"): expected no 'fov'"));
    EXPECT_THAT(refusal(good, "warp = \"x\""), HasSubstr("'warp': expected none beside 'mpcdi'"));
    EXPECT_THAT(refusal(good, "rotation = 90"), HasSubstr("'rotation': expected none beside 'mpcdi'"));
    std::filesystem::remove(folder_.file("p.mpcdi"));
    auto config = config::parse_config(
        "[[node]]\nname = \"n\"\n[[node.tile]]\nname = \"left\"\nrect = [0, 0, 8, 6]\n"
        "mpcdi = \"q.mpcdi\"\n",
        "wall.toml");
    EXPECT_THAT(files_.load(*config, folder_.file("")).error().message,
                HasSubstr("q.mpcdi: cannot be read: expected the MPCDI file of tile 'left'"));
}

TEST(Pfm, IsOfEitherByteOrder) {
    const auto map = field_of(3, 2, bent);
    for (const bool big_endian : {false, true}) {
        const auto read = parse_pfm(pfm_of(map, big_endian), "x");
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(read->values, map.values);
    }
}

/// A cell of the finest mesh is 7.5 pixels, and its farthest corner twice that away along rows and columns.
TEST(MpcdiMesh, ReachesBeyondTheBorderOfWhatIsShown) {
    const auto map = field_of(1920, 270, [](double x, double y) -> Value {
        if (std::hypot(x - 0.5, y - 0.5) > 0.5) return {kNan, kNan, kNan};
        return {static_cast<float>(0.5 + 0.47 * std::sin((x - 0.5) * 1.9)), static_cast<float>(y), 0};
    });
    EXPECT_LE(mesh_of(map, 1920, 270, 0).error, 0.02f);
}

TEST(MpcdiMesh, IsAsFineAsItMustBe) {
    const auto columns = [](double waves, float most) {
        const auto map = field_of(640, 480, [&](double x, double y) -> Value {
            return {static_cast<float>(x + 0.003 * std::sin(waves * 6.28 * x)), static_cast<float>(y), 0};
        });
        const auto mesh = mesh_of(map, 1920, 1080, most);
        EXPECT_EQ(geom::wrong_with(mesh.warp), nullptr);
        return std::pair(mesh.warp.columns, mesh.error);
    };
    EXPECT_EQ(columns(0, 0.05f).first, 17u);
    EXPECT_GT(columns(5, 0.05f).first, 17u);
    EXPECT_LE(columns(5, 0.05f).second, 0.05f);
    EXPECT_EQ(columns(40, 0.05f).first, 256u) << "and no finer";
    EXPECT_GT(columns(40, 0.05f).second, 0.05f);
}

}  // namespace
}  // namespace wall::mpcdi
