#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Plays recorded programs and scenes of our own on a wall whose nodes draw with another driver than the references were
made with, such as a GPU's, and says how far each picture is from plain Mesa's. They are never the same: each driver
rounds, filters and smooths in its own way. So this finds what is missing or looks otherwise, for people to look at
(docs/gpus.md).

other_driver.py --references FOLDER [--tiles CxR] [--only NAME]... [--sheet FILE.png]
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
import cv2  # noqa: E402
import numpy as np  # noqa: E402
from stages import Performance, References, WallStage  # noqa: E402
from subjects import Subject, load_recordings, load_scenes  # noqa: E402
from wall import WallError, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

LIMIT = 60  # seconds for one
WORTH_A_LOOK = 0.002  # of the pixels outside their neighbourhood: a picture goes onto the sheet
ROW = 220  # pixels a picture is high there


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


def sheet(found: list[tuple[str, Distance]]) -> np.ndarray:
    """Reference and picture beside each other, a row for each."""
    rows = []
    for name, far in found:
        width = ROW * far.reference.shape[1] // far.reference.shape[0]
        pair = [cv2.resize(each, (width, ROW)) for each in (far.reference, far.picture)]
        row = np.ascontiguousarray(np.hstack(pair)[..., ::-1])
        rows.append(cv2.putText(row, name, (4, 14), cv2.FONT_HERSHEY_SIMPLEX, 0.45, (0, 0, 255), 1))
    widest = max(row.shape[1] for row in rows)
    return np.vstack([cv2.copyMakeBorder(row, 0, 4, 0, widest - row.shape[1], cv2.BORDER_CONSTANT) for row in rows])


def too_long(*_) -> None:
    raise WallError(f"it takes longer than {LIMIT} seconds")


def play_all(subjects: list[Subject], tiles: tuple[int, int], references: References
             ) -> Iterator[tuple[Subject, Distance, str]]:
    signal.signal(signal.SIGALRM, too_long)
    with XServer() as x, WallStage(x, tiles) as stage:
        for subject in subjects:
            plain = references.find(subject)
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
    arguments.add_argument("--sheet", type=Path, help="picture of those that are far from theirs")
    options = arguments.parse_args()
    references = References(options.references)
    subjects = [subject for subject in [*load_recordings(), *load_scenes(build_folder() / "tests" / "golden_scenes")]
                if references.find(subject) and (not options.only or subject.name in options.only)]
    if not subjects:
        arguments.error(f"no references of these in {options.references}")
    played = list(play_all(subjects, tuple(map(int, options.tiles.split("x"))), references))
    far = [(subject.name, found) for subject, found, _ in played
           if found.outside > WORTH_A_LOOK and found.picture.shape == found.reference.shape]
    if options.sheet and far:
        cv2.imwrite(str(options.sheet), sheet(far))
    failed = [subject.name for subject, _, wrong in played if wrong]
    print(f"{len(played)} subjects, {len(failed)} failed, {len(far)} worth a look"
          f"{f' in {options.sheet}' if options.sheet and far else ''}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
