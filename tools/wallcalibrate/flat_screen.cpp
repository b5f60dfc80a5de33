// SPDX-License-Identifier: MIT
#include "tools/wallcalibrate/flat_screen.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/optim.hpp>

namespace wall::calibrate {
namespace {

constexpr std::size_t kFitted = 4000;  // matches of a projector that are fitted
constexpr double kOutlier = 3;         // projector pixels
constexpr double kMostBump = 2;        // projector pixels, 95 %: beyond, the screen is not flat
constexpr double kStep = 0.05;         // of k1 and k2, in which the search begins

/// Some of the matches, from all over the picture.
std::vector<Match> sample_of(const std::vector<Match>& all) {
    if (all.size() <= kFitted) return all;
    std::vector<Match> out;
    cv::RNG random(1);
    for (std::size_t i = 0; i < kFitted; ++i)
        out.push_back(all[static_cast<std::size_t>(random.uniform(0, static_cast<int>(all.size())))]);
    return out;
}

/// From the ideal camera's pixels to the projector's, which is where errors are counted; empty: there is none.
cv::Mat fit(const Lens& lens, const std::vector<Match>& matches, int method) {
    std::vector<cv::Point2d> camera, output;
    for (const Match& match : matches) {
        camera.push_back(lens.straight(match.camera));
        output.push_back(match.output);
    }
    return cv::findHomography(camera, output, method, kOutlier);
}

double distance(const cv::Matx33d& to_output, const Lens& lens, const Match& match) {
    const auto off = apply(to_output, lens.straight(match.camera)) - match.output;
    return std::hypot(off.x, off.y);
}

/// How badly homographies fit behind a lens: the mean square error of all, without what is no match at all.
class Misfit final : public cv::MinProblemSolver::Function {
public:
    Misfit(const cv::Size& picture, const std::vector<std::vector<Match>>& matches)
        : picture_(picture), matches_(matches) {}
    int getDims() const override { return 2; }
    double calc(const double* k) const override {
        const Lens lens{picture_, k[0], k[1]};
        double sum = 0, count = 0;
        for (const auto& matches : matches_) {
            const cv::Mat to_output = fit(lens, matches, 0);
            if (to_output.empty()) return 1e9;
            const cv::Matx33d homography(to_output);
            for (const Match& match : matches) {
                sum += std::pow(std::min(distance(homography, lens, match), kOutlier), 2);
                ++count;
            }
        }
        return sum / count;
    }

private:
    cv::Size picture_;
    const std::vector<std::vector<Match>>& matches_;
};

}  // namespace

cv::Point2d apply(const cv::Matx33d& homography, const cv::Point2d& point) {
    const cv::Vec3d at = homography * cv::Vec3d(point.x, point.y, 1);
    return {at[0] / at[2], at[1] / at[2]};
}

cv::Point2d Lens::straight(const cv::Point2d& seen) const {
    const cv::Point2d middle(picture.width / 2.0, picture.height / 2.0);
    const double unit = std::max(picture.width, picture.height) / 2.0;
    const cv::Point2d from = (seen - middle) / unit;
    const double r2 = from.dot(from);
    return middle + from * (unit * (1 + k1 * r2 + k2 * r2 * r2));
}

Result<FlatScreen> find_flat_screen(const cv::Size& picture, std::span<const std::vector<Match>> projectors) {
    // What is wrongly decoded goes first, as seen through a lens that is not known yet, so with some room.
    std::vector<std::vector<Match>> samples;
    const Lens unknown{picture, 0, 0};
    for (const auto& matches : projectors) {
        const auto some = sample_of(matches);
        const cv::Mat rough = fit(unknown, some, cv::LMEDS);
        if (rough.empty())
            return fail("projector " + std::to_string(samples.size()) + " lies nowhere on a flat screen");
        std::vector<double> off;
        for (const Match& match : some) off.push_back(distance(cv::Matx33d(rough), unknown, match));
        auto sorted = off;
        std::ranges::sort(sorted);
        const double most = std::max(kOutlier, 4 * sorted[sorted.size() / 2]);
        auto& kept = samples.emplace_back();
        for (std::size_t i = 0; i < some.size(); ++i)
            if (off[i] <= most) kept.push_back(some[i]);
    }
    const auto solver =
        cv::DownhillSolver::create(cv::makePtr<Misfit>(picture, samples), cv::Mat_<double>(1, 2, kStep),
                                   cv::TermCriteria(cv::TermCriteria::MAX_ITER | cv::TermCriteria::EPS, 200, 1e-9));
    cv::Mat found = cv::Mat_<double>(1, 2, 0.0);
    solver->minimize(found);
    FlatScreen out{{picture, found.at<double>(0), found.at<double>(1)}, {}, 0};
    std::vector<double> off;
    for (const auto& matches : samples) {
        const cv::Mat to_output = fit(out.lens, matches, cv::RANSAC);
        if (to_output.empty())
            return fail("projector " + std::to_string(out.from_output.size()) + " lies nowhere on a flat screen");
        const cv::Matx33d homography(to_output);
        out.from_output.push_back(homography.inv());
        for (const Match& match : matches) off.push_back(distance(homography, out.lens, match));
    }
    std::ranges::sort(off);
    out.error = off[off.size() * 95 / 100];
    if (out.error > kMostBump)
        return fail("the photographs fit no flat screen: 95 % are off by up to " + std::to_string(out.error) +
                    " pixels of a projector (has the camera moved, or is the screen curved?)");
    return out;
}

}  // namespace wall::calibrate
