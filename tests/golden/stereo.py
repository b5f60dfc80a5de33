#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Programs that know nothing of two eyes, on tiles that are for one each (docs/walls.md, "Stereo"): each shows, pixel
by pixel, what plain Mesa draws from that eye's place (moved/views.h). A tile for both eyes and what the program reads
back stay its own picture, and so does everything while nobody asks for stereo. An output that shows both eyes has the
rows of one and of the other.

stereo.py [--report FOLDER] [SUBJECT...]
"""
from __future__ import annotations

import argparse
import contextlib
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

PERCENT = 4.0  # of the window's width: more than people can see, so that it shows
# And how far from the camera the wall's plane is, in each program's units: in the midst of what it draws.
SUBJECTS = {"around": 4.0, "atlantis": 60000.0, "solarwinds": 50.0, "glxgears": 40.0, "dangerball": 30.0}
ORIGIN = (7, 5)  # of the window on the wall
CUT = 181  # where a tile ends that shows the window's left part
EYES = {"left": -1, "right": 1}


def to_single(value: float) -> float:
    return struct.unpack("f", struct.pack("f", value))[0]


def view_of(eye: str, distance: float) -> str:
    """The 16 numbers of geom::values_of() of an eye that looks where the program does."""
    shift = to_single(EYES[eye] * to_single(PERCENT / 100))
    return " ".join(repr(number) for number in (*[0] * 14, shift, to_single(distance)))


class StereoWall:
    """A pair of projectors for each half, the left eye's at one node and the right one's at another; beside them, over
    the left half, a tile for both eyes and one whose output has the rows of both."""

    def __init__(self, x: XServer):
        self._x = x
        width, height = WINDOW[0] + 20, WINDOW[1] + 20
        edge = ORIGIN[0] + CUT
        halves = {"0": (0, 0, edge, height), "1": (edge, 0, width - edge, height)}
        plan = {f"{eye}s": {eye + half: rect for half, rect in halves.items()} for eye in EYES}
        plan["others"] = {"plain": halves["0"], "rows": halves["0"]}
        keys = {eye + half: f'eye = "{eye}"' for eye in EYES for half in halves}
        # Rows of the output are those of the canvas, so its height must be even.
        keys["rows"] = 'stereo = "rows"'
        self.wall = PlannedWall(plan, keys, die_with_parent=True, swap_timeout_ms=10000, name="stereo")
        # What each tile shows of the window, in the window's pixels.
        self.parts = {"0": (0, 0, CUT, WINDOW[1]), "1": (CUT, 0, WINDOW[0] - CUT, WINDOW[1])}

    def part_of(self, picture: np.ndarray, half: str) -> np.ndarray:
        x, y = (ORIGIN[0] if half == "0" else 0), ORIGIN[1]
        _, _, width, height = self.parts[half]
        return picture[y:y + height, x:x + width]

    def play(self, subject: Subject, distance: float | None) -> tuple[Performance, dict[tuple[int, str], np.ndarray]]:
        """And each tile's part of the window in each frame that can be looked at, by (frame, tile). `distance`: none
        for a program that nobody has asked stereo of."""
        given, shown = Performance(), {}
        stereo = "" if distance is None else f"{PERCENT},{distance}"
        prefix = self.wall.wallrun(rect=(*ORIGIN, *WINDOW), name=subject.name, stereo=stereo)
        play = Play(subject, self._x.environment(vblank_mode="0"), prefix)
        session = Session(self.wall, play.pid)
        for number, frame in enumerate(play.frames()):
            given.read.append(frame)
            if number >= 1 and number in subject.shown:
                try:
                    session.wait_shown(number + 1, wait_a_moment=False)
                    for tile in self.wall.tile_names:
                        picture = decode_png(self.wall.screenshot(tile=tile, output=tile == "rows"))
                        shown[number, tile] = self.part_of(picture, "1" if tile.endswith("1") else "0")
                except (WallError, ValueError) as problem:
                    given.problems.append(f"frame {number}: {problem}")
            play.go_on()
        given.end(play)
        return given, shown


class EyeStage:
    """One eye's picture of one half, on plain Mesa."""

    def __init__(self, x: XServer, parts: dict[str, tuple[int, int, int, int]]):
        self._parts = parts
        library = build_folder() / "tests" / "moved"
        self._environment = mesa_environment(x) | {
            "__GLX_VENDOR_LIBRARY_NAME": "moved", "LD_LIBRARY_PATH": str(library),
            "__EGL_VENDOR_LIBRARY_FILENAMES": str(library / "moved.json"), "GOLDEN_TILE": "0"}

    def play(self, subject: Subject, half: str, view: str = "") -> list[np.ndarray]:
        width, height = subject.window
        x, y, w, h = self._parts[half]
        environment = self._environment | ({"GOLDEN_VIEW": view} if view else {})
        with tempfile.NamedTemporaryFile(prefix="golden-share-") as share:
            play = Play(subject, environment | {"GOLDEN_TILES": f"{width},{height};{x},{y},{w},{h}",
                                                "GOLDEN_SHARE": share.name})
            frames = []
            for frame in play.frames():
                frames.append(frame[y:y + h, x:x + w])
                play.go_on()
            code, said = play.finish()
        if code != 0:
            raise WallError(f"no reference: {said[-300:]}")
        return frames


def judge(subject: Subject, distance: float, stage: StereoWall, plain: MesaStage, eyes: EyeStage,
          report: Path | None) -> list[str]:
    """What is wrong."""
    wrong: list[str] = []

    def compare(number: int, tile: str, seen: np.ndarray, right: np.ndarray) -> None:
        apart = int((seen != right).any(axis=2).sum()) if seen.shape == right.shape else -1
        if apart == 0:
            return
        wrong.append(f"frame {number}, {tile}: {apart} pixels differ")
        if report and apart > 0:
            report.mkdir(parents=True, exist_ok=True)
            cv2.imwrite(str(report / f"{subject.name}-{number}-{tile}.png"),
                        np.concatenate([seen, right], axis=1)[:, :, ::-1])

    own = plain.play(subject)
    cut = {half: eyes.play(subject, half) for half in stage.parts}
    for asked in (None, distance):
        given, shown = stage.play(subject, asked)
        wrong += given.problems
        if given.exit_code != 0 or not shown:
            wrong.append(f"exit code {given.exit_code}, {len(shown)} pictures: {given.errors[-500:]}")
            continue
        for number in subject.compared:
            # What no tile shows as it is lies uncut off the wall.
            right = cut["1"][number] if asked is None or number == 0 else own.read[number][:, CUT:]
            picture = np.concatenate([cut["0"][number], right], axis=1)
            if number >= len(given.read) or not (picture == given.read[number]).all():
                wrong.append(f"frame {number}: what the program reads back is not its own picture")
        by_eye = {eye + half: cut[half] if asked is None else eyes.play(subject, half, view_of(eye, asked))
                  for eye in EYES for half in stage.parts}
        apart = 0
        for (number, tile), seen in sorted(shown.items()):
            if tile == "plain":
                compare(number, tile, seen, cut["0"][number])
            elif tile == "rows":
                mixed = by_eye["left0"][number].copy()
                first = 1 - ORIGIN[1] % 2  # of the window's rows, the first that the right eye sees
                mixed[first::2] = by_eye["right0"][number][first::2]
                compare(number, tile, seen, mixed)
            else:
                compare(number, tile, seen, by_eye[tile][number])
                apart += int((seen != cut[tile[-1]][number]).any())
        if asked is not None and apart < 2:
            wrong.append("fewer than two pictures are another than the program's own")
        print(f"{subject.name}{'' if asked is None else f', {PERCENT} % from {distance} on'}: {len(shown)} pictures, "
              f"{apart} apart from the program's: {'same' if not wrong else '; '.join(wrong[:5])}", flush=True)
    return wrong


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--report", type=Path, help="folder for pictures that differ: the tile's, Mesa's")
    options.add_argument("subjects", nargs="*", default=list(SUBJECTS))
    given = options.parse_args()
    subjects = {s.name: s for s in [*load_scenes(build_folder() / "tests" / "golden_scenes"), *load_recordings()]}
    unknown = [name for name in given.subjects if name not in subjects or name not in SUBJECTS]
    if unknown:
        print(f"no such subject: {', '.join(unknown)}", file=sys.stderr)
        return 2
    wrong = 0
    with contextlib.ExitStack() as stack:
        servers = [stack.enter_context(XServer()) for _ in range(2)]
        stage = StereoWall(servers[0])
        stack.enter_context(stage.wall)
        plain, eyes = MesaStage(servers[1]), EyeStage(servers[1], stage.parts)
        for name in given.subjects:
            wrong += bool(judge(subjects[name], SUBJECTS[name], stage, plain, eyes, given.report))
    print(f"{len(given.subjects) - wrong} of {len(given.subjects)} same")
    return 1 if wrong else 0


if __name__ == "__main__":
    os.umask(0o022)
    sys.exit(main())
