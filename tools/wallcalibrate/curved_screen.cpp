// SPDX-License-Identifier: MIT
#include "tools/wallcalibrate/curved_screen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "common/geom/tile_output.h"

namespace wall::calibrate {
namespace {

constexpr double kFinest = 16, kCoarsest = 64;  // projector pixels from point to point
constexpr double kMatchesOfCell = 40;           // that a cell has on the average
constexpr std::size_t kLeastOfCell = 8;         // matches around a point, or it is not seen
constexpr double kReach = 1.5;                  // cells, that a point is found from
constexpr std::size_t kSample = 400;            // matches that a point is found from
constexpr double kMostRoughness = 2;            // projector pixels, 95 %: beyond, it is no smooth screen
constexpr int kTerms = 6;                       // of a polynomial of two variables, of the second degree
constexpr double kSlack = 2;                    // camera pixels that a match may always be off by
const double kNothing = std::numeric_limits<double>::quiet_NaN();

using Terms = cv::Matx<double, kTerms, 1>;

double middle_of(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// Around one point of a projector, where the camera sees its pixels: a polynomial of the second degree.
struct Patch {
    cv::Point2d middle;  ///< of the projector
    double reach = 1;    ///< projector pixels that are 1 of the polynomial's variables
    Terms x, y;

    static Terms terms(const cv::Point2d& from) {
        return {1, from.x, from.y, from.x * from.x, from.x * from.y, from.y * from.y};
    }
    cv::Point2d at(const cv::Point2d& output) const {
        const Terms t = terms((output - middle) / reach);
        return {x.dot(t), y.dot(t)};
    }
    /// Camera pixels that a projector's is wide, in the middle.
    double scale() const { return std::sqrt(std::abs(x(1) * y(2) - x(2) * y(1))) / reach; }
};

/// What is wrongly decoded lies far from what most say.
std::vector<Match> without_strays(const std::vector<Match>& all) {
    std::array<double, 2> middle{}, spread{};
    std::vector<double> values;
    for (const int axis : {0, 1}) {
        const auto take = [&](auto value) {
            values.clear();
            for (const Match& match : all) values.push_back(value(axis == 0 ? match.camera.x : match.camera.y));
            return middle_of(values);
        };
        const auto k = static_cast<std::size_t>(axis);
        middle[k] = take([](double v) { return v; });
        spread[k] = take([&](double v) { return std::abs(v - middle[k]); });
    }
    std::vector<Match> out;
    for (const Match& match : all)
        if (std::abs(match.camera.x - middle[0]) <= 6 * spread[0] + kSlack &&
            std::abs(match.camera.y - middle[1]) <= 6 * spread[1] + kSlack)
            out.push_back(match);
    return out;
}

/// Least squares, those that are nearer counting more; none: the matches do not tell.
std::optional<Patch> fit(const cv::Point2d& middle, double reach, const std::vector<Match>& matches) {
    cv::Matx<double, kTerms, kTerms> squares;
    Terms x, y;
    for (const Match& match : matches) {
        const cv::Point2d from = (match.output - middle) / reach;
        const double near = std::max(0.05, 1 - from.dot(from) / 2);  // 2: the square's corners
        const Terms t = Patch::terms(from);
        squares += near * near * t * t.t();
        x += near * near * match.camera.x * t;
        y += near * near * match.camera.y * t;
    }
    bool good = false;
    const auto inverse = squares.inv(cv::DECOMP_CHOLESKY, &good);
    if (!good) return std::nullopt;
    return Patch{middle, reach, inverse * x, inverse * y};
}

std::optional<Patch> find_patch(const cv::Point2d& middle, double reach, const std::vector<Match>& all,
                                std::vector<double>& errors) {
    auto matches = without_strays(all);
    for (const bool last : {false, true}) {
        if (matches.size() < std::size_t{2} * kTerms) return std::nullopt;
        const auto patch = fit(middle, reach, matches);
        if (!patch) return std::nullopt;
        std::vector<double> off;
        for (const Match& match : matches) off.push_back(cv::norm(patch->at(match.output) - match.camera));
        if (last) {
            for (const double each : off) errors.push_back(each / patch->scale());
            return patch;
        }
        auto sorted = off;
        const double most = 4 * middle_of(sorted) + kSlack / 4;
        std::vector<Match> kept;
        for (std::size_t i = 0; i < matches.size(); ++i)
            if (off[i] <= most) kept.push_back(matches[i]);
        matches = std::move(kept);
    }
    return std::nullopt;
}

/// A projector's matches, by the square of its output in which they lie.
class Squares {
public:
    Squares(const Seen& seen, double side) : side_(side) {
        columns_ = static_cast<int>(seen.width / side) + 1;
        rows_ = static_cast<int>(seen.height / side) + 1;
        squares_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
        for (const Match& match : seen.matches) of(match.output).push_back(match);
    }
    /// No more than kSample of those in a square of `reach` on each side.
    std::vector<Match> around(const cv::Point2d& middle, double reach) {
        std::vector<Match> all;
        for (double y = middle.y - reach; y < middle.y + reach + side_; y += side_)
            for (double x = middle.x - reach; x < middle.x + reach + side_; x += side_)
                if (x > -side_ && y > -side_ && x < columns_ * side_ && y < rows_ * side_)
                    for (const Match& match : of({std::max(0.0, x), std::max(0.0, y)}))
                        if (std::max(std::abs(match.output.x - middle.x), std::abs(match.output.y - middle.y)) <= reach)
                            all.push_back(match);
        if (all.size() <= kSample) return all;
        std::vector<Match> out;
        for (std::size_t i = 0; i < kSample; ++i) out.push_back(all[i * all.size() / kSample]);
        return out;
    }

private:
    std::vector<Match>& of(const cv::Point2d& output) {
        const int column = std::min(columns_ - 1, static_cast<int>(output.x / side_)),
                  row = std::min(rows_ - 1, static_cast<int>(output.y / side_));
        return squares_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                        static_cast<std::size_t>(column)];
    }
    double side_;
    int columns_ = 0, rows_ = 0;
    std::vector<std::vector<Match>> squares_;
};

/// The grid of one projector: a patch at each point that has matches around it, and one point farther out, so that
/// small holes close and the screen is lit up to its rim.
class MeshFinder {
public:
    explicit MeshFinder(const Seen& seen) : seen_(seen) {
        const double pixels = static_cast<double>(seen.width) * seen.height,
                     each = std::clamp(std::sqrt(kMatchesOfCell * pixels / static_cast<double>(seen.matches.size())),
                                       kFinest, kCoarsest);
        constexpr auto kMost = 256;  // squared: geom::kMaxMeshPoints
        static_assert(kMost * kMost <= geom::kMaxMeshPoints);
        const auto count = [&](int extent) {
            return std::clamp(static_cast<int>(std::ceil(extent / each)) + 1, 2, kMost);
        };
        mesh_.columns = count(seen.width);
        mesh_.rows = count(seen.height);
        across_ = static_cast<double>(seen.width) / (mesh_.columns - 1);
        down_ = static_cast<double>(seen.height) / (mesh_.rows - 1);
    }

    /// False: nothing of it is seen.
    bool find(std::vector<double>& errors) {
        const double cell = std::max(across_, down_);
        Squares squares(seen_, cell);
        patches_.resize(static_cast<std::size_t>(mesh_.columns) * static_cast<std::size_t>(mesh_.rows));
        bool any = false;
        each_point([&](int column, int row) {
            const auto middle = output_at(column, row);
            if (squares.around(middle, cell / 2).size() < kLeastOfCell) return;
            auto& patch = patches_[index(column, row)];
            patch = find_patch(middle, kReach * cell, squares.around(middle, kReach * cell), errors);
            any = any || patch;
        });
        each_point([&](int column, int row) { mesh_.points.push_back(point(column, row)); });
        return any;
    }
    SeenMesh take() { return std::move(mesh_); }

private:
    template <typename Visit>
    void each_point(Visit visit) const {
        for (int row = 0; row < mesh_.rows; ++row)
            for (int column = 0; column < mesh_.columns; ++column) visit(column, row);
    }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(mesh_.columns) +
               static_cast<std::size_t>(column);
    }
    cv::Point2d output_at(int column, int row) const { return {column * across_, row * down_}; }
    /// Its own, or the mean of what its neighbours say of it.
    cv::Point2d point(int column, int row) const {
        const auto at = output_at(column, row);
        if (const auto& own = patches_[index(column, row)]) return own->at(at);
        cv::Point2d sum;
        double count = 0;
        for (int y = std::max(0, row - 1); y <= std::min(mesh_.rows - 1, row + 1); ++y) {
            for (int x = std::max(0, column - 1); x <= std::min(mesh_.columns - 1, column + 1); ++x) {
                const auto& patch = patches_[index(x, y)];
                if (!patch) continue;
                sum += patch->at(at);
                ++count;
            }
        }
        return count == 0 ? cv::Point2d(kNothing, kNothing) : sum / count;
    }

    const Seen& seen_;
    SeenMesh mesh_;
    double across_ = 0, down_ = 0;  // projector pixels from point to point
    std::vector<std::optional<Patch>> patches_;
};

void straighten(const CameraLens& lens, SeenMesh& mesh) {
    std::vector<cv::Point2d> seen;
    std::ranges::copy_if(mesh.points, std::back_inserter(seen), is_seen);
    const auto ideal = straight(lens, seen);
    std::size_t next = 0;
    for (auto& point : mesh.points)
        if (is_seen(point)) point = ideal[next++];
}

}  // namespace

bool is_seen(const cv::Point2d& point) { return !std::isnan(point.x); }

Result<CurvedScreen> find_curved_screen(const CameraLens* lens, std::span<const Seen> projectors) {
    CurvedScreen out;
    std::vector<double> errors;
    for (const Seen& seen : projectors) {
        MeshFinder finder(seen);
        if (!finder.find(errors))
            return fail("of projector " + std::to_string(out.seen.size()) + " no part is seen that hangs together");
        out.seen.push_back(finder.take());
        if (lens) straighten(*lens, out.seen.back());
    }
    std::ranges::sort(errors);
    out.error = errors[errors.size() * 95 / 100];
    if (out.error > kMostRoughness)
        return fail("the photographs fit no smooth screen: 95 % are off by up to " + std::to_string(out.error) +
                    " pixels of a projector (has the camera moved?)");
    return out;
}

}  // namespace wall::calibrate
