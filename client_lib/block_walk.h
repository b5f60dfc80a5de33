// SPDX-License-Identifier: MIT
// Walks the packed commands of one primitive, forwards, knowing where each attribute was last set. Pure.
#pragma once

#include <array>
#include <cstring>
#include <optional>

#include "client_lib/packer.h"

namespace wall::client {

/// Operands of a geometry command; all of them have a fixed size.
inline std::size_t operand_bytes_of(glapi::Op op) { return glapi::kOpFixedBytes[static_cast<std::size_t>(op)]; }

inline std::optional<Attribute> attribute_of(glapi::Op op) {
    using glapi::Op;
    switch (op) {
        case Op::Color3f:
        case Op::Color4f:
        case Op::Color4ub: return Attribute::color;
        case Op::Normal3f: return Attribute::normal;
        case Op::TexCoord1f:
        case Op::TexCoord2f:
        case Op::TexCoord3f:
        case Op::TexCoord4f: return Attribute::texcoord0;
        case Op::SecondaryColor3f: return Attribute::secondary_color;
        case Op::FogCoordf: return Attribute::fog_coord;
        case Op::EdgeFlag: return Attribute::edge_flag;
        default: return std::nullopt;
    }
}

class BlockWalk {
public:
    BlockWalk(const wire::PackBuffer& buffer, wire::PackMark first, wire::PackMark last, const AttributePlaces& before)
        : buffer_(buffer), at_(first), last_(last), places_(before) {}

    /// Goes over the next command; false behind the last.
    bool next() {
        if (at_.commands >= last_.commands) return false;
        op_ = static_cast<glapi::Op>(buffer_.opcode_at(at_.commands));
        operand_ = at_.operand_bytes;
        ++at_.commands;
        at_.operand_bytes += operand_bytes_of(op_);
        if (const auto attribute = attribute_of(op_)) {
            places_.offset[static_cast<std::size_t>(*attribute)] = static_cast<std::uint32_t>(operand_);
            places_.op[static_cast<std::size_t>(*attribute)] = op_;
        }
        return true;
    }

    glapi::Op op() const { return op_; }
    const std::byte* operand() const { return buffer_.operand_at(operand_); }
    wire::PackMark position() const { return at_; }  ///< behind the command
    const AttributePlaces& places() const { return places_; }
    bool is_vertex() const {
        return op_ == glapi::Op::Vertex2f || op_ == glapi::Op::Vertex3f || op_ == glapi::Op::Vertex4f;
    }
    std::array<float, 4> vertex() const {
        std::array<float, 4> v{0, 0, 0, 1};
        std::memcpy(v.data(), operand(), operand_bytes_of(op_));
        return v;
    }

private:
    const wire::PackBuffer& buffer_;
    wire::PackMark at_, last_;
    AttributePlaces places_;
    glapi::Op op_{};
    std::size_t operand_ = 0;
};

}  // namespace wall::client
