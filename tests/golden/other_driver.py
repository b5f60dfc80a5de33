#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Plays recorded programs and scenes of our own on a wall whose nodes draw with another driver than the references were
made with, such as a GPU's, and says how far each picture is from plain Mesa's. They are never the same: each driver
rounds, filters and smooths in its own way. So this finds what is missing or looks otherwise, for people to look at
(docs/gpus.md).

other_driver.py --references FOLDER [--tiles CxR] [--only NAME]... [--report FOLDER]
    the references are written on a machine with Mesa: golden.py --tiles mesa --references FOLDER. Subjects that have
    none are left out. The X server needs OpenGL of its own only as far as GLX asks it for its version.

Exit code 1 if one ended too early or gave no pictures.
"""
from __future__ import annotations

import argparse
import dataclasses
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))

import compare  # noqa: E402
import numpy as np  # noqa: E402
from stages import Performance, References, WallStage  # noqa: E402
from subjects import Subject, load_recordings, load_scenes  # noqa: E402
from wall import WallError, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

LIMIT = 60  # seconds for one
WORTH_A_LOOK = 0.002  # of the pixels outside their neighbourhood: both pictures are kept


@dataclasses.dataclass(frozen=True)
class Distance:
    """Of the picture that is farthest from its reference."""

    outside: float = 0.0  # share of the pixels outside the reference's neighbourhood, widened (compare.py)
    differing: float = 0.0  # share of the pixels that differ by more than compare.LEVELS
    largest: int = 0  # difference, levels
    reference: np.ndarray | None = dataclasses.field(default=None, compare=False)
    picture: np.ndarray | None = dataclasses.field(default=None, compare=False)

    def key(self) -> tuple[float, float, int]:
        return self.outside, self.differing, self.largest


def distance(reference: np.ndarray, picture: np.ndarray) -> Distance:
    found = compare.same(reference, picture)
    if found.reason:
        return Distance(1.0, 1.0, 255, reference, picture)
    return Distance(found.outside / found.pixels, found.differing / found.pixels, found.largest, reference, picture)


def farthest(subject: Subject, plain: Performance, given: Performance) -> Distance:
    pairs = [(number, given.read[number]) for number in subject.compared if number < len(given.read)]
    pairs += sorted(given.shown.items())
    found = [distance(plain.read[number], picture) for number, picture in pairs if number < len(plain.read)]
    return max(found, key=Distance.key, default=Distance())


def problem(subject: Subject, given: Performance) -> str:
    """Why it did not play to its end; nothing if it did."""
    if given.exit_code != 0 or len(given.read) != subject.frames:
        return f"exit code {given.exit_code}, {len(given.read)} of {subject.frames} frames: {given.errors[-300:]}"
    return "; ".join(given.problems)


def too_long(*_) -> None:
    raise WallError(f"it takes longer than {LIMIT} seconds")


def play_all(subjects: list[Subject], tiles: tuple[int, int], references: References
             ) -> Iterator[tuple[Subject, Distance, str]]:
    signal.signal(signal.SIGALRM, too_long)
    with XServer() as x, WallStage(x, tiles) as stage:
        for subject in subjects:
            plain = references.find(subject)
            if plain is None:
                continue
            start = time.monotonic()
            signal.alarm(LIMIT)
            try:
                given = stage.play(subject)
            except WallError as error:
                given = Performance(exit_code=-1, errors=str(error))
            signal.alarm(0)
            far, wrong = farthest(subject, plain, given), problem(subject, given)
            text = "" if given.text == plain.text else ", other answers"
            print(f"{subject.kind} {subject.name}: {far.outside:.4%} outside, {far.differing:.4%} differ, "
                  f"by {far.largest} at most{text}, {time.monotonic() - start:.1f} s"
                  f"{f'; FAILED: {wrong}' if wrong else ''}", flush=True)
            yield subject, far, wrong


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("--references", type=Path, required=True, help="folder that golden.py --tiles mesa wrote")
    arguments.add_argument("--tiles", default="1x1")
    arguments.add_argument("--only", action="append", default=[], help="recording or scene; may be given again")
    arguments.add_argument("--report", type=Path, default=Path("test-output/other-driver"),
                           help="folder for pictures that are far from their references")
    options = arguments.parse_args()
    subjects = [subject for subject in [*load_recordings(), *load_scenes(build_folder() / "tests" / "golden_scenes")]
                if not options.only or subject.name in options.only]
    played, failed, far = 0, 0, 0
    for subject, found, wrong in play_all(subjects, tuple(map(int, options.tiles.split("x"))),
                                          References(options.references)):
        played += 1
        failed += bool(wrong)
        if found.outside > WORTH_A_LOOK:
            far += 1
            compare.save_png(options.report / f"{subject.name}.png",
                             compare.difference_picture(found.reference, found.picture))
    if not played:
        arguments.error(f"no references of these in {options.references}")
    print(f"{played} subjects, {failed} failed, {far} worth a look in {options.report}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
