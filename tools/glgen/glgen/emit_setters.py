# SPDX-License-Identifier: MIT
"""gen/client_lib/state_api.gen.cpp: api functions that follow from state.toml, with their validation."""

from .emit_state import value_kind
from .state import TYPES
from .text import header


def setters_source(commands, model, registry):
    out = [header("proto/gl/state.toml and proto/gl/commands.toml",
                  "Commands that set one element of the state, or read parameters.", [], pragma=False),
           '#include <array>\n\n#include "client_lib/context/context.h"\n'
           '#include "client_lib/context/indexed_values.h"\n#include "client_lib/context/named_objects.h"\n'
           '#include "client_lib/context/param_commands.h"\n#include "gen/client_lib/api.gen.h"\n\n'
           "namespace wall::client {\n\nnamespace el = glstate::el;\nusing namespace glstate;  // value types\n\n"
           "namespace {\n\n"]
    body = _body(commands, model, registry)
    for name, words in model.valid.items():
        if f"kValid_{name})" in body:
            out.append(f"constexpr GLenum kValid_{name}[] = {{\n" + "".join(f"    {w},\n" for w in words) + "};\n")
    return "".join(out) + body


def _body(commands, model, registry):
    """All but the lists of enums, of which it names some."""
    out = ["\n// ---- parameters: v is what the command gave, i the element's index ----\n\n"]
    for e in model.elements:
        if e.param and not e.hand and not model.families[e.family].get("hand"):
            out.append(_param_setter(e, model))
    out.append(_param_rows(model, registry))
    out.append(_cap_rows(model, registry))
    out.append("}  // namespace\n\nconst std::span<const ParamRow> kParamRows = kParamTable;\n"
               "const std::span<const CapRow> kCapRows = kCapTable;\n\n"
               "namespace api {\n\n")
    by_set = {e.set: e for e in model.elements if e.set}
    by_set |= {e.set + "i": e for e in model.elements if e.rest}
    for i in commands.canonical:
        if i.way == "state":
            out.append(_setter(i, by_set[i.name]))
        elif i.way == "param":
            out.append(_param_command(i, commands))
        elif i.way == "caps":
            out.append(_caps_command(i))
        elif i.way == "named":
            out.append(_named_command(i, registry))
    out.append("}  // namespace api\n}  // namespace wall::client\n")
    return "".join(out)


def _literal(type_, value):
    if TYPES[type_][1] == "float":
        return f"{float(value)}f"
    return repr(float(value)) if type_ == "double" else str(value)


def _checks(e, f, expression):
    """Lines that refuse a bad value of one component."""
    lines = []
    valid = e.of_field("valid", f.name)
    if valid and not isinstance(valid, dict):
        lines.append(f"if (!one_of({expression}, kValid_{valid})) return c.error({e.invalid or 'GL_INVALID_ENUM'});")
    for key, operator in (("min", "<"), ("max", ">"), ("above", "<="), ("below", ">=")):
        limit = e.of_field(key, f.name)
        if limit is not None and not isinstance(limit, dict):
            other = e.keys.get("or")
            exempt = f" && {expression} != {_literal(f.type, other)}" if other is not None else ""
            lines.append(f"if ({expression} {operator} {_literal(f.type, limit)}{exempt}) return "
                         f"c.error(GL_INVALID_VALUE);")
    most = e.of_field("forward_max", f.name)
    if most is not None:
        lines.append(f"if (c.profile.forward_compatible && {expression} > {_literal(f.type, most)}) return "
                     f"c.error(GL_INVALID_VALUE);")
    return lines


def _clamped(e, f, expression):
    clamp = e.of_field("clamp", f.name)
    if not clamp or isinstance(clamp, dict):
        return expression
    low, high = (_literal(f.type, v) for v in clamp)
    return f"clamped({expression}, {low}, {high})"


def _component(e, f, expression, given):
    """A parameter of the command as the component's type."""
    if e.bits:
        return f"all_or_none({expression}, {e.bits})"
    wanted = TYPES[f.type][0] if f.components == 1 else "float"
    if f.type == "flag":
        return f"to_flag({expression})"
    plain = {"std::int32_t": ("GLint", "GLsizei"), "std::uint32_t": ("GLuint",), "GLenum": ("GLenum",),
             "float": ("GLfloat",),
             "double": ("GLdouble",)}[wanted]
    return expression if given in plain else f"static_cast<{wanted}>({expression})"


def _setter(i, e):
    params = list(i.command.params)
    lines, index = [], "0"
    one_buffer = e.rest and i.name == e.set + "i"
    if e.index == "face" or one_buffer:
        params.pop(0)
    order = e.args.split() if e.args else [f.name for f in e.fields]
    fields = {f.name: f for f in e.fields}
    values = {}
    if e.plain:
        f = e.fields[0]
        for p in params:
            lines += _checks(e, f, p.name)
        parts = [_clamped(e, f, _component(e, f, p.name, p.type)) for p in params]
        value = parts[0] if f.components == 1 else f"{{{', '.join(parts)}}}"
    else:
        for name, p in zip(order, params):
            lines += _checks(e, fields[name], p.name)
            values[name] = _clamped(e, fields[name], _component(e, fields[name], p.name, p.type))
        value = "{" + ", ".join(values[f.name] for f in e.fields) + "}"
    face = i.command.params[0].name
    if e.index == "face":
        lines.insert(0, f"if (!is_face({face})) return c.error(GL_INVALID_ENUM);")
        lines += [f"for (unsigned i = 0; i < 2; ++i)",
                  f"    if (names_face({face}, i)) c.set<el::{e.name}>(i, {value});"]
    elif one_buffer:
        lines.insert(0, f"if ({face} >= draw_buffers_of(c)) return c.error(GL_INVALID_VALUE);")
        lines.append(f"set_at<el::{e.name}, el::{e.rest}>(c, {face}, {value});")
    elif e.rest:
        lines.append(f"set_everywhere<el::{e.name}, el::{e.rest}>(c, {value});")
    else:
        lines.append(f"c.set<el::{e.name}>({index}, {value});")
    declared = ", ".join(["Context& c"] + [f"{p.type} {p.name}" for p in i.command.params])
    return f"void {i.name}({declared}) {{\n" + "".join(f"    {line}\n" for line in lines) + "}\n"


def _param_setter(e, model):
    f = e.fields[0]
    lines = []
    component = TYPES[f.type][1]
    if f.components > 1:
        lines.append(f"c.set<el::{e.name}>(i, vector<{TYPES[f.type][0]}>(v));")
    else:
        get = {"enum": "to_enum(v[0])", "flag": "to_flag(v[0])", "i32": "to_int(v[0])", "u32": "to_int(v[0])",
               "float": "static_cast<float>(v[0])"}[component]
        lines.append(f"const {TYPES[f.type][0]} value = {get};")
        if e.valid and model.valid[e.valid][0].isdigit():
            given = "v[0]" if component == "flag" else "value"
            wrong = " && ".join(f"{given} != {w}" for w in model.valid[e.valid])
            lines.append(f"if ({wrong}) return c.error(GL_INVALID_VALUE);")
            lines += _checks(_without_valid(e), f, "value")
        else:
            lines += _checks(e, f, "value")
        lines.append(f"c.set<el::{e.name}>(i, {_clamped(e, f, 'value')});")
    head = f"void set_{e.name}(Context& c, unsigned i, const double* v) {{\n"
    return head + "".join(f"    {line}\n" for line in lines) + "}\n"


def _without_valid(e):
    import dataclasses
    return dataclasses.replace(e, keys={k: v for k, v in e.keys.items() if k != "valid"})


def _param_rows(model, registry):
    rows = []
    for e in model.elements:
        if not e.param:
            continue
        f = e.fields[0]
        by_hand = model.families[e.family].get("hand")
        setter = "nullptr" if by_hand else f"&hand::set_{e.name}" if e.hand else f"&set_{e.name}"
        norm = "true" if value_kind(e, f) == "normalized" else "false"
        word = "true" if f.type in ("enum", "flag") else "false"
        rows.append((e.family, e.param_target or "0", e.pname, f.components, norm, word, setter))
    for family, keys in model.families.items():
        for pname, shape in keys.get("shape", {}).items():
            parts = shape.split()
            rows.append((family, "0", "kAnyParam" if pname == "*" else pname, int(parts[0]),
                         *("true" if word in parts else "false" for word in ("norm", "word")), "nullptr"))
    rows.sort(key=lambda r: (r[0], r[2] == "kAnyParam"))
    out = f"\nconst std::array<ParamRow, {len(rows)}> kParamTable = {{{{\n"
    for family, target, pname, n, norm, word, setter in rows:
        out += f"    {{ParamFamily::{family}, {target}, {pname}, {n}, {norm}, {word}, {setter}}},\n"
    return out + "}};\n\n"


def _cap_rows(model, registry):
    rows = sorted((registry.enums[word], word, first, e) for e in model.elements for word, first in e.caps)
    out = "template <class E>\nvoid set_cap(Context& c, unsigned i, glstate::Flag on) {\n    c.set<E>(i, on);\n}\n" \
          "template <class E, unsigned kBits>\nvoid set_bits_cap(Context& c, unsigned, glstate::Flag on) {\n" \
          "    c.set<E>(0, all_or_none(on, kBits));\n}\n\n"
    out += f"const std::array<CapRow, {len(rows)}> kCapTable = {{{{\n"
    for _, word, first, e in rows:
        set_ = f"set_bits_cap<el::{e.name}, {e.bits}>" if e.bits else f"set_cap<el::{e.name}>"
        out += f"    {{{word}, &{set_}, {first}, {e.unit_stride}}},\n"
    return out + "}};\n\n"


def _param_command(i, commands):
    declared = ", ".join(["Context& c"] + [f"{p.type} {p.name}" for p in i.command.params])
    names = [p.name for p in i.command.params]
    if i.cls == "query":
        family, form = commands.family_of(i.name[3:])
        lead = names[0] if len(names) == 3 else "0"
        get = "get_fixed_params" if form == "xv" else "get_params"
        return (f"void {i.name}({declared}) {{\n"
                f"    {get}(c, ParamFamily::{family}, {lead}, {names[-2]}, {names[-1]});\n}}\n")
    family, form = commands.family_of(i.name)
    lead = names[0] if len(names) == 3 else "0"
    value = names[-1]
    give = f"set_params(c, ParamFamily::{family}, {lead}, {names[-2]}, "
    if form.endswith("v"):
        return f"void {i.name}({declared}) {{\n    {give}{value});\n}}\n"
    return f"void {i.name}({declared}) {{\n    {give}&{value});\n}}\n"


def _named_command(i, registry):
    """The object of its first parameter is bound, the command about what is bound done, and all bound as before."""
    declared = ", ".join(["Context& c"] + [f"{p.type} {p.name}".replace("* ", "*") for p in i.command.params])
    names = [p.name for p in i.command.params]
    target = registry.commands["gl" + i.target]
    with_target = len(target.params) == len(names)
    assert with_target or len(target.params) == len(names) - 1, f"{i.place}: {i.target} takes other parameters"
    args = ", ".join(["c"] + (["named.target()"] if with_target else []) + names[1:])
    give, none = ("", "return;") if i.command.returns == "void" else ("return ", "return {};")
    return (f"{i.command.returns} {i.name}({declared}) {{\n    const {i.binder} named(c, {names[0]});\n"
            f"    if (!named) {none}\n    {give}{i.target}({args});\n}}\n")


def _caps_command(i):
    if i.name == "IsEnabled":
        return "GLboolean IsEnabled(Context& c, GLenum cap) { return is_capability_set(c, cap); }\n"
    on = "true" if i.name == "Enable" else "false"
    return f"void {i.name}(Context& c, GLenum cap) {{ set_capability(c, cap, {on}); }}\n"
