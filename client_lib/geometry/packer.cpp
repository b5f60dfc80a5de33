// SPDX-License-Identifier: MIT
#include "client_lib/geometry/packer.h"

#include <algorithm>

#include "client_lib/geometry/block_walk.h"

namespace wall::client {
namespace {

constexpr std::size_t kInitialOperandBytes = 256 << 10;
/// Room beyond the limit: the largest command that a fast path packs, rounded up.
constexpr std::size_t kSlack = 64;

}  // namespace

Packer::Packer() : PackBuffer(kInitialOperandBytes) { update_limit(); }

// A fast path packs one opcode with at least 4 operand bytes, so a limit for the operands also holds for the opcodes
// as long as free operand words are only counted up to the free opcodes.
std::size_t Packer::usable_bytes() const {
    const auto free_opcodes = static_cast<std::size_t>(opcodes_ - base());
    const auto free_bytes = static_cast<std::size_t>(end_of_memory() - operands_);
    return std::min(free_bytes, free_opcodes * 4);
}

bool Packer::tight() const { return usable_bytes() < 2 * kSlack; }

void Packer::update_limit() {
    const std::size_t usable = usable_bytes();
    limit = closed_ || usable < kSlack ? nullptr : operands_ + usable - kSlack;
}

void Packer::make_room() {
    if (!tight()) return update_limit();  // closed, or the estimate was too careful
    if (inside_ && bytes() > most_bytes_) {
        overflown_ = true;
        rewind({open_.first.commands + 1, open_.first.operand_bytes + sizeof open_.mode});  // behind its Begin
        return update_limit();
    }
    const std::byte* old = operands().data();
    grow(commands() + kSlack, operand_bytes() + 4 * kSlack);
    for (auto& place : last)
        if (place) place = operands().data() + (place - old);
    update_limit();
}

/// Forgets what was packed since then; the attributes are those of before.
void Packer::rewind(const wire::PackMark& to) {
    opcodes_ = middle_ - to.commands;
    operands_ = middle_ + to.operand_bytes;
    BlockWalk walk(*this, {}, to, {});
    walk.go_to(to);
    for (std::size_t i = 0; i < kAttributes; ++i) {
        const std::uint32_t offset = walk.places().offset[i];
        last[i] = offset == AttributePlaces::kNone ? nullptr : middle_ + offset;
        last_op[i] = walk.places().op[i];
    }
}

void Packer::begin(std::uint32_t mode) {
    if (tight()) make_room();
    if (primitives_.size() == primitives_.capacity()) primitives_.reserve(2 * primitives_.size() + kSlack);
    inside_ = true;
    open_ = Primitive{};
    open_.first = mark();
    open_.mode = mode;
    box = geom::Box{};
    glapi::pack::Begin(*this, mode);
    update_limit();
}

// There is room for it: whoever packed before left some, and begin() made place for the primitive. So an end cannot
// fail for want of memory, and the program and this are always of one mind about what is inside.
void Packer::end() {
    inside_ = false;
    glapi::pack::End(*this);
    if (overflown_ || bytes() > most_bytes_) {
        overflown_ = true;
        rewind(open_.first);
        return update_limit();
    }
    if (box.empty()) {  // no vertex: nothing to draw, but its attributes count
        update_limit();
        return;
    }
    open_.last = mark();
    open_.box = box;
    block_box_.add(box);
    primitives_.push_back(open_);
    update_limit();
}

std::byte* Packer::append_attribute(Attribute attribute, glapi::Op op, std::size_t bytes) {
    if (tight()) make_room();
    std::byte* at = append(static_cast<std::uint8_t>(op), bytes);
    last[place_of(attribute)] = at;
    last_op[place_of(attribute)] = op;
    update_limit();
    return at;
}

std::byte* Packer::append_rare(glapi::Op op, std::size_t bytes) {
    if (tight()) make_room();
    if (inside_) open_.divisible = false;
    rare_ = true;
    std::byte* at = append(static_cast<std::uint8_t>(op), bytes);
    update_limit();
    return at;
}

void Packer::reset() {
    clear();
    primitives_.clear();
    block_box_ = geom::Box{};
    has_w_ = false;
    last.fill(nullptr);
    materials.clear();
    rare_ = false;
    update_limit();
}

}  // namespace wall::client
