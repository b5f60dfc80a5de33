# SPDX-License-Identifier: MIT
"""The programs that are counted, measured and simulated."""
from __future__ import annotations

import dataclasses
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "support"))
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

ATLANTIS = ["/usr/libexec/xscreensaver/atlantis", "--window", "--geometry", "1000x750", "-no-gradient"]
ENDLESS = "1000000"  # frames
RECORDED = 30.0  # seconds of a program that is recorded


@dataclasses.dataclass(frozen=True)
class Subject:
    """`command` draws as fast as it can. What is counted and measured are its frames after `first`, by which it has
    said what it says once."""

    name: str
    command: list[str]
    what: str
    parallel: bool = False  # it can be of several processes
    in_pieces: bool = False  # nodes leave out parts of its draws
    first: int = 20
    frames: int = 100  # that are counted
    recorded: bool = False  # each is another one: those that are measured are those that were counted


def record_atlantis(folder: Path, x: XServer) -> Path:
    """So that every wall gets the same frames."""
    clip = folder / "atlantis.trace"
    process = subprocess.Popen(["apitrace", "trace", "--api=egl", "-o", clip, *ATLANTIS], env=x.environment(),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    time.sleep(RECORDED)
    os.killpg(process.pid, signal.SIGINT)
    process.wait(30)
    return clip


def subjects(folder: Path, x: XServer) -> list[Subject]:
    examples, bench = build_folder() / "examples", build_folder() / "bench"
    march = [str(examples / "march"), "--size", "800x600", "--frames", ENDLESS]
    return [
        Subject("atlantis", ["eglretrace", "-b", str(record_atlantis(folder, x))],
                "xscreensaver's atlantis, recorded: immediate mode", frames=400, recorded=True),
        Subject("march", [*march, "--cells", "24"], "examples/march, 24 cells a side: all anew in each frame",
                parallel=True),
        Subject("buffers", [str(bench / "buffers"), "--mesh", "1001x100", "--frames", ENDLESS],
                "bench/buffers: 200,200 triangles that the nodes keep", in_pieces=True),
    ]


def large_march() -> Subject:
    """For many processes."""
    return Subject("march-64", [str(build_folder() / "examples" / "march"), "--size", "800x600", "--cells", "64",
                                "--frames", ENDLESS], "examples/march, 64 cells a side", parallel=True, first=4,
                   frames=16)
