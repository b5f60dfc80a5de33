# SPDX-License-Identifier: MIT
"""gen/glstate/attributes.gen.h: the vertex attributes, and between their commands and their values."""

from .text import header

NOTES = """
The current vertex attributes. Each value has a place of its own: `texcoord` is that of the first texture unit's, the
second unit's is the next. Between values and the commands of the stream that set them.
"""


def attributes_header(attributes):
    out = [header("proto/gl/attributes.toml", NOTES,
                   ["<array>", "<cstddef>", "<cstdint>", "<cstring>", "<optional>", "<type_traits>"]),
           '\n#include "gen/glapi/wire.gen.h"\n#include "gen/glstate/state.gen.h"\n'
           "\nnamespace wall::glstate {\n\nenum class Attribute : std::uint8_t {\n"]
    out += [f"    {a.name} = {a.place},\n" for a in attributes]
    last = attributes[-1]
    out.append(f"}};\ninline constexpr std::size_t kAttributes = {last.place + last.count};  ///< all values\n\n")
    out.append(_HELPERS)
    rows = {c.op.name: (a, c) for a in attributes for c in a.commands}
    out.append("inline constexpr std::array<AttributeCommand, glapi::kOpCount> kAttributeCommands = [] {\n"
               "    std::array<AttributeCommand, glapi::kOpCount> rows{};\n"
               "    const auto row = [&](glapi::Op op) -> AttributeCommand& {\n"
               "        return rows[static_cast<std::size_t>(op)];\n    };\n")
    out += [f"    row(glapi::Op::{name}) = {{{a.place}, {a.count}, {str(c.indexed).lower()}}};\n"
            for name, (a, c) in rows.items()]
    out.append("    return rows;\n}();\n\n")
    out.append(_LOOKUP)
    out.append(_apply(attributes))
    out.append(_write(attributes))
    out.append(_of_element(attributes))
    out.append(_with_element(attributes))
    out.append(_float_command(attributes))
    out.append(_arrays(attributes))
    out.append("}  // namespace wall::glstate\n")
    return "".join(out)


_HELPERS = """\
/// The place of one value of several.
constexpr Attribute operator+(Attribute first, unsigned i) {
    return static_cast<Attribute>(static_cast<unsigned>(first) + i);
}
constexpr std::size_t place_of(Attribute a) { return static_cast<std::size_t>(a); }

/// What a command of the stream sets.
struct AttributeCommand {
    std::uint8_t place = 255;  ///< of the first value; 255: no attribute
    std::uint8_t count = 0;    ///< values
    bool indexed = false;      ///< the first operand says which value
    constexpr bool sets_one() const { return count != 0; }
};

"""

_LOOKUP = """\
constexpr const AttributeCommand& attribute_command(glapi::Op op) {
    return kAttributeCommands[static_cast<std::size_t>(op)];
}

/// The attribute that a command sets; only for those that set one. An index beyond the values is brought among them.
inline Attribute attribute_set_by(glapi::Op op, const std::byte* operand) {
    const AttributeCommand& row = attribute_command(op);
    std::uint32_t index = 0;
    if (row.indexed) std::memcpy(&index, operand, sizeof index);
    return static_cast<Attribute>(row.place + index % row.count);
}

inline constexpr std::size_t kMostAttributeBytes = 20;  ///< operands of one command

namespace detail {
inline Vec4 attribute_floats(const std::byte* operand, std::size_t count) {
    Vec4 value{0, 0, 0, 1};
    std::memcpy(value.data(), operand, count * sizeof(float));
    return value;
}
inline Vec4 attribute_bytes(const std::byte* operand) {
    Vec4 value;
    for (std::size_t i = 0; i < 4; ++i) value[i] = static_cast<float>(operand[i]) / 255.0f;
    return value;
}
inline std::uint32_t attribute_word(const std::byte* operand) {
    std::uint32_t word;
    std::memcpy(&word, operand, sizeof word);
    return word;
}
template <class Value>
Value attribute_value(const Vec4& v) {
    if constexpr (std::is_same_v<Value, Flag>) return v[0] != 0 ? 1 : 0;
    else if constexpr (std::is_same_v<Value, float>) return v[0];
    else if constexpr (std::is_same_v<Value, Vec3>) return {v[0], v[1], v[2]};
    else return v;
}
template <class Value>
void put_attribute(std::byte* operand, const Value& value, std::size_t bytes = sizeof(Value)) {
    std::memcpy(operand, &value, bytes);
}
}  // namespace detail

"""


def _apply(attributes):
    lines = ["/// Sets the current attribute that a command stands for; nothing for any other command.\n"
             "inline void apply_attribute(State& state, glapi::Op op, const std::byte* operand) {\n"
             "    const AttributeCommand& row = attribute_command(op);\n    if (!row.sets_one()) return;\n"
             "    const std::size_t index = place_of(attribute_set_by(op, operand)) - row.place;\n"
             "    auto& current = state.current;\n    switch (op) {\n"]
    for a in attributes:
        for c in a.commands:
            target = f"current.{a.name}" + (f"[{'index' if c.indexed else '0'}]" if a.count > 1 else "")
            lines.append(f"        case glapi::Op::{c.op.name}: {target} = {_value(a, c)}; break;\n")
    lines.append("        default: break;\n    }\n}\n\n")
    return "".join(lines)


def _value(a, c):
    operand = "operand + 4" if c.indexed else "operand"
    if c.form == "bytes":
        return f"detail::attribute_bytes({operand})"
    if c.form == "flag":
        return f"detail::attribute_word({operand}) != 0"
    floats = f"detail::attribute_floats({operand}, {c.floats})"
    return {"float": f"{floats}[0]", "Vec3": f"{{{floats}[0], {floats}[1], {floats}[2]}}"}.get(a.element.cpp, floats)


def _write(attributes):
    lines = ["/// The command that gives an attribute its value in `state`, and its operands.\n"
             "inline glapi::Op write_attribute(const State& state, Attribute attribute, std::byte* operand) {\n"
             "    const auto& current = state.current;\n    const std::size_t place = place_of(attribute);\n"]
    for a in attributes:
        first, any_value = a.whole(False), a.whole(True)
        if a.count == 1:
            lines.append(f"    if (place == {a.place}) {{\n{_put(first, f'current.{a.name}')}    }}\n")
            continue
        if first:
            lines.append(f"    if (place == {a.place}) {{\n{_put(first, f'current.{a.name}[0]')}    }}\n")
        lines.append(f"    if (place < {a.place + a.count}) {{\n"
                     f"        const auto index = static_cast<std::uint32_t>(place - {a.place});\n"
                     "        detail::put_attribute(operand, index);\n"
                     f"{_put(any_value, f'current.{a.name}[index]')}    }}\n")
    lines.append("    return glapi::Op::End;\n}\n\n")
    return "".join(lines)


def _put(c, value):
    at = "operand + 4" if c.indexed else "operand"
    if c.form == "flag":
        put = f"detail::put_attribute({at}, std::uint32_t{{{value} != 0}});\n"
    else:
        put = f"detail::put_attribute({at}, {value}, {4 * c.floats});\n"
    return f"        {put}        return glapi::Op::{c.op.name};\n"


def _of_element(attributes):
    lines = ["/// The place of value i of an element of category `current`.\n"
             "template <class E>\nconstexpr Attribute attribute_of_element(unsigned i) {\n"
             "    static_assert(E::category == Category::current);\n"]
    lines += [f"    if (E::id == el::{a.name}::id) return Attribute::{a.name} + i;\n" for a in attributes]
    lines.append("    return Attribute{};\n}\n\n")
    return "".join(lines)


def _with_element(attributes):
    lines = ["/// Calls use(element, i, v): the attribute is value i of that element of category `current`, and v is\n"
             "/// `value`, which has four components, in the element's type.\n"
             "template <class Use>\nvoid with_attribute(Attribute attribute, const Vec4& value, Use&& use) {\n"
             "    const auto place = static_cast<unsigned>(place_of(attribute));\n"
             "    const auto is = [&]<class E>(E, unsigned first) {\n"
             "        if (place - first >= E::count) return false;\n"
             "        use(E{}, place - first, detail::attribute_value<typename E::type>(value));\n"
             "        return true;\n    };\n"]
    tests = [f"is(el::{a.name}{{}}, {a.place})" for a in attributes]
    lines.append("    static_cast<void>(" + " || ".join(tests) + ");\n}\n\n")
    return "".join(lines)


def _float_command(attributes):
    lines = ["/// The command that gives an attribute its value by as many floats; nothing: there is none.\n"
             "constexpr std::optional<glapi::Op> float_command(Attribute attribute, unsigned floats) {\n"
             "    const std::size_t place = place_of(attribute);\n"]
    for a in attributes:
        for floats, c in sorted(a.of_floats(False).items()):
            lines.append(f"    if (place == {a.place} && floats == {floats}) return glapi::Op::{c.op.name};\n")
    lines.append("    return std::nullopt;\n}\n\n")
    return "".join(lines)


def _arrays(attributes):
    lines = ["/// Calls use(attribute, array) for the vertex array of each attribute.\n"
             "template <class Use>\nvoid for_each_attribute_array(const State& state, Use&& use) {\n"
             "    const auto each = [&]<class E>(E, Attribute first) {\n"
             "        for (unsigned i = 0; i < E::count; ++i) use(first + i, E::ref(state, i));\n    };\n"]
    lines += [f"    each(el::{a.array.name}{{}}, Attribute::{a.name});\n" for a in attributes]
    lines.append("}\n\n")
    return "".join(lines)
