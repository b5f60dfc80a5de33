// SPDX-License-Identifier: MIT
#include "tools/wallcalibrate/wall_plan.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "common/base/quoted.h"
#include "tools/wallcalibrate/flat_screen.h"

namespace wall::calibrate {
namespace {

/// A projector's place in the grid.
struct Cell {
    std::size_t column = 0, row = 0;
};

/// Groups of values that lie close together, in order: for each value, which one it is in.
std::vector<std::size_t> groups(const std::vector<double>& middles, double apart) {
    std::vector<std::size_t> order(middles.size()), out(middles.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::sort(order, {}, [&](std::size_t i) { return middles[i]; });
    std::size_t group = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && middles[order[i]] - middles[order[i - 1]] > apart) ++group;
        out[order[i]] = group;
    }
    return out;
}

Result<std::vector<Cell>> grid_of(std::span<const Projector> projectors) {
    std::vector<double> x, y;
    double width = 1e9, height = 1e9;
    for (const auto& projector : projectors) {
        const auto& rect = projector.rect;
        x.push_back(rect.x + rect.width / 2.0);
        y.push_back(rect.y + rect.height / 2.0);
        width = std::min(width, static_cast<double>(rect.width));
        height = std::min(height, static_cast<double>(rect.height));
    }
    const auto columns = groups(x, width / 3), rows = groups(y, height / 3);
    const auto many = [](const std::vector<std::size_t>& all) { return *std::ranges::max_element(all) + 1; };
    if (many(columns) * many(rows) != projectors.size())
        return fail("the tiles of " + std::to_string(projectors.size()) + " projectors lie in " +
                    std::to_string(many(columns)) + " columns and " + std::to_string(many(rows)) +
                    " rows: expected a full grid");
    std::vector<Cell> out;
    for (std::size_t i = 0; i < projectors.size(); ++i) out.push_back({columns[i], rows[i]});
    return out;
}

std::array<cv::Point2d, 4> corners_of(const Projector& projector, const cv::Matx33d& map) {
    const double w = projector.width, h = projector.height;
    return {apply(map, {0, 0}), apply(map, {w, 0}), apply(map, {w, h}), apply(map, {0, h})};
}

/// From the screen's picture to a canvas whose corners are the outer ones of the corner projectors, upright, and whose
/// pixels are as large as the projectors' on the average, each way.
cv::Matx33d canvas_of(std::span<const Projector> projectors, const std::vector<Cell>& cells) {
    std::size_t columns = 0, rows = 0;
    for (const Cell& cell : cells) {
        columns = std::max(columns, cell.column);
        rows = std::max(rows, cell.row);
    }
    std::array<cv::Point2f, 4> outer;
    for (std::size_t i = 0; i < projectors.size(); ++i) {
        const auto corners = corners_of(projectors[i], projectors[i].on_screen);
        const auto [column, row] = cells[i];
        const auto take = [&](std::size_t c, std::size_t r, std::size_t corner) {
            if (column == c && row == r) outer[corner] = cv::Point2f(corners[corner]);
        };
        take(0, 0, 0);
        take(columns, 0, 1);
        take(columns, rows, 2);
        take(0, rows, 3);
    }
    const std::array<cv::Point2f, 4> unit{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const cv::Matx33d to_unit(cv::getPerspectiveTransform(outer.data(), unit.data()));
    double across = 0, down = 0;  // of the unit square, a projector's pixel
    for (const auto& projector : projectors) {
        const auto c = corners_of(projector, to_unit * projector.on_screen);
        across += (cv::norm(c[1] - c[0]) + cv::norm(c[2] - c[3])) / (2 * projector.width);
        down += (cv::norm(c[3] - c[0]) + cv::norm(c[2] - c[1])) / (2 * projector.height);
    }
    const auto count = static_cast<double>(projectors.size());
    return cv::Matx33d(count / across, 0, 0, 0, count / down, 0, 0, 0, 1) * to_unit;
}

/// An interval of the canvas that a projector lights from end to end.
struct Span {
    std::optional<double> from, to;          ///< its own ends; none: the screen ends before
    double seen_from = 1e9, seen_to = -1e9;  ///< of what is seen of it
};

/// A projector's pixels from edge to edge on the canvas: a grid, with NaN for what no screen is behind.
struct OnCanvas {
    std::size_t columns = 2, rows = 2;
    std::vector<cv::Point2d> points;
};

OnCanvas on_canvas(const Projector& projector, const cv::Matx33d& canvas) {
    OnCanvas out;
    if (projector.seen.points.empty()) {
        const auto c = corners_of(projector, canvas * projector.on_screen);
        out.points = {c[0], c[1], c[3], c[2]};
        return out;
    }
    out.columns = static_cast<std::size_t>(projector.seen.columns);
    out.rows = static_cast<std::size_t>(projector.seen.rows);
    for (const auto& point : projector.seen.points) out.points.push_back(is_seen(point) ? apply(canvas, point) : point);
    return out;
}

/// Across (x), or down.
Span span_of(const OnCanvas& grid, bool across) {
    Span out;
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
        if (!is_seen(grid.points[i])) continue;
        const double at = across ? grid.points[i].x : grid.points[i].y;
        const std::size_t place = across ? i % grid.columns : i / grid.columns,
                          last = (across ? grid.columns : grid.rows) - 1;
        out.seen_from = std::min(out.seen_from, at);
        out.seen_to = std::max(out.seen_to, at);
        if (place == 0) out.from = std::max(out.from.value_or(at), at);
        if (place == last) out.to = std::min(out.to.value_or(at), at);
    }
    return out;
}

/// What all projectors of each column, or row, light from end to end.
std::map<std::size_t, Span> lit(const std::vector<std::size_t>& group, const std::vector<Span>& each) {
    std::map<std::size_t, Span> out;
    for (std::size_t i = 0; i < group.size(); ++i) {
        Span& span = out[group[i]];
        if (each[i].from) span.from = std::max(span.from.value_or(*each[i].from), *each[i].from);
        if (each[i].to) span.to = std::min(span.to.value_or(*each[i].to), *each[i].to);
        span.seen_from = std::min(span.seen_from, each[i].seen_from);
        span.seen_to = std::max(span.seen_to, each[i].seen_to);
    }
    for (auto& [index, span] : out) {
        if (!span.from) span.from = span.seen_from;
        if (!span.to) span.to = span.seen_to;
    }
    return out;
}

/// Whole pixels within each, beginning at 0. An error: neighbours do not overlap.
Result<std::map<std::size_t, std::pair<int, int>>> whole(const std::map<std::size_t, Span>& spans, double origin,
                                                         const char* what) {
    std::map<std::size_t, std::pair<int, int>> out;
    for (const auto& [group, span] : spans) {
        const int from = static_cast<int>(std::ceil(*span.from - origin)),
                  to = static_cast<int>(std::floor(*span.to - origin));
        if (to <= from || (group > 0 && from >= out[group - 1].second))
            return fail(
                fmt::format("{} {} and the one before it do not overlap on the screen: expected projectors whose "
                            "pictures do (or no `wallctl calibrate` for them)",
                            what, group));
        out[group] = {from, to};
    }
    return out;
}

/// `fractions`: from the screen's picture to fractions of the tile.
geom::Warp flat_warp(const Projector& projector, const cv::Matx33d& fractions) {
    const cv::Matx33d pixels(projector.width, 0, 0, 0, projector.height, 0, 0, 0, 1);
    cv::Matx33d all = fractions * projector.on_screen * pixels;
    all *= 1 / all(2, 2);
    geom::Warp out;
    for (int k = 0; k < 9; ++k) out.homography[static_cast<std::size_t>(k)] = static_cast<float>(all.val[k]);
    return out;
}

geom::Warp mesh_of(const OnCanvas& grid, const cv::Matx33d& fractions) {
    geom::Warp out;
    out.columns = static_cast<std::uint32_t>(grid.columns);
    out.rows = static_cast<std::uint32_t>(grid.rows);
    for (const auto& point : grid.points) {
        const auto at = is_seen(point) ? apply(fractions, point) : point;
        out.points.push_back({static_cast<float>(at.x), static_cast<float>(at.y)});
    }
    return out;
}

}  // namespace

void put(Projector& projector, SeenMesh seen) {
    std::vector<cv::Point2d> pixels, points;
    for (std::size_t i = 0; i < seen.points.size(); ++i) {
        if (!is_seen(seen.points[i])) continue;
        const auto columns = static_cast<std::size_t>(seen.columns);
        pixels.emplace_back(static_cast<double>(i % columns) * projector.width / (seen.columns - 1),
                            static_cast<double>(i / columns) * projector.height / (seen.rows - 1));
        points.push_back(seen.points[i]);
    }
    projector.on_screen = cv::Matx33d(cv::findHomography(pixels, points, 0));
    projector.seen = std::move(seen);
}

Result<std::vector<PlannedTile>> plan_wall(std::span<const Projector> projectors) {
    if (projectors.empty()) return fail("no projectors");
    const auto cells = grid_of(projectors);
    if (!cells) return tl::unexpected(cells.error());
    const cv::Matx33d canvas = canvas_of(projectors, *cells);
    std::vector<OnCanvas> grids;
    std::vector<Span> across, down;
    std::vector<std::size_t> columns, rows;
    for (std::size_t i = 0; i < projectors.size(); ++i) {
        grids.push_back(on_canvas(projectors[i], canvas));
        across.push_back(span_of(grids.back(), true));
        down.push_back(span_of(grids.back(), false));
        columns.push_back((*cells)[i].column);
        rows.push_back((*cells)[i].row);
    }
    const auto lit_columns = lit(columns, across), lit_rows = lit(rows, down);
    const double left = std::ceil(*lit_columns.at(0).from), top = std::ceil(*lit_rows.at(0).from);
    const auto x = whole(lit_columns, left, "column"), y = whole(lit_rows, top, "row");
    if (!x) return tl::unexpected(x.error());
    if (!y) return tl::unexpected(y.error());
    std::vector<PlannedTile> out;
    for (std::size_t i = 0; i < projectors.size(); ++i) {
        const auto [column, row] = (*cells)[i];
        const auto [x0, x1] = x->at(column);
        const auto [y0, y1] = y->at(row);
        PlannedTile tile{
            projectors[i].tile, {x0, y0, x1 - x0, y1 - y0}, projectors[i].width, projectors[i].height, {}, {}};
        if (column > 0) tile.ramps[geom::Blend::left] = x->at(column - 1).second - x0;
        if (x->contains(column + 1)) tile.ramps[geom::Blend::right] = x1 - x->at(column + 1).first;
        if (row > 0) tile.ramps[geom::Blend::top] = y->at(row - 1).second - y0;
        if (y->contains(row + 1)) tile.ramps[geom::Blend::bottom] = y1 - y->at(row + 1).first;
        // The canvas to fractions of the tile.
        const cv::Matx33d fractions(1.0 / tile.rect.width, 0, -(left + x0) / tile.rect.width, 0, 1.0 / tile.rect.height,
                                    -(top + y0) / tile.rect.height, 0, 0, 1);
        tile.warp = projectors[i].seen.points.empty() ? flat_warp(projectors[i], fractions * canvas)
                                                      : mesh_of(grids[i], fractions);
        if (const char* wrong = geom::wrong_with(tile.warp))
            return fail("the warp of tile '" + tile.tile + "' " + wrong);
        out.push_back(std::move(tile));
    }
    return out;
}

std::string tile_lines(const PlannedTile& tile, const std::string& warp_file, double gamma) {
    const auto& r = tile.rect;
    std::string out = fmt::format("rect = [{}, {}, {}, {}]\npixels = [{}, {}]\nwarp = {}\n", r.x, r.y, r.width,
                                  r.height, tile.width, tile.height, in_quotes(warp_file));
    if (std::ranges::any_of(tile.ramps, [](int ramp) { return ramp != 0; }))
        out += fmt::format("blend = {{ left = {}, right = {}, top = {}, bottom = {}, gamma = {} }}\n", tile.ramps[0],
                           tile.ramps[1], tile.ramps[2], tile.ramps[3], gamma);
    return out;
}

std::string warp_text(const geom::Warp& warp) {
    constexpr std::string_view kSays = "# From places of the output to places of the tile (docs/walls.md).\n";
    if (warp.columns == 0) return fmt::format("{}homography = [{}]\n", kSays, fmt::join(warp.homography, ", "));
    std::string out = fmt::format("{}[mesh]\ncolumns = {}\nrows = {}\npoints = [\n", kSays, warp.columns, warp.rows);
    for (std::size_t i = 0; i < warp.points.size(); ++i) {
        const auto& point = warp.points[i];
        out += std::isnan(point.x) ? "[]" : fmt::format("[{:.6f}, {:.6f}]", point.x, point.y);
        out += (i + 1) % warp.columns == 0 ? ",\n" : ", ";
    }
    return out + "]\n";
}

}  // namespace wall::calibrate
