#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Generates everything that follows from gl.xml and proto/gl/*.toml.

    glgen.py --registry gl.xml --proto proto/gl --out build/release/generated/gen [--coverage docs/opengl-coverage.md]

Python 3.11, standard library only. Files are written only when their text changes.
"""

import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from glgen import commands, emit_client, emit_functions, emit_setters, emit_state, emit_wire, registry, state, wire  # noqa: E402

DRIVER_EXTRA = ["glFramebufferParameteriMESA", "glGetFramebufferParameterivMESA"]


def generate(registry_path, proto):
    """All generated files: name below gen/ -> text."""
    gl = registry.load(registry_path)
    ops = wire.load(proto / "wire.toml")
    model = state.load(proto / "state.toml")
    api = commands.load(proto / "commands.toml", gl, model)
    return {
        "glapi/wire.gen.h": emit_wire.wire_header(ops),
        "glapi/decode.gen.h": emit_wire.decode_header(ops),
        "glapi/null_handler.gen.h": emit_wire.null_handler_header(ops),
        "glapi/gl_functions.gen.h": emit_functions.functions_header(gl, DRIVER_EXTRA),
        "glstate/state.gen.h": emit_state.state_header(model),
        "glstate/tables.gen.h": emit_state.tables_header(model),
        "glstate/state_tables.gen.cpp": emit_state.tables_source(model, gl),
        "glstate/driver_emit.gen.h": emit_state.driver_header(model, gl),
        "client_lib/api.gen.h": emit_client.api_header(api, model),
        "client_lib/entries.gen.cpp": emit_client.entries_source(api, gl),
        "client_lib/tables.gen.cpp": emit_client.tables_source(api),
        "client_lib/state_api.gen.cpp": emit_setters.setters_source(api, model, gl),
    }


def write_if_changed(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--registry", type=pathlib.Path, required=True)
    parser.add_argument("--proto", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    args = parser.parse_args()
    for name, text in generate(args.registry, args.proto).items():
        write_if_changed(args.out / name, text)


if __name__ == "__main__":
    main()
