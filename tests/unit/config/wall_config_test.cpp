// SPDX-License-Identifier: MIT
#include "common/config/load_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wall::config {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kGood = R"(
[wall]
name = "lab"
background = "#102030"
swap_timeout_ms = 100
close_timeout_ms = 500
max_sessions = 7
state_directory = "/var/lib/wallgl"

[control]
listen = ["unix:/run/wallgl/walld.sock", "127.0.0.1:7770"]
users = ["root", 1234]

[http]
listen = "127.0.0.1:7780"

[people]
operators = ["root", "@root"]
viewers = [77]
default_role = "viewer"
http_role = "none"
[[people.token]]
name = "kiosk"
file = "/etc/wallgl/kiosk.token"
role = "operator"

[[node]]
name = "left"
listen = "unix:/run/wallgl/left.sock"
[[node.tile]]
name = "top"
rect = [0, 0, 640, 480]
[[node.tile]]
name = "bottom"
rect = [0, 500, 640, 480]

[[node]]
name = "right"
backend = "osmesa"
[[node.tile]]
name = "big"
rect = [660, 0, 1280, 980]
)";

TEST(WallConfig, KeepsNamesBeyondAscii) {
    std::string text = kGood;
    text.replace(text.find("lab"), 3, "M\u00fcller \u4e2d");
    const auto config = parse_config(text, "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->name, "M\u00fcller \u4e2d");
    text.replace(text.find("background"), 10, "h\u00f6he");
    text.replace(text.find("h\u00f6he"), 6, "\"h\u00f6he\"");
    EXPECT_THAT(parse_config(text, "wall.toml").error().message, HasSubstr("unknown key 'h\u00f6he'"));
}

TEST(WallConfig, ReadsEverything) {
    const auto config = parse_config(kGood, "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->name, "lab");
    EXPECT_EQ(config->background, 0x102030u);
    EXPECT_EQ(config->swap_timeout.count(), 100);
    ASSERT_EQ(config->control_listen.size(), 2u);
    EXPECT_EQ(config->control_listen[0].path, "/run/wallgl/walld.sock");
    EXPECT_EQ(config->close_timeout.count(), 500);
    EXPECT_EQ(config->max_sessions, 7u);
    EXPECT_EQ(config->state_directory, "/var/lib/wallgl");
    const auto& people = config->people;
    EXPECT_EQ(people.users.users, (std::vector<std::uint32_t>{0, 1234}));
    EXPECT_EQ(people.operators.groups, (std::vector<std::uint32_t>{0}));
    EXPECT_EQ(people.default_role, Role::viewer);
    EXPECT_EQ(people.http_role, Role::none);
    ASSERT_EQ(people.tokens.size(), 1u);
    EXPECT_EQ(people.tokens[0].name, "kiosk");
    EXPECT_EQ(people.tokens[0].role, Role::operator_);
    ASSERT_EQ(config->http_listen.size(), 1u);
    EXPECT_EQ(config->http_listen[0].port, 7780);
    ASSERT_EQ(config->nodes.size(), 2u);
    EXPECT_EQ(config->nodes[0].tiles[1].rect, (geom::Rect{0, 500, 640, 480}));
    EXPECT_EQ(config->nodes[1].backend, Backend::osmesa);
    EXPECT_EQ(config->nodes[1].listen.port, net::kDefaultDataPort);
    EXPECT_EQ(config->canvas(), (geom::Rect{0, 0, 1940, 980}));
    EXPECT_EQ(config->find_node("right"), &config->nodes[1]);
    EXPECT_EQ(config->find_node("middle"), nullptr);
}

TEST(WallConfig, NothingIsLostUnlessItSaysSo) {
    EXPECT_EQ(parse_config(kGood, "wall.toml")->lossy_pixels, 0);
    std::string text = kGood;
    text.replace(text.find("background"), 0, "lossy_pixels = 0.25\n");
    EXPECT_EQ(parse_config(text, "wall.toml")->lossy_pixels, 0.25f);
}

TEST(WallConfig, NamesAndCommentsMayBeInAnyLanguage) {
    const auto config = parse_config(
        "# f\u00fcr alle\n[wall]\nname='W\u00e4nde \\\\ "
        "\"'\n[[node]]\nname=\"\\\"\u4e00\"\n[[node.tile]]\nname=\"\"\"t\u00e9 \"\" \"\"\"\nrect=[0,0,1,1]\n",
        "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->nodes[0].name, "\"\u4e00");
}

TEST(WallConfig, NodesAreEnough) {
    const auto config = parse_config("[[node]]\nname='n'\n[[node.tile]]\nname='t'\nrect=[0,0,1,1]\n", "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->control_listen[0].text(), "127.0.0.1:7770");
    EXPECT_TRUE(config->http_listen.empty());
    EXPECT_EQ(config->swap_timeout.count(), 250);
}

TEST(WallConfig, ANodeSaysWhetherItOrdersTriangles) {
    const auto node = [](const std::string& line) {
        return parse_config("[[node]]\nname='n'\n" + line + "\n[[node.tile]]\nname='t'\nrect=[0,0,1,1]\n", "wall.toml");
    };
    const auto usual = node(""), on = node("triangle_order = \"on\""), off = node("triangle_order = \"off\"");
    ASSERT_TRUE(usual && on && off);
    EXPECT_EQ(usual->nodes[0].triangle_order, TriangleOrder::automatic);
    EXPECT_EQ(node("triangle_order = \"auto\"")->nodes[0], usual->nodes[0]);
    EXPECT_EQ(on->nodes[0].triangle_order, TriangleOrder::on);
    EXPECT_EQ(off->nodes[0].triangle_order, TriangleOrder::off);
    EXPECT_FALSE(draws_as(on->nodes[0], off->nodes[0])) << "the node begins anew";
    EXPECT_EQ(node("triangle_order = true").error().message, "wall.toml:3: 'triangle_order': expected a string");
    EXPECT_EQ(node("triangle_order = \"yes\"").error().message,
              "wall.toml:3: 'triangle_order' is 'yes': expected \"auto\", \"on\" or \"off\"");
}

TEST(WallConfig, ANodeSaysWhatItDoesForProgramsThatAreDealt) {
    const auto node = [](const std::string& line, bool tile = true) {
        return parse_config("[[node]]\nname='n'\n" + line + (tile ? "\n[[node.tile]]\nname='t'\nrect=[0,0,1,1]\n" : ""),
                            "wall.toml");
    };
    const auto usual = node(""), shows = node("role = 'display'"), draws = node("role = ['render']", false);
    ASSERT_TRUE(usual && shows && draws);
    EXPECT_EQ(usual->nodes[0].roles, (Roles{.render = true, .display = true, .compose = false}));
    EXPECT_EQ(node("role = ['display', 'render']")->nodes[0], usual->nodes[0]);
    EXPECT_EQ(shows->nodes[0].roles, (Roles{.render = false, .display = true, .compose = false}));
    const auto composes = node("role = ['compose']", false);
    ASSERT_TRUE(composes);
    EXPECT_EQ(composes->nodes[0].roles, (Roles{.render = false, .display = false, .compose = true}));
    EXPECT_EQ(draws->nodes[0].roles, (Roles{.render = true, .display = false}));
    EXPECT_EQ(node("role = 'draw'").error().message,
              "wall.toml:3: 'role' is 'draw': expected \"render\", \"compose\" or \"display\", or several in a list");
    EXPECT_EQ(node("role = []").error().message,
              "wall.toml:3: 'role' is empty: expected \"render\", \"compose\" or \"display\"");
    EXPECT_EQ(node("role = 'render'").error().message,
              "wall.toml:3: node 'n' has tiles: expected \"display\" among its roles");
}

TEST(WallConfig, ATileIsHeadlessOrAWindow) {
    const auto config = parse_config(R"(
[[node]]
name = "n"
[[node.tile]]
name = "memory"
rect = [0, 0, 10, 10]
[[node.tile]]
name = "placed"
rect = [10, 0, 10, 10]
output = "window"
position = [1920, 7]
[[node.tile]]
name = "inside"
rect = [30, 10, 10, 10]
output = "window"
parent = 0x1400003
[[node.tile]]
name = "covering"
rect = [20, 0, 10, 10]
output = "window"
monitor = "DP-1"
[[node]]
name = "other display"
[[node.tile]]
name = "second seat"
rect = [30, 0, 10, 10]
output = "window"
display = ":1"
)",
                                     "wall.toml");
    ASSERT_TRUE(config) << config.error().message;
    const auto& tiles = config->nodes[0].tiles;
    EXPECT_EQ(tiles[0].window, std::nullopt);
    EXPECT_STREQ(output_name(tiles[0]), "headless");
    EXPECT_EQ(tiles[1].window, (WindowConfig{.display = "", .monitor = "", .x = 1920, .y = 7}));
    EXPECT_STREQ(output_name(tiles[1]), "window");
    EXPECT_EQ(tiles[2].window, (WindowConfig{.display = "", .monitor = "", .parent = 0x1400003}));
    EXPECT_EQ(tiles[3].window, (WindowConfig{.display = "", .monitor = "DP-1"}));
    EXPECT_EQ(config->nodes[1].tiles[0].window, (WindowConfig{.display = ":1", .monitor = ""}));
}

TEST(WallConfig, ATileIsOnAMonitorWithoutAWindowSystem) {
    const auto tile_with = [](const std::string& keys) {
        const auto config = parse_config(
            "[[node]]\nname = \"n\"\n[[node.tile]]\nname = \"t\"\nrect = [0, 0, 10, 10]\n" + keys, "wall.toml");
        EXPECT_TRUE(config) << config.error().message;
        return config ? config->nodes[0].tiles[0] : TileConfig{};
    };
    const auto next = tile_with("output = \"kms\"\n");
    EXPECT_EQ(next.kms, KmsConfig());
    EXPECT_EQ(next.window, std::nullopt);
    EXPECT_STREQ(output_name(next), "kms");
    EXPECT_EQ(tile_with("output = \"kms:HDMI-A-1\"\n").kms, (KmsConfig{.connector = "HDMI-A-1", .mode = {}}));
    const auto mode = [&](const std::string& text) {
        return tile_with("output = \"kms:DP-1\"\nmode = \"" + text + "\"\n").kms->mode;
    };
    EXPECT_EQ(mode("1920x1080"), (ModeConfig{1920, 1080, 0}));
    EXPECT_EQ(mode("1920x1080@60"), (ModeConfig{1920, 1080, 60'000}));
    EXPECT_EQ(mode("3840x2160@59.94"), (ModeConfig{3840, 2160, 59'940}));
}

TEST(WallConfig, AModeIsASizeAndPerhapsARate) {
    for (const char* wrong : {"1920", "1920x", "x1080", "0x1080", "1920x1080@", "1920x1080@0", "1920x1080@1001",
                              "1920x1080@nan", "1920x1080 ", "1920x99999", "-1x5", "1920x1080@60Hz"}) {
        const auto config = parse_config(
            "[[node]]\nname = \"n\"\n[[node.tile]]\nname = \"t\"\nrect = [0, 0, 1, 1]\noutput = \"kms\"\nmode = \"" +
                std::string(wrong) + "\"\n",
            "wall.toml");
        ASSERT_FALSE(config) << wrong;
        EXPECT_THAT(config.error().message, StartsWith("wall.toml:7: 'mode'")) << wrong;
    }
}

TEST(WallConfig, AnotherMonitorIsAnotherTile) {
    const auto draws_as = [](const TileConfig& a, const TileConfig& b) {
        return config::draws_as(NodeConfig{.tiles = {a}}, NodeConfig{.tiles = {b}});
    };
    TileConfig tile;
    tile.kms = KmsConfig{.connector = "DP-1", .mode = {}};
    TileConfig other = tile;
    EXPECT_TRUE(draws_as(tile, other));
    other.output.width = 7;
    EXPECT_TRUE(draws_as(tile, other)) << "it is scaled to the monitor";
    other.kms->mode = ModeConfig{1920, 1080, 0};
    EXPECT_FALSE(draws_as(tile, other));
    other.kms.reset();
    EXPECT_FALSE(draws_as(tile, other));
}

TEST(People, EachHasTheHighestRoleThatNamesThem) {
    PeopleConfig people;
    people.operators.users = {1};
    people.users.groups = {50};
    people.viewers.users = {3, 1};
    const std::uint32_t group[] = {7, 50};
    EXPECT_EQ(role_of(people, 0, {}), Role::operator_) << "root";
    EXPECT_EQ(role_of(people, 1, {}), Role::operator_);
    EXPECT_EQ(role_of(people, 2, group), Role::user);
    EXPECT_EQ(role_of(people, 3, {}), Role::viewer);
    EXPECT_EQ(role_of(people, 4, {}), Role::none);
    people.default_role = Role::user;
    EXPECT_EQ(role_of(people, 3, {}), Role::user) << "not less than a stranger";
    EXPECT_EQ(role_of(people, 4, {}), Role::user);
}

struct Wrong {
    const char* name;
    const char* from;  ///< text of kGood that is replaced
    const char* to;
    const char* where;  ///< how the error starts
    const char* what;   ///< what it must say
};

class WrongConfig : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongConfig, NamesFileLineAndWhatWasExpected) {
    std::string text = kGood;
    const auto at = text.find(GetParam().from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, std::string(GetParam().from).size(), GetParam().to);
    const auto config = parse_config(text, "wall.toml");
    ASSERT_FALSE(config);
    EXPECT_THAT(config.error().message, StartsWith(GetParam().where));
    EXPECT_THAT(config.error().message, HasSubstr(GetParam().what));
}

INSTANTIATE_TEST_SUITE_P(
    Cases, WrongConfig,
    ::testing::Values(
        Wrong{"syntax", "name = \"lab\"", "name = ", "wall.toml:3: ", "not TOML"},
        Wrong{"table_without_a_name", "[http]", "[\n]", "wall.toml:", "not TOML"},
        Wrong{"control_character", "name = \"lab\"", "name = \"l\x01b\"", "wall.toml:3: ", "a control character"},
        Wrong{"stray_character", "name = \"lab\"", "n\u00e4me = \"lab\"", "wall.toml:3: ", "not TOML"},
        Wrong{"stray_character_after_a_quote_in_a_number", "name = \"lab\"", "name = 1'''\u0422",
              "wall.toml:3: ", "not TOML"},
        Wrong{"unknown_section", "[http]", "[htpp]",
              "wall.toml:14: ", "expected one of wall, control, http, people, quota, node"},
        Wrong{"unknown_key", "swap_timeout_ms", "swap_timeout", "wall.toml:5: ",
              "expected one of name, background, swap_timeout_ms, close_timeout_ms, max_sessions, state_directory"},
        Wrong{"name_type", "\"lab\"", "7", "wall.toml:3: ", "'name': expected a string"},
        Wrong{"colour", "#102030", "grey", "wall.toml:4: ", "expected a colour as \"#RRGGBB\""},
        Wrong{"timeout_range", "= 100", "= 0", "wall.toml:5: ", "expected an integer from 1 to 10000"},
        Wrong{"lossy_pixels", "max_sessions = 7", "lossy_pixels = 17",
              "wall.toml:7: ", "'lossy_pixels': expected a number from 0 to 16"},
        Wrong{"address", "127.0.0.1:7770", "here", "wall.toml:11: ", "expected unix:PATH or HOST:PORT"},
        Wrong{"listen_type", "[\"unix:/run/wallgl/walld.sock\", \"127.0.0.1:7770\"]", "7770",
              "wall.toml:11: ", "expected an array of addresses"},
        Wrong{"user", "\"root\"", "\"no such user\"", "wall.toml:12: ", "this machine has no user 'no such user'"},
        Wrong{"no_group", "\"@root\"", "\"@no such group\"",
              "wall.toml:18: ", "'operators': this machine has no group 'no such group'"},
        Wrong{"member_type", "[77]", "[1.5]", "wall.toml:19: ", "expected user names, user numbers or \"@group\""},
        Wrong{"member_list", "[77]", "77", "wall.toml:19: ", "'viewers': expected an array"},
        Wrong{"role", "\"viewer\"", "\"king\"",
              "wall.toml:20: ", "expected \"none\", \"viewer\", \"user\" or \"operator\""},
        Wrong{"token_file", "file = \"/etc/wallgl/kiosk.token\"", "", "wall.toml:22: ", "'file' is missing"},
        Wrong{"sessions", "= 7", "= 0", "wall.toml:7: ", "expected an integer from 1 to 10000"},
        Wrong{"http_unix", "127.0.0.1:7780", "unix:/x", "wall.toml:15: ", "expected HOST:PORT"},
        Wrong{"backend", "\"osmesa\"", "\"vulkan\"", "wall.toml:39: ", "expected \"egl\" or \"osmesa\""},
        Wrong{"rect_count", "[660, 0, 1280, 980]", "[660, 0, 1280]",
              "wall.toml:42: ", "expected [x, y, width, height]"},
        Wrong{"rect_negative", "[660, 0, 1280, 980]", "[-1, 0, 1280, 980]",
              "wall.toml:42: ", "expected [x, y, width, height]"},
        Wrong{"rect_empty", "[660, 0, 1280, 980]", "[660, 0, 0, 980]",
              "wall.toml:42: ", "expected [x, y, width, height]"},
        Wrong{"rect_huge", "[660, 0, 1280, 980]", "[32000, 0, 1280, 980]",
              "wall.toml:42: ", "expected [x, y, width, height]"},
        Wrong{"tile_key", "rect = [660", "size = 1\nrect = [660",
              "wall.toml:42: ", "expected one of name, rect, output, display, monitor, parent, position"},
        Wrong{"output", "rect = [0, 500, 640, 480]", "output = \"tv\"\nrect = [0, 500, 640, 480]", "wall.toml:35: ",
              "'output' is 'tv': expected \"headless\", \"window\", \"kms\", or \"kms:\" and a connector"},
        Wrong{"no_connector", "rect = [0, 500, 640, 480]", "output = \"kms:\"\nrect = [0, 500, 640, 480]",
              "wall.toml:35: ", "expected the name of a connector behind \"kms:\", such as \"kms:DP-1\""},
        Wrong{"connector_of_a_path", "rect = [0, 500, 640, 480]", "output = \"kms:../x\"\nrect = [0, 500, 640, 480]",
              "wall.toml:35: ", "'output' is 'kms:../x': expected the name of a connector"},
        Wrong{"mode_without_kms", "rect = [0, 500, 640, 480]", "rect = [0, 500, 640, 480]\nmode = \"640x480\"",
              "wall.toml:36: ", "'mode' is of a tile on a monitor without a window system: expected output = \"kms\""},
        Wrong{"mode_of_words", "rect = [0, 500, 640, 480]",
              "rect = [0, 500, 640, 480]\noutput = \"kms\"\nmode = \"large\"",
              "wall.toml:37: ", "'mode': expected the monitor's picture as \"1920x1080\" or \"1920x1080@60\""},
        Wrong{"monitor_of_kms", "rect = [0, 500, 640, 480]",
              "rect = [0, 500, 640, 480]\noutput = \"kms\"\nmonitor = \"DP-1\"",
              "wall.toml:37: ", "'monitor' is of a tile in a window: expected output = \"window\" beside it"},
        Wrong{"kms_of_osmesa", "rect = [660, 0, 1280, 980]", "rect = [660, 0, 1280, 980]\noutput = \"kms:DP-1\"",
              "wall.toml:43: ", "'output' is 'kms' on a node with backend \"osmesa\", which draws into memory only"},
        Wrong{"one_connector_twice", "rect = [0, 0, 640, 480]\n[[node.tile]]\nname = \"bottom\"",
              "rect = [0, 0, 640, 480]\noutput = \"kms:DP-1\"\n[[node.tile]]\noutput = \"kms:DP-1\"\nname = "
              "\"bottom\"",
              "wall.toml:35: ", "connector 'DP-1' shows tile 'top' already"},
        Wrong{"kms_beside_a_window", "rect = [0, 0, 640, 480]\n[[node.tile]]\nname = \"bottom\"",
              "rect = [0, 0, 640, 480]\noutput = \"window\"\n[[node.tile]]\noutput = \"kms\"\nname = \"bottom\"",
              "wall.toml:35: ",
              "tile 'bottom' has output 'kms', tile 'top' has 'window': expected one of both in a node"},
        Wrong{"output_type", "rect = [0, 500, 640, 480]", "output = 1\nrect = [0, 500, 640, 480]",
              "wall.toml:35: ", "'output': expected a string"},
        Wrong{"monitor_without_window", "rect = [0, 500, 640, 480]", "rect = [0, 500, 640, 480]\nmonitor = \"DP-1\"",
              "wall.toml:36: ", "'monitor' is of a tile in a window: expected output = \"window\" beside it"},
        Wrong{"monitor_and_position", "rect = [0, 500, 640, 480]",
              "rect = [0, 500, 640, 480]\noutput = \"window\"\nmonitor = \"DP-1\"\nposition = [0, 0]",
              "wall.toml:38: ", "'position' beside 'monitor'"},
        Wrong{"monitor_and_parent", "rect = [0, 500, 640, 480]",
              "rect = [0, 500, 640, 480]\noutput = \"window\"\nparent = 5\nmonitor = \"DP-1\"",
              "wall.toml:38: ", "'monitor' beside 'parent'"},
        Wrong{"parent_of_no_window", "rect = [0, 500, 640, 480]",
              "rect = [0, 500, 640, 480]\noutput = \"window\"\nparent = 0",
              "wall.toml:37: ", "'parent': expected an integer from 1"},
        Wrong{"position_type", "rect = [0, 500, 640, 480]",
              "rect = [0, 500, 640, 480]\noutput = \"window\"\nposition = [1, -1]",
              "wall.toml:37: ", "'position': expected [x, y] in pixels, each from 0 to 32767"},
        Wrong{"position_count", "rect = [0, 500, 640, 480]",
              "rect = [0, 500, 640, 480]\noutput = \"window\"\nposition = 5",
              "wall.toml:37: ", "'position': expected [x, y]"},
        Wrong{"display_empty", "rect = [0, 500, 640, 480]",
              "rect = [0, 500, 640, 480]\noutput = \"window\"\ndisplay = \"\"", "wall.toml:37: ", "'display' is empty"},
        Wrong{"window_of_osmesa", "rect = [660, 0, 1280, 980]", "rect = [660, 0, 1280, 980]\noutput = \"window\"",
              "wall.toml:43: ", "expected backend = \"egl\" or output = \"headless\""},
        Wrong{"two_displays", "rect = [0, 0, 640, 480]\n[[node.tile]]\nname = \"bottom\"",
              "rect = [0, 0, 640, 480]\noutput = \"window\"\n[[node.tile]]\noutput = \"window\"\ndisplay = "
              "\":1\"\nname = \"bottom\"",
              "wall.toml:36: ", "tile 'bottom' is on display \":1\", tile 'top' on $DISPLAY: expected one display"},
        Wrong{"one_monitor_twice", "rect = [0, 0, 640, 480]\n[[node.tile]]\nname = \"bottom\"",
              "rect = [0, 0, 640, 480]\noutput = \"window\"\nmonitor = \"A\"\n[[node.tile]]\noutput = "
              "\"window\"\nmonitor = \"A\"\nname = \"bottom\"",
              "wall.toml:37: ", "monitor 'A' shows tile 'top' already"},
        Wrong{"node_twice", "\"right\"", "\"left\"", "wall.toml:37: ", "node 'left' appears twice"},
        Wrong{"tile_twice", "\"big\"", "\"top\"", "wall.toml:37: ", "tile 'top' appears twice"},
        Wrong{"no_tile", "[[node.tile]]\nname = \"big\"\nrect = [660, 0, 1280, 980]", "",
              "wall.toml:37: ", "'tile' is missing: expected at least one [[node.tile]]"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(WallConfig, AnEmptyOneLacksNodes) {
    const auto config = parse_config("", "wall.toml");
    ASSERT_FALSE(config);
    EXPECT_EQ(config.error().message, "wall.toml:1: 'node' is missing: expected at least one [[node]]");
}

TEST(WallConfig, AQuotaIsWhatItSaysAndNothingElse) {
    const auto with = [](const std::string& keys) { return parse_config(kGood + ("[quota]\n" + keys), "wall.toml"); };
    const auto quota = with("program_memory = 512\nprogram_fps = 60\nperson_programs = 3\n")->quota;
    EXPECT_EQ(quota.program_memory, std::uint64_t{512} << 20);
    EXPECT_EQ(quota.program_fps, 60u);
    EXPECT_EQ(quota.person_programs, 3u);
    EXPECT_FALSE(quota.program_objects || quota.program_bandwidth || quota.program_windows || quota.person_memory);
    EXPECT_EQ(parse_config(kGood, "wall.toml")->quota, QuotaConfig());
    EXPECT_EQ(with("person_views = 4\nperson_pictures = 2\n")->quota,
              (QuotaConfig{.person_views = 4, .person_pictures = 2}));
    EXPECT_EQ(
        with("program_bandwidth = 100\nprogram_objects = 7\nprogram_windows = 2\nperson_memory = 1\n")->quota,
        (QuotaConfig{
            .program_objects = 7, .program_bandwidth = 100 << 20, .program_windows = 2, .person_memory = 1 << 20}));
    for (const char* wrong : {"program_memory = 0", "program_memory = \"1 GiB\"", "program_fps = 1001",
                              "program_windows = 257", "person_views = 257", "memory = 1"}) {
        const auto read = with(wrong);
        ASSERT_FALSE(read) << wrong;
        EXPECT_THAT(read.error().message, StartsWith("wall.toml:"));
    }
}

TEST(WallConfig, NodesStandAloneToBeAdded) {
    const auto nodes = parse_nodes("[[node]]\nname = \"a\"\n[[node.tile]]\nname = \"t\"\nrect = [0, 0, 8, 6]\n", "x");
    ASSERT_TRUE(nodes) << nodes.error().message;
    ASSERT_EQ(nodes->size(), 1u);
    EXPECT_EQ(nodes->front().tiles.at(0).rect, (geom::Rect{0, 0, 8, 6}));
    const auto more = parse_nodes("[people]\n", "x");
    ASSERT_FALSE(more);
    EXPECT_THAT(more.error().message, StartsWith("x:1: unknown key 'people' in the nodes"));
}

TEST(WallConfig, AMissingFileIsNamed) {
    const auto config = load_config("/nowhere/wall.toml");
    ASSERT_FALSE(config);
    EXPECT_THAT(config.error().message, StartsWith("/nowhere/wall.toml: cannot be read"));
}

}  // namespace
}  // namespace wall::config
