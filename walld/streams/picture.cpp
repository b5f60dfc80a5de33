// SPDX-License-Identifier: MIT
#include "walld/streams/picture.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace wall::walld {
namespace {

constexpr int kPngLevel = 1;  // zlib; a tenth larger than the best, five times quicker

void draw(cv::Mat& canvas, const geom::Rect& view, const TilePicture& tile) {
    const auto part = geom::intersect(view, tile.rect);
    if (part.empty() || !tile.complete()) return;
    // OpenCV has no read-only Mat over foreign bytes; nothing writes here.
    const cv::Mat pixels(tile.rect.height, tile.rect.width, CV_8UC3, const_cast<char*>(tile.rgb.data()));
    const cv::Rect from(part.x - tile.rect.x, part.y - tile.rect.y, part.width, part.height);
    const cv::Rect to(part.x - view.x, part.y - view.y, part.width, part.height);
    cv::cvtColor(pixels(from), canvas(to), cv::COLOR_RGB2BGR);
}

}  // namespace

std::size_t TilePicture::bytes() const {
    return std::size_t{3} * static_cast<std::size_t>(rect.width) * static_cast<std::size_t>(rect.height);
}

bool TilePicture::add(std::uint32_t width, std::uint32_t height, std::uint64_t offset, const std::string& part) {
    if (width != static_cast<std::uint32_t>(rect.width) || height != static_cast<std::uint32_t>(rect.height) ||
        offset != rgb.size() || part.empty() || part.size() > bytes() - rgb.size())
        return false;
    if (rgb.empty()) rgb.reserve(bytes());
    rgb += part;
    return true;
}

Result<std::string> compose_png(PictureJob job) {
    if (job.view.empty()) return fail("picture: nothing of it is on the canvas");
    const cv::Scalar background(job.background & 0xff, job.background >> 8 & 0xff, job.background >> 16 & 0xff);
    cv::Mat canvas(job.view.height, job.view.width, CV_8UC3, background);
    for (auto& tile : job.tiles) {
        draw(canvas, job.view, tile);
        tile.rgb = {};
    }
    std::vector<unsigned char> png;
    if (!cv::imencode(".png", canvas, png, {cv::IMWRITE_PNG_COMPRESSION, kPngLevel}))
        return fail("picture: cannot be encoded");
    return std::string(png.begin(), png.end());
}

}  // namespace wall::walld
