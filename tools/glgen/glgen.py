#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Generates everything that follows from gl.xml, proto/gl/extensions.xml and proto/gl/*.toml.

    glgen.py --registry gl.xml --proto proto/gl --out build/release/generated/gen
    glgen.py --registry gl.xml --proto proto/gl --coverage docs/opengl-coverage.md [--check]

Python 3.11, standard library only. Files are written only when their text changes. --check writes nothing and fails if
the file is not current.
"""

import argparse
import pathlib
import sys
from dataclasses import dataclass

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from glgen import attributes, commands, es, registry, state, texture_targets, wire  # noqa: E402
from glgen import emit_attributes, emit_client, emit_docs, emit_es, emit_functions, emit_samples  # noqa: E402
from glgen import emit_setters, emit_state, emit_texture_targets, emit_wire  # noqa: E402

DRIVER_EXTRA = ["glBindProgramARB", "glBlendBarrierKHR", "glDeleteProgramsARB", "glFramebufferParameteriMESA",
                "glGenProgramsARB", "glGetFramebufferParameterivMESA", "glGetProgramivARB",
                "glProgramEnvParameter4fvARB", "glProgramLocalParameter4fvARB", "glProgramStringARB"]


@dataclass
class Model:
    gl: registry.Registry
    ops: list
    state: state.StateModel
    attributes: list
    textures: list
    api: commands.Commands
    es: es.EsModel


def load(registry_path, proto):
    gl = registry.load(registry_path, proto / "extensions.xml")
    elements = state.load(proto / "state.toml")
    ops = wire.load(proto / "wire.toml")
    api = commands.load(proto / "commands.toml", gl, elements)
    return Model(gl, ops, elements, attributes.load(proto / "attributes.toml", ops, elements),
                 texture_targets.load(proto / "texture_targets.toml", gl, elements),
                 api, es.load(proto / "es.toml", gl, api))


def generate(m):
    """All generated sources: name below gen/ -> text."""
    return {
        "glapi/wire.gen.h": emit_wire.wire_header(m.ops, m.state.elements),
        "glapi/decode.gen.h": emit_wire.decode_header(m.ops),
        "glapi/null_handler.gen.h": emit_wire.null_handler_header(m.ops),
        "glapi/gl_functions.gen.h": emit_functions.functions_header(m.gl, DRIVER_EXTRA),
        "glapi/texture_targets.gen.h": emit_texture_targets.targets_header(m.textures),
        "glstate/texture_elements.gen.h": emit_texture_targets.elements_header(m.textures),
        "glstate/state.gen.h": emit_state.state_header(m.state),
        "glstate/attributes.gen.h": emit_attributes.attributes_header(m.attributes),
        "glstate/tables.gen.h": emit_state.tables_header(m.state),
        "glstate/state_tables.gen.cpp": emit_state.tables_source(m.state, m.gl),
        "glstate/driver_emit.gen.h": emit_state.driver_header(m.state, m.gl),
        "glstate/samples.gen.h": emit_samples.samples_header(m.state),
        "client_lib/api.gen.h": emit_client.api_header(m.api, m.state, m.attributes),
        "client_lib/entries.gen.cpp": emit_client.entries_source(m.api, m.gl),
        "client_lib/tables.gen.cpp": emit_client.tables_source(m.api, m.attributes, m.gl),
        "client_lib/es.gen.h": emit_es.es_header(m.es),
        "client_lib/es_images.gen.h": emit_es.images_header(m.es),
        "client_lib/es_tables.gen.cpp": emit_es.es_source(m.es),
        "client_lib/state_api.gen.cpp": emit_setters.setters_source(m.api, m.state, m.gl),
    }


def write_if_changed(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--registry", type=pathlib.Path, required=True)
    parser.add_argument("--proto", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--coverage", type=pathlib.Path)
    parser.add_argument("--check", action="store_true")
    args = parser.parse_args()
    try:
        model = load(args.registry, args.proto)
        texts = generate(model) if args.out else {}
    except AssertionError as wrong:
        sys.exit(f"glgen: {wrong}")
    for name, text in texts.items():
        write_if_changed(args.out / name, text)
    if args.coverage:
        text = emit_docs.coverage(model.api, model.state, model.ops, model.es)
        if args.check and (not args.coverage.exists() or args.coverage.read_text() != text):
            sys.exit(f"glgen: {args.coverage} is not current: run `ninja coverage-doc`")
        if not args.check:
            write_if_changed(args.coverage, text)


if __name__ == "__main__":
    main()
