# SPDX-License-Identifier: MIT
"""A tileserver that draws with several GPUs (docs/gpus.md): each is a node of the wall, with a process of its own.
Several contexts of the software renderer stand for GPUs here."""
from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from compare import same  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from show import OneMachine, Part, Show, until  # noqa: E402
from wall import Wall, WallError, build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

PLAN = {"a": {"one": (0, 0, 200, 300), "two": (200, 0, 200, 300)}, "b": {"three": (400, 0, 200, 300)}}
QUIET = {"LP_NUM_THREADS": "0"}
FPS = 20
RIGHT_AGAIN = 15.0  # seconds until the wall is right; about 1 where the machine does nothing else
REPORTS = 2.5  # seconds in which each node has reported
GPUS = ["a/gpu0", "a/gpu1", "b"]


class ANodeOfTwoGpus(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        whole = cls.enterClassContext(Wall((3, 1), (200, 300), one_node=True, environment=QUIET, die_with_parent=True))
        cls.whole = OneMachine(whole, cls.x)

    def setUp(self) -> None:
        self.wall = self.enterContext(PlannedWall(PLAN, node_keys={"a": "gpus = 2"}, environment=QUIET,
                                                  die_with_parent=True))
        self.show = Show(self.wall, self.wall.run, self.x, FPS)
        self.addCleanup(end_all, self.show.apps)

    def nodes(self) -> dict[str, dict]:
        return {node["name"]: node for node in self.wall.nodes()}

    def assert_becomes_right(self, dark: tuple[int, int] = (0, 0)) -> None:
        """But for the columns that are `dark`: nobody draws there."""
        def right() -> bool:
            self.show.hold()
            expected, now = self.whole.picture(self.show.frames).copy(), self.show.picture().copy()
            expected[:, slice(*dark)] = now[:, slice(*dark)] = 0
            good = same(expected, now).good
            if not good:
                self.show.go_on()
            return good
        until(right, "the wall is right", RIGHT_AGAIN)
        self.assertEqual([app.poll() for app in self.show.apps], [None] * len(self.show.apps), "the programs run on")
        self.assertEqual([s["fault"] for s in self.wall.sessions()], [""] * len(self.show.apps))
        self.show.go_on()

    def test_draws_what_one_would(self) -> None:
        self.assert_becomes_right()
        nodes = self.nodes()
        self.assertEqual(list(nodes), GPUS)
        self.assertEqual([nodes[gpu]["address"] for gpu in GPUS],
                         [f"unix:{self.wall.folder}/{name}" for name in ("a.sock", "a.sock.1", "b.sock")])
        self.assertEqual([(nodes[gpu]["process"], nodes[gpu]["gpu"]) for gpu in GPUS],
                         [("a", "0"), ("a", "1"), ("b", "auto")])
        self.assertEqual({tile["name"]: tile["node"] for tile in self.wall.ctl("tiles")},
                         {"one": "a/gpu0", "two": "a/gpu1", "three": "b"})
        self.assertIn("a/gpu1", subprocess.run([self.wall.bin / "wallctl", "--walld", self.wall.address, "nodes"],
                                               check=True, capture_output=True, text=True).stdout)
        self.assertIn('ready node="a" gpus=2', self.wall.log("a"))

    def test_gets_only_what_it_draws(self) -> None:
        """A window on the tile of one is none of the other one's business: objects are where they are drawn with."""
        def textures() -> dict[str, int]:
            return {name: node["objects"]["textures"] for name, node in self.nodes().items()}
        until(lambda: all(textures().values()), "all nodes report", RIGHT_AGAIN)
        before = textures()
        app = self.wall.run(build_folder() / "tests" / "drawn_once", "--size", "200x150", rect=(200, 0, 200, 150),
                            env=self.x.environment())
        self.show.hold()
        session = self.wall.wait_session(app)
        self.wall.wait(session, 1)
        self.addCleanup(end_all, [app])
        until(lambda: textures()["a/gpu1"] > before["a/gpu1"], "one has its objects", RIGHT_AGAIN)
        time.sleep(REPORTS)
        after = textures()
        self.assertEqual((after["a/gpu0"], after["b"]), (before["a/gpu0"], before["b"]))

    def test_comes_back_with_both(self) -> None:
        for _ in range(2):
            incarnations = {name: node["incarnation"] for name, node in self.nodes().items()}
            self.wall.daemons["a"].kill()
            self.wall.daemons["a"].wait()
            self.wall.start_node("a")
            until(lambda: all(self.nodes()[gpu]["up"] and self.nodes()[gpu]["incarnation"] > incarnations[gpu]
                              for gpu in GPUS[:2]), "both are up again", RIGHT_AGAIN)
            self.assert_becomes_right()

    def test_one_comes_back_alone(self) -> None:
        before = self.nodes()
        os.kill(before["a/gpu1"]["pid"], signal.SIGKILL)
        until(lambda: self.nodes()["a/gpu1"]["up"] and
              self.nodes()["a/gpu1"]["incarnation"] > before["a/gpu1"]["incarnation"], "it is up again", RIGHT_AGAIN)
        self.assert_becomes_right()
        after = self.nodes()
        self.assertEqual([after[gpu]["incarnation"] for gpu in ("a/gpu0", "b")],
                         [before[gpu]["incarnation"] for gpu in ("a/gpu0", "b")])
        self.assertIsNone(self.wall.daemons["a"].poll())

    def test_ends_in_order(self) -> None:
        self.wall.daemons["a"].send_signal(signal.SIGTERM)
        self.assertEqual(self.wall.daemons["a"].wait(5), 0)
        log = self.wall.log("a")
        self.assertEqual(log.count(" info stopped\n"), 2, log)

    def test_is_drained_as_a_whole_or_in_part(self) -> None:
        def drained() -> list[str]:
            return [name for name, node in self.nodes().items() if node["drained"]]
        self.wall.ctl("node", "drain", "a/gpu1")
        self.assertEqual(drained(), ["a/gpu1"])
        self.assert_becomes_right(dark=(200, 400))
        self.wall.ctl("node", "drain", "a")
        self.assertEqual(drained(), GPUS[:2])
        self.wall.ctl("node", "undrain", "a/gpu0")
        self.assertEqual(drained(), ["a/gpu1"])
        self.wall.restart_walld_only()
        until(lambda: self.show.sessions <= {s["id"] for s in self.wall.sessions() if s["surfaces"]},
              "the programs are back", RIGHT_AGAIN)
        self.assertEqual(drained(), ["a/gpu1"], "walld keeps it")
        self.wall.ctl("node", "undrain", "a")
        self.assertEqual(drained(), [])
        until(lambda: all(node["up"] for node in self.nodes().values()), "all are up", RIGHT_AGAIN)
        self.assert_becomes_right()
        with self.assertRaisesRegex(WallError, "there is no node 'a/gpu2'"):
            self.wall.ctl("node", "drain", "a/gpu2")
        self.wall.ctl("node", "drain", "a")
        for gpus, names in (({}, ["a"]), ({"a": "gpus = 2"}, GPUS[:2])):
            self.wall.node_keys = gpus
            self.wall.write(PLAN)
            self.wall.ctl("reload")
            self.assertEqual(drained(), names, "as a whole, also when it has other GPUs")
        self.wall.ctl("node", "undrain", "a/gpu0")
        self.assertEqual(drained(), ["a/gpu1"])

    def test_tiles_move_from_one_to_the_other(self) -> None:
        def expect(tiles: dict[str, str]) -> None:
            until(lambda: {t["name"]: t["node"] for t in self.wall.ctl("tiles")} == tiles and
                  all(node["up"] for node in self.nodes().values()), f"{tiles}", RIGHT_AGAIN)
            self.assert_becomes_right()
        self.wall.node_keys = {}
        self.wall.keys = {"one": "gpu = 1", "two": "gpu = 0"}
        self.wall.reload(PLAN)
        expect({"one": "a/gpu1", "two": "a/gpu0", "three": "b"})
        self.wall.keys = {}
        self.wall.reload(PLAN)
        expect({"one": "a", "two": "a", "three": "b"})
        self.wall.node_keys = {"a": "gpus = 2"}
        self.wall.reload(PLAN)
        expect({"one": "a/gpu0", "two": "a/gpu1", "three": "b"})
        (self.wall.folder / "wall.toml").write_text(self.wall._description().replace("gpus = 2", "gpus = 0"))
        with self.assertRaisesRegex(WallError, r"wall.toml:\d+: 'gpus': expected an integer from 1 to 64"):
            self.wall.ctl("reload")
        self.assert_becomes_right()


FOUR = {"a": {"one": (0, 0, 200, 150), "two": (200, 0, 200, 150), "three": (0, 150, 200, 150),
              "four": (200, 150, 200, 150)}}
COSTLY = ("--vertices", 60000)
BALANCED = 60.0  # seconds; about 6 where nothing else runs


class TwoGpusOfWhichOneHasMoreToDo(unittest.TestCase):
    def test_a_tile_goes_to_the_other_and_no_picture_is_wrong(self) -> None:
        x = self.enterContext(XServer())
        wall = self.enterContext(PlannedWall(FOUR, node_keys={"a": "gpus = 2"}, environment=QUIET,
                                             die_with_parent=True))
        parts = (Part("drawn_once", (0, 0, 400, 100), still=True),
                 Part("frame_clock", (0, 100, 200, 50), arguments=COSTLY),
                 Part("frame_clock", (200, 200, 200, 100), arguments=COSTLY))
        show = Show(wall, wall.run, x, parts=parts)  # as fast as they can
        self.addCleanup(end_all, show.apps)

        def places() -> dict[str, str]:
            return {tile["name"]: tile["node"] for tile in wall.ctl("tiles")}
        at_first = {"one": "a/gpu0", "two": "a/gpu1", "three": "a/gpu1", "four": "a/gpu0"}
        self.assertEqual(places(), at_first)
        incarnations = {node["name"]: node["incarnation"] for node in wall.nodes()}
        still = show.picture()[:100]
        self.assertGreater(still.std(), 10, "there is something to see")
        show.go_on()
        pictures, end = 0, time.monotonic() + BALANCED
        while places() == at_first:
            self.assertLess(time.monotonic(), end, f"no tile has moved: {wall.log('walld')[-2000:]}")
            self.assertTrue((show.picture()[:100] == still).all(), "a program that draws once is seen all the time")
            pictures += 1
        for _ in range(10):
            self.assertTrue((show.picture()[:100] == still).all())
        moved = {tile for tile, node in places().items() if node != at_first[tile]}
        self.assertEqual(len(moved), 1)
        self.assertLessEqual(moved, {"one", "four"}, "one of those that are costly")
        self.assertGreater(pictures, 10)
        self.assertEqual({node["name"]: node["incarnation"] for node in wall.nodes()}, incarnations)
        show.hold()
        whole = self.enterContext(Wall((2, 2), (200, 150), one_node=True, environment=QUIET, die_with_parent=True))
        expected = OneMachine(whole, x, parts).picture(show.frames)
        self.assertTrue(same(expected, show.picture()).good, "what runs is right as well")
        self.assertEqual([s["fault"] for s in wall.sessions()], [""] * len(show.apps))


if __name__ == "__main__":
    unittest.main()
