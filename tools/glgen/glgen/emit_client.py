# SPDX-License-Identifier: MIT
"""gen/client_lib/api.gen.h, entries.gen.cpp (entry points, names), tables.gen.cpp (immediate, inside_begin, compile,
replay). The generated state commands are emit_setters.py's."""

from .text import header

API_NOTES = """
The implemented commands: api::NAME does one in its usual mode; GlTable has a place for each, and the three tables are a
context's modes. Written by hand in client_lib: api::NAME of the commands marked `by hand`; compile::NAME and
replay::NAME of those marked `record`; hand::NAME, setters of single parameters; gl_entry_NAME of those marked `hot`.
"""


def _signature(i, namespace=""):
    params = "".join(f", {p.type} {p.name}".replace("* ", "*") for p in i.command.params)
    return f"{i.command.returns} {namespace}{i.name}(Context& c{params})"


def _declaration(i):
    return _signature(i).replace("Context& c", "Context&")


def _pointer(i):
    params = "".join(f", {p.type}" for p in i.command.params)
    return f"{i.command.returns} (*{i.name})(Context&{params})"


def api_header(commands, model, attributes):
    canonical = commands.canonical
    out = [header("gl.xml, proto/gl/commands.toml, proto/gl/state.toml", API_NOTES, []),
           '#include <cstddef>\n#include <cstdint>\n#include <span>\n\n'
           '#include "common/glapi/gl_types.h"\n#include "gen/glapi/wire.gen.h"\n'
           '#include "gen/glstate/attributes.gen.h"\n\n'
           "namespace wall::client {\n\nclass Context;\n\nnamespace api {\n\n"]
    for i in canonical:
        note = " // by hand" if i.way == "hand" else ""
        out.append(_declaration(i) + ";" + note + "\n")
    out.append("\n}  // namespace api\n\n/// Setters of single parameters and words, for what is more than storing a "
               "value.\nnamespace hand {\n\n")
    for e in model.elements:
        if e.hand and e.param:
            out.append(f"void set_{e.name}(Context&, unsigned i, const double* v);\n")
    out.append("\n}  // namespace hand\n\n/// Putting a command into the display list being compiled (and executing "
               "it, if asked for).\nnamespace compile {\n\n")
    recorded = [i for i in canonical if "record" in i.flags]
    out += [_declaration(i) + ";\n" for i in recorded]
    out.append("\n}  // namespace compile\n\n/// Executing it from there: the payload is what compile::NAME appended.\n"
               "namespace replay {\n\n")
    out += [f"void {i.name}(Context&, std::span<const std::byte> payload);\n" for i in recorded]
    out.append("\n}  // namespace replay\n\nstruct GlTable {\n")
    out += [f"    {_pointer(i)};\n" for i in canonical]
    out.append("};\n\nnamespace tables {\n"
               "extern const GlTable immediate;     ///< each command at once\n"
               "extern const GlTable inside_begin;  ///< between glBegin and glEnd: most are errors\n"
               "extern const GlTable compile;       ///< into the context's list()\n"
               "extern const GlTable core;          ///< at once, in a core profile: what it does not have is an "
               "error\n"
               "}  // namespace tables\n\n"
               "/// What the context does with a command at once, while a list may be compiled as well: `inside_begin` "
               "or `immediate`.\n"
               "const GlTable& execution_table(const Context& c);\n\n")
    out.append("/// A recorded command's number (common/glapi/recorder.h).\nenum class CommandId : std::uint16_t {\n"
               + "".join(f"    {i.name},\n" for i in canonical) + "};\n"
               f"inline constexpr std::size_t kCommandCount = {len(canonical)};\n"
               "extern const char* const kCommandNames[kCommandCount];\n\n"
               "/// The recorded commands that set vertex attributes, and what they are in the stream.\n"
               "struct RecordedAttribute {\n    CommandId command;\n    glapi::Op op;\n};\n"
               "inline constexpr RecordedAttribute kRecordedAttributes[] = {\n"
               + "".join(f"    {{CommandId::{c.op.name}, glapi::Op::{c.op.name}}},\n"
                         for a in attributes for c in a.commands) + "};\n\n"
               "/// Gives a vertex attribute its value by a command of the table: the one of `size` components if "
               "there is one.\n/// `v` has four; those behind the first `size` are 0, 0, 1 as OpenGL would fill them "
               "in.\n"
               "void call_attribute(const GlTable& table, Context& c, glstate::Attribute attribute, GLint size, "
               "const GLfloat* v);\n\n"
               "/// Executes a recorded command, as between glBegin and glEnd if the context is there.\n"
               "void replay_command(Context& c, std::uint16_t command, std::span<const std::byte> payload);\n\n")
    out.append("/// An entry point by name.\nstruct ProcEntry {\n    const char* name;\n    void (*entry)();\n};\n"
               "extern const std::span<const ProcEntry> kProcs;  ///< every function of gl.xml, by name\n\n")
    unsupported = _unsupported(commands)
    out.append("/// Commands that are not implemented; report_unsupported (unsupported.h) takes an index of these.\n"
               f"inline constexpr std::size_t kUnsupportedCount = {len(unsupported)};\n"
               "extern const char* const kUnsupportedNames[kUnsupportedCount];\n\n")
    out.append("/// A version of OpenGL, compatibility profile.\n"
               "struct VersionCommands {\n    int major, minor;\n"
               "    const char* missing;  ///< a command of it that is not implemented; null: there is none\n};\n"
               "extern const std::span<const VersionCommands> kVersions;  ///< all that there are, in order\n"
               "/// Words that mean nothing in a core profile, in order.\n"
               "extern const std::span<const GLenum> kRemovedWords;\n\n")
    hot = _hot(commands)
    out.append("}  // namespace wall::client\n\n"
               "// Entry points written by hand. Each begins with a line of the processor's cache: they are called "
               "millions\n// of times a frame, and where they lie by chance is a tenth of their speed.\n"
               "namespace wall::client {\n\n")
    out += [f"[[gnu::aligned(64)]] {i.command.returns} GLAPIENTRY gl_entry_{i.name}({i.command.declaration});\n"
            for i in hot]
    out.append("\n}  // namespace wall::client\n")
    return "".join(out)


def _unsupported(commands):
    return [i for i in commands.unique if i.later]


def _hot(commands):
    return [i for i in commands.unique if "hot" in i.flags]


# ---- tables ----

def _attribute_calls(attributes):
    """call_attribute(): a line for each command that gives an attribute its value."""
    lines = ["void call_attribute(const GlTable& table, Context& c, glstate::Attribute attribute, GLint size, "
             "const GLfloat* v) {\n    const auto place = static_cast<GLuint>(glstate::place_of(attribute));\n"]
    for a in attributes:
        for floats, command in a.of_floats(False).items():
            if command is not a.whole(False):
                lines.append(f"    if (place == {a.place} && size == {floats}) return {_attribute_call(a, command)};\n")
        if a.whole(False):
            lines.append(f"    if (place == {a.place}) return {_attribute_call(a, a.whole(False))};\n")
        if a.whole(True):
            lines.append(f"    if (place < {a.place + a.count}) return {_attribute_call(a, a.whole(True))};\n")
    return "".join(lines) + "}\n\n"


def _attribute_call(a, command):
    index = {"unit": [f"GL_TEXTURE0 + place - {a.place}"], "index": [f"place - {a.place}"]}
    first = index[command.op.operands[0].name] if command.indexed else []
    values = ["v[0] != 0"] if command.form == "flag" else [f"v[{i}]" for i in range(command.floats)]
    return f"table.{command.op.name}({', '.join(['c', *first, *values])})"


def tables_source(commands, attributes, registry):
    canonical = commands.canonical
    out = [header("gl.xml and proto/gl/commands.toml",
                  "The modes of a context as tables, display list recording and replay.", [], pragma=False),
           '#include "client_lib/context/context.h"\n#include "client_lib/context/param_commands.h"\n'
           '#include "common/glapi/recorder.h"\n'
           '#include "gen/client_lib/api.gen.h"\n\nnamespace wall::client {\n\nnamespace {\n\n'
           "using glapi::recorded_array;\n\n"
           "/// A command that no list holds, while one is compiled: done at once.\n"
           "template <auto kCommand, class Function>\nstruct Direct;\n"
           "template <auto kCommand, class R, class... A>\nstruct Direct<kCommand, R (*)(Context&, A...)> {\n"
           "    static R call(Context& c, A... a) { return (execution_table(c).*kCommand)(c, a...); }\n};\n\n"
           "/// A command that is an error: between glBegin and glEnd, in a core profile.\n"
           "template <class Function>\nstruct RefusedInside;\n"
           "template <class R, class... A>\nstruct RefusedInside<R (*)(Context&, A...)> {\n"
           "    static R call(Context& c, A...) {\n        c.error(GL_INVALID_OPERATION);\n        return R();\n    }\n"
           "};\n\n"
           "}  // namespace\n\nnamespace {\n\n"]
    automatic = [i for i in canonical if i.in_list and "record" not in i.flags]
    for i in automatic:
        out.append(_compile(i, commands))
    for i in automatic:
        out.append(_replay(i))
    out.append("struct ReplayRow {\n    void (*run)(Context&, std::span<const std::byte>);  ///< null: not in lists\n"
               "};\n\n"
               "const ReplayRow kReplayRows[kCommandCount] = {\n")
    for i in canonical:
        run = "nullptr" if not i.in_list else f"&replay::{i.name}" if "record" in i.flags else f"&replay_{i.name}"
        out.append(f"    {{{run}}},  // {i.name}\n")
    out.append("};\n\n}  // namespace\n\n"
               "const GlTable& execution_table(const Context& c) { return c.packer.inside() ? tables::inside_begin : "
               "tables::immediate; }\n\n"
               "void replay_command(Context& c, std::uint16_t command, std::span<const std::byte> payload) {\n"
               "    if (command < kCommandCount && kReplayRows[command].run) kReplayRows[command].run(c, payload);\n}\n"
               "\n"
               + _attribute_calls(attributes) +
               "const char* const kCommandNames[kCommandCount] = {\n"
               + "".join(f'    "gl{i.name}",\n' for i in canonical) + "};\n\n"
               "namespace tables {\n\n")
    out.append(_table("immediate", canonical, lambda i: f"&api::{i.name}"))
    out.append(_table("inside_begin", canonical,
                      lambda i: f"&api::{i.name}"
                      if "inside" in i.flags else f"&RefusedInside<decltype(GlTable::{i.name})>::call"))
    out.append(_table("compile", canonical,
                      lambda i: f"&Direct<&GlTable::{i.name}, decltype(GlTable::{i.name})>::call"
                      if not i.in_list else f"&compile::{i.name}" if "record" in i.flags else f"&compile_{i.name}"))
    out.append(_table("core", canonical,
                      lambda i: f"&api::{i.name}"
                      if i.in_core else f"&RefusedInside<decltype(GlTable::{i.name})>::call"))
    out.append("}  // namespace tables\n\n" + _versions(commands) + _removed_words(registry)
               + "}  // namespace wall::client\n")
    return "".join(out)


def _versions(commands):
    missing = {}
    for i in commands.all.values():
        if i.command.gl:
            missing.setdefault(i.command.gl, None)
    for name in sorted(commands.all):
        i = commands.all[name]
        if i.later and i.command.gl:
            missing[i.command.gl] = missing[i.command.gl] or name
    rows = sorted((tuple(int(n) for n in version.split(".")), name) for version, name in missing.items())
    return ("namespace {\nconst VersionCommands kVersionTable[] = {\n"
            + "".join(f"    {{{major}, {minor}, {f'{chr(34)}{name}{chr(34)}' if name else 'nullptr'}}},\n"
                      for (major, minor), name in rows)
            + "};\n}  // namespace\nconst std::span<const VersionCommands> kVersions = kVersionTable;\n\n")


def _removed_words(registry):
    """By value, which some of them share with words that stay."""
    removed = set(registry.removed)
    staying = {registry.enums[name] for name in registry.core_enums}
    values = {registry.enums[name] for name in removed} - staying
    return ("namespace {\nconst GLenum kRemovedWordTable[] = {\n"
            + "".join(f"    0x{value:04x},\n" for value in sorted(values) if value > 0xFF)
            + "};\n}  // namespace\nconst std::span<const GLenum> kRemovedWords = kRemovedWordTable;\n\n")


def _table(name, canonical, value):
    return f"const GlTable {name} = {{\n" + "".join(f"    {value(i)},\n" for i in canonical) + "};\n\n"


def _array_length(i, p, commands):
    if p.len and p.len.startswith("COMPSIZE"):
        family = max((f for f in commands.families if i.name.startswith(f)), key=len)
        return f"param_components(ParamFamily::{family}, pname)"
    assert p.len, f"{i.place}: {i.name}: {p.name} has no length in gl.xml: word `record`"
    return p.len


def _compile(i, commands):
    args = "".join(f", {p.name}" for p in i.command.params)
    recorded = "".join(", " + (f"recorded_array({p.name}, {_array_length(i, p, commands)})" if p.pointer else p.name)
                       for p in i.command.params)
    return (_signature(i, "compile_") + " {\n"
            f"    c.list().record(static_cast<std::uint16_t>(CommandId::{i.name}){recorded});\n"
            f"    if (c.list().execute) execution_table(c).{i.name}(c{args});\n}}\n")


def _replay(i):
    params = i.command.params
    lines = [f"void replay_{i.name}(Context& c, std::span<const std::byte>{' payload' if params else ''}) {{\n"]
    if params:
        lines.append("    glapi::RecordReader in(payload);\n")
    for p in params:
        read = f"in.array<{p.value_type}>()" if p.pointer else f"in.get<{p.type}>()"
        lines.append(f"    const auto {p.name} = {read};\n")
    lines.append(f"    execution_table(c).{i.name}({', '.join(['c'] + [p.name for p in params])});\n}}\n")
    return "".join(lines)


# ---- entry points ----

def entries_source(commands, registry):
    out = [header("gl.xml and proto/gl/commands.toml", "The functions that applications call, and their names.", [],
                  pragma=False),
           '#include "client_lib/context/context.h"\n#include "client_lib/context/current.h"\n'
           '#include "client_lib/api/entry_guard.h"\n#include "client_lib/context/param_commands.h"\n'
           '#include "client_lib/api/unsupported.h"\n#include "common/glapi/convert.h"\n'
           '#include "common/glapi/packed_vertex.h"\n'
           '#include "gen/client_lib/api.gen.h"\n\n'
           "namespace wall::client {\nnamespace {\n\n"
           "using glapi::from_fixed;\nusing glapi::to_bits;\nusing glapi::to_fraction;\n\n"]
    for i in commands.unique:
        if not i.later and "hot" not in i.flags:
            out.append(_entry(i, commands, registry))
    unsupported = _unsupported(commands)
    out.append("/// Any signature: the calling convention lets a callee ignore its arguments.\n"
               "template <std::size_t kIndex>\nstd::uintptr_t GLAPIENTRY unsupported() {\n"
               "    report_unsupported(kIndex);\n    return 0;\n}\n\n"
               "template <class F>\nProcEntry proc(const char* name, F* entry) {\n"
               "    return {name, reinterpret_cast<void (*)()>(entry)};\n}\n\n")
    index = {i.name: n for n, i in enumerate(unsupported)}
    names = sorted(commands.all)
    out.append(f"const ProcEntry kProcTable[] = {{\n")
    for name in names:
        i = commands.all[name]
        out.append(f'    proc("{name}", &unsupported<{index[i.name]}>),\n'
                   if i.later else f'    proc("{name}", &gl_entry_{i.name}),\n')
    out.append("};\n\n}  // namespace\n\nconst std::span<const ProcEntry> kProcs = kProcTable;\n\n"
               "const char* const kUnsupportedNames[kUnsupportedCount] = {\n"
               + "".join(f'    "gl{i.name}",\n' for i in unsupported) + "};\n\n"
               "}  // namespace wall::client\n")
    return "".join(out)


def _entry(i, commands, registry):
    """Nothing that is thrown leaves it. What another entry point by hand does goes straight there."""
    returns = i.command.returns
    head = f"{returns} GLAPIENTRY gl_entry_{i.name}({i.command.declaration}) {{\n"
    if i.way in ("convert", "as") and "packed" not in i.flags and "hot" in commands.all["gl" + i.target].flags:
        return f"{head}    gl_entry_{i.target}({', '.join(_target_args(i, registry))});\n}}\n"
    none = "return;" if returns == "void" else "return {};"
    lines = [head, f"    Context* c = tls_context;\n    if (!c) {none}\n",
             "    const EntryEnd entry_end(*c);\n    try {\n"]
    lines += [f"        {line}\n" for line in _entry_body(i, commands, registry)]
    lines.append(f'    }} catch (...) {{\n        entry_failed("gl{i.name}");\n')
    lines += [] if returns == "void" else [f"        {none}\n"]
    lines.append("    }\n}\n")
    return "".join(lines)


def _target_args(i, registry):
    target = registry.commands["gl" + i.target]
    if i.way == "as":
        return [_converted(p.type, a, "", ()) for p, a in zip(target.params, i.args)]
    return _convert_args(i, target)


def _call(i, name, args):
    give = "" if i.command.returns == "void" else "return "
    return f"{give}c->table->{name}({', '.join(['*c'] + args)});"


def _entry_body(i, commands, registry):
    if commands.has_slot(i):
        return [_call(i, i.name, [p.name for p in i.command.params])]
    if "packed" in i.flags:
        return _packed_entry(i, registry)
    if i.way in ("as", "convert"):
        return [_call(i, i.target, _target_args(i, registry))]
    return _param_entry(i, commands)


def _packed_entry(i, registry):
    """A word of type 2_10_10_10, and what stands before its type."""
    target = registry.commands["gl" + i.target]
    names = [p.name for p in i.command.params]
    word = names[-1] + ("[0]" if i.command.params[-1].pointer else "")
    command, none = "glapi::Fraction::command", "glapi::Fraction::none"
    fraction = f"normalized ? {command} : {none}" if "normalized" in names else command if "norm" in i.flags else none
    lead = names[:names.index("type")]
    floats = [f"v[{n}]" for n in range(len(target.params) - len(lead))]
    components = i.name.rstrip("uiv")[-1]
    return ["GLfloat v[4] = {0, 0, 0, 1};",
            f"if (!glapi::unpack_2_10_10_10(type, {word}, {fraction}, {components}, v)) "
            "return c->error(GL_INVALID_ENUM);", _call(i, i.target, lead + floats)]


_FIXED = ("GLfixed", "GLclampx")    # sixteen bits behind the point


def _converted(wanted, expression, given, flags):
    if given in _FIXED:
        return f"from_fixed({expression})"
    if "bits" in flags:
        return f"to_bits({expression})"
    if "norm" in flags:
        return f"to_fraction({expression})"
    return f"static_cast<{wanted}>({expression})"


def _convert_args(i, target):
    """The target's arguments: leading enums and indices as they are, vectors spread out, missing components filled."""
    given = []
    for p in i.command.params:
        if p.pointer:
            assert p.len and p.len.isdigit(), f"{i.place}: {i.name}: {p.name}: length unknown"
            given += [(f"{p.name}[{k}]", p.value_type) for k in range(int(p.len))]
        else:
            given.append((p.name, p.type))
    out = []
    for n, p in enumerate(target.params):
        if n >= len(given):
            last = n == len(target.params) - 1 and len(target.params) >= 4
            one = "to_bits(1)" if "bits" in i.flags else "1"
            out.append("255" if p.type == "GLubyte" else one if last else "0")
        elif given[n][1] == p.type:
            out.append(given[n][0])
        else:
            out.append(_converted(p.type, *given[n], i.flags))
    return out


def _param_entry(i, commands):
    family, form = commands.family_of(i.name)
    keys = commands.families[family]
    lead = [p.name for p in i.command.params[:-2]]
    pname, value = i.command.params[-2].name, i.command.params[-1].name
    table = f"c->table->{family}{keys['form']}"
    args = ", ".join(["*c"] + lead + [pname])
    if form in ("x", "xv"):
        return _fixed_param_entry(family, form, pname, value, f"{table}({args}, v);")
    if keys["form"] == "f":
        return [f"{table}({args}, static_cast<GLfloat>({value}));"]
    if keys["form"] == "i":
        return [f"{table}({args}, rounded_param({value}));"]
    if form.endswith("v"):
        return ["GLfloat v[4] = {};", f"convert_params(ParamFamily::{family}, {pname}, {value}, v);",
                f"{table}({args}, v);"]
    if form == "i" and keys.get("fractions"):
        return [f"const GLint given[4] = {{{value}}};", "GLfloat v[4] = {};",
                f"convert_params(ParamFamily::{family}, {pname}, given, v);", f"{table}({args}, v);"]
    refusal = []
    if keys.get("strict"):
        refusal = [f"if (refuses_one_value(*c, ParamFamily::{family}, {pname})) return c->error(GL_INVALID_ENUM);"]
    return [f"const GLfloat v[4] = {{static_cast<GLfloat>({value})}};", *refusal, f"{table}({args}, v);"]


def _fixed_param_entry(family, form, pname, value, call):
    """Words are given as they are, all else with sixteen bits behind the point. One value is given for one only."""
    given = value if form == "xv" else "given"
    lines = ["GLfloat v[4] = {};", f"convert_fixed(ParamFamily::{family}, {pname}, {given}, v);", call]
    if form == "xv":
        return lines
    return [f"const GLfixed given[4] = {{{value}}};",
            f"if (param_components(ParamFamily::{family}, {pname}) > 1) return c->error(GL_INVALID_ENUM);", *lines]
