# SPDX-License-Identifier: MIT
"""Every GL command with its class and how it is done (proto/gl/commands.toml over gl.xml)."""

import re
from dataclasses import dataclass

from . import data

CLASSES = ("primitive", "state", "object", "query", "special")
LISTED = {"primitive": True, "state": True, "special": True, "object": False, "query": False}
WAYS = ("hand", "state", "param", "caps", "convert", "as", "named", "later")
# named: which object is bound while it is done -> the class of client_lib/context/named_objects.h that binds it
NAMED = {"buffer": "NamedBuffer", "texture": "NamedTexture", "image": "NamedImage", "framebuffer": "NamedFramebuffer",
         "renderbuffer": "NamedRenderbuffer", "array": "NamedVertexArray"}
FLAGS = {"inside", "list", "nolist", "record", "hot", "compat", "norm", "bits", "packed"} | NAMED.keys()


@dataclass
class Implementation:
    command: object         # registry.Command
    cls: str                # one of CLASSES
    way: str                # one of WAYS
    target: str = ""        # convert, as, named: short name of the command that does it
    args: tuple = ()        # as: its arguments
    flags: frozenset = frozenset()
    explicit: bool = True   # has a line
    place: str = "commands.toml"    # of that line

    @property
    def name(self):
        return self.command.short

    @property
    def later(self):
        return self.way == "later"

    @property
    def in_list(self):
        return "list" in self.flags or (LISTED[self.cls] and "nolist" not in self.flags)

    @property
    def in_core(self):
        """Core profiles have it."""
        return self.command.core and "compat" not in self.flags

    @property
    def binder(self):
        """named: the class that binds its object."""
        found = [NAMED[f] for f in self.flags if f in NAMED]
        assert len(found) == 1, f"{self.place}: {self.name}: one of {', '.join(NAMED)} is named"
        return found[0]

    @property
    def status(self):
        """As docs/opengl-coverage.md calls it."""
        if self.later:
            return "not yet"
        return "tracked" if self.cls == "state" else "supported"


@dataclass
class Commands:
    all: dict           # full name -> Implementation; aliases share one
    families: dict      # from state.toml

    @property
    def canonical(self):
        """Implemented commands with a place in the dispatch table, by name."""
        return [i for i in self.unique if self.has_slot(i)]

    @property
    def unique(self):
        seen = {i.name: i for i in self.all.values()}
        return [seen[n] for n in sorted(seen)]

    def has_slot(self, i):
        if i.way in ("later", "convert", "as"):
            return False
        if i.way == "param" and i.cls != "query":
            family, form = self.family_of(i.name)
            return self.families[family]["form"] == form
        return True

    def family_of(self, name):
        """Fogiv -> (Fog, iv), TexGenxOES -> (TexGen, x)."""
        for family in sorted(self.families, key=len, reverse=True):
            if name.startswith(family):
                form = name[len(family):].removesuffix("OES") or "plain"
                if form in self.families[family]["types"].split():
                    return family, form
        raise AssertionError(f"{name}: no family in state.toml has this form")


_LINE = re.compile(r"^(?P<way>\w+)(?: (?P<target>[A-Z]\w*)(?:\((?P<args>[^)]*)\))?)?(?P<flags>(?: [a-z]+)*)$")


def _parse(command, cls, line):
    m = _LINE.match(line)
    assert m and m["way"] in WAYS, repr(line)
    flags = frozenset(m["flags"].split())
    assert flags <= FLAGS, f"unknown words {flags - FLAGS}"
    args = tuple(a.strip() for a in m["args"].split(",")) if m["args"] else ()
    return Implementation(command, cls, m["way"], m["target"] or "", args, flags)


def load(path, registry, model):
    file = data.load(path)
    lines = {}
    for cls, entries in file.sections.items():
        if cls not in CLASSES:
            file.refuse(f"no class {cls}", cls)
        for name, line in entries.items():
            with file.line(cls, name):
                full = "gl" + name
                assert full in registry.commands, f"no command {full} in gl.xml or extensions.xml"
                assert full not in lines, "twice"
                lines[full] = _parse(registry.commands[full], cls, line)
                lines[full].place = file.place(cls, name)
    everything = {}
    for name, command in registry.commands.items():
        everything[name] = lines.get(name) or _inherited(name, registry, lines) or _by_rule(command, path)
    commands = Commands(everything, model.families)
    _check(commands, registry)
    return commands


def _aliases(name, registry):
    while registry.commands[name].alias:
        name = registry.commands[name].alias
        yield name


def _inherited(name, registry, lines):
    return next((lines[a] for a in _aliases(name, registry) if a in lines), None)


def _by_rule(command, path):
    assert not command.gl and not command.es, f"{path}: {command.short} of the OpenGL core has no class"
    cls = "query" if re.match(r"(Get|Is)[A-Z]", command.short) else "object"
    return Implementation(command, cls, "later", explicit=False)


def _check(commands, registry):
    slots = {i.name for i in commands.canonical}
    for i in commands.all.values():
        if i.target:
            assert i.target in slots, f"{i.place}: {i.name}: {i.target} is not implemented itself"
        if i.name in slots and i.in_list:
            assert i.command.returns == "void", f"{i.place}: {i.name}: a listed command returns nothing"
