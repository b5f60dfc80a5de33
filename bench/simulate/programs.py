# SPDX-License-Identifier: MIT
"""The programs that are counted, measured and simulated."""
from __future__ import annotations

import dataclasses
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "tests" / "support")]
from traffic import ATLANTIS, record  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

ENDLESS = "1000000"  # frames
RECORDED = 30.0  # seconds of a program that is recorded


@dataclasses.dataclass(frozen=True)
class Subject:
    """`command` draws as fast as it can. What is counted and measured are its frames after `first`, by which it has
    said what it says once."""

    name: str
    command: list[str]
    what: str
    in_pieces: bool = False  # nodes leave out parts of its draws
    first: int = 20
    frames: int = 100  # that are counted
    recorded: bool = False  # each is another one: those that are measured are those that were counted


def subjects(folder: Path, x: XServer) -> list[Subject]:
    examples, bench = build_folder() / "examples", build_folder() / "bench"
    march = [str(examples / "march"), "--size", "800x600", "--frames", ENDLESS]
    return [
        Subject("atlantis", record(ATLANTIS, RECORDED, folder, x).silent_argv(),
                "xscreensaver's atlantis, recorded: immediate mode", frames=400, recorded=True),
        Subject("march", [*march, "--cells", "24"], "examples/march, 24 cells a side: all anew in each frame"),
        Subject("buffers", [str(bench / "buffers"), "--mesh", "1001x100", "--frames", ENDLESS],
                "bench/buffers: 200,200 triangles that the nodes keep", in_pieces=True),
    ]


def large_march() -> Subject:
    """For many processes."""
    return Subject("march-64", [str(build_folder() / "examples" / "march"), "--size", "800x600", "--cells", "64",
                                "--frames", ENDLESS], "examples/march, 64 cells a side", first=4, frames=16)
