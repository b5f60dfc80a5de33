// SPDX-License-Identifier: MIT
#include "tools/wallctl/columns.h"

#include <algorithm>

namespace wall::wallctl {
namespace {

constexpr std::string_view kEllipsis = "…";
constexpr std::size_t kGap = 2;  // cells between columns

bool begins_character(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) != 0x80; }
std::size_t cells(std::string_view text) {
    return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

/// The columns that are shown, and how wide they are.
struct Shown {
    std::vector<std::size_t> columns, widths;
    std::size_t total() const {
        std::size_t sum = columns.empty() ? 0 : kGap * (columns.size() - 1);
        for (const auto column : columns) sum += widths[column];
        return sum;
    }
};

Shown fitting(const std::vector<Row>& rows, std::span<const int> ranks, std::size_t width) {
    Shown shown{{}, std::vector<std::size_t>(rows.front().size())};
    for (std::size_t i = 0; i < shown.widths.size(); ++i) {
        shown.columns.push_back(i);
        for (const auto& row : rows) shown.widths[i] = std::max(shown.widths[i], cells(row[i]));
    }
    const auto rank = [&](std::size_t column) { return column < ranks.size() ? ranks[column] : 0; };
    while (shown.total() > width) {
        const auto least = std::ranges::max_element(shown.columns, {}, rank);
        if (rank(*least) == 0) break;
        shown.columns.erase(least);
    }
    return shown;
}

}  // namespace

std::string table(const std::vector<Row>& rows, std::span<const int> ranks, std::size_t width) {
    const auto shown = fitting(rows, ranks, width);
    std::string out;
    for (const auto& row : rows) {
        std::string line;
        for (const auto column : shown.columns)
            line += row[column] + std::string(shown.widths[column] - cells(row[column]) + kGap, ' ');
        out += cut(line.substr(0, line.find_last_not_of(' ') + 1), width) + "\n";
    }
    return out;
}

std::string cut(std::string_view text, std::size_t width) {
    if (width == kAnyWidth || cells(text) <= width) return std::string(text);
    if (width == 0) return {};
    std::size_t at = 0, seen = 0;
    while (at < text.size() && !(begins_character(text[at]) && seen++ == width - 1)) ++at;
    return std::string(text.substr(0, at)) + std::string(kEllipsis);
}

std::string printable(std::string_view text) {
    std::string out(text);
    std::ranges::replace_if(
        out, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
    return out;
}

}  // namespace wall::wallctl
