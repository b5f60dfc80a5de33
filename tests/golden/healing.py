#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Recorded programs go on drawing their last frame, over and over, while nodes of the wall are killed and come back;
then the wall shows that frame again, also what of it was drawn once and only the nodes have (DESIGN, sections 1 and 9:
a node added or restarted follows from nothing).

healing.py [--tiles CxR] [--only NAME]... [--rounds N] [--seed N] [--all]
    --all plays every recording whose last frame is the same each time it is drawn; else those of SAMPLE.
"""
from __future__ import annotations

import argparse
import contextlib
import random
import sys
import time
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))

import numpy as np  # noqa: E402
from expectations import Check, Outcome  # noqa: E402
from stages import WallStage, decode_png  # noqa: E402
from subjects import Play, Recording, load_recordings  # noqa: E402
from wall import Wall, WallError  # noqa: E402
from xserver import XServer  # noqa: E402

# Targets that are drawn once or each frame, many objects, meshes in buffers, uniform blocks, core profiles.
SAMPLE = "paraview quick openarena2 glmark2_desktop glmark2_terrain es_refract es_shadow pymol".split()
# These do not clear their window but fade it, 0.22 of it in a frame. Where a fade ends depends by rounding on where it
# began, at a new node with black: 0.5 / 0.22 levels to each side.
LEVELS_OF_FADING = {"flux": 5}
SETTLED = 5  # frames of the loop that are not looked at
STANDS_STILL = 30.0  # seconds until the window shows the same picture twice
RIGHT_AGAIN = 30.0  # seconds from a node's start until the wall is right; 1 to 9 on a busy machine
MOST_COLORS = 8  # a picture of fewer is no witness


class Healing:
    """One recording on the wall, its last frame in a loop."""

    def __init__(self, wall: Wall, recording: Recording, play: Play, rect: tuple[int, int, int, int]):
        self._wall, self._recording, self._play, self._rect = wall, recording, play, rect

    def picture(self) -> np.ndarray:
        x, y, width, height = self._rect
        return decode_png(self._wall.screenshot())[y:y + height, x:x + width]

    def frame(self) -> int:
        sessions = [s for s in self._wall.sessions() if s["pid"] == self._play.pid and s["surfaces"]]
        if not sessions:
            raise WallError("the program has no window on the wall")
        if sessions[0]["fault"]:
            raise WallError("session fault: " + sessions[0]["fault"])
        return sessions[0]["surfaces"][-1]["frame"]

    def all_in_time(self) -> bool:
        """No node is left out of frames because it is late: its tiles show an earlier one."""
        return all(tile["lag_frames"] == 0 for tile in self._wall.ctl("tiles"))

    def still_picture(self) -> np.ndarray | None:
        """What the wall shows while nobody disturbs it; None if it never shows the same twice."""
        end = time.monotonic() + STANDS_STILL
        last = None
        while time.monotonic() < end:
            with contextlib.suppress(WallError):
                before = self.frame()
                if before >= self._recording.frames + SETTLED and self.all_in_time():
                    picture = self.picture()
                    if last is not None and (picture == last).all():
                        return picture
                    last = picture
                    while self.frame() < before + 2 and time.monotonic() < end:
                        time.sleep(0.02)
            time.sleep(0.05)
        return None

    def kill(self, names: list[str], pause: float) -> None:
        for name in names:
            node = self._wall.daemons[name]
            node.kill()
            node.wait()
        time.sleep(pause)
        for name in names:
            self._wall.start_node(name)

    def becomes_right(self, expected: np.ndarray) -> tuple[bool, str]:
        begin, wrong = time.monotonic(), 0
        while time.monotonic() < begin + RIGHT_AGAIN:
            self.frame()
            shown = self.picture()
            off = np.abs(shown.astype(int) - expected)
            wrong = int((off > LEVELS_OF_FADING.get(self._recording.name, 0)).any(axis=2).sum())
            if wrong == 0:
                return True, f"{time.monotonic() - begin:.1f} s"
            time.sleep(0.05)
        return False, f"{wrong} of {expected.shape[0] * expected.shape[1]} pixels wrong after {RIGHT_AGAIN:.0f} s"


def heal(stage: WallStage, recording: Recording, rounds: int, chance: random.Random) -> Iterator[Outcome]:
    tiles = "x".join(map(str, stage.tiles))

    def outcome(view: str, good: bool, detail: str) -> Outcome:
        return Outcome(Check(recording.name, tiles, view, -1), good, detail)

    with stage.looping(recording) as (wall, play, rect):
        healing = Healing(wall, recording, play, rect)
        expected = healing.still_picture()
        if expected is None:
            yield outcome("still", False, "its last frame is not the same each time")
            return
        colors = len(np.unique(expected.reshape(-1, 3), axis=0))
        yield outcome("still", colors > MOST_COLORS, f"{colors} colours")
        for number in range(rounds):
            names = chance.sample(wall.node_names, chance.randint(1, len(wall.node_names) - 1))
            try:
                healing.kill(names, chance.uniform(0, 0.6))
                good, detail = healing.becomes_right(expected)
            except WallError as error:
                good, detail = False, str(error)
            yield outcome(f"healed {number}", good, f"{' '.join(names)}: {detail}")
        yield outcome("alive", play.alive(), "it goes on")


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("--tiles", default="2x2")
    arguments.add_argument("--only", action="append", default=[], help="recording; may be given again")
    arguments.add_argument("--rounds", type=int, default=3, help="of killing some nodes, but not all (3)")
    arguments.add_argument("--seed", type=int, default=int(time.time()), help="of chance; printed")
    arguments.add_argument("--all", action="store_true", help="every recording whose last frame stands still")
    options = arguments.parse_args()
    recordings = load_recordings()
    unknown = set(options.only) - {recording.name for recording in recordings}
    if unknown:
        arguments.error(f"no recording {', '.join(sorted(unknown))}")
    names = options.only or ([r.name for r in recordings] if options.all else SAMPLE)
    print(f"seed {options.seed}")
    chance = random.Random(options.seed)
    failed, played = 0, 0
    with XServer() as x, WallStage(x, tuple(map(int, options.tiles.split("x"))), swap_timeout_ms=250) as stage:
        for recording in (r for r in recordings if r.name in names):
            outcomes = list(heal(stage, recording, options.rounds, chance))
            skipped = options.all and [o.check.view for o in outcomes if not o.good] == ["still"]
            played += not skipped
            failed += 0 if skipped else sum(not o.good for o in outcomes)
            said = "; ".join(f"{'' if o.good else 'FAILED '}{o.check.view}: {o.detail}" for o in outcomes)
            print(f"{'skipped ' if skipped else ''}{recording.name}: {said}", flush=True)
    print(f"{played} recordings, {failed} failures")
    return 0 if played and not failed else 1


if __name__ == "__main__":
    sys.exit(main())
