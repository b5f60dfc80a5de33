// SPDX-License-Identifier: MIT
#include "tileserver/kms/cards.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "tileserver/gpu/backend.h"
#include "tileserver/gpu/gpu_devices.h"
#include "tileserver/kms/libdrm_device.h"

namespace wall::tileserver {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "card", kUsualDomain = "0000:";
constexpr std::size_t kConnectorWidth = 13, kMonitorWidth = 16;  // columns

std::string padded(std::string text, std::size_t width) {
    text.resize(std::max(text.size() + 1, width), ' ');
    return text;
}

/// Of "card12": 12; none: it is called otherwise.
std::optional<unsigned> number_of(const std::string& name) {
    unsigned out = 0;
    if (!name.starts_with(kPrefix)) return {};
    const char *begin = name.data() + kPrefix.size(), *end = name.data() + name.size();
    const auto read = std::from_chars(begin, end, out);
    return read.ec == std::errc{} && read.ptr == end ? std::optional(out) : std::nullopt;
}

std::string modes_of(const Connector& connector) {
    std::string out;
    for (const Mode& mode : connector.modes)
        if (!mode.interlaced) out += (out.empty() ? "" : " ") + text_of(mode) + (mode.preferred ? "*" : "");
    return out.empty() ? "-" : out;
}

}  // namespace

std::vector<CardFile> card_files() {
    std::error_code error;
    std::vector<std::pair<unsigned, CardFile>> found;
    for (fs::directory_iterator at("/dev/dri", error), end; !error && at != end; at.increment(error)) {
        const auto path = at->path().string();
        if (const auto number = number_of(at->path().filename().string()))
            found.emplace_back(*number, CardFile{path, pci_address(path)});
    }
    std::ranges::sort(found, {}, [](const auto& entry) { return entry.first; });
    std::vector<CardFile> out;
    for (auto& [number, file] : found) out.push_back(std::move(file));
    return out;
}

Result<std::vector<std::string>> choose_cards(std::span<const CardFile> cards, std::string_view gpu) {
    std::vector<std::string> out;
    std::string known;
    for (const CardFile& card : cards) {
        known += (known.empty() ? "there are " : ", ") + card.path + (card.pci.empty() ? "" : " (" + card.pci + ")");
        if (gpu == kAnyGpu ||
            (!card.pci.empty() && (card.pci == gpu || card.pci == std::string(kUsualDomain).append(gpu))))
            out.push_back(card.path);
    }
    if (!out.empty()) return out;
    if (cards.empty())
        return fail(
            "a tile is shown without a window system, but this machine has no graphics card for monitors "
            "(/dev/dri/card*)");
    return fail("there is no graphics card '" + std::string(gpu) + "': " + known);
}

std::string monitor_lines(const CardFile& file, const Card& card) {
    std::string out = file.path + (file.pci.empty() ? "" : "  " + file.pci) + "\n";
    for (const Connector& connector : card.connectors) {
        out += "  " + padded(connector.name, kConnectorWidth);
        out += connector.connected
                   ? padded(connector.monitor.empty() ? "?" : connector.monitor, kMonitorWidth) + modes_of(connector)
                   : "-";
        out += "\n";
    }
    return out;
}

std::string monitor_table() {
    const auto cards = card_files();
    if (cards.empty()) return "This machine has no graphics card for monitors (/dev/dri/card*).\n";
    std::string out;
    for (const CardFile& file : cards) {
        const auto device = LibdrmDevice::open(file.path);
        if (device) (*device)->give_up_master();  // who opens a card that is nobody's has it
        const auto card = device ? (*device)->describe() : tl::unexpected(device.error());
        out += card ? monitor_lines(file, *card) : file.path + "\n  " + card.error().message + "\n";
    }
    return out;
}

}  // namespace wall::tileserver
