#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Plays recorded programs and scenes of our own on plain Mesa and on a wall, and compares every frame: as glReadPixels
returns it and as the composed wall shows it. On one tile they are the same, on several they match (DESIGN.md, section 8).
Also compared: what the scenes' queries answered, and that no query waited for an answer of the wall.

golden.py --tiles CxR|mesa [--only NAME]... [--backend egl|osmesa] [--report FOLDER] [--references FOLDER]
    mesa instead of a wall compares Mesa with itself: it checks these tests, and writes the references.
"""
from __future__ import annotations

import argparse
import contextlib
import difflib
import sys
import time
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))

import compare  # noqa: E402
from expectations import Check, Outcome, judge, load  # noqa: E402
from stages import MesaStage, Performance, References, WallStage  # noqa: E402
from subjects import Subject, load_recordings, load_scenes  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

# Functions that must be answered without a round trip, whatever the program.
LOCAL_ANSWERS = ("glGet", "glIs", "glAreTexturesResident", "glGenLists", "glGenTextures", "glCheck")
# Those of them whose answer only a node has.
REMOTE_ANSWERS = ("glGetTexImage", "glGetQueryObject")
NO_PICTURE = "no picture"


class Comparison:
    """Of one subject's two performances, on the wall named `tiles`."""

    def __init__(self, subject: Subject, tiles: str, reference: Performance, given: Performance, report: Path):
        self._subject, self._tiles, self._report = subject, tiles, report
        self._reference, self._given = reference, given
        self._right = compare.same if tiles in ("1x1", "mesa") else compare.match

    def outcomes(self) -> Iterator[Outcome]:
        yield self._exit()
        yield self._text()
        yield self._round_trips()
        for number in self._subject.compared:
            yield self._picture("read", number, self._given.read[number] if number < len(self._given.read) else None)
            if self._tiles != "mesa" and number in self._subject.shown:
                yield self._picture("shown", number, self._given.shown.get(number))

    def _check(self, view: str, frame: int = -1) -> Check:
        return Check(self._subject.name, self._tiles, view, frame)

    def _exit(self) -> Outcome:
        given = self._given
        good = given.exit_code == self._reference.exit_code == 0 and not given.problems and len(given.read) == self._subject.frames
        detail = [f"exit code {given.exit_code}, {len(given.read)} of {self._subject.frames} frames", *given.problems]
        return Outcome(self._check("exit"), good, "; ".join(detail) + ("" if good else "\n" + given.errors[-2000:]))

    def _text(self) -> Outcome:
        lines = list(difflib.unified_diff(self._reference.text, self._given.text, "mesa", "wall", lineterm="", n=0))
        return Outcome(self._check("text"), not lines, "\n".join(lines[:16]))

    def _round_trips(self) -> Outcome:
        waited = self._given.stats.get("round_trips_by_function", {})
        bad = {name: count for name, count in waited.items()
               if name.startswith(LOCAL_ANSWERS) and not name.startswith(REMOTE_ANSWERS)}
        missing = self._tiles != "mesa" and "round_trips" not in self._given.stats
        return Outcome(self._check("round_trips"), not bad and not missing, "no statistics" if missing else f"{bad or waited}")

    def _picture(self, view: str, number: int, picture) -> Outcome:
        check = self._check(view, number)
        if picture is None or number >= len(self._reference.read):
            return Outcome(check, False, NO_PICTURE)
        reference = self._reference.read[number]
        verdict = self._right(reference, picture)
        if not verdict.good:
            name = f"{self._subject.name}-{self._tiles}-{view}-{number}.png"
            compare.save_png(self._report / name, compare.difference_picture(reference, picture))
        return Outcome(check, verdict.good, str(verdict))


def play_all(subjects: list[Subject], options: argparse.Namespace, x: XServer) -> Iterator[Outcome]:
    mesa, references, tiles = MesaStage(x), References(options.references), options.tiles
    with contextlib.ExitStack() as stack:
        stage = mesa if tiles == "mesa" else stack.enter_context(
            WallStage(x, tuple(map(int, tiles.split("x"))), options.backend))
        for subject in subjects:
            start = time.monotonic()
            reference = (references.find(subject) if tiles != "mesa" else None) or mesa.play(subject)
            if tiles == "mesa":
                references.keep(subject, reference)
            outcomes = list(Comparison(subject, tiles, reference, stage.play(subject), options.report).outcomes())
            wrong = sum(not outcome.good for outcome in outcomes)
            waits = next(outcome.detail for outcome in outcomes if outcome.check.view == "round_trips")
            print(f"{subject.kind} {subject.name}: {len(outcomes) - wrong} of {len(outcomes)} right, round trips {waits}, "
                  f"{time.monotonic() - start:.1f} s", flush=True)
            yield from outcomes


def most_telling(failures: list[Outcome]) -> list[Outcome]:
    """Of a subject that gave no pictures, only the failures that are not about pictures: they say why."""
    return [outcome for outcome in failures if outcome.detail != NO_PICTURE] or failures


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--tiles", default="mesa")
    arguments.add_argument("--backend", default="egl", choices=["egl", "osmesa"])
    arguments.add_argument("--only", action="append", default=[], help="recording or scene; may be given again")
    arguments.add_argument("--report", type=Path, default=Path("test-output/golden"), help="folder for pictures of failures")
    arguments.add_argument("--references", type=Path, help="folder of frames on Mesa; written with --tiles mesa")
    options = arguments.parse_args()
    subjects = [*load_recordings(), *load_scenes(build_folder() / "tests" / "golden_scenes")]
    unknown = set(options.only) - {subject.name for subject in subjects}
    if unknown:
        arguments.error(f"no recording or scene {', '.join(sorted(unknown))}")
    chosen = [subject for subject in subjects if not options.only or subject.name in options.only]
    with XServer() as x:
        judgement = judge(play_all(chosen, options, x), load(HERE / "expectations.toml"))
    for outcome in most_telling(judgement.failures):
        print(f"FAILED {outcome.check}: {outcome.detail}")
    for check in judgement.unexpected_passes:
        print(f"UNEXPECTEDLY RIGHT {check}: take it out of expectations.toml")
    print(f"{len(chosen)} subjects, {len(judgement.failures)} failures, {len(judgement.expected)} expected failures, "
          f"{len(judgement.unexpected_passes)} unexpectedly right; pictures of failures in {options.report}")
    return 0 if judgement.good and chosen else 1


if __name__ == "__main__":
    sys.exit(main())
