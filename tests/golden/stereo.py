#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Programs that know nothing of two eyes, and one that draws two pictures itself (GLX_STEREO), on tiles that are for
one eye each (docs/walls.md, "Stereo"): each shows, pixel by pixel, what plain Mesa draws from that eye's place
(moved/views.h), or of that eye's buffers. A tile for both eyes and what the program reads back stay its own picture,
and so does everything while nobody asks for stereo. An output that shows both eyes has the rows of one and of the
other.

stereo.py [--report FOLDER] [SUBJECT...]
"""
from __future__ import annotations

import argparse
import contextlib
import os
import struct
import subprocess
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
from wall import WallError, build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

PERCENT = 4.0  # of the window's width: more than people can see, so that it shows
# And how far from the camera the wall's plane is, in each program's units: in the midst of what it draws.
SUBJECTS = {"around": 4.0, "atlantis": 60000.0, "solarwinds": 50.0, "glxgears": 40.0, "dangerball": 30.0}
OWN = "two_eyes"  # draws to left and right buffers
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

    def play(self, subject: Subject, distance: float | None,
             **environment: str) -> tuple[Performance, dict[tuple[int, str], np.ndarray]]:
        """And each tile's part of the window in each frame that can be looked at, by (frame, tile). `distance`: none
        for a program that nobody has asked stereo of."""
        given, shown = Performance(), {}
        stereo = "" if distance is None else f"{PERCENT},{distance}"
        prefix = self.wall.wallrun(rect=(*ORIGIN, *WINDOW), name=subject.name, stereo=stereo)
        play = Play(subject, self._x.environment(vblank_mode="0", **environment), prefix)
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

    def play(self, subject: Subject, half: str, view: str = "", **environment: str) -> list[np.ndarray]:
        width, height = subject.window
        x, y, w, h = self._parts[half]
        environment = self._environment | environment | ({"GOLDEN_VIEW": view} if view else {})
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


class Comparison:
    """Of what tiles show with what they should, picture by picture."""

    def __init__(self, subject: Subject, report: Path | None):
        self._name, self._report = subject.name, report
        self.wrong: list[str] = []

    def tile(self, number: int, tile: str, seen: np.ndarray, right: np.ndarray) -> None:
        apart = int((seen != right).any(axis=2).sum()) if seen.shape == right.shape else -1
        if apart == 0:
            return
        self.wrong.append(f"frame {number}, {tile}: {apart} pixels differ")
        if self._report and apart > 0:
            self._report.mkdir(parents=True, exist_ok=True)
            cv2.imwrite(str(self._report / f"{self._name}-{number}-{tile}.png"),
                        np.concatenate([seen, right], axis=1)[:, :, ::-1])

    def tiles(self, shown: dict[tuple[int, str], np.ndarray], plain: list[np.ndarray],
              by_eye: dict[str, list[np.ndarray]]) -> None:
        """`plain`: what a tile for both eyes shows; `by_eye`: what the others do, by eye and half."""
        for (number, tile), seen in sorted(shown.items()):
            if tile == "plain":
                self.tile(number, tile, seen, plain[number])
            elif tile == "rows":
                mixed = by_eye["left0"][number].copy()
                first = 1 - ORIGIN[1] % 2  # of the window's rows, the first that the right eye sees
                mixed[first::2] = by_eye["right0"][number][first::2]
                self.tile(number, tile, seen, mixed)
            else:
                self.tile(number, tile, seen, by_eye[tile][number])

    @property
    def verdict(self) -> str:
        return "same" if not self.wrong else "; ".join(self.wrong[:5])


def judge_own(subject: Subject, stage: StereoWall, eyes: EyeStage, report: Path | None) -> list[str]:
    """What is wrong with a program that draws for each eye. Asked for stereo, it has that already."""
    found = Comparison(subject, report)
    by_eye = {eye + half: eyes.play(subject, half, GOLDEN_EYE=eye) for eye in EYES for half in stage.parts}
    for read, asked in ("left", None), ("right", None), ("left", 3.0):
        given, shown = stage.play(subject, asked, GOLDEN_EYE=read)
        found.wrong += given.problems
        found.wrong += [line for line in given.text if "error 0x" in line]
        if given.exit_code != 0 or not shown:
            found.wrong.append(f"exit code {given.exit_code}, {len(shown)} pictures: {given.errors[-500:]}")
            continue
        for number in subject.compared:
            picture = np.concatenate([by_eye[read + half][number] for half in stage.parts], axis=1)
            if number >= len(given.read) or not (picture == given.read[number]).all():
                found.wrong.append(f"frame {number}: what it reads of the {read} eye's is not that")
        found.tiles(shown, by_eye["left0"], by_eye)
        print(f"{subject.name}, {read} eye's read{', asked for stereo' if asked else ''}: {len(shown)} pictures: "
              f"{found.verdict}", flush=True)
    apart = sum((left != right).any() for left, right in zip(by_eye["left0"], by_eye["right0"]))
    if apart < len(by_eye["left0"]):
        found.wrong.append("both eyes see the same somewhere")
    return found.wrong


def judge_gears(stage: StereoWall, x: XServer) -> list[str]:
    """What is wrong with glxgears -stereo, of which Mesa here gives no picture: both eyes see the same things on the
    same rows, and not at the same places."""
    app = stage.wall.run_line(stage.wall.wallrun("glxgears", "-stereo", rect=(*ORIGIN, *WINDOW), hold=True),
                              env=x.environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    session = stage.wall.wait_session(app)
    wrong = []
    for _ in range(3):
        stage.wall.step(session)
        seen = {eye: np.concatenate([stage.part_of(decode_png(stage.wall.screenshot(tile=eye + half)), half)
                                     for half in stage.parts], axis=1).max(axis=2) > 0 for eye in EYES}
        rows = {eye: picture.any(axis=1) for eye, picture in seen.items()}
        middle = {eye: np.nonzero(picture)[1].mean() for eye, picture in seen.items()}
        if (rows["left"] != rows["right"]).sum() > 2:
            wrong.append("the gears are not on the same rows")
        if abs(middle["left"] - middle["right"]) < 1:
            wrong.append(f"both eyes see the gears at the same place, column {middle['left']:.1f}")
    end_all([app])
    print(f"glxgears -stereo: {'from two places' if not wrong else '; '.join(wrong)}", flush=True)
    return wrong


def judge(subject: Subject, distance: float, stage: StereoWall, plain: MesaStage, eyes: EyeStage,
          report: Path | None) -> list[str]:
    """What is wrong."""
    found = Comparison(subject, report)
    wrong = found.wrong
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
        found.tiles(shown, cut["0"], by_eye)
        apart = sum(bool((seen != cut[tile[-1]][number]).any()) for (number, tile), seen in shown.items()
                    if tile in by_eye)
        if asked is not None and apart < 2:
            wrong.append("fewer than two pictures are another than the program's own")
        print(f"{subject.name}{'' if asked is None else f', {PERCENT} % from {distance} on'}: {len(shown)} pictures, "
              f"{apart} apart from the program's: {found.verdict}", flush=True)
    return wrong


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--report", type=Path, help="folder for pictures that differ: the tile's, Mesa's")
    options.add_argument("subjects", nargs="*", default=[*SUBJECTS, OWN])
    given = options.parse_args()
    subjects = {s.name: s for s in [*load_scenes(build_folder() / "tests" / "golden_scenes"), *load_recordings()]}
    unknown = [name for name in given.subjects if name not in subjects or name not in (*SUBJECTS, OWN)]
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
            if name == OWN:
                found = judge_own(subjects[name], stage, eyes, given.report) + judge_gears(stage, servers[0])
            else:
                found = judge(subjects[name], SUBJECTS[name], stage, plain, eyes, given.report)
            wrong += bool(found)
    print(f"{len(given.subjects) - wrong} of {len(given.subjects)} same")
    return 1 if wrong else 0


if __name__ == "__main__":
    os.umask(0o022)
    sys.exit(main())
