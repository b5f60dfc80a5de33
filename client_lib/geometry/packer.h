// SPDX-License-Identifier: MIT
// The geometry packer: what glBegin, glVertex3f, glColor3f and their like write into, and the record of it that the
// router sorts (W3.1, W3.2). It holds one *block*: the geometry since the last change of state. One packer per context,
// used by the thread that has the context.
//
// Current attributes are not copied on every call (T3.2): the packer remembers where the last one of each kind was
// packed, and they are read back from there when somebody asks.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "client_lib/geometry/material.h"
#include "common/geom/box.h"
#include "common/wire/limits.h"
#include "common/wire/pack_buffer.h"
#include "gen/glapi/wire.gen.h"
#include "gen/glstate/attributes.gen.h"

namespace wall::client {

using glstate::Attribute;
using glstate::kAttributes;
using glstate::place_of;

/// One glBegin .. glEnd.
struct Primitive {
    wire::PackMark first, last;  ///< Begin's opcode; behind End's
    std::uint32_t mode = 0;      ///< GL_POINTS ...
    bool divisible = true;       ///< holds only vertices and attributes, so that it may be cut between nodes
    geom::Box box;               ///< object space
};

class Packer : public wire::PackBuffer {
public:
    Packer();

    // ---- hot members, used by the entry points in api/geometry.cpp ----

    std::byte*& next_operand() { return operands_; }
    std::byte*& next_opcode() { return opcodes_; }
    /// An entry point takes its slow path once `next_operand` has reached this; null closes the packer.
    const std::byte* limit = nullptr;
    geom::Box box;  ///< of the open primitive
    std::array<const std::byte*, kAttributes>
        last{};  ///< the latest operands of each attribute; null: not in this block
    std::array<glapi::Op, kAttributes> last_op{};
    std::vector<MaterialChange> materials;  ///< of glMaterial inside the block, in order

    // ---- the rest ----

    void begin(std::uint32_t mode);
    void end();
    bool inside() const { return inside_; }
    std::uint32_t mode() const { return open_.mode; }

    /// Appends an attribute's command; the caller fills in its operands.
    std::byte* append_attribute(Attribute attribute, glapi::Op op, std::size_t bytes);
    /// Appends a command that is no plain vertex and no attribute: what surrounds it stays in one piece.
    std::byte* append_rare(glapi::Op op, std::size_t bytes);
    /// Geometry of unknown extent was packed (evaluators).
    void mark_unbounded() { box.make_unbounded(); }

    /// A primitive made the block larger than can be carried to a node, and was dropped.
    bool take_overflow() { return std::exchange(overflown_, false); }
    /// The most bytes of a block; at first wire::kMaxBlockBytes.
    void set_most_bytes(std::size_t bytes) { most_bytes_ = bytes; }

    bool has_geometry() const { return !primitives_.empty(); }
    bool has_rare() const { return rare_; }
    /// Some vertex has a w other than 1; then the box is around what fixed function makes of it.
    bool has_w() const { return has_w_; }
    void note_w() { has_w_ = true; }
    const std::vector<Primitive>& primitives() const { return primitives_; }
    const geom::Box& block_box() const { return block_box_; }

    /// More room, called by slow paths; keeps the remembered places.
    void make_room();
    /// Forgets the block.
    void reset();
    /// Shut: every entry point goes through the context's table (display list compilation).
    void set_closed(bool closed) {
        closed_ = closed;
        update_limit();
    }
    bool closed() const { return closed_; }

private:
    void update_limit();
    std::size_t usable_bytes() const;
    bool tight() const;
    void rewind(const wire::PackMark& to);

    std::vector<Primitive> primitives_;
    Primitive open_;
    geom::Box block_box_;
    bool inside_ = false;
    bool rare_ = false;
    bool has_w_ = false;
    bool closed_ = false;
    bool overflown_ = false;
    std::size_t most_bytes_ = wire::kMaxBlockBytes;
};

}  // namespace wall::client
