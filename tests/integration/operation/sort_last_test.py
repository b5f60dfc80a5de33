# SPDX-License-Identifier: MIT
"""Programs whose geometry is dealt to nodes (docs/sort-last.md): their pictures are those that they have without it,
for any number of nodes that draw, and again when one of them is gone."""
from __future__ import annotations

import subprocess
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import numpy as np  # noqa: E402
from compare import load_png  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

QUIET = {"LP_NUM_THREADS": "0"}
SIZE = 320, 240  # of a tile
BLENDED = (build_folder() / "examples" / "volume", "--cells", "32", "--planes", "60", "--size", "600x400",
           "--step", "75")  # a slab that is behind the others in one frame is before them in the next
ROUNDING = 8  # of a colour of 255: each process' part is rounded by itself, in each of its planes (6 is measured)
MARCH = (build_folder() / "examples" / "march", "--cells", "24", "--size", "600x400")
LIGHT = (build_folder() / "examples" / "march", "--cells", "8", "--size", "600x400")  # its nodes have more to do
FRAME = 4


def plan_of(renderers: int) -> dict:
    """Two nodes that show two tiles each, and some that have none."""
    width, height = SIZE
    shows = {f"shows{row}": {f"t{column}{row}": (column * width, row * height, width, height) for column in range(2)}
             for row in range(2)}
    return shows | {f"draws{i}": {} for i in range(renderers)}


def keys_of(renderers: int) -> dict[str, str]:
    return {f"shows{row}": 'role = "display"' for row in range(2)} | {
        f"draws{i}": 'role = ["render"]' for i in range(renderers)}


class ProgramsThatAreDealt(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())

    def wall_of(self, renderers: int) -> PlannedWall:
        return self.enterContext(PlannedWall(plan_of(renderers), node_keys=keys_of(renderers), environment=QUIET,
                                             swap_timeout_ms=5000, die_with_parent=True))

    def start(self, wall: PlannedWall, *command: object, sort_last: bool = True) -> tuple[subprocess.Popen, int]:
        line = wall.wallrun(*command, rect=(13, 9, 600, 400), hold=True, sort_last=sort_last)
        app = wall.run_line(line, env=self.x.environment(), stdout=subprocess.DEVNULL)
        return app, wall.wait_session(app)

    def picture(self, wall: PlannedWall, session: int, frame: int) -> np.ndarray:
        wall.step(session, frame)
        wall.wait(session, frame)
        path = wall.folder / "wall.png"
        wall.screenshot(path)
        return load_png(path)[:, :, :3]

    def partials(self, wall: PlannedWall, session: int) -> dict:
        return next(s for s in wall.sessions() if s["id"] == session)["partials"]

    def without(self, frame: int, program: tuple = MARCH) -> np.ndarray:
        """What the wall shows of a program, drawn by the nodes that show it."""
        with PlannedWall(plan_of(0), environment=QUIET, swap_timeout_ms=5000) as plain:
            app, session = self.start(plain, *program, sort_last=False)
            shown = self.picture(plain, session, frame)
            self.assertEqual(self.partials(plain, session)["merged"], 0)
        return shown

    def test_their_pictures_are_the_same_by_any_number_of_nodes(self) -> None:
        expected = self.without(FRAME)
        self.assertGreater((expected != expected[0, 0]).any(axis=2).mean(), 0.05, "there is something to be seen")
        for renderers in (1, 2, 4, 8):
            with self.subTest(renderers=renderers), PlannedWall(
                    plan_of(renderers), node_keys=keys_of(renderers), environment=QUIET, swap_timeout_ms=5000) as wall:
                app, session = self.start(wall, *MARCH)
                given = self.picture(wall, session, FRAME)
                self.assertEqual(int((given != expected).any(axis=2).sum()), 0)
                wall._until(lambda: self.partials(wall, session)["merged"] > 0, "nodes merge what others draw", "walld")
                self.assertEqual(self.partials(wall, session)["missed"], 0)

    def test_their_pictures_are_the_same_whoever_composes_them(self) -> None:
        expected = self.without(FRAME)
        drawing = {f"draws{i}": 'role = "render"' for i in range(3)}
        showing = {f"shows{row}": 'role = "display"' for row in range(2)}
        walls = {"those that draw": {name: 'role = ["render", "compose"]' for name in drawing} | showing,
                 "those that show": drawing | {name: 'role = ["compose", "display"]' for name in showing},
                 "one more": drawing | showing | {"composes": 'role = "compose"'},
                 "all do what they can": {name: 'role = ["render", "compose"]' for name in drawing} | {
                     name: 'role = ["render", "compose", "display"]' for name in showing}}
        for who, keys in walls.items():
            plan = plan_of(3) | ({"composes": {}} if "composes" in keys else {})
            with self.subTest(who), PlannedWall(plan, node_keys=keys, environment=QUIET, swap_timeout_ms=5000) as wall:
                app, session = self.start(wall, *MARCH)
                given = self.picture(wall, session, FRAME)
                self.assertEqual(int((given != expected).any(axis=2).sum()), 0)
                wall._until(lambda: self.partials(wall, session)["merged"] > 0, "nodes merge what others draw", "walld")
                self.assertEqual(self.partials(wall, session)["missed"], 0)

    def test_a_node_that_composes_may_go(self) -> None:
        keys = keys_of(2) | {f"composes{i}": 'role = "compose"' for i in range(2)}
        wall = self.enterContext(PlannedWall(plan_of(2) | {f"composes{i}": {} for i in range(2)}, node_keys=keys,
                                             environment=QUIET, swap_timeout_ms=5000, die_with_parent=True))
        app, session = self.start(wall, *MARCH)
        self.picture(wall, session, 2)
        wall.hold(session, False)
        wall.wait(session, 10)
        wall.daemons["composes0"].kill()
        wall.daemons["composes0"].wait()
        killed = time.monotonic()
        wall.wait(session, wall.wait(session, 1) + 5)
        self.assertLess(time.monotonic() - killed, 1.0, "the other one has its part")
        wall.hold(session)
        after = self.picture(wall, session, 1)
        frame = next(s for s in wall.sessions() if s["id"] == session)["surfaces"][0]["frame"]
        self.assertEqual(int((after != self.without(frame)).any(axis=2).sum()), 0)

    def test_a_wall_may_have_it_tried_for_all(self) -> None:
        """Whether it is kept is a matter of speed; that it is tried is seen where a program waits for its nodes."""
        expected = self.without(FRAME, LIGHT)
        wall = self.enterContext(PlannedWall(plan_of(2), node_keys=keys_of(2), environment=QUIET, swap_timeout_ms=5000,
                                             options='sort_last = "measured"', die_with_parent=True))
        app, session = self.start(wall, *LIGHT, sort_last=False)
        self.assertEqual(int((self.picture(wall, session, FRAME) != expected).any(axis=2).sum()), 0)
        self.assertEqual(self.partials(wall, session)["merged"], 0)
        wall.hold(session, False)
        wall._until(lambda: self.partials(wall, session)["merged"] > 0, "it is tried", "walld", limit=60)
        wall.hold(session)
        shown = lambda: next(s for s in wall.sessions() if s["id"] == session)["surfaces"][0]["frame"]  # noqa: E731
        frame = shown()
        while (now := (time.sleep(0.5), shown())[1]) != frame:  # what was on its way when it was held
            frame = now
        wall.step(session)
        wall.wait(session, frame + 1)
        path = wall.folder / "wall.png"
        wall.screenshot(path)
        self.assertEqual(int((load_png(path)[:, :, :3] != self.without(frame + 1, LIGHT)).any(axis=2).sum()), 0)

    def test_a_node_that_draws_may_go(self) -> None:
        wall = self.wall_of(2)
        app, session = self.start(wall, *MARCH)
        self.picture(wall, session, 2)
        wall._until(lambda: self.partials(wall, session)["merged"] > 0, "nodes merge what others draw", "walld")
        wall.hold(session, False)
        wall.wait(session, 10)
        wall.daemons["draws0"].kill()
        wall.daemons["draws0"].wait()
        killed = time.monotonic()
        wall.wait(session, wall.wait(session, 1) + 5)
        self.assertLess(time.monotonic() - killed, 1.0, "nobody waits for what it would have drawn")
        wall.hold(session)
        after = self.picture(wall, session, 1)
        frame = next(s for s in wall.sessions() if s["id"] == session)["surfaces"][0]["frame"]
        expected = self.without(frame)
        self.assertEqual(int((after != expected).any(axis=2).sum()), 0)

    def test_processes_of_a_parallel_program_draw_on_a_node_each(self) -> None:
        expected = self.without(FRAME)
        for ranks, renderers in ((2, 2), (4, 3)):
            with self.subTest(ranks=ranks, renderers=renderers), PlannedWall(
                    plan_of(renderers), node_keys=keys_of(renderers), environment=QUIET, swap_timeout_ms=5000) as wall:
                wall.run_line(wall.wallrun(*MARCH, rect=(13, 9, 600, 400), hold=True, sort_last=True, parallel=ranks),
                              env=self.x.environment(), stdout=subprocess.DEVNULL)
                session = wall.wait_session()
                given = self.picture(wall, session, FRAME)
                self.assertEqual(int((given != expected).any(axis=2).sum()), 0)
                wall._until(lambda: self.partials(wall, session)["merged"] > 0, "nodes merge what others draw", "walld")
                self.assertEqual(self.partials(wall, session)["missed"], 0)

    def blended(self, wall: PlannedWall, ranks: int, *more: object) -> int:
        """The session of so many processes, each with a slab of the volume."""
        line = wall.wallrun(*BLENDED, *more, rect=(13, 9, 600, 400), hold=True, sort_last=True, parallel=ranks)
        wall.run_line(line, env=self.x.environment(), stdout=subprocess.DEVNULL)
        return wall.wait_session()

    def test_what_they_blend_lies_one_over_the_other_in_their_order(self) -> None:
        first, second = (self.without(frame, BLENDED).astype(int) for frame in (1, 2))
        self.assertGreater((first != first[0, 0]).any(axis=2).mean(), 0.05, "there is something to be seen")
        all_do_both = {f"node{i}": {f"t{i % 2}{i // 2}": (i % 2 * SIZE[0], i // 2 * SIZE[1], *SIZE)} for i in range(4)}
        walls = {"nodes that draw": (2, plan_of(2), keys_of(2)),
                 "more processes than nodes": (4, plan_of(3), keys_of(3)),
                 "nodes that do both": (4, all_do_both, {})}
        for name, (ranks, plan, keys) in walls.items():
            with self.subTest(name), PlannedWall(plan, node_keys=keys, environment=QUIET,
                                                 swap_timeout_ms=5000) as wall:
                session = self.blended(wall, ranks)
                for expected in (first, second):
                    given = self.picture(wall, session, 1).astype(int)
                    self.assertLessEqual(int(abs(given - expected).max()), ROUNDING)
                wall._until(lambda: self.partials(wall, session)["merged"] > 0, "nodes merge what others draw", "walld")
                self.assertEqual(self.partials(wall, session)["missed"], 0)
        with PlannedWall(plan_of(2), node_keys=keys_of(2), environment=QUIET, swap_timeout_ms=5000) as wall:
            wrong = self.picture(wall, self.blended(wall, 2, "--order", "front"), 1).astype(int)
            self.assertGreater(int(abs(wrong - first).max()), 5 * ROUNDING, "the order is to be seen")


if __name__ == "__main__":
    unittest.main()
