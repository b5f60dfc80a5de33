// SPDX-License-Identifier: MIT
// The pieces of a large draw, each with its box (common/glstate/pieces.h). Render thread.
#pragma once

#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "common/glstate/pieces.h"
#include "tileserver/objects/object.h"

namespace wall::tileserver {

class DrawPieces final : public ObjectOf<ObjectKind::draw_pieces> {
public:
    explicit DrawPieces(ObjectAccount& account) : ObjectOf(account) {}

    /// False: more memory than a session may have.
    [[nodiscard]] bool define(const glstate::Cut& cut, std::span<const std::byte> boxes) {
        cut_ = cut;
        boxes_.resize(boxes.size() / sizeof(glstate::PieceBox));
        if (!boxes_.empty()) std::memcpy(boxes_.data(), boxes.data(), boxes_.size() * sizeof(glstate::PieceBox));
        return has_content(boxes.size());
    }
    const glstate::Cut& cut() const { return cut_; }
    std::span<const glstate::PieceBox> boxes() const { return boxes_; }

private:
    glstate::Cut cut_;
    std::vector<glstate::PieceBox> boxes_;
};

}  // namespace wall::tileserver
