#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Eight recorded programs at once, of both window systems, one over the other on 3x2 tiles, each stopped at a frame of
its own. The composed wall is the same as the picture put together from each program run alone on that wall, and as the
one put together from each program's frame on plain Mesa, drawn in the tiles' parts (docs/golden-tests.md).

together.py [--report FOLDER]
"""
from __future__ import annotations

import argparse
import contextlib
import random
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))

import compare  # noqa: E402
import numpy as np  # noqa: E402
from stages import MovedStage, decode_png, parts_of  # noqa: E402
from subjects import WINDOW, Play, Recording, load_recordings  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

TILES, TILE_SIZE = (3, 2), (310, 290)
# Name, frame that stays on the wall, left top corner. Nothing lies at a tile's border; the last two reach over the
# wall's edge.
CAST = [("glxgears", 2, (30, 20)), ("glmark2_build", 1, (250, 60)), ("atlantis", 3, (470, 15)),
        ("boing", 2, (120, 190)),
        ("menger", 3, (330, 230)), ("dangerball", 2, (505, 265)), ("morph3d", 3, (-60, 250)),
        ("solarwinds", 4, (600, 140))]
SEED = 8  # of the order in which they are raised
SHOWN_LIMIT = 30.0  # seconds until the wall shows every frame


class Actor:
    """A program on the wall that has swapped its frame and now waits to be read, so the frame stays."""

    def __init__(self, wall: Wall, x: XServer, recording: Recording, frame: int, corner: tuple[int, int]):
        self.name, self._wall, self._frame, self.rect = recording.name, wall, frame, (*corner, *WINDOW)
        prefix = wall.wallrun(rect=self.rect, name=recording.name)
        self._play = Play(recording, x.environment(vblank_mode="0"), prefix)
        frames = self._play.frames()
        for _ in range(frame + 1):
            next(frames)

    def session(self) -> dict:
        return next(s for s in self._wall.sessions() if s["pid"] == self._play.pid)

    def wait_shown(self) -> None:
        end = time.monotonic() + SHOWN_LIMIT
        while self.session()["surfaces"][-1]["frame"] < self._frame + 1:
            if time.monotonic() > end:
                raise RuntimeError(f"{self.name}: frame {self._frame} is not shown within {SHOWN_LIMIT:.0f} seconds")
            time.sleep(0.02)

    def end(self) -> None:
        for _ in self._play.frames():
            pass
        self._play.finish()


def paste(wall: np.ndarray, picture: np.ndarray, corner: tuple[int, int]) -> None:
    """A window's picture at its place; what reaches over the wall's edge is cut off."""
    x, y = corner
    left, top = max(x, 0), max(y, 0)
    right, bottom = min(x + picture.shape[1], wall.shape[1]), min(y + picture.shape[0], wall.shape[0])
    wall[top:bottom, left:right] = picture[top - y:bottom - y, left - x:right - x]


def composed(wall: Wall) -> np.ndarray:
    return decode_png(wall.screenshot()).copy()


@contextlib.contextmanager
def acting(wall: Wall, x: XServer, recordings: dict[str, Recording], cast: list) -> list[Actor]:
    actors = []
    try:
        for name, frame, corner in cast:
            actors.append(Actor(wall, x, recordings[name], frame, corner))
        for actor in actors:
            actor.wait_shown()
        yield actors
    finally:
        for actor in actors:
            actor.end()


def alone_on_the_wall(wall: Wall, x: XServer, recordings: dict[str, Recording]) -> dict[str, np.ndarray]:
    """Each program's part of the wall with no other on it, as large as the wall."""
    pictures = {}
    for entry in CAST:
        with acting(wall, x, recordings, [entry]):
            pictures[entry[0]] = composed(wall)
        end = time.monotonic() + SHOWN_LIMIT
        while wall.sessions() and time.monotonic() < end:
            time.sleep(0.02)
    return pictures


def on_mesa(recordings: dict[str, Recording]) -> dict[str, np.ndarray]:
    """Each program's frame, of which there is only what lies on the wall."""
    pictures = {}
    with contextlib.ExitStack() as stack:
        servers = [stack.enter_context(XServer()) for _ in range(TILES[0] * TILES[1])]
        for name, frame, corner in CAST:
            parts = parts_of((*corner, *WINDOW), TILES, TILE_SIZE)
            stage = MovedStage(lambda _, parts=parts: parts, build_folder(), servers)
            given = stage.play(recordings[name])
            if given.problems or given.exit_code != 0:
                raise RuntimeError(f"{name} on Mesa: exit code {given.exit_code}, {given.problems}: {given.errors}")
            pictures[name] = given.read[frame]
    return pictures


def expected_pictures(order: list[str], alone: dict[str, np.ndarray],
                      mesa: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """The wall from each program alone on it, and from plain Mesa; `order` is bottom first."""
    corners = {name: corner for name, _, corner in CAST}
    shape = next(iter(alone.values())).shape
    from_alone, from_mesa = np.zeros(shape, np.uint8), np.zeros(shape, np.uint8)
    for name in order:
        x, y = corners[name]
        part = np.s_[max(y, 0):max(y + WINDOW[1], 0), max(x, 0):max(x + WINDOW[0], 0)]
        from_alone[part] = alone[name][part]
        paste(from_mesa, mesa[name], corners[name])
    return from_alone, from_mesa


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--report", type=Path, default=Path("test-output/together"),
                           help="folder for pictures of failures")
    options = arguments.parse_args()
    recordings = {recording.name: recording for recording in load_recordings()}
    with XServer() as x, Wall(tiles=TILES, tile_size=TILE_SIZE, swap_timeout_ms=10000, name="together") as wall:
        mesa, alone = on_mesa(recordings), alone_on_the_wall(wall, x, recordings)
        with acting(wall, x, recordings, CAST) as actors:
            raised = random.Random(SEED).sample([actor.name for actor in actors], 4)
            for name in raised:
                wall.ctl("raise", next(actor for actor in actors if actor.name == name).session()["id"])
            order = [name for name, _, _ in CAST if name not in raised] + raised
            time.sleep(0.5)  # the stacking has reached the nodes
            shown = composed(wall)
    from_alone, from_mesa = expected_pictures(order, alone, mesa)
    good = True
    for what, expected in (("alone", from_alone), ("mesa", from_mesa)):
        verdict = compare.same(expected, shown)
        print(f"against each program {'alone on the wall' if what == 'alone' else 'on plain Mesa'}: {verdict}")
        if not verdict.good:
            options.report.mkdir(parents=True, exist_ok=True)
            compare.save_png(options.report / f"{what}.png", compare.difference_picture(expected, shown))
        good = good and verdict.good
    print("bottom first: " + ", ".join(order))
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
