# SPDX-License-Identifier: MIT
"""The data stream's commands (proto/gl/wire.toml) as values."""

from dataclasses import dataclass, field

from . import data

CPP = {"u32": "std::uint32_t", "i32": "std::int32_t", "f32": "float", "f64": "double", "enum": "std::uint32_t"}
SIZE = {"u32": 4, "i32": 4, "f32": 4, "f64": 8, "enum": 4}
# Types of common/base/ids.h: a u32 in the stream.
IDS = {"surface": "SurfaceId", "context": "ContextId", "request": "RequestId", "object": "ClientName"}


@dataclass(frozen=True)
class Operand:
    type: str   # in the stream: key of CPP, or "bytes"
    name: str
    id: str = field(default="", repr=False)     # what the number is called in C++, of IDS; it is nothing to the stream

    @property
    def cpp(self):
        return self.id or CPP[self.type]

    @staticmethod
    def parse(text):
        kind, name = text.split()
        assert kind in CPP or kind in IDS or kind == "bytes", f"unknown type {kind}"
        return Operand("u32", name, IDS[kind]) if kind in IDS else Operand(kind, name)


@dataclass(frozen=True)
class Op:
    code: int
    name: str
    group: str
    operands: tuple     # of Operand, without a trailing bytes operand
    bytes_name: str     # name of the trailing bytes operand, or ""
    is_state: bool      # State: an element id, then a value of the element's own size

    @property
    def asks(self):
        """Its first operand is a request, which the node answers."""
        return bool(self.operands) and self.operands[0].id == IDS["request"]

    @property
    def fixed_bytes(self):
        """Operand bytes before the content of a bytes operand or a state value; its count included."""
        return sum(SIZE[o.type] for o in self.operands) + (4 if self.bytes_name or self.is_state else 0)


def load(path):
    file = data.load(path)
    ops = []
    for group, commands in file.sections.items():
        for name, signature in commands.items():
            with file.line(group, name):
                ops.append(_op(len(ops), name, group, signature))
                assert len(ops) <= 256, "opcodes are one byte"
    return ops


def _op(code, name, group, signature):
    if signature == "value":
        return Op(code, name, group, (), "", True)
    operands = [Operand.parse(part) for part in signature.split(",") if part.strip()]
    bytes_name = ""
    if operands and operands[-1].type == "bytes":
        bytes_name = operands.pop().name
    assert all(o.type != "bytes" for o in operands), "bytes come last"
    return Op(code, name, group, tuple(operands), bytes_name, False)
