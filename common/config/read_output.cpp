// SPDX-License-Identifier: MIT
#include "common/config/read_output.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string>

namespace wall::config {
namespace {

constexpr std::int64_t kMaxPosition = 32767;        // X has 16 bits for it
constexpr std::int64_t kMaxWindow = (1 << 29) - 1;  // X names its windows by 29 bits
constexpr std::string_view kKms = "kms";            // alone, or before ":CONNECTOR"
constexpr std::size_t kMaxConnectorName = 32;       // the kernel's names are shorter
constexpr double kLeastRate = 1, kMostRate = 1000;  // Hz

/// Keys that mean nothing without a window, or beside another key.
void refuse_key(TreeReader& read, const toml::table& tile, std::string_view key, std::string_view why) {
    if (const auto* node = tile.get(key)) read.refuse(node->source(), TreeReader::quoted(key) + " " + std::string(why));
}

std::string display_text(const WindowConfig& window) {
    return window.display.empty() ? "$DISPLAY" : "display \"" + window.display + "\"";
}

/// The number that `text` begins with, which is taken off it; none: there is no such number.
template <class Number>
std::optional<Number> take_number(std::string_view& text, Number least, Number most) {
    Number value{};
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc{} || !(value >= least && value <= most)) return {};
    text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
    return value;
}

bool take_character(std::string_view& text, char wanted) {
    if (text.empty() || text.front() != wanted) return false;
    text.remove_prefix(1);
    return true;
}

/// "1920x1080", or with a rate in Hz: "1920x1080@59.94". None: it is nothing like that.
std::optional<ModeConfig> parse_mode(std::string_view text) {
    constexpr auto kMost = static_cast<std::int32_t>(kMaxCanvas);
    const auto width = take_number<std::int32_t>(text, 1, kMost);
    if (!width || !take_character(text, 'x')) return {};
    const auto height = take_number<std::int32_t>(text, 1, kMost);
    if (!height) return {};
    ModeConfig out{*width, *height};
    if (take_character(text, '@')) {
        const auto rate = take_number<double>(text, kLeastRate, kMostRate);
        if (!rate) return {};
        out.millihertz = static_cast<std::uint32_t>(std::lround(*rate * 1000));
    }
    return text.empty() ? std::optional(out) : std::nullopt;
}

bool is_connector_name(std::string_view name) {
    constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-";
    return !name.empty() && name.size() <= kMaxConnectorName &&
           name.find_first_not_of(kLetters) == std::string_view::npos;
}

/// `output` is "kms" or begins with "kms:".
KmsConfig read_kms(TreeReader& read, const toml::table& tile, const std::string& output) {
    KmsConfig out;
    if (output != kKms) {
        out.connector = output.substr(kKms.size() + 1);
        if (!is_connector_name(out.connector))
            read.refuse(tile.get("output")->source(),
                        "'output' is '" + output +
                            "': expected the name of a connector behind \"kms:\", such as \"kms:DP-1\" "
                            "(`tileserver --monitors` lists them)");
    }
    if (!tile.get("mode")) return out;
    out.mode = parse_mode(read.text(tile, "mode"));
    if (!out.mode)
        read.refuse(tile.get("mode")->source(),
                    "'mode': expected the monitor's picture as \"1920x1080\" or \"1920x1080@60\", the rate from 1 to "
                    "1000 Hz");
    return out;
}

WindowConfig read_window(TreeReader& read, const toml::table& tile) {
    WindowConfig out;
    if (tile.get("display")) out.display = read.text(tile, "display");
    if (tile.get("monitor")) {
        out.monitor = read.text(tile, "monitor");
        refuse_key(read, tile, "position", "beside 'monitor': expected one of them");
    }
    if (tile.get("parent")) {
        out.parent = static_cast<std::uint32_t>(read.integer(tile, "parent", 1, kMaxWindow, 0));
        refuse_key(read, tile, "monitor", "beside 'parent': expected one of them");
    }
    const auto position = read.position(tile, "position", kMaxPosition);
    out.x = position[0];
    out.y = position[1];
    return out;
}

/// Two tiles of a node on monitors without a window system, of which `tile` describes the second.
void check_connectors(TreeReader& read, const toml::table& tile, const TileConfig& second, const TileConfig& first) {
    const auto& connector = second.kms->connector;
    if (!connector.empty() && connector == first.kms->connector && second.gpu == first.gpu)
        read.refuse(tile.get("output")->source(), "connector '" + connector + "' shows tile '" + first.name +
                                                      "' already: expected one tile for a connector");
}

/// Two windows of a node, of which `tile` describes the second.
void check_windows(TreeReader& read, const toml::table& tile, const TileConfig& second, const TileConfig& first) {
    const auto &mine = *second.window, &others = *first.window;
    if (others.display != mine.display) {
        const auto* key = tile.get("display");
        read.refuse(key ? key->source() : tile.source(),
                    "tile '" + second.name + "' is on " + display_text(mine) + ", tile '" + first.name + "' on " +
                        display_text(others) + ": expected one display for all windows of a node (or a node for each)");
    }
    if (!mine.monitor.empty() && others.monitor == mine.monitor)
        read.refuse(tile.get("monitor")->source(), "monitor '" + mine.monitor + "' shows tile '" + first.name +
                                                       "' already: expected one tile for a monitor");
}

}  // namespace

void read_output(TreeReader& read, const toml::table& tile, TileConfig& out) {
    const auto output = read.text(tile, "output", "headless");
    if (output != "window")
        for (const auto* key : {"display", "monitor", "parent", "position"})
            refuse_key(read, tile, key, "is of a tile in a window: expected output = \"window\" beside it");
    const bool kms = output == kKms || output.starts_with(std::string(kKms) + ":");
    if (!kms)
        refuse_key(read, tile, "mode",
                   "is of a tile on a monitor without a window system: expected output = \"kms\" beside it");
    if (kms) out.kms = read_kms(read, tile, output);
    else if (output == "window") out.window = read_window(read, tile);
    else if (output != "headless")
        read.refuse(
            tile.get("output")->source(),
            "'output' is '" + output + "': expected \"headless\", \"window\", \"kms\", or \"kms:\" and a connector");
}

void check_output(TreeReader& read, const toml::table& tile, const NodeConfig& node) {
    const auto& last = node.tiles.back();
    if (!last.window && !last.kms) return;
    const auto& where = tile.get("output")->source();
    if (node.backend != Backend::egl)
        read.refuse(where, "'output' is '" + std::string(output_name(last)) +
                               "' on a node with backend \"osmesa\", which draws into memory only: expected backend = "
                               "\"egl\" or output = \"headless\"");
    for (const auto& other : std::span(node.tiles).first(node.tiles.size() - 1)) {
        if (other.window && last.window) check_windows(read, tile, last, other);
        if (other.kms && last.kms) check_connectors(read, tile, last, other);
        if ((other.window && last.kms) || (other.kms && last.window))
            read.refuse(where, "tile '" + last.name + "' has output '" + output_name(last) + "', tile '" + other.name +
                                   "' has '" + output_name(other) +
                                   "': expected one of both in a node (or a node for each)");
    }
}

}  // namespace wall::config
