#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Recordings of commands (docs/recordings.md): whether real programs look as they did when they are shown again, on
three other walls from random frames on, and how large a recording is beside lossless video of the same frames.

Each program is held, so that its frames can be looked at one after the other while it is recorded on 2x2 tiles. Then
each wall begins at some random frames, and shows that frame and the one behind it. All pixels must be the same:
- where tiles lie as they did, as the program's own;
- where they lie otherwise, and a driver therefore rounds otherwise, as the program's own if that draws by the number of
  the frame and so can be looked at there, too; of other programs as the recording when it is shown there from its
  beginning, and how many pixels of that differ from the program's by more than rounding (2 of 255) is said.

recordings.py [--frames N] [--starts N] [--only NAME]... [--seed N] [--json FILE]     exit code 1 if a picture is wrong
"""
from __future__ import annotations

import argparse
import contextlib
import dataclasses
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from wall import Wall, build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

WINDOW = (480, 360)
RECT = (0, 0, *WINDOW)
ROUNDING = 2  # of 255
SNAPSHOT_SECONDS = 1  # so that the frames are in several segments
LIMIT = 60.0
HACKS = "/usr/libexec/xscreensaver/"
GEOMETRY = "{}x{}".format(*WINDOW)
EXAMPLES = build_folder() / "examples"


@dataclasses.dataclass(frozen=True)
class Program:
    name: str
    command: list[object]
    by_frame: bool = False  # what it draws depends on the frame's number alone


def hack(name: str) -> Program:
    return Program(name, [HACKS + name, "--window", "--geometry", GEOMETRY])


def glmark2(scene: str) -> Program:
    return Program(scene, ["glmark2", "-s", GEOMETRY, "-b", f"{scene}:duration=1000"])


PROGRAMS = [Program("march", [EXAMPLES / "march", "--size", GEOMETRY, "--cells", "24", "--frames", "1000000"], True),
            Program("volume", [EXAMPLES / "volume", "--size", GEOMETRY, "--frames", "1000000"], True),
            Program("glxgears", ["glxgears", "-geometry", GEOMETRY]), Program("es2gears", ["es2gears_x11"]),
            *map(hack, ("atlantis", "flurry", "pipes", "euphoria")),
            *map(glmark2, ("shadow", "buffer", "refract", "terrain"))]


@dataclasses.dataclass(frozen=True)
class Other:
    """A wall that a recording is shown on."""

    name: str
    same: bool  # its tiles lie as those on which it was recorded
    options: dict


VIDEO = [("ffv1", "bgr0"), ("huffyuv", "bgr24")]  # FFmpeg's names
# A program that is held goes on by itself when the time limit is over; with threads, llvmpipe rounds from run to run.
PATIENT = {"swap_timeout_ms": 10000, "environment": {"LP_NUM_THREADS": "0"}}
RECORDED_ON = {"tiles": (2, 2), "tile_size": (240, 180), **PATIENT}
OTHERS = [Other("2x2 on one node", True, {"tiles": (2, 2), "tile_size": (240, 180), "one_node": True, **PATIENT}),
          Other("1x1", False, {"tiles": (1, 1), "tile_size": (480, 360), **PATIENT}),
          Other("3x2", False, {"tiles": (3, 2), "tile_size": (160, 180), **PATIENT})]


@dataclasses.dataclass
class Result:
    name: str
    frames: int
    segments: int
    commands: float  # bytes a frame, of the recording
    plain: float  # before coding
    ffv1: float  # as video, bytes a frame
    huffyuv: float
    first: int = -1  # of the pictures is the first of the recording
    compared: int = 0
    otherwise: int = 0  # most pixels that other tiles show otherwise, by more than rounding
    wrong: list[str] = dataclasses.field(default_factory=list)


def picture(wall: Wall) -> numpy.ndarray:
    whole = cv2.imdecode(numpy.frombuffer(wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)
    return whole[:WINDOW[1], :WINDOW[0]]


def video_bytes(pictures: list[numpy.ndarray], codec: str, pixels: str) -> int:
    """Of the pictures as FFmpeg codes them without loss."""
    with tempfile.NamedTemporaryFile(suffix=".avi") as file:
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "bgr24", "-s", GEOMETRY, "-i", "-",
                        "-c:v", codec, "-pix_fmt", pixels, file.name],
                       input=b"".join(each.tobytes() for each in pictures), check=True)
        return Path(file.name).stat().st_size


def begin_recording(wall: Wall, session: int, path: Path) -> subprocess.Popen:
    recorder = subprocess.Popen(
        [wall.bin / "wallctl", "--walld", wall.address, "--json", "record", "--commands", str(session), path,
         "--seconds", "3600", "--snapshot", str(SNAPSHOT_SECONDS)], stdout=subprocess.PIPE, text=True)
    end = time.monotonic() + LIMIT
    while not any(each["id"] == session and each["recorded"] for each in wall.sessions()):
        if recorder.poll() is not None or time.monotonic() > end:
            raise RuntimeError("it is not recorded")
        time.sleep(0.02)
    return recorder


def held(wall: Wall, program: Program, x: XServer) -> int:
    """The session of the program, which has shown its first frame."""
    app = wall.run(*program.command, rect=RECT, hold=True, env=x.environment(), stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    session = wall.wait_session(app)
    wall.step(session)
    wall.wait(session, 1)
    return session


def next_pictures(wall: Wall, session: int, shown: int, frames: int) -> list[numpy.ndarray]:
    """Those of so many frames behind the one that is shown."""
    pictures = []
    for number in range(shown + 1, shown + frames + 1):
        wall.step(session)
        wall.wait(session, number)
        pictures.append(picture(wall))
    return pictures


def record(program: Program, frames: int, x: XServer, path: Path) -> tuple[list[numpy.ndarray], dict]:
    """The pictures of a program's frames from the second on, and what wallctl says of the recording that begins within
    the first of them (a program is some frames ahead of what is shown)."""
    with Wall(**RECORDED_ON) as wall:
        session = held(wall, program, x)
        recorder = begin_recording(wall, session, path)
        pictures = next_pictures(wall, session, 1, frames)
        recorder.send_signal(signal.SIGINT)
        said, _ = recorder.communicate(timeout=LIMIT)
    return pictures, json.loads(said)


def played(wall: Wall, path: Path, frame: int, frames: int) -> list[numpy.ndarray]:
    """The pictures of a recording's frames, from that one on."""
    player = wall.run_line([str(word) for word in (
        wall.bin / "wallplay", "--walld", wall.address, path, "--rect", ",".join(map(str, RECT)), "--frame", frame,
        "--frames", frames, "--stay")], env=dict(os.environ, WALLGL_HOLD="1"))
    pictures = next_pictures(wall, wall.wait_session(player), 0, frames)
    end_all([player])
    return pictures


def first_recorded(pictures: list[numpy.ndarray], given: list[numpy.ndarray]) -> int:
    """Which of the program's pictures the recording begins with; -1: none."""
    for first in range(len(pictures) - len(given) + 1):
        if all((a == b).all() for a, b in zip(pictures[first:], given, strict=False)):
            return first
    return -1


def references(program: Program, wall: Wall, other: Other, path: Path, pictures: list[numpy.ndarray], x: XServer,
               result: Result) -> list[numpy.ndarray]:
    """What the wall must show of the frames: `pictures` on the wall where they were recorded."""
    if other.same:
        return pictures
    if program.by_frame:
        session = held(wall, program, x)
        all_of_it = next_pictures(wall, session, 1, result.first + len(pictures))
        wall.ctl("close", session)
        return all_of_it[result.first:]
    straight = played(wall, path, 1, len(pictures))
    for ours, theirs in zip(straight, pictures, strict=True):
        differing = (cv2.absdiff(ours, theirs).max(axis=2) > ROUNDING).sum()
        result.otherwise = max(result.otherwise, int(differing))
    return straight


def examine(program: Program, options: argparse.Namespace, walls: list[Wall], x: XServer,
            chance: random.Random) -> Result:
    with tempfile.TemporaryDirectory(prefix="wallgl-") as folder:
        path = Path(folder) / f"{program.name}.wgl"
        pictures, summary = record(program, options.frames, x, path)
        told = json.loads(subprocess.run([walls[0].bin / "wallplay", "--info", "--json", path], check=True,
                                         capture_output=True, text=True).stdout)
        result = Result(program.name, summary["frames"], len(told["segments"]),
                        summary["bytes"] / summary["frames"], summary["plain_bytes"] / summary["frames"],
                        *(video_bytes(pictures, *codec) / len(pictures) for codec in VIDEO))
        result.first = first_recorded(pictures, played(walls[0], path, 1, options.frames // 2))
        if result.first < 0:
            result.wrong.append("its first frames are none that were seen")
            return result
        pictures = pictures[result.first:][:summary["frames"]]
        for other, wall in zip(OTHERS, walls, strict=True):
            expected = references(program, wall, other, path, pictures, x, result)
            for start in sorted(chance.sample(range(1, len(expected)), options.starts)):
                for frame, given in zip((start, start + 1), played(wall, path, start, 2), strict=True):
                    unequal = int((given != expected[frame - 1]).any(axis=2).sum())
                    result.compared += 1
                    if unequal:
                        result.wrong.append(f"{other.name}, frame {frame}, from {start} on: {unequal} pixels differ")
        return result


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--frames", type=int, default=40, help="of each program")
    arguments.add_argument("--starts", type=int, default=10, help="on each wall")
    arguments.add_argument("--only", action="append", choices=[each.name for each in PROGRAMS], metavar="NAME")
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    chance = random.Random(options.seed)
    results = []
    print(f"{'program':10} {'frames':>6} {'segments':>8} {'commands':>9} {'uncoded':>9} {'FFV1':>8} {'HuffYUV':>8}"
          f" {'pictures':>8} {'wrong':>5} {'otherwise':>9}   (bytes a frame; pixels)")
    with contextlib.ExitStack() as stack:
        x = stack.enter_context(XServer())
        walls = [stack.enter_context(Wall(**other.options)) for other in OTHERS]
        for program in PROGRAMS:
            if options.only and program.name not in options.only:
                continue
            if not shutil.which(program.command[0]):
                print(f"{program.name:10} is not installed")
                continue
            each = examine(program, options, walls, x, chance)
            results.append(each)
            print(f"{each.name:10} {each.frames:6} {each.segments:8} {each.commands:9.0f} {each.plain:9.0f}"
                  f" {each.ffv1:8.0f} {each.huffyuv:8.0f} {each.compared:8} {len(each.wrong):5}"
                  f" {each.otherwise:9}", flush=True)
            print("".join(f"    {line}\n" for line in each.wrong), end="")
    if options.json:
        options.json.write_text(json.dumps([dataclasses.asdict(each) for each in results], indent=1) + "\n")
    return 1 if not results or any(each.wrong for each in results) else 0


if __name__ == "__main__":
    sys.exit(main())
