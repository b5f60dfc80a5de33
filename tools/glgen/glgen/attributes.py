# SPDX-License-Identifier: MIT
"""Vertex attributes (proto/gl/attributes.toml) as values: elements of the state with the commands that set them."""

from dataclasses import dataclass

from . import data

INDICES = ("unit", "index")


@dataclass(frozen=True)
class Command:
    op: object      # wire.Op
    indexed: bool   # the first operand says which value
    form: str       # floats, bytes (four of one word), flag

    @property
    def floats(self):
        return len(self.op.operands) - self.indexed


@dataclass(frozen=True)
class Attribute:
    element: object     # state.Element
    place: int          # of its first value among all attributes' values
    commands: tuple
    array: object       # state.Element: its vertex arrays

    @property
    def name(self):
        return self.element.name

    @property
    def count(self):
        return self.element.count

    def of_floats(self, indexed):
        """The commands of floats by how many they take, of the first value or of any."""
        return {c.floats: c for c in self.commands if c.indexed == indexed and c.form == "floats"}

    def whole(self, indexed):
        """The command that says all of a value: of the first, or of any."""
        fitting = [c for c in self.commands if c.indexed == indexed]
        return fitting[-1] if fitting else None


def load(path, ops, model):
    file = data.load(path)
    by_name = {op.name: op for op in ops}
    elements = {e.name: e for e in model.elements if e.category == "current"}
    arrays = {name: _array(file, name, word, model) for name, word in file.sections["attribute_array"].items()}
    attributes, place = [], 0
    for name, words in file.sections["attribute"].items():
        with file.line("attribute", name):
            assert name in elements, "no element of [current] in state.toml"
            assert name in arrays, "no line in [attribute_array]"
            sets = tuple(_command(by_name, w) for w in words.split())
            attributes.append(Attribute(elements[name], place, sets, arrays[name]))
            one = elements[name].count == 1
            assert one or attributes[-1].whole(True), "several values need a command with an index"
            place += elements[name].count
    for name in sorted(set(arrays) - {a.name for a in attributes}):
        file.refuse(f"{name}: no line in [attribute]", "attribute_array", name)
    missing = sorted(set(elements) - {a.name for a in attributes})
    if missing:
        file.refuse(f"no line for {', '.join(missing)} of [current] in state.toml", "attribute")
    return attributes


def _array(file, name, word, model):
    """The element of an attribute's vertex arrays."""
    elements = {e.name: e for e in model.elements}
    with file.line("attribute_array", name):
        array = elements.get(word)
        assert array and array.cpp == "ClientArray", f"{word}: no vertex array in state.toml"
        assert name not in elements or array.count == elements[name].count, f"{word}: not as many as values"
    return array


def _command(by_name, word):
    assert word in by_name and by_name[word].group == "geometry", f"{word}: no command of [geometry] in wire.toml"
    op = by_name[word]
    indexed = op.operands[0].name in INDICES
    form = {"rgba": "bytes", "flag": "flag"}.get(op.operands[0].name, "floats")
    types = {o.type for o in op.operands[int(indexed):]}
    assert form != "floats" or types == {"f32"}, f"{word}: operands that are no floats"
    return Command(op, indexed, form)
