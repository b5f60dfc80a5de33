#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Plays recorded programs and scenes of our own on plain Mesa and on a wall, and compares every frame: as glReadPixels
returns it and as the composed wall shows it. They are the same: on one tile as in a plain window, on several as plain
Mesa draws each tile's part, everything moved by the tile's place in the window (docs/golden-tests.md). Also compared:
what the scenes' queries answered, that no query waited for an answer of the wall, and that the moved reference matches
the plain one.

golden.py --tiles CxR|mesa [--only NAME]... [--sample K/N] [--backend egl|osmesa] [--report FOLDER]
          [--references FOLDER]
    mesa instead of a wall compares Mesa with itself: it checks these tests, and writes the references.
"""
from __future__ import annotations

import argparse
import concurrent.futures
import contextlib
import difflib
import sys
import time
from collections.abc import Collection, Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))

import compare  # noqa: E402
from expectations import Check, Outcome, judge, load  # noqa: E402
from stages import MesaStage, MovedStage, Performance, Rect, References, WallStage  # noqa: E402
from subjects import WINDOW, Subject, load_recordings, load_scenes  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

# Functions that must be answered without a round trip, whatever the program.
LOCAL_ANSWERS = ("glGet", "glIs", "glAreTexturesResident", "glGenLists", "glGenTextures", "glCheck")
# Those of them whose answer only a node has.
REMOTE_ANSWERS = ("glGetBufferSubData", "glGetMultisample", "glGetTexImage", "glGetQueryObject")
NO_PICTURE = "no picture"


class Comparison:
    """Of a subject's performances: `plain` in a window of plain Mesa, `moved` there in the tiles' parts (on one tile it
    is not needed), and `given` on the wall named `tiles`."""

    def __init__(self, subject: Subject, tiles: str, plain: Performance, moved: Performance | None, given: Performance,
                 report: Path):
        self._subject, self._tiles, self._report = subject, tiles, report
        self._plain, self._moved, self._given = plain, moved, given

    def outcomes(self) -> Iterator[Outcome]:
        yield self._exit()
        yield self._text()
        yield self._round_trips()
        right = self._moved or self._plain
        for number in self._subject.compared:
            yield self._picture("read", number, right.read, frame_of(self._given.read, number))
            if self._tiles != "mesa" and number in self._subject.shown:
                yield self._picture("shown", number, right.read, self._given.shown.get(number))
        if self._moved:
            yield from self._reference(self._moved)

    def _reference(self, moved: Performance) -> Iterator[Outcome]:
        """Moving changes nothing but rounding; and nothing at all where the whole window is one part."""
        if moved.problems or moved.exit_code != 0:
            detail = "; ".join([f"exit code {moved.exit_code}", *moved.problems])
            yield Outcome(self._check("reference"), False, detail + "\n" + moved.errors[-2000:])
        for number in self._subject.compared:
            yield self._picture("reference", number, self._plain.read, frame_of(moved.read, number),
                                compare.same if self._tiles == "mesa" else compare.match)

    def _check(self, view: str, frame: int = -1) -> Check:
        return Check(self._subject.name, self._tiles, view, frame)

    def _exit(self) -> Outcome:
        given = self._given
        good = given.exit_code == self._plain.exit_code == 0 and not given.problems
        good = good and len(given.read) == self._subject.frames
        detail = [f"exit code {given.exit_code}, {len(given.read)} of {self._subject.frames} frames", *given.problems]
        return Outcome(self._check("exit"), good, "; ".join(detail) + ("" if good else "\n" + given.errors[-2000:]))

    def _text(self) -> Outcome:
        lines = list(difflib.unified_diff(self._plain.text, self._given.text, "mesa", "wall", lineterm="", n=0))
        return Outcome(self._check("text"), not lines, "\n".join(lines[:16]))

    def _round_trips(self) -> Outcome:
        waited = self._given.stats.get("round_trips_by_function", {})
        bad = {name: count for name, count in waited.items()
               if name.startswith(LOCAL_ANSWERS) and not name.startswith(REMOTE_ANSWERS)}
        missing = self._tiles != "mesa" and "round_trips" not in self._given.stats
        return Outcome(self._check("round_trips"), not bad and not missing,
                       "no statistics" if missing else f"{bad or waited}")

    def _picture(self, view: str, number: int, references: list, picture, right=compare.same) -> Outcome:
        check, reference = self._check(view, number), frame_of(references, number)
        if picture is None or reference is None:
            return Outcome(check, False, NO_PICTURE)
        verdict = right(reference, picture)
        if not verdict.good:
            name = f"{self._subject.name}-{self._tiles}-{view}-{number}.png"
            compare.save_png(self._report / name, compare.difference_picture(reference, picture))
        return Outcome(check, verdict.good, str(verdict), near=not verdict.reason and verdict.outside == 0)


def frame_of(pictures: list, number: int):
    return pictures[number] if number < len(pictures) else None


def either(first: list[Outcome], second: list[Outcome], expected: Collection[Check]) -> list[Outcome]:
    """Of the same checks against two plays of the references, the one that is good; else the first. What is expected to
    fail is not tried twice."""
    return [two if two.good and not one.good and one.check not in expected else one
            for one, two in zip(first, second, strict=True)]


class Played:
    """Each subject's references on plain Mesa: the whole window, and in parts. They are made one subject ahead, on the
    processor's time that the wall leaves."""

    def __init__(self, subjects: list[Subject], whole: MesaStage, parts: MovedStage | None, kept: References,
                 keep: bool):
        self._subjects, self._whole, self._parts, self._kept, self._keep = subjects, whole, parts, kept, keep

    def __iter__(self) -> Iterator[tuple[Subject, Performance, Performance | None]]:
        with concurrent.futures.ThreadPoolExecutor(1) as beside:
            self._beside = beside
            ahead = beside.submit(self._play, self._subjects[0])
            for i, subject in enumerate(self._subjects):
                plain, moved = ahead.result()
                if i + 1 < len(self._subjects):
                    ahead = beside.submit(self._play, self._subjects[i + 1])
                yield subject, plain, moved

    def again(self, subject: Subject) -> tuple[Performance, Performance | None]:
        """Plays them a second time; between two steps of the iteration."""
        def play() -> tuple[Performance, Performance | None]:
            return self._whole.play(subject), self._play_moved(subject)
        return self._beside.submit(play).result()  # not beside another play: they have the displays in common

    def _play(self, subject: Subject) -> tuple[Performance, Performance | None]:
        plain = (None if self._keep else self._kept.find(subject)) or self._whole.play(subject)
        if self._keep:
            self._kept.keep(subject, plain)
        return plain, self._play_moved(subject)

    def _play_moved(self, subject: Subject) -> Performance | None:
        return self._parts.play(subject) if self._parts and not subject.whole else None


def whole_window(window: tuple[int, int]) -> list[Rect]:
    return [(0, 0, *window)]


def play_all(subjects: list[Subject], expected: Collection[Check], options: argparse.Namespace) -> Iterator[Outcome]:
    tiles = options.tiles
    with contextlib.ExitStack() as stack:
        def x_server() -> XServer:
            return stack.enter_context(XServer())

        if tiles == "mesa":
            stage, count = MesaStage(x_server()), 1
        else:
            stage = stack.enter_context(WallStage(x_server(), tuple(map(int, tiles.split("x"))), options.backend,
                                                  gpus=options.gpus, triangle_order=options.triangle_order,
                                                  sort_last=options.sort_last))
            count = len(stage.parts(WINDOW))
        servers = [x_server() for _ in range(count)]
        parts_of_window = whole_window if tiles == "mesa" else stage.parts
        moved = MovedStage(parts_of_window, build_folder(), servers) if tiles != "1x1" else None
        played = Played(subjects, MesaStage(servers[0]), moved, References(options.references), keep=tiles == "mesa")
        for subject, plain, in_parts in played:
            start = time.monotonic()
            given = stage.play(subject)
            outcomes = list(Comparison(subject, tiles, plain, in_parts, given, options.report).outcomes())
            # Mesa itself does not draw each frame alike every time: it reads memory that nobody has written (frame 0 of
            # `engine` shows it). So a frame is wrong only if Mesa draws it otherwise twice.
            if any(not outcome.good and outcome.check not in expected for outcome in outcomes):
                second = Comparison(subject, tiles, *played.again(subject), given, options.report)
                outcomes = either(outcomes, list(second.outcomes()), expected)
            wrong = sum(not outcome.good for outcome in outcomes)
            waits = next(outcome.detail for outcome in outcomes if outcome.check.view == "round_trips")
            print(f"{subject.kind} {subject.name}: {len(outcomes) - wrong} of {len(outcomes)} right, round trips "
                  f"{waits}, "
                  f"{time.monotonic() - start:.1f} s", flush=True)
            yield from outcomes


def sample(subjects: list[Subject], which: str) -> list[Subject]:
    """Of recordings the Kth of every N, `which` being "K/N"; of scenes all, since each is about something else."""
    number, of = map(int, which.split("/"))
    if not 1 <= number <= of:
        raise ValueError(f"{which}: expected K/N with K from 1 to N")
    recordings = [subject for subject in subjects if subject.kind == "recording"]
    return [subject for subject in subjects
            if subject.kind != "recording" or recordings.index(subject) % of == number - 1]


def most_telling(failures: list[Outcome]) -> list[Outcome]:
    """Of a subject that gave no pictures, only the failures that are not about pictures: they say why."""
    return [outcome for outcome in failures if outcome.detail != NO_PICTURE] or failures


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--tiles", default="mesa")
    arguments.add_argument("--sample", default="1/1", metavar="K/N", help="of recordings only the Kth of every N")
    arguments.add_argument("--backend", default="egl", choices=["egl", "osmesa"])
    arguments.add_argument("--gpus", type=int, default=0, help="all tiles on one node that draws with so many")
    arguments.add_argument("--sort-last", action="store_true", help="geometry is dealt to the nodes")
    arguments.add_argument("--triangle-order", default="", choices=["auto", "on", "off"], help="of the nodes")
    arguments.add_argument("--only", action="append", default=[], help="recording or scene; may be given again")
    arguments.add_argument("--report", type=Path, default=Path("test-output/golden"),
                           help="folder for pictures of failures")
    arguments.add_argument("--references", type=Path, help="folder of frames on Mesa; written with --tiles mesa")
    options = arguments.parse_args()
    subjects = [*load_recordings(), *load_scenes(build_folder() / "tests" / "golden_scenes")]
    unknown = set(options.only) - {subject.name for subject in subjects}
    if unknown:
        arguments.error(f"no recording or scene {', '.join(sorted(unknown))}")
    try:
        sampled = sample(subjects, options.sample)
    except ValueError as error:
        arguments.error(str(error))
    chosen = [subject for subject in subjects if subject.name in options.only] or sampled
    expected = load(HERE / "expectations.toml")
    judgement = judge(play_all(chosen, expected, options), expected)
    for outcome in most_telling(judgement.failures):
        print(f"FAILED {outcome.check}: {outcome.detail}")
    for check in judgement.unexpected_passes:
        print(f"UNEXPECTEDLY RIGHT {check}: take it out of expectations.toml")
    print(f"{len(chosen)} subjects, {len(judgement.failures)} failures, {len(judgement.expected)} expected failures, "
          f"{len(judgement.unexpected_passes)} unexpectedly right; pictures of failures in {options.report}")
    return 0 if judgement.good and chosen else 1


if __name__ == "__main__":
    sys.exit(main())
