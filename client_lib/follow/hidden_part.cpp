// SPDX-License-Identifier: MIT
#include "client_lib/follow/hidden_part.h"

#include <algorithm>
#include <utility>

namespace wall::client {
namespace {

constexpr std::size_t kMostSpareBuffers = 8;  // of a frame

}  // namespace

void KeptFrame::turn_to(ContextId context) {
    if (follower.batch_context == context) return;
    seal();
    follower.batch_context = context;
    mirror = &follower.mirrors[context];
}

void KeptFrame::seal() {
    if (!follower.batch.empty()) {
        sealed_bytes_ += follower.batch.bytes();
        stretches.push_back(
            {follower.batch_context, std::exchange(follower.batch, empty_buffer()), std::exchange(matrices, {})});
    }
    follower.batch_context = {};
}

wire::PackBuffer KeptFrame::empty_buffer() {
    if (spare_.empty()) return wire::PackBuffer();
    auto buffer = std::move(spare_.back());
    spare_.pop_back();
    return buffer;
}

void KeptFrame::restart(bool from_nothing) {
    for (Stretch& stretch : stretches) {
        if (spare_.size() == kMostSpareBuffers) break;
        stretch.commands.clear();
        spare_.push_back(std::move(stretch.commands));
    }
    stretches.clear();
    matrices.clear();
    starts.clear();
    started = {};
    follower.batch.clear();
    follower.batch_context = {};
    follower.mirrors.clear();
    follower.object_stamps.clear();
    follower.brought.forget();
    sealed_bytes_ = 0;
    whole = from_nothing;
}

void HiddenPart::finish() {
    now.seal();
    KeptFrame next;
    if (now.whole) {
        if (!finished.empty()) next = std::move(finished.front());
        finished.clear();
    }
    next.restart(false);
    if (now.whole || !finished.empty() || !now.empty()) finished.push_back(std::exchange(now, std::move(next)));
}

void HiddenPart::forget() {
    finished.clear();
    now.restart(false);
}

std::size_t HiddenPart::bytes() const {
    std::size_t sum = now.bytes();
    for (const KeptFrame& frame : finished) sum += frame.bytes();
    return sum;
}

namespace {

/// What of `from` lies outside of `hole`: at most four rectangles.
void cut(const geom::Rect& from, const geom::Rect& hole, std::vector<geom::Rect>& rest) {
    const geom::Rect both = geom::intersect(from, hole);
    if (both.empty()) return rest.push_back(from);
    const geom::Rect pieces[] = {{from.x, from.y, from.width, both.y - from.y},
                                 {from.x, both.bottom(), from.width, from.bottom() - both.bottom()},
                                 {from.x, both.y, both.x - from.x, both.height},
                                 {both.right(), both.y, from.right() - both.right(), both.height}};
    for (const geom::Rect& piece : pieces)
        if (!piece.empty()) rest.push_back(piece);
}

}  // namespace

geom::Rect uncovered(const geom::Rect& window, const std::vector<geom::Rect>& shown) {
    std::vector<geom::Rect> left{window}, rest;
    for (const geom::Rect& hole : shown) {
        rest.clear();
        for (const geom::Rect& piece : left) cut(piece, hole, rest);
        std::swap(left, rest);
    }
    geom::Rect around;
    for (const geom::Rect& piece : left) {
        if (around.empty()) around = piece;
        const auto x = std::min(around.x, piece.x), y = std::min(around.y, piece.y);
        around = {x, y, std::max(around.right(), piece.right()) - x, std::max(around.bottom(), piece.bottom()) - y};
    }
    return around;
}

}  // namespace wall::client
