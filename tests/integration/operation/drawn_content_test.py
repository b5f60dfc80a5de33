#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Pictures that only the nodes have, because they drew them (drawn_once.cpp): nodes are killed and come back, and the
wall is right again without the program drawing them anew."""
import random
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

TILE = (200, 150)
WINDOW = (400, 300)
RIGHT_AGAIN = 15.0  # seconds from a node's start until the wall is right; about 1 where the machine does nothing else


class DrawnContent(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())

    def setUp(self) -> None:
        self.wall = self.enterContext(Wall(tiles=(2, 2), tile_size=TILE, environment={"LP_NUM_THREADS": "0"}))

    def start(self, *options: object):
        app = self.wall.run(build_folder() / "tests" / "drawn_once", "--size", "%dx%d" % WINDOW, *options,
                            rect=(0, 0, *WINDOW), env=self.x.environment())
        self.wall.wait(self.wall.wait_session(app), 5)
        return app

    def picture(self) -> numpy.ndarray:
        return cv2.imdecode(numpy.frombuffer(self.wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)

    def assert_shown(self, expected: numpy.ndarray) -> float:
        """How long it took."""
        begin = time.monotonic()
        while (self.picture() != expected).any():
            if time.monotonic() - begin > RIGHT_AGAIN:
                wrong = int((self.picture() != expected).any(axis=2).sum())
                self.fail(f"{wrong} pixels are wrong after {RIGHT_AGAIN} s")
            time.sleep(0.1)
        return time.monotonic() - begin

    def kill(self, name: str) -> None:
        node = self.wall.daemons[name]
        node.kill()
        node.wait()

    def test_a_node_that_comes_back_gets_them_from_another(self) -> None:
        self.start()
        expected = self.picture()
        self.assertGreater(len(numpy.unique(expected.reshape(-1, 3), axis=0)), 50, "a picture of many colours")
        chance = random.Random(7)
        for _ in range(6):
            name = chance.choice(self.wall.node_names)
            self.kill(name)
            self.wall.start_node(name)
            took = self.assert_shown(expected)
            print(f"{name} is right {took:.1f} s after its start", flush=True)

    def test_what_compute_shaders_wrote(self) -> None:
        self.start("--by", "computing")
        expected = self.picture()
        self.assertGreater(len(numpy.unique(expected.reshape(-1, 3), axis=0)), 50, "a picture of many colours")
        for name in self.wall.node_names[1:]:
            self.kill(name)
            self.wall.start_node(name)
            self.assert_shown(expected)

    def test_all_but_one_at_once(self) -> None:
        self.start()
        expected = self.picture()
        names = self.wall.node_names
        for name in names[1:]:
            self.kill(name)
        for name in names[1:]:
            self.wall.start_node(name)
        self.assert_shown(expected)

    def test_all_at_once_until_they_are_drawn_anew(self) -> None:
        app = self.start("--anew-at", "250")
        expected = self.picture()
        for name in self.wall.node_names:
            self.kill(name)
        for name in self.wall.node_names:
            self.wall.start_node(name)
        self.assert_shown(expected)
        self.assertIsNone(app.poll(), "the program goes on")


if __name__ == "__main__":
    unittest.main()
