# SPDX-License-Identifier: MIT
"""gen/glstate/samples.gen.h: a few allowed values of each element, for tests."""

from .state import TYPES
from .text import header

NOTES = """
Samples<E>::values: three allowed values of every element that has a type to choose from, none of them special. For
tests.
"""


def samples_header(model):
    out = [header("proto/gl/state.toml", NOTES, []),
           '#include "gen/glstate/state.gen.h"\n\nnamespace wall::glstate {\n\ntemplate <class E>\nstruct Samples;\n']
    for e in model.elements:
        values = ", ".join(_value(e, n, model) for n in range(3))
        out.append(f"template <>\nstruct Samples<el::{e.name}> {{\n"
                   f"    static constexpr {e.cpp} values[] = {{{values}}};\n}};\n")
    out.append("\n}  // namespace wall::glstate\n")
    return "".join(out)


def _value(e, n, model):
    if e.plain:
        f = e.fields[0]
        parts = [_component(e, f, n + k, model) for k in range(f.components)]
        return parts[0] if f.components == 1 else e.cpp + "{" + ", ".join(parts) + "}"
    return e.cpp + "{" + ", ".join(_component(e, f, n + k, model) for k, f in enumerate(e.fields)) + "}"


def _component(e, f, n, model):
    kind = TYPES[f.type][1]
    valid = e.of_field("valid", f.name)
    if valid and not isinstance(valid, dict):
        words = model.valid[valid]
        return words[n * (len(words) - 1) // 2 % len(words)]
    if kind == "flag":
        return "01"[n % 2]
    if kind == "enum":
        return e.keys["default"] if e.plain else e.keys["default"][[x.name for x in e.fields].index(f.name)]
    if kind in ("float", "double"):
        limited = e.norm or isinstance(e.of_field("clamp", f.name), list)
        value = (0.25, 0.5, 0.75)[n % 3] if limited else (1.5, 2.5, 3.25)[n % 3]
        return f"{value}f" if kind == "float" else str(value)
    return "123"[n % 3]
