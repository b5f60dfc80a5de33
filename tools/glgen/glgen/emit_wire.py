# SPDX-License-Identifier: MIT
"""gen/glapi/wire.gen.h (opcodes, packers) and decode.gen.h (the bounds-checked decoder table)."""

import zlib

from .text import header
from .wire import SIZE

WIRE_NOTES = """
The opcodes of the data stream and a packer for each. Usage:

    wire::PackBuffer buffer;
    glapi::pack::Clear(buffer, GL_COLOR_BUFFER_BIT);
    glapi::pack::TexImage(buffer, texture, ..., pixels);      // bytes operand: std::span<const std::byte>
    glapi::pack_state(buffer, element_id, &value, sizeof value);
"""

DECODE_NOTES = """
DecodeTable<H>::rows[op]: checks the operands' bounds and calls the member of the same name, of H or of what H has for
the command's group; see common/glapi/decoder.h for what H must offer and for the loop around it.
"""


FRAMING = 6  # of common/wire/frame.h and batch.h; 2: a batch may come in parts; 3: rings, streams that outlive
             # their connection; 4: coded batches; 5: programs whose cameras are named; 6: answers
             # that tell where programs look textures up


def stream_version(ops, elements):
    """A number that changes with the framing and with every command and state element of the stream: its CRC-32."""
    lines = [f"framing {FRAMING}"]
    lines += [f"{op.code} {op.name} {op.group} {op.operands} {op.bytes_name} {op.is_state}" for op in ops]
    lines += [f"{e.id} {e.name} {e.count} {e.fields} {e.defaults}" for e in elements]
    return zlib.crc32("\n".join(lines).encode())


def wire_header(ops, elements):
    out = [header("proto/gl/wire.toml", WIRE_NOTES,
                  ["<array>", "<cstddef>", "<cstdint>", "<cstring>", "<span>", "", '"common/base/ids.h"',
                   '"common/wire/pack_buffer.h"', '"common/wire/padding.h"']).replace("#include \n", "\n")]
    out.append("\nnamespace wall::glapi {\n\nenum class Op : std::uint8_t {\n")
    out += [f"    {op.name} = {op.code},\n" for op in ops]
    out.append("};\n\n")
    out.append(f"inline constexpr std::size_t kOpCount = {len(ops)};\n\n")
    out.append("/// Says which commands and state elements there are: both ends of a stream must have the same.\n"
               f"inline constexpr std::uint32_t kStreamVersion = {stream_version(ops, elements):#010x};\n\n")
    out.append("/// Where an opcode may stand.\nenum class OpGroup : std::uint8_t { "
               + ", ".join(dict.fromkeys(op.group for op in ops)) + " };\n\n")
    out.append("inline constexpr std::array<const char*, kOpCount> kOpNames = {\n")
    out += [f'    "{op.name}",\n' for op in ops]
    out.append("};\n\ninline constexpr std::array<OpGroup, kOpCount> kOpGroups = {\n")
    out += [f"    OpGroup::{op.group},  // {op.name}\n" for op in ops]
    out.append("};\n\n/// Operand bytes of each opcode, up to and with the count of a bytes operand.\n")
    out.append("inline constexpr std::array<std::uint32_t, kOpCount> kOpFixedBytes = {\n")
    out += [f"    {op.fixed_bytes},  // {op.name}\n" for op in ops]
    out.append("};\n\n/// Whether a bytes operand comes last.\n")
    out.append("inline constexpr std::array<bool, kOpCount> kOpHasBytes = {\n")
    out += [f"    {'true' if op.bytes_name else 'false'},  // {op.name}\n" for op in ops]
    out.append("};\n\n/// Whether it wants an answer: its first operand is a request.\n")
    out.append("inline constexpr std::array<bool, kOpCount> kOpAsks = {\n")
    out += [f"    {'true' if op.asks else 'false'},  // {op.name}\n" for op in ops]
    out.append("};\n\n")
    out.append(_PACK_HELPERS)
    out.append("namespace pack {\n\n")
    out += [_packer(op) for op in ops if not op.is_state]
    out.append("}  // namespace pack\n}  // namespace wall::glapi\n")
    return "".join(out)


_PACK_HELPERS = """\
/// One element of the soft context (glstate::element_bytes(id) == bytes).
inline void pack_state(wire::PackBuffer& to, std::uint32_t id, const void* value, std::size_t bytes) {
    std::byte* at = to.append(static_cast<std::uint8_t>(Op::State), 4 + bytes);
    std::memcpy(at, &id, 4);
    std::memcpy(at + 4, value, bytes);
}

namespace detail {
template <class T>
void put(std::byte* at, T value) {
    std::memcpy(at, &value, sizeof value);
}
/// A bytes operand: count, content, zeros up to a multiple of 4.
inline void put_bytes(std::byte* at, std::span<const std::byte> content) {
    put(at, static_cast<std::uint32_t>(content.size()));
    if (content.empty()) return;
    put(at + wire::padded4(content.size()), std::uint32_t{0});  // the last word; overwritten but for the padding
    std::memcpy(at + 4, content.data(), content.size());
}
}  // namespace detail

"""


def _packer(op):
    params = "".join(f", {o.cpp} {o.name}" for o in op.operands)
    if op.bytes_name:
        params += f", std::span<const std::byte> {op.bytes_name}"
    size = str(op.fixed_bytes)
    if op.bytes_name:
        size += f" + wire::padded4({op.bytes_name}.size())"
    uses = op.operands or op.bytes_name
    lines = [f"inline void {op.name}(wire::PackBuffer& to{params}) {{\n"]
    call = f"to.append(static_cast<std::uint8_t>(Op::{op.name}), {size})"
    lines.append(f"    std::byte* at = {call};\n" if uses else f"    {call};\n")
    offset = 0
    for o in op.operands:
        lines.append(f"    detail::put(at + {offset}, {o.name});\n")
        offset += SIZE[o.type]
    if op.bytes_name:
        lines.append(f"    detail::put_bytes(at + {offset}, {op.bytes_name});\n")
    lines.append("}\n\n")
    return "".join(lines)


def decode_header(ops):
    out = [header("proto/gl/wire.toml", DECODE_NOTES,
                  ["<cstdint>", "<span>", "", '"common/wire/operand_reader.h"',
                   '"gen/glapi/wire.gen.h"']).replace("#include \n", "\n")]
    out.append("""
namespace wall::glapi {

template <class H>
struct DecodeTable {
    struct Row {
        const char* name;
        std::uint32_t fixed_bytes;  ///< operand bytes, up to and with the count of a bytes operand
        bool bytes_operand;
        bool (*run)(H&, wire::OperandReader&);  ///< false: too few operands, or the handler has refused
    };
    static const Row rows[kOpCount];

private:
    // Whose member takes the commands of a group.
""")
    out += [_group(name) for name in dict.fromkeys(op.group for op in ops)]
    out.append("\n")
    out += [_decoder(op) for op in ops]
    out.append("};\n\ntemplate <class H>\nconst typename DecodeTable<H>::Row DecodeTable<H>::rows[kOpCount] = {\n")
    for op in ops:
        run = "nullptr" if op.name == "Block" else f"&DecodeTable::{op.name}"
        comment = "  // the decoder's own" if op.name == "Block" else ""
        out.append(f'    {{"{op.name}", {op.fixed_bytes}, {"true" if op.bytes_name else "false"}, {run}}},{comment}\n')
    out.append("};\n\n}  // namespace wall::glapi\n")
    return "".join(out)


def _group(name):
    return (f"    static auto& {name}(H& h) {{\n        if constexpr (H::kByGroup) return h.{name};\n"
            f"        else return h;\n    }}\n")


def _decoder(op):
    if op.name == "Block":
        return ""
    lines = [f"    static bool {op.name}(H& h, wire::OperandReader& in) {{\n"]
    if op.is_state:
        lines += ["        const std::uint32_t id = in.get<std::uint32_t>();\n",
                  f"        const std::uint32_t bytes = in.ok() ? {op.group}(h).state_bytes(id) : 0;\n",
                  "        if (bytes == 0) return false;\n",
                  "        const std::span<const std::byte> value = in.raw(bytes);\n",
                  f"        return in.ok() && {op.group}(h).State(id, value) && !h.refused();\n    }}\n"]
        return "".join(lines)
    args = [o.name for o in op.operands] + ([op.bytes_name] if op.bytes_name else [])
    if op.operands:
        lines.append(f"        const std::byte* at = in.raw({sum(SIZE[o.type] for o in op.operands)}).data();\n")
        if not op.bytes_name:
            lines.append("        if (!in.ok()) return false;\n")
    if op.bytes_name:
        lines.append(f"        const std::span<const std::byte> {op.bytes_name} = in.bytes();\n")
        lines.append("        if (!in.ok()) return false;\n")
    offset = 0
    loads = []
    for o in op.operands:
        loads.append(f"wire::load<{o.cpp}>(at + {offset})")
        offset += SIZE[o.type]
    if op.bytes_name:
        loads.append(op.bytes_name)
    if not args:
        lines.append("        (void)in;\n")
    lines.append(f"        {op.group}(h).{op.name}({', '.join(loads)});\n")
    lines.append("        return !h.refused();\n    }\n")
    return "".join(lines)


NULL_NOTES = """
A handler that takes every command and does nothing: the base of handlers that look at a few (tests, benchmarks,
fuzzers). A derived class declares members of the same name over these.
"""


def null_handler_header(ops):
    out = [header("proto/gl/wire.toml", NULL_NOTES, []),
           '#include <cstdint>\n#include <span>\n\n#include "common/glapi/decoder.h"\n\nnamespace wall::glapi {\n\n'
           "struct NullHandler : Handler {\n"
           "    std::uint64_t begin_block(std::uint64_t tiles, std::size_t) { return tiles; }\n"
           "    void begin_tile(unsigned) {}\n    bool another_pass() { return false; }\n    void end_block() {}\n"
           "    std::uint32_t state_bytes(std::uint32_t) { return 4; }\n"
           "    bool State(std::uint32_t, std::span<const std::byte>) { return true; }\n"]
    for op in ops:
        if op.is_state or op.name == "Block":
            continue
        params = [o.cpp for o in op.operands] + (["std::span<const std::byte>"] if op.bytes_name else [])
        out.append(f"    void {op.name}({', '.join(params)}) {{}}\n")
    out.append("};\n\n}  // namespace wall::glapi\n")
    return "".join(out)
