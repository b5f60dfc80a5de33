# SPDX-License-Identifier: MIT
"""The Khronos registry (gl.xml), and what is added to it, as values: every command with its signature, first version
and alias."""

import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Param:
    type: str   # C spelling, e.g. "const GLfloat *"
    name: str   # safe as a C++ identifier
    len: str | None = None  # of a pointer: number of values, name of a parameter, or COMPSIZE(...)

    @property
    def pointer(self):
        return self.type.endswith("*")

    @property
    def value_type(self):
        """What a pointer points to, without const; else the type itself."""
        return self.type.replace("const ", "").rstrip(" *") if self.pointer else self.type


@dataclass
class Command:
    name: str                   # with the gl prefix
    returns: str
    params: tuple               # of Param
    alias: str | None = None    # the command that this one is another name of, as gl.xml says
    gl: str | None = None       # first OpenGL version ("1.0"), compatibility profile
    es: str | None = None       # first OpenGL ES version
    core: bool = True           # false: the core profile of OpenGL does not have it
    extensions: list = field(default_factory=list)

    @property
    def short(self):
        """Name without the gl prefix."""
        return self.name[2:]

    @property
    def declaration(self):
        return ", ".join(f"{p.type} {p.name}".replace("* ", "*") for p in self.params)

    @property
    def types(self):
        return ", ".join(p.type for p in self.params)


@dataclass
class Names:
    """What a version or an extension has."""
    commands: set = field(default_factory=set)
    enums: set = field(default_factory=set)
    apis: set = field(default_factory=set)      # of an extension of OpenGL ES: "gles1", "gles2"

    def add(self, require):
        self.commands |= {item.get("name") for item in require.findall("command")}
        self.enums |= {item.get("name") for item in require.findall("enum")}


@dataclass
class Registry:
    commands: dict  # name -> Command
    enums: dict     # GL_NAME -> int (desktop GL and ES)
    removed: set = field(default_factory=set)       # GL_NAMEs of OpenGL that its core profile does not have
    core_enums: set = field(default_factory=set)    # those that it has
    es_features: dict = field(default_factory=dict)     # (major, minor) of OpenGL ES -> Names that came with it
    es_extensions: dict = field(default_factory=dict)   # of OpenGL ES, by name -> Names
    bitmasks: set = field(default_factory=set)      # GL_NAMEs that are bits of something

    def canonical(self, name):
        """Follows aliases to the command that is implemented."""
        seen = set()
        while self.commands[name].alias and name not in seen:
            seen.add(name)
            name = self.commands[name].alias
        return name


def _declared(element):
    """C type and name out of a <proto> or <param>."""
    name = element.find("name").text
    text = "".join(element.itertext()).strip()
    type_text = re.sub(r"\s+", " ", text[: text.rindex(name)]).strip()
    type_text = re.sub(r"\s*\*", " *", type_text)
    return type_text, name


_RESERVED = {"near": "near_", "far": "far_", "ref": "ref_", "string": "string_", "class": "class_", "c": "value"}


def _command(element):
    returns, name = _declared(element.find("proto"))
    params = []
    for p in element.findall("param"):
        type_text, pname = _declared(p)
        params.append(Param(type_text, _RESERVED.get(pname, pname), p.get("len")))
    alias = element.find("alias")
    return Command(name, returns, tuple(params), alias.get("name") if alias is not None else None)


def _version(text):
    return tuple(int(x) for x in text.split("."))


def _note_core_profile(gl, root):
    """What the core profile of the last version has: removed by one version, some of it came again by a later one."""
    features = sorted((f for f in root.findall("feature") if f.get("api") == "gl"),
                      key=lambda f: _version(f.get("number")))
    known, core = set(), set()
    for feature in features:
        for change in feature:
            names = {item.get("name") for item in change if item.tag in ("command", "enum")}
            if change.tag == "remove":
                core -= names
                continue
            known |= names
            if change.get("profile") != "compatibility":
                core |= names
    for name in known - core:
        if name in gl.commands:
            gl.commands[name].core = False
    gl.removed |= {name for name in known - core if name not in gl.commands}
    gl.core_enums |= {name for name in core if name not in gl.commands}


def _es_version(feature):
    """The registry calls OpenGL ES 1.1 by the number of 1.0, whose commands it has all."""
    number = _version(feature.get("number"))
    return (1, 1) if number == (1, 0) else number


def _note_es(gl, root):
    for feature in root.findall("feature"):
        if feature.get("api") in ("gles1", "gles2"):
            names = gl.es_features.setdefault(_es_version(feature), Names())
            for require in feature.findall("require"):
                names.add(require)
    for extension in root.find("extensions"):
        apis = {"gles1", "gles2"} & set(extension.get("supported", "").split("|"))
        if not apis:
            continue
        names = gl.es_extensions.setdefault(extension.get("name"), Names())
        names.apis |= apis
        for require in extension.findall("require"):
            # What is direct state access in desktop's form no library of OpenGL ES has.
            desktop = require.get("api") in ("gl", "glcore") or "EXT_direct_state_access" in require.get("comment", "")
            if not desktop:
                names.add(require)
    for block in root.findall("enums"):
        if block.get("type") == "bitmask":
            gl.bitmasks |= {item.get("name") for item in block.findall("enum")}


def load(path, *more):
    """The registry at `path`, and the files in its format that add to it."""
    gl = Registry({}, {})
    for each in (path, *more):
        _add(gl, ET.parse(each).getroot())
    _name_es_1_commands(gl)
    return gl


_SAME_TYPES = {"GLclampx": "GLfixed", "GLclampf": "GLfloat"}


def _signature(command):
    return [command.returns] + [_SAME_TYPES.get(p.type, p.type) for p in command.params]


def _name_es_1_commands(gl):
    """Extensions of OpenGL ES 1 have commands that only their OES tells from those of a version; the registry does not
    say that they are other names of them."""
    for extension in gl.es_extensions.values():
        for name in extension.commands if "gles1" in extension.apis else ():
            command, plain = gl.commands[name], gl.commands.get(name.removesuffix("OES"))
            if plain and plain is not command and not command.alias and _signature(command) == _signature(plain):
                command.alias = plain.name


def _add(gl, root):
    commands = gl.commands
    for element in root.find("commands"):
        command = _command(element)
        assert command.name not in commands, f"{command.name} twice"
        commands[command.name] = command
    for feature in root.findall("feature"):
        api, number = feature.get("api"), feature.get("number")
        if api not in ("gl", "gles1", "gles2"):
            continue
        for require in feature.findall("require"):
            for item in require.findall("command"):
                c = commands[item.get("name")]
                if api == "gl":
                    c.gl = min(c.gl or number, number, key=_version)
                else:
                    number = ".".join(map(str, _es_version(feature)))
                    c.es = min(c.es or number, number, key=_version)
    _note_core_profile(gl, root)
    _note_es(gl, root)
    for extension in root.find("extensions"):
        for require in extension.findall("require"):
            for item in require.findall("command"):
                commands[item.get("name")].extensions.append(extension.get("name"))
    for block in root.findall("enums"):
        for item in block.findall("enum"):
            if item.get("api") in (None, "gl", "gles2"):
                gl.enums[item.get("name")] = int(item.get("value"), 0)
