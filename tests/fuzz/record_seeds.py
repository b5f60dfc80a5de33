#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes inputs of fuzz_executor of what real programs send: plays the recordings of the golden tests on a wall, listens
on the way to the nodes, and writes each small batch that needs no shader as a file of its own into FOLDER. Then
`fuzz_executor -merge=1 tests/fuzz/corpus/fuzz_executor FOLDER` keeps those that reach code that no other input does.

record_seeds.py FOLDER [NAME]...     NAME: only these recordings"""
from __future__ import annotations

import argparse
import contextlib
import hashlib
import re
import struct
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "support"), str(ROOT / "tests" / "golden")]
from subjects import load_recordings  # noqa: E402
from tap import Tap  # noqa: E402
from wall import Wall, build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

TILES, TILE = (2, 1), (160, 120)
MOST_BYTES = 6000  # of an input
MOST_SECONDS = 10.0  # of a recording
BATCH_HEADER = struct.Struct("<III")  # common/wire/frame.h
WITHOUT = {"ShaderCompile", "ProgramLink"}  # Mesa's compiler has faults of its own


def opcodes() -> list[str]:
    text = (build_folder() / "generated" / "gen" / "glapi" / "wire.gen.h").read_text()
    return re.findall(r'"(\w+)"', re.search(r"kOpNames = \{(.*?)\}", text, re.DOTALL).group(1))


class Seeds:
    def __init__(self, folder: Path):
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        self.without = {number for number, name in enumerate(opcodes()) if name in WITHOUT}

    def take(self, payload: bytes) -> None:
        """A batch, as tests/fuzz/batch_input.h makes one of an input."""
        _, codes, operands = BATCH_HEADER.unpack_from(payload)
        begin = BATCH_HEADER.size + -codes % 4
        ops = payload[begin:begin + codes]
        if not codes or codes + operands > MOST_BYTES or self.without & set(ops):
            return
        seed = struct.pack("<H", codes) + payload[begin:begin + codes + operands]
        (self.folder / hashlib.sha1(seed).hexdigest()).write_bytes(seed)


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("names", nargs="*", metavar="NAME")
    options = arguments.parse_args()
    seeds = Seeds(options.folder)
    with XServer() as x, Wall(TILES, TILE) as wall:
        for name in wall.node_names:
            Tap(wall.folder / f"{name}.sock", seeds.take)
        for recording in load_recordings():
            if options.names and recording.name not in options.names:
                continue
            player = wall.run("eglretrace" if recording.api == "egl" else "glretrace", "--singlethread", recording.path,
                              rect=(0, 0, TILES[0] * TILE[0], TILE[1]), stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, env=x.environment(WALLGL_RING="0", **recording.environment()))
            with contextlib.suppress(subprocess.TimeoutExpired):
                player.wait(MOST_SECONDS)
            end_all([player])
            print(f"{recording.name}: {len(list(options.folder.iterdir()))} inputs", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
