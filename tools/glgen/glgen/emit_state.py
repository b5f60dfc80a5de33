# SPDX-License-Identifier: MIT
"""gen/glstate/state.gen.h, state_tables.gen.cpp and driver_emit.gen.h."""

from .state import CLIENT_GROUP_BITS, GROUP_BITS, TYPES
from .text import header

STATE_NOTES = """
The state of an OpenGL context. Usage:

    glstate::State state;                                            // everything at its default
    glstate::assign<el::fog_density>(state, 0, 0.5f);                // false if it was that already
    const float d = el::fog_density::ref(state);                     // or state.fog.fog_density
    glstate::diff(mirror, state, sink);                              // sink.set<E>(i, value); common/glstate/diff.h
    glstate::element_bytes(id), glstate::apply(state, id, bytes);    // the receiving side; common/glstate/elements.h

A category's value id names its whole content: equal ids mean equal values. Element i of an array has the id E::id + i.
"""

EMIT_NOTES = """
Tells a driver one element's value: DriverEmit<Gl>{}.emit(gl, el::fog_density{}, 0, 0.5f) calls gl.Fogf(GL_FOG_DENSITY,
0.5f). Elements of CustomElements have no overload here: derive, `using DriverEmit<Gl>::emit;`, and add them.
Gl is glapi::GlFunctions or anything with members of the same names.
"""


def _mask(groups, bits):
    return " | ".join(bits[g] for g in groups) or "0"


def state_header(model):
    out = [header("proto/gl/state.toml", STATE_NOTES, []),
           '#include <array>\n#include <cstddef>\n#include <cstdint>\n#include <type_traits>\n\n'
           '#include "common/glapi/gl_types.h"\n#include "common/glstate/value_ids.h"\n'
           '#include "common/glstate/values.h"\n\nnamespace wall::glstate {\n\n']
    names = [c.name for c in model.categories]
    out.append("enum class Category : std::uint8_t {\n" + "".join(f"    {n},\n" for n in names) + "    kCount\n};\n")
    out.append(f"inline constexpr std::size_t kCategoryCount = {len(names)};\n")
    out.append("inline constexpr std::array<const char*, kCategoryCount> kCategoryNames = {\n"
               + "".join(f'    "{n}",\n' for n in names) + "};\n")
    sent = [c for c in model.categories if c.sent]
    last_sent = sent[-1].elements[-1]
    out.append(f"inline constexpr std::size_t kSentCategoryCount = {len(sent)};  ///< the first ones\n")
    out.append(f"inline constexpr std::uint32_t kLastSentId = {last_sent.id + last_sent.count - 1};  ///< ids 1 to "
               f"this travel; those of the other categories do not\n")
    out.append(f"inline constexpr std::uint32_t kLastId = {model.last_id};\n\n")
    for struct, fields in model.structs.items():
        out.append(f"struct {struct} {{\n" + "".join(f"    {TYPES[f.type][0]} {f.name};\n" for f in fields)
                   + f"    bool operator==(const {struct}&) const = default;\n}};\n")
        size = sum(TYPES[f.type][3] for f in fields)
        out.append(f"static_assert(sizeof({struct}) == {size} && std::is_trivially_copyable_v<{struct}>);\n\n")
    out += [_category_struct(c) for c in model.categories]
    out.append("/// Standard layout; copied and compared by category. Never holds pointers of its own.\n"
               "struct State {\n"
               "    ValueIds<kCategoryCount> ids;\n")
    out += [f"    {c.struct} {c.name};\n" for c in model.categories]
    out.append("};\nstatic_assert(std::is_standard_layout_v<State>);\n\nnamespace el {\n\n")
    out += [_tag(model, e, c) for c in model.categories for e in c.elements]
    out.append("}  // namespace el\n\n/// The elements of each category, in the order in which a difference is told.\n"
               "template <Category>\nstruct CategoryElements;\n")
    for c in model.categories:
        out.append(f"template <>\nstruct CategoryElements<Category::{c.name}> {{\n    using list = ElementList<\n"
                   + ",\n".join(f"        el::{e.name}" for e in c.elements) + ">;\n};\n")
    out.append("\n}  // namespace wall::glstate\n")
    return "".join(out)


def _category_struct(c):
    out = [f"/// {c.note}\n" if c.note else "", f"struct {c.struct} {{\n"]
    for e in c.elements:
        if e.count == 1:
            out.append(f"    {e.cpp} {e.name} = {e.defaults[0]};\n")
        elif len(set(e.defaults)) == 1:
            out.append(f"    std::array<{e.cpp}, {e.count}> {e.name} = filled<std::array<{e.cpp}, "
                       f"{e.count}>>({e.cpp}{_braced(e.defaults[0])});\n")
        else:
            values = ", ".join(e.cpp + _braced(d) for d in e.defaults)
            out.append(f"    std::array<{e.cpp}, {e.count}> {e.name} = {{{values}}};\n")
    out.append("};\n\n")
    return "".join(out)


def _braced(initializer):
    return initializer if initializer.startswith("{") else "{" + initializer + "}"


def _matters(model, e):
    """Whether an element's value can make a difference; of State `s` and index `i`."""
    switches = model.switches(e)
    if not switches:
        return "    static constexpr bool waits = false;\n"
    def place(s):
        if s.count not in (1, e.count):
            raise ValueError(f"{e.name}: {s.name} has another number of indices")
        return f"s.{s.category}.{s.name}" + ("[i]" if s.count > 1 else "")
    indexed = any(s.count > 1 for s in switches)
    return ("    static constexpr bool waits = true;  ///< where it does not matter\n"
            f"    static bool matters(const State& s, unsigned{' i' if indexed else ''}) {{\n        return ("
            + " |\n                ".join(map(place, switches)) + ") != 0;\n    }\n")


def _tag(model, e, c):
    at = f"s.{c.name}.{e.name}" + ("[i]" if e.count > 1 else "")
    i = "i" if e.count > 1 else ""
    return (f"struct {e.name} {{\n    using type = {e.cpp};\n"
            f'    static constexpr const char* name = "{e.name}";\n'
            f"    static constexpr std::uint16_t id = {e.id};\n    static constexpr unsigned count = {e.count};\n"
            f"    static constexpr Category category = Category::{c.name};\n"
            f"    static constexpr bool sent = {str(c.sent).lower()};\n"
            f"    static constexpr GLbitfield groups = {_mask(e.groups, GROUP_BITS)};\n"
            f"    static constexpr GLbitfield client_groups = {_mask(e.client_groups, CLIENT_GROUP_BITS)};\n"
            + _matters(model, e) +
            f"    static type& ref(State& s, unsigned {i or ''}{' = 0' if i else ' = 0'}) {{ return {at}; }}\n"
            f"    static const type& ref(const State& s, unsigned {i or ''}{' = 0' if i else ' = 0'}) "
            f"{{ return {at}; }}\n}};\n")


# ---- tables ----

def tables_source(model, registry):
    out = [header("proto/gl/state.toml", "Tables over the state's elements: common/glstate/elements.h, queries.h.", [],
                  pragma=False),
           '#include "common/glstate/elements.h"\n#include "common/glstate/queries.h"\n\n#include <cstddef>\n\n'
           'namespace wall::glstate {\n\n']
    elements = model.elements
    out.append(f"const std::array<ElementInfo, kElementCount> kElements = {{{{\n")
    for e in elements:
        out.append(f'    {{"{e.name}", Category::{e.category}, {e.id}, {e.count}, {e.bytes}, '
                   f"offsetof(State, {e.category}.{e.name}), "
                   f"{_mask(e.groups, GROUP_BITS)}, {_mask(e.client_groups, CLIENT_GROUP_BITS)}}},\n")
    out.append("}};\n\nconst std::array<std::uint16_t, kLastId + 1> kElementOfId = {\n    0,  // no element\n")
    for n, e in enumerate(elements):
        out.append("    " + f"{n}, " * e.count + f" // {e.name}\n")
    out.append("};\n\n")
    out.append(_getters(model, registry))
    out.append(_caps(model, registry))
    out.append(_params(model))
    out.append("}  // namespace wall::glstate\n")
    return "".join(out).replace(",  //", ",  //")


def value_kind(e, f):
    component = TYPES[f.type][1]
    if e.bits:
        return "first_bit"
    if e.name_of:
        return f"name_{e.name_of}"
    if f.name == "buffer":  # of a client array
        return "name_buffer"
    if component in ("float", "double") and e.norm:
        return "normalized" if component == "float" else "normalized64"
    return {"flag": "flag", "enum": "enumerant", "i32": "integer", "u32": "unsigned_integer", "u64": "pointer",
            "float": "real", "double": "real64"}[component]


def _rule(e):
    return {"unit": "unit", "coord": "unit", "client_unit": "client_unit"}.get(e.index, "none")


def _getters(model, registry):
    rows = []
    for e in model.elements:
        for word, first, f, components in e.getters:
            rows.append((registry.enums[word],
                         f"    {{{word}, ValueKind::{value_kind(e, f)}, {components}, el::{e.name}::id + {first}, "
                         f"{f.offset}, IndexRule::{_rule(e)}, {e.unit_stride}, {e.units}}},\n"))
    rows.sort()
    assert len({r[0] for r in rows}) == len(rows), "state.toml: two elements answer the same glGet word"
    return f"const std::array<GetEntry, {len(rows)}> kGetTable = {{{{\n" + "".join(r[1] for r in rows) + "}};\n" \
        "const std::span<const GetEntry> kGetEntries = kGetTable;\n\n"


def _caps(model, registry):
    rows = []
    for e in model.elements:
        for word, first in e.caps:
            rows.append((registry.enums[word],
                         f"    {{{word}, el::{e.name}::id + {first}, IndexRule::{_rule(e)}, {e.unit_stride}, "
                         f"{e.units}}},\n"))
    rows.sort()
    return f"const std::array<CapEntry, {len(rows)}> kCapTable = {{{{\n" + "".join(r[1] for r in rows) + "}};\n" \
        "const std::span<const CapEntry> kCapEntries = kCapTable;\n\n"


def _params(model):
    rows = []
    for e in model.elements:
        if e.param:
            f = e.fields[0]
            rows.append(f"    {{ParamFamily::{e.family}, {e.param_target or '0'}, {e.pname}, "
                        f"ValueKind::{value_kind(e, f)}, {f.components}, el::{e.name}::id}},\n")
    return f"const std::array<ParamEntry, {len(rows)}> kParamTable = {{{{\n" + "".join(rows) + "}};\n" \
        "const std::span<const ParamEntry> kParamEntries = kParamTable;\n\n"


def tables_header(model):
    families = sorted(model.families)
    names = sorted({e.name_of for e in model.elements if e.name_of} | {"buffer"})
    out = [header("proto/gl/state.toml",
                  "Sizes and closed sets that the tables of elements.h and queries.h are declared with.", []),
           "#include <cstddef>\n#include <cstdint>\n\nnamespace wall::glstate {\n\n"]
    out.append(f"inline constexpr std::size_t kElementCount = {len(model.elements)};\n\n")
    out.append("/// Commands that set a parameter by its name.\nenum class ParamFamily : std::uint8_t { "
               + ", ".join(families) + " };\n\n")
    kinds = ["flag", "first_bit", "enumerant", "integer", "unsigned_integer", "real", "normalized", "real64",
             "normalized64", "pointer"]
    out.append("/// What a component is, which decides how glGet* converts it.\nenum class ValueKind : std::uint8_t {\n"
               + "".join(f"    {k},\n" for k in kinds)
               + "".join(f"    name_{n},  ///< a session's name of an object: the application has its own\n"
                         for n in names) + "};\n\n"
               "}  // namespace wall::glstate\n")
    return "".join(out)


# ---- driver ----

def driver_header(model, registry):
    out = [header("proto/gl/state.toml", EMIT_NOTES, []),
           '#include "gen/glstate/state.gen.h"\n\nnamespace wall::glstate {\n\n'
           "template <class Gl>\nstruct DriverEmit {\n"
           "    unsigned active_unit = 0;  ///< the driver's\n\n"
           "    void unit(Gl& gl, unsigned i) {\n"
           "        if (active_unit != i) gl.ActiveTexture(GL_TEXTURE0 + (active_unit = i));\n    }\n"
           "    static GLenum face(unsigned i) { return i == 0 ? GL_FRONT : GL_BACK; }\n"
           "    /// The lowest `count` bits are all alike.\n"
           "    static bool alike(std::uint32_t bits, unsigned count) {\n"
           "        const std::uint32_t all = (1u << count) - 1;\n"
           "        return (bits & all) == 0 || (bits & all) == all;\n    }\n\n"]
    custom = []
    for e in (e for c in model.categories if c.sent for e in c.elements):
        if e.emit_custom:
            custom.append(e)
        else:
            out.append(_emit(e, registry, model))
    out.append("};\n\n/// Told to the driver by hand-written code.\nusing CustomElements = ElementList<\n"
               + ",\n".join(f"    el::{e.name}" for e in custom) + ">;\n\n}  // namespace wall::glstate\n")
    return "".join(out)


def _emit(e, registry, model):
    lead = {"unit": "unit(gl, i); "}.get(e.index, "")
    if e.index == "coord":
        lead = "unit(gl, i / 4); "
    if e.bits:
        body = _emit_bits(e)
    elif e.cap:
        word = e.cap
        if e.index == "coord":
            word = "GL_TEXTURE_GEN_S + i % 4"
        elif e.count > 1 and e.index != "unit":
            word = f"{e.cap} + i"
        body = f"v ? gl.Enable({word}) : gl.Disable({word});"
    elif e.param:
        body = _emit_param(e)
    else:
        command = registry.commands["gl" + (e.emit or e.set)]
        body, lead = _emit_command(e, command, lead)
    i = " i" if "i" in _identifiers(lead + body) else ""
    return f"    void emit(Gl& gl, el::{e.name}, unsigned{i}, const {e.cpp}& v) {{ {lead}{body} }}\n"


def _emit_bits(e):
    """Of all draw buffers in one call where they are alike; else of each."""
    values = components(e)
    alike = " && ".join(f"alike({v}, {e.bits})" for v in values)
    if e.cap:
        once = f"v & 1 ? gl.Enable({e.cap}) : gl.Disable({e.cap});"
        each = f"v >> k & 1 ? gl.Enablei({e.cap}, k) : gl.Disablei({e.cap}, k);"
    else:
        once = f"gl.{e.set}({', '.join(_cast('GLboolean', f'{v} & 1') for v in values)});"
        each = f"gl.{e.set}i(k, {', '.join(_cast('GLboolean', f'{v} >> k & 1') for v in values)});"
    return (f"if ({alike}) {{ {once} return; }} "
            f"for (unsigned k = 0; k < {e.bits}; ++k) {{ {each} }}")


def _identifiers(text):
    import re
    return set(re.findall(r"[A-Za-z_]\w*", text))


def _emit_param(e):
    f = e.fields[0]
    lead = {"light": "GL_LIGHT0 + i, ", "face": "face(i), ", "coord": "GL_S + i % 4, "}.get(e.index, "")
    if e.param_target:
        lead = e.param_target + ", "
    if e.family in ("Hint", "ClampColor"):
        return f"gl.{e.family}({e.pname}, v);"
    component = TYPES[f.type][1]
    if f.components > 1:
        return f"gl.{e.family}fv({lead}{e.pname}, v.data());"
    if component == "float":
        return f"gl.{e.family}f({lead}{e.pname}, v);"
    return f"gl.{e.family}i({lead}{e.pname}, static_cast<GLint>(v));"


def components(e):
    """C++ expressions of the value `v`'s components, in the command's order."""
    if e.plain:
        n = e.fields[0].components
        return ["v"] if n == 1 else [f"v[{k}]" for k in range(n)]
    order = e.args.split() if e.args else [f.name for f in e.fields]
    return [f"v.{name}" for name in order]


def _emit_command(e, command, lead):
    args = components(e)
    first = {"face": "face(i)", "attrib": "i"}.get(e.index)
    if e.index == "unit" and command.short == "MultiTexCoord4f":
        first, lead = "GL_TEXTURE0 + i", ""
    wanted = command.params[1:] if first else command.params
    args = [_cast(p.type, a) for p, a in zip(wanted, args)]
    assert len(args) == len(wanted), f"{e.place}: {e.name}: {command.name} takes {len(wanted)} values"
    return f"gl.{command.short}({', '.join(([first] if first else []) + args)});", lead


def _cast(type_, expression):
    return f"static_cast<{type_}>({expression})" if type_ in ("GLboolean", "GLushort") else expression
