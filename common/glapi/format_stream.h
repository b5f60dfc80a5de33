// SPDX-License-Identifier: MIT
// What the formats of programs are made of (program_format.h, assembly_format.h): u32, strings (u32 count, bytes,
// padding to 4), lists (their length, then the items), and position programs. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/glapi/position_program.h"
#include "common/wire/operand_reader.h"
#include "common/wire/padding.h"

namespace wall::glapi {

class FormatWriter {
public:
    std::vector<std::byte> out;

    void put(std::uint32_t value) { append(&value, sizeof value); }
    void put(std::int32_t value) { append(&value, sizeof value); }
    void put(bool value) { put(std::uint32_t{value}); }
    void put(const std::string& text) {
        put(static_cast<std::uint32_t>(text.size()));
        append(text.data(), text.size());
        out.resize(wire::padded4(out.size()));
    }
    void put(const std::vector<std::uint32_t>& words) {
        put(static_cast<std::uint32_t>(words.size()));
        append(words.data(), words.size() * sizeof(std::uint32_t));
    }
    void put(const PositionProgram& position) {
        list(position.uniforms, [&](const PositionUniform& u) { put(u.name), put(u.element); });
        put(position.attribute);
        put(position.depth);
        list(position.steps, [&](const PositionStep& step) {
            put(static_cast<std::uint32_t>(step.op) | std::uint32_t{step.columns} << 8 |
                std::uint32_t{step.rows} << 16);
            put(step.operands);
        });
        put(position.camera ? *position.camera + 1 : std::uint32_t{0});
    }
    template <class T, class Put>
    void list(const std::vector<T>& items, Put&& put_item) {
        put(static_cast<std::uint32_t>(items.size()));
        for (const T& item : items) put_item(item);
    }

private:
    void append(const void* from, std::size_t bytes) {
        const auto* first = static_cast<const std::byte*>(from);
        out.insert(out.end(), first, first + bytes);
    }
};

/// Bounded, and sticky in failure: what is behind the end reads as zeros.
class FormatReader {
public:
    explicit FormatReader(std::span<const std::byte> bytes) : in_(bytes) {}

    std::uint32_t word() { return in_.get<std::uint32_t>(); }
    std::int32_t number() { return static_cast<std::int32_t>(word()); }
    bool flag() { return word() != 0; }
    std::string text() {
        const auto bytes = in_.bytes();
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    std::vector<std::uint32_t> words() {
        const std::size_t count = word();
        const auto bytes = count > in_.remaining() / 4 ? in_.raw(in_.remaining() + 1) : in_.raw(count * 4);
        std::vector<std::uint32_t> out(bytes.size() / 4);
        if (!bytes.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
        return out;
    }
    /// Every item takes at least one word, so that a length cannot ask for more than what is there.
    template <class T, class Get>
    void list(std::vector<T>& items, Get&& get_item) {
        const std::size_t count = word();
        if (count > in_.remaining() / 4) return in_.fail();
        for (std::size_t i = 0; i < count && in_.ok(); ++i) items.push_back(get_item());
    }
    /// One whose steps have a meaning; else it fails.
    PositionProgram position() {
        PositionProgram out;
        list(out.uniforms, [&] { return PositionUniform{text(), word()}; });
        out.attribute = text();
        out.depth = flag();
        list(out.steps, [&] {
            const std::uint32_t head = word();
            if (head >> 24 != 0) in_.fail();
            return PositionStep{static_cast<PositionOp>(head & 0xff), static_cast<std::uint8_t>(head >> 8),
                                static_cast<std::uint8_t>(head >> 16), words()};
        });
        if (const std::uint32_t camera = word(); camera != 0) out.camera = camera - 1;
        if (!is_valid(out)) in_.fail();
        return out;
    }
    void fail() { in_.fail(); }
    bool complete() const { return in_.ok() && in_.remaining() == 0; }

private:
    wire::OperandReader in_;
};

/// Nothing, if the reader has failed or something is left over.
template <class T>
std::optional<T> if_complete(const FormatReader& reader, T&& value) {
    if (!reader.complete()) return std::nullopt;
    return std::move(value);
}

}  // namespace wall::glapi
