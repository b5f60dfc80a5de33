// SPDX-License-Identifier: MIT
#include "tools/wallcalibrate/gray_code.h"

#include <bit>

namespace wall::calibrate {
namespace {

constexpr int kLeastContrast = 24;        // levels between white and black where a projector shines
constexpr double kLeastOfContrast = 0.2;  // of that, between a bit and its inverse
constexpr std::size_t kLeastMatches = 500;

int bits_for(int pixels) { return std::bit_width(static_cast<unsigned>(std::max(1, pixels - 1))); }

/// Both pictures of a bit at once.
struct Bit {
    cv::Mat shown, inverted;
};

Result<Bit> take(const Photograph& photograph, Shot shot, const cv::Size& size) {
    Bit out;
    for (cv::Mat* picture : {&out.shown, &out.inverted}) {
        shot.inverted = picture == &out.inverted;
        auto taken = photograph(shot);
        if (!taken) return tl::unexpected(taken.error());
        if (taken->size() != size || taken->type() != CV_8UC1)
            return fail("photograph '" + shot.name() + "': expected grey, " + std::to_string(size.width) + "x" +
                        std::to_string(size.height) + " as the white one");
        *picture = std::move(*taken);
    }
    return out;
}

/// Adds the places along one axis to `codes`, and forgets pixels of `seen` at which a bit cannot be told.
Result<void> read_axis(int pixels, bool rows, const Photograph& photograph, const cv::Mat& contrast, cv::Mat& seen,
                       cv::Mat& codes) {
    codes = cv::Mat(seen.size(), CV_32S, cv::Scalar(0));
    cv::Mat least, difference;
    contrast.convertTo(least, CV_32F, kLeastOfContrast);
    for (int bit = bits_for(pixels) - 1; bit >= 0; --bit) {
        const auto both = take(photograph, {.kind = Shot::Kind::code, .bit = bit, .rows = rows}, seen.size());
        if (!both) return tl::unexpected(both.error());
        cv::subtract(both->shown, both->inverted, difference, cv::noArray(), CV_32F);
        seen.setTo(0, cv::abs(difference) < least);
        cv::add(codes, cv::Scalar(1 << bit), codes, difference > 0);
    }
    return {};
}

int from_gray(int code) {
    for (int shift = 1; shift < 32; shift <<= 1) code ^= code >> shift;
    return code;
}

}  // namespace

std::string Shot::name() const {
    if (kind != Kind::code) return kind == Kind::white ? "white" : "black";
    return std::string(rows ? "y-" : "x-") + std::to_string(bit) + (inverted ? "-inverted" : "");
}

std::vector<Shot> shots_of(int width, int height) {
    std::vector<Shot> out{{.kind = Shot::Kind::white}, {.kind = Shot::Kind::black}};
    for (const bool rows : {false, true})
        for (int bit = bits_for(rows ? height : width) - 1; bit >= 0; --bit)
            for (const bool inverted : {false, true})
                out.push_back({.kind = Shot::Kind::code, .bit = bit, .rows = rows, .inverted = inverted});
    return out;
}

Result<std::vector<Match>> decode(int width, int height, const Photograph& photograph) {
    const auto white = photograph({.kind = Shot::Kind::white});
    if (!white) return tl::unexpected(white.error());
    const auto black = photograph({.kind = Shot::Kind::black});
    if (!black) return tl::unexpected(black.error());
    if (white->empty() || white->size() != black->size() || white->type() != CV_8UC1 || black->type() != CV_8UC1)
        return fail("the white and the black photograph: expected two in grey and of one size");
    cv::Mat contrast, columns, rows;
    cv::subtract(*white, *black, contrast);  // no less than 0
    cv::Mat seen = contrast >= kLeastContrast;
    for (const bool along_rows : {false, true}) {
        auto read =
            read_axis(along_rows ? height : width, along_rows, photograph, contrast, seen, along_rows ? rows : columns);
        if (!read) return tl::unexpected(read.error());
    }
    std::vector<Match> out;
    for (int y = 0; y < seen.rows; ++y) {
        for (int x = 0; x < seen.cols; ++x) {
            if (seen.at<uchar>(y, x) == 0) continue;
            const int column = from_gray(columns.at<int>(y, x)), row = from_gray(rows.at<int>(y, x));
            if (column < width && row < height) out.push_back({{x + 0.5, y + 0.5}, {column + 0.5, row + 0.5}});
        }
    }
    if (out.size() < kLeastMatches)
        return fail("only " + std::to_string(out.size()) + " pixels of the camera see it: expected at least " +
                    std::to_string(kLeastMatches) + " (is it sharp, bright and within the picture?)");
    return out;
}

}  // namespace wall::calibrate
