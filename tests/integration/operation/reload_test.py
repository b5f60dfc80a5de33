# SPDX-License-Identifier: MIT
"""wall.toml changes while programs run: tiles come, move to other nodes and go, and nodes with them. Afterwards the
wall shows what a wall shows that was so from the beginning; programs never notice. What makes no sense is refused, and
nothing is changed then."""
from __future__ import annotations

import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import numpy  # noqa: E402
from compare import same  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from show import PROGRAMS, SETTLED, OneMachine, Show, until  # noqa: E402
from wall import Wall, WallError, build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

LEFT, MIDDLE, RIGHT = (0, 0, 200, 300), (200, 0, 200, 300), (400, 0, 200, 300)
TWO = {"a": {"one": LEFT}, "b": {"two": MIDDLE}}
THREE = {**TWO, "c": {"three": RIGHT}}
QUIET = {"LP_NUM_THREADS": "0"}
FPS = 20
RIGHT_AGAIN = 15.0  # seconds until the wall is right; about 1 where the machine does nothing else
SOME = 10  # frames, from which one sees that a program goes on


class AWallThatChanges(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        whole = cls.enterClassContext(Wall((3, 1), (200, 300), one_node=True, environment=QUIET, die_with_parent=True))
        cls.whole = OneMachine(whole, cls.x)

    def wall_of(self, plan: dict) -> PlannedWall:
        return self.enterContext(PlannedWall(plan, environment=QUIET, die_with_parent=True))

    def show_on(self, wall: Wall) -> Show:
        show = Show(wall, wall.run, self.x, FPS)
        self.addCleanup(end_all, show.apps)
        return show

    def assert_becomes_right(self, show: Show) -> None:
        """All that the wall has tiles for, from its left edge on; with frames to come. It goes on then."""
        end = time.monotonic() + RIGHT_AGAIN
        while True:
            show.hold()
            picture = show.picture()
            verdict = same(self.whole.picture(show.frames)[:, :picture.shape[1]], picture)
            if verdict.good:
                break
            self.assertLess(time.monotonic(), end, f"frames {show.frames}: {verdict}")
            show.go_on()
            time.sleep(SETTLED)
        for app in show.apps:
            self.assertIsNone(app.poll(), "the program runs on")
        self.assertEqual(show.sessions, {s["id"] for s in show.wall.sessions()}, "as the same sessions")
        self.assertEqual([s["fault"] for s in show.wall.sessions()], [""] * len(show.apps))
        show.go_on()

    def assert_goes_on(self, show: Show) -> None:
        first = show.clock.frame_now()
        until(lambda: show.clock.frame_now() >= first + SOME, "the program goes on", RIGHT_AGAIN)

    def come_back(self, show: Show) -> None:
        """Its programs, to a walld that was started again."""
        until(lambda: show.sessions <= {s["id"] for s in show.wall.sessions() if s["surfaces"]}, "all come back",
              RIGHT_AGAIN)

    def tiles(self, wall: Wall) -> dict[str, tuple[str, list[int]]]:
        return {tile["name"]: (tile["node"], tile["rect"]) for tile in wall.ctl("tiles")}

    def test_tiles_come_move_and_go(self) -> None:
        wall = self.wall_of(TWO)
        show = self.show_on(wall)
        show.go_on()
        self.assert_becomes_right(show)
        pids = {name: daemon.pid for name, daemon in wall.daemons.items()}

        wall.reload(THREE)
        self.assertEqual(wall.status()["wall"]["width"], 600)
        self.assert_becomes_right(show)

        wall.reload({"a": {"one": RIGHT}, "b": {"two": MIDDLE}, "c": {"three": LEFT}})
        self.assertEqual(self.tiles(wall)["one"], ("a", list(RIGHT)))
        self.assert_becomes_right(show)

        wall.reload({"a": {"one": RIGHT}, "b": {"two": MIDDLE, "three": LEFT}}, by_signal=True)
        self.assertEqual(self.tiles(wall)["three"], ("b", list(LEFT)))
        self.assert_becomes_right(show)
        end_all([wall.daemons.pop("c")])

        wall.reload({"b": {"two": MIDDLE, "three": LEFT}})
        self.assertEqual(wall.status()["wall"]["width"], 400)
        self.assert_becomes_right(show)

        end_all([wall.daemons.pop("a")])
        wall.reload({"b": {"two": MIDDLE, "three": LEFT}, "a": {"one": RIGHT}})
        self.assert_becomes_right(show)
        self.assertEqual({name: wall.daemons[name].pid for name in ("walld", "b")},
                         {name: pids[name] for name in ("walld", "b")}, "nobody was started by hand but who was ended")

    def test_a_node_whose_description_is_as_before_goes_on(self) -> None:
        wall = self.wall_of(TWO)
        show = self.show_on(wall)
        before = {n["name"]: n["incarnation"] for n in wall.nodes()}
        wall.reload(THREE)
        after = {n["name"]: n["incarnation"] for n in wall.nodes()}
        self.assertEqual({name: after[name] for name in before}, before)
        show.go_on()
        self.assert_goes_on(show)

    def test_what_makes_no_sense_changes_nothing(self) -> None:
        wall = self.wall_of(TWO)
        show = self.show_on(wall)
        before, tiles, text = wall.status(), self.tiles(wall), (wall.folder / "wall.toml").read_text()
        for changed, words in ((text.replace("[people]", "[peple]"), r"wall.toml:\d+: unknown key 'peple'"),
                               (text + wall.node_text("a", {"x": RIGHT}), r"wall.toml:\d+: node 'a' appears twice"),
                               (text.replace("walld.sock", "other.sock"), "'listen' in .control. has changed"),
                               (text.replace("= 250", "= 300"), "'swap_timeout_ms' in .wall. has changed")):
            self.assertNotEqual(changed, text)
            (wall.folder / "wall.toml").write_text(changed)
            with self.assertRaisesRegex(WallError, words):
                wall.ctl("reload")
        (wall.folder / "wall.toml").write_text(text)
        self.assertEqual(wall.status()["wall"], before["wall"])
        self.assertEqual(self.tiles(wall), tiles)
        self.assertEqual({n["name"]: n["incarnation"] for n in wall.nodes()},
                         {n["name"]: n["incarnation"] for n in before["nodes"]})
        show.go_on()
        self.assert_becomes_right(show)

    def test_a_node_is_added_by_name_and_removed(self) -> None:
        wall = self.wall_of(TWO)
        show = self.show_on(wall)
        show.go_on()
        table = wall.node_text("c", {"three": RIGHT})
        file = wall.folder / "c-node.toml"
        file.write_text(table)
        self.assertEqual(wall.ctl("node", "add", file), {"nodes": ["c"], "tiles": 3})
        with self.assertRaisesRegex(WallError, "has a node 'c' already"):
            wall.ctl("node", "add", file)
        wall.start_node_of("c", (wall.folder / "wall.toml").read_text() + table)
        wall.wait_nodes()
        self.assert_becomes_right(show)

        wall.restart_walld()  # which has kept it
        self.come_back(show)
        self.assertEqual(self.tiles(wall)["three"], ("c", list(RIGHT)))
        self.assert_becomes_right(show)

        with self.assertRaisesRegex(WallError, "stands in .*wall.toml: take it out there"):
            wall.ctl("node", "remove", "a")
        self.assertEqual(wall.ctl("node", "remove", "c"), {"nodes": ["c"], "tiles": 2})
        with self.assertRaisesRegex(WallError, "there is no node 'c'"):
            wall.ctl("node", "remove", "c")
        self.assert_becomes_right(show)
        self.assertNotIn("c", {n["name"] for n in wall.nodes()})

    def test_a_node_is_drained_and_serves_again(self) -> None:
        wall = self.wall_of(THREE)
        show = self.show_on(wall)
        show.go_on()
        self.assert_becomes_right(show)
        wall.ctl("node", "drain", "b")
        until(lambda: self.node(wall, "b")["drained"] and not self.node(wall, "b")["up"], "it is drained", RIGHT_AGAIN)
        self.assert_goes_on(show)
        until(lambda: self.is_dark(show), "its tile goes dark", RIGHT_AGAIN)
        end_all([wall.daemons["b"]])  # what it was drained for
        self.assert_goes_on(show)
        wall.restart_walld_only()
        self.come_back(show)
        self.assertTrue(self.node(wall, "b")["drained"], "walld has kept that")
        wall.start_node("b")
        self.assert_goes_on(show)
        self.assertFalse(self.node(wall, "b")["up"])
        wall.ctl("node", "undrain", "b")
        wall.wait_nodes()
        self.assert_becomes_right(show)
        with self.assertRaisesRegex(WallError, "there is no node 'x'"):
            wall.ctl("node", "drain", "x")

    @staticmethod
    def node(wall: Wall, name: str) -> dict:
        return next(n for n in wall.nodes() if n["name"] == name)

    @staticmethod
    def is_dark(show: Show) -> bool:
        return not numpy.any(show.picture()[:, MIDDLE[0]:MIDDLE[0] + MIDDLE[2]])

    def test_a_full_screen_program_fills_the_wall_that_there_is(self) -> None:
        wall = self.wall_of(TWO)
        app = wall.run(PROGRAMS / "frame_clock", "--size", "400x300", "--fps", FPS, fullscreen=True,
                       env=self.x.environment())
        session = wall.wait_session(app)
        wall.wait(session, SOME)
        wall.reload(THREE)

        def fills() -> bool:
            shown = wall.sessions()[0]["surfaces"][0]
            return shown["shown_rect"] == [0, 0, 600, 300] and not shown["moving"]
        until(fills, "the program covers the new tile, too", RIGHT_AGAIN)

    def test_a_window_whose_place_is_gone_gets_another_one(self) -> None:
        wall = self.wall_of(THREE)
        app = wall.run(PROGRAMS / "frame_clock", "--size", "100x100", "--fps", FPS, rect=(450, 50, 100, 100),
                       env=self.x.environment())
        wall.wait(wall.wait_session(app), SOME)
        wall.reload(TWO)

        def shown() -> list[int]:
            return wall.sessions()[0]["surfaces"][0]["shown_rect"]
        until(lambda: shown()[0] + shown()[2] <= 400, "it lies on the wall", RIGHT_AGAIN)


class AParallelProgram(unittest.TestCase):
    def test_goes_on_with_other_tiles(self) -> None:
        with XServer() as x, PlannedWall(TWO, environment=QUIET, die_with_parent=True) as wall:
            line = wall.wallrun(build_folder() / "examples" / "march", "--cells", "16", "--size", "600x300",
                                rect=(0, 0, 600, 300))
            line[1:1] = ["--parallel", "2"]
            wall.run_line(line, env=x.environment())
            session = wall.wait_session()
            for plan in (THREE, {"a": {"one": RIGHT}, "b": {"two": MIDDLE}, "c": {"three": LEFT}}):
                wall.reload(plan)
                frame = wall.wait(session, 1)
                wall.wait(session, frame + 3 * SOME, limit=RIGHT_AGAIN)
            self.assertEqual([s["fault"] for s in wall.sessions()], [""])


if __name__ == "__main__":
    unittest.main()
