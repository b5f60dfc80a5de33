// SPDX-License-Identifier: MIT
// The pieces of a large draw as the nodes know them (common/glstate/pieces.h). Guarded as the vertex input that it
// belongs to.
#pragma once

#include <utility>
#include <vector>

#include "client_lib/objects/object.h"
#include "common/glstate/pieces.h"

namespace wall::client {

class DrawPieces : public Object {
public:
    DrawPieces() : Object(next_object_id()) {}

    void define(const glstate::Cut& cut, std::vector<glstate::PieceBox> boxes) {
        cut_ = cut;
        boxes_ = std::move(boxes);
        stamp_ = next_stamp();
    }

    std::size_t count() const { return boxes_.size(); }
    std::uint64_t latest() const override { return stamp_; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;

private:
    glstate::Cut cut_;
    std::vector<glstate::PieceBox> boxes_;
    std::uint64_t stamp_ = 0;
};

}  // namespace wall::client
