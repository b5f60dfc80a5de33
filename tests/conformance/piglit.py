#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs piglit's tests on a wall. What does not pass there is run on plain Mesa as well: worse than Mesa is a
failure."""
from __future__ import annotations

import argparse
import collections
import re
import subprocess
import sys
import time
import zlib
from collections.abc import Callable, Collection, Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))

import report  # noqa: E402
from expectations import load, on_wall  # noqa: E402
from players import MesaPlayer, WallPlayer, play_all  # noqa: E402
from results import Outcome, judge  # noqa: E402
from suite import HOME, PROFILES, Offer, SuiteError, Test, all_tests, group_of, in_framebuffer  # noqa: E402
from suite import load_left_out, read_offer, with_es  # noqa: E402
from wall import Wall, WallError  # noqa: E402
from xserver import XServer  # noqa: E402

PROGRESS = 10.0  # seconds between two lines of progress
LARGE_GROUP = 300  # tests; its like are generated, hundreds of a kind
HELP = """\
Selected are the tests about what the wall offers: its OpenGL and GLSL versions and extensions, GLX and EGL. They draw
into windows, with --fbo into framebuffer objects. A test that is skipped asks for something that is not offered: that
is no failure.

    piglit.py                                   everything, on one tile
    piglit.py --tiles 4x3 --tile-size 144x150   on twelve tiles so small that windows cross their borders
    piglit.py --fbo                             into framebuffer objects what piglit itself would draw there
    piglit.py --part 2/4                        a quarter of the tests
    piglit.py --filter 'texwrap|copy-pixels'    tests whose name has this
    piglit.py --filter 'pbo$' --list            which these are, and how each is started by hand

report.txt in the report folder has a table by group, why tests were skipped, and the last lines of each that failed;
report.json has everything. Known differences are in expectations.toml, with their reasons. docs/conformance.md tells
more.
"""


def pair(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d+)x(\d+)", text)
    if not found:
        raise argparse.ArgumentTypeError(f"'{text}', expected two numbers as 2x2")
    return int(found[1]), int(found[2])


def part(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d+)/(\d+)", text)
    if not found or not 1 <= int(found[1]) <= int(found[2]):
        raise argparse.ArgumentTypeError(f"'{text}', expected one of some as 2/4")
    return int(found[1]), int(found[2])


def read_arguments(given: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, epilog=HELP,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tiles", type=pair, default=(1, 1), metavar="CxR",
                        help="columns and rows of the wall, a node each; default 1x1")
    parser.add_argument("--tile-size", type=pair, default=(1280, 1024), metavar="WxH",
                        help="pixels of a tile; default 1280x1024")
    parser.add_argument("--filter", type=re.compile, default=re.compile(""), metavar="REGEX",
                        help="only tests whose name has this")
    parser.add_argument("--profile", action="append", choices=PROFILES,
                        help="only tests of this profile; may be given again; "
                        "opengl are programs, shader are scripts that draw, glslparser only compile")
    parser.add_argument("--all", action="store_true", help="also what selection.toml leaves out")
    parser.add_argument("--sample", type=int, default=1, metavar="N",
                        help=f"of groups of more than {LARGE_GROUP} tests only one of N, always the same; default all")
    parser.add_argument("--part", type=part, default=(1, 1), metavar="K/N",
                        help="the K-th of N parts, always the same, which together are all")
    parser.add_argument("--fbo", action="store_true",
                        help="tests that can, draw into framebuffer objects; the others are left out")
    parser.add_argument("--list", action="store_true", help="only print the tests")
    parser.add_argument("-j", "--jobs", type=int, default=2, help="tests at a time; default 2")
    parser.add_argument("--timeout", type=float, default=120.0, metavar="S",
                        help="seconds until a test is ended; default 120")
    parser.add_argument("--report", type=Path, default=Path("test-output/conformance"), help="folder for the report")
    return parser.parse_args(given)


def offer_of(player: WallPlayer) -> Offer:
    offer = read_offer(player.play(Test("glinfo", (str(HOME / "bin" / "glinfo"), "-auto"), "opengl")).output)
    return with_es(offer, player.play(Test("es2_info", ("es2_info",), "opengl")).output)


class Selection:
    """Of all tests, those to run; and how many were left out for which reason."""

    def __init__(self, tests: list[Test], offer: Offer, options: argparse.Namespace):
        left_out = [] if options.all else load_left_out(HERE / "selection.toml")
        self.offer = offer
        self.left_out: collections.Counter[str] = collections.Counter()
        self.tests: list[Test] = []
        for test in sorted(tests, key=lambda test: PROFILES.index(test.profile)):
            if (not group_of(test.name, offer) or not options.filter.search(test.name)
                    or test.profile not in (options.profile or PROFILES) or (options.fbo and not test.offscreen)):
                continue
            reason = next((each.reason for each in left_out if each.pattern.search(test.name)), "")
            if reason:
                self.left_out[reason] += 1
            else:
                self.tests.append(in_framebuffer(test) if options.fbo else test)
        if options.sample > 1:
            self.tests = sample(self.tests, options.sample, lambda test: group_of(test.name, offer))
        which, of = options.part
        self.tests = [test for test in self.tests if zlib.crc32(b"part " + test.name.encode()) % of == which - 1]


def sample(tests: list[Test], of: int, group: Callable[[Test], str]) -> list[Test]:
    """One of so many tests of each large group, by their names, the same everywhere; all of the others."""
    sizes = collections.Counter(group(test) for test in tests)
    return [test for test in tests
            if sizes[group(test)] <= LARGE_GROUP or zlib.crc32(test.name.encode()) % of == 0]


class Progress:
    def __init__(self, total: int):
        self._start = self._last = time.monotonic()
        self._total, self._done = total, 0

    def step(self) -> None:
        self._done += 1
        now = time.monotonic()
        if now - self._last >= PROGRESS:
            self._last = now
            print(f"{self._done} of {self._total} tests, {now - self._start:.0f} s", flush=True)


def play(wall: WallPlayer, mesa: MesaPlayer, selection: Selection, expected: Collection[str],
         jobs: int) -> Iterator[Outcome]:
    """Ends early once a daemon of the wall is in trouble."""
    progress = Progress(len(selection.tests))
    for test, given in play_all(wall, selection.tests, jobs):
        reference = None if given.good else mesa.play(test)
        outcome = Outcome(test.name, group_of(test.name, selection.offer), given, reference)
        if outcome.worse and test.name not in expected:
            print(f"{outcome.worse}: {test.name}", flush=True)
        yield outcome
        progress.step()
        if trouble := wall.trouble():
            print("stopped: " + "; ".join(trouble), flush=True)
            return


def run(options: argparse.Namespace) -> bool:
    tests = all_tests()
    name = "{}x{} of {}x{}".format(*options.tiles, *options.tile_size) + (", -fbo" if options.fbo else "")
    expected = on_wall(load(HERE / "expectations.toml"), name)
    with XServer() as x, Wall(tiles=options.tiles, tile_size=options.tile_size, name="conformance",
                              swap_timeout_ms=10000,
                              environment={"LP_NUM_THREADS": "0"}, die_with_parent=True) as wall:
        player = WallPlayer(x, wall, options.timeout)
        selection = Selection(tests, offer_of(player), options)
        if options.list:
            print("\n".join(f"{test.name}\n    {' '.join(test.command)}" for test in selection.tests))
            return True
        start = time.monotonic()
        mesa = MesaPlayer(x, options.timeout, selection.offer.es)
        outcomes = list(play(player, mesa, selection, expected, options.jobs))
        described = report.Run(name, time.monotonic() - start, dict(selection.left_out), player.aftermath())
    judgement = judge(outcomes, expected, [test.name for test in tests])
    print(report.write(options.report, described, judgement, expected), end="")
    return described.good(judgement)


def main() -> int:
    options = read_arguments()
    try:
        return 0 if run(options) else 1
    except (SuiteError, WallError, ValueError, subprocess.SubprocessError) as error:
        print(f"conformance: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
