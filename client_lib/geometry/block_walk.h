// SPDX-License-Identifier: MIT
// Walks packed commands, forwards, knowing where each attribute was last set. Pure.
#pragma once

#include <array>
#include <cstring>

#include "common/wire/pack_buffer.h"
#include "gen/glapi/wire.gen.h"
#include "gen/glstate/attributes.gen.h"

namespace wall::client {

using glstate::Attribute;
using glstate::kAttributes;
using glstate::place_of;

/// Operands of a geometry command; all of them have a fixed size.
inline std::size_t operand_bytes_of(glapi::Op op) { return glapi::kOpFixedBytes[static_cast<std::size_t>(op)]; }

/// Where the latest operands of each attribute stand in a block; kNone: not set in it.
struct AttributePlaces {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::array<std::uint32_t, kAttributes> offset;
    std::array<glapi::Op, kAttributes> op;
    AttributePlaces() {
        offset.fill(kNone);
        op.fill(glapi::Op::End);
    }
};

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
        if (sets_attribute()) {
            const std::size_t place = place_of(attribute());
            places_.offset[place] = static_cast<std::uint32_t>(operand_);
            places_.op[place] = op_;
        }
        return true;
    }
    /// Goes over all commands before `mark`.
    void go_to(wire::PackMark mark) {
        while (at_.commands < mark.commands && next()) continue;
    }

    glapi::Op op() const { return op_; }
    const std::byte* operand() const { return buffer_.operand_at(operand_); }
    wire::PackMark position() const { return at_; }  ///< behind the command
    const AttributePlaces& places() const { return places_; }
    bool sets_attribute() const { return glstate::attribute_command(op_).sets_one(); }
    Attribute attribute() const { return glstate::attribute_set_by(op_, operand()); }  ///< that it sets
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
