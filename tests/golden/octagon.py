#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Eight tiles around the user (docs/walls.md, "Views"; OCTAVIS, section 2): each shows, pixel by pixel, what plain Mesa
draws with the matrices of that view (moved/views.h), and what the program reads back is its own view still.

octagon.py [--report FOLDER] [SUBJECT...]
"""
from __future__ import annotations

import argparse
import contextlib
import math
import os
import struct
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))

import cv2  # noqa: E402
import numpy as np  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from stages import MesaStage, Performance, Session, decode_png, mesa_environment  # noqa: E402
from subjects import WINDOW, Play, Subject, load_recordings, load_scenes  # noqa: E402
from wall import WallError, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

SIDES = 8
FOV = 45.0  # degrees, of a side
SUBJECTS = ("around", "atlantis", "solarwinds", "glxgears", "dangerball", "named_camera")
CAMERAS = {"named_camera": "camera,matrices[1]"}  # uniforms that hold them, where nobody finds them in the shaders


def to_single(value: float) -> float:
    return struct.unpack("f", struct.pack("f", value))[0]


def view_of(yaw: float, window: tuple[int, int]) -> str:
    """The 16 numbers of geom::values_of() of a view for both eyes, from the angles as wall.toml says them."""
    degree = math.pi / 180
    height = 2 * math.atan(math.tan(FOV * degree / 2) * (window[1] / window[0])) / degree
    aside, up = math.tan(FOV * degree / 2), math.tan(height * degree / 2)
    sin, cos = math.sin(yaw * degree), math.cos(yaw * degree)
    return " ".join(repr(to_single(number)) for number in
                    (1, cos, 0, -sin, 0, 1, 0, sin, 0, cos, -aside, aside, -up, up, 0, 1))


class Octagon:
    """Two nodes of four sides each."""

    def __init__(self, x: XServer):
        self._x = x
        width, height = WINDOW
        sides = {f"side{i}": (i * width, 0, width, height) for i in range(SIDES)}
        names = list(sides)
        keys = {name: f"yaw = {i * 360 / SIDES}\nfov = {FOV}" for i, name in enumerate(names)}
        self.rect = (0, 0, SIDES * width, height)
        self.sides = names
        half = SIDES // 2
        plan = {"front": {n: sides[n] for n in names[:half]}, "back": {n: sides[n] for n in names[half:]}}
        self.wall = PlannedWall(plan, keys, die_with_parent=True, swap_timeout_ms=10000, name="octagon")

    def play(self, subject: Subject) -> tuple[Performance, dict[tuple[int, int], np.ndarray]]:
        """And each side's picture of each frame that can be looked at, by (frame, side). Of the first frame nobody
        knows yet that there is a camera."""
        given, sides = Performance(), {}
        prefix = self.wall.wallrun(rect=self.rect, name=subject.name, camera=CAMERAS.get(subject.name, ""))
        play = Play(subject, self._x.environment(vblank_mode="0"), prefix)
        session = Session(self.wall, play.pid)
        for number, frame in enumerate(play.frames()):
            given.read.append(frame)
            if number >= 1 and number in subject.shown:
                try:
                    session.wait_shown(number + 1, wait_a_moment=False)
                    for side, name in enumerate(self.sides):
                        sides[number, side] = decode_png(self.wall.screenshot(tile=name))
                except (WallError, ValueError) as problem:
                    given.problems.append(f"frame {number}: {problem}")
            play.go_on()
        given.end(play)
        return given, sides


class ViewStage:
    """One side on plain Mesa."""

    def __init__(self, x: XServer):
        library = build_folder() / "tests" / "moved"
        self._environment = mesa_environment(x) | {
            "__GLX_VENDOR_LIBRARY_NAME": "moved", "LD_LIBRARY_PATH": str(library),
            "__EGL_VENDOR_LIBRARY_FILENAMES": str(library / "moved.json"), "GOLDEN_TILE": "0"}

    @staticmethod
    def _camera(subject: Subject) -> dict[str, str]:
        return {"GOLDEN_CAMERA": CAMERAS[subject.name]} if subject.name in CAMERAS else {}

    def play(self, subject: Subject, side: int) -> Performance:
        width, height = subject.window
        given = Performance()
        with tempfile.NamedTemporaryFile(prefix="golden-share-") as share:
            play = Play(subject, self._environment | {
                "GOLDEN_TILES": f"{width},{height};0,0,{width},{height}", "GOLDEN_SHARE": share.name,
                "GOLDEN_VIEW": view_of(side * 360 / SIDES, subject.window)} | self._camera(subject))
            for frame in play.frames():
                given.read.append(frame)
                play.go_on()
            given.end(play)
        return given


def judge(subject: Subject, octagon: Octagon, plain: MesaStage, stage: ViewStage, report: Path | None) -> list[str]:
    """What is wrong."""
    wrong: list[str] = []
    given, shown = octagon.play(subject)
    wrong += given.problems
    if given.exit_code != 0 or not shown:
        return [*wrong, f"exit code {given.exit_code}, {len(shown)} pictures: {given.errors[-500:]}"]
    own = plain.play(subject)
    for number in subject.compared:
        if number == 0:  # flat, and so at the scale of the canvas
            continue
        if number >= len(given.read) or not (own.read[number] == given.read[number]).all():
            wrong.append(f"frame {number}: what the program reads back is not its own view")
    if own.text != given.text:
        wrong.append(f"it says {given.text[:3]}, on plain Mesa {own.text[:3]}")
    lit = 0
    for side in range(SIDES):
        reference = stage.play(subject, side)
        if reference.exit_code != 0:
            wrong.append(f"side {side}: no reference: {reference.errors[-300:]}")
            continue
        for number in sorted({number for number, of_side in shown if of_side == side}):
            seen, right = shown[number, side], reference.read[number]
            lit += int((right != right[0, 0]).any())
            apart = int((seen != right).any(axis=2).sum()) if seen.shape == right.shape else -1
            if apart == 0:
                continue
            wrong.append(f"frame {number}, side {side}: {apart} pixels differ")
            if report and apart > 0:
                report.mkdir(parents=True, exist_ok=True)
                both = np.concatenate([seen, right], axis=1)
                cv2.imwrite(str(report / f"{subject.name}-{number}-{side}.png"), both[:, :, ::-1])
    if lit < 2:
        wrong.append("fewer than two pictures have anything to see")
    print(f"{subject.name}: {len(shown)} pictures of sides, {lit} with something to see: "
          f"{'same' if not wrong else '; '.join(wrong[:5])}", flush=True)
    return wrong


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--report", type=Path, help="folder for pictures that differ: the side's, Mesa's")
    options.add_argument("subjects", nargs="*", default=SUBJECTS)
    given = options.parse_args()
    subjects = {s.name: s for s in [*load_scenes(build_folder() / "tests" / "golden_scenes"), *load_recordings()]}
    unknown = [name for name in given.subjects if name not in subjects]
    if unknown:
        print(f"no such subject: {', '.join(unknown)}", file=sys.stderr)
        return 2
    wrong = 0
    with contextlib.ExitStack() as stack:
        servers = [stack.enter_context(XServer()) for _ in range(2)]
        octagon = Octagon(servers[0])
        stack.enter_context(octagon.wall)
        plain, stage = MesaStage(servers[1]), ViewStage(servers[1])
        for name in given.subjects:
            wrong += bool(judge(subjects[name], octagon, plain, stage, given.report))
    print(f"{len(given.subjects) - wrong} of {len(given.subjects)} same")
    return 1 if wrong else 0


if __name__ == "__main__":
    os.umask(0o022)
    sys.exit(main())
