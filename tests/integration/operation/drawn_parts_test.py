#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A framebuffer object that is copied to the window as it is, of which each node draws its part (docs/framebuffers.md):
what the wall shows is what it shows where every node draws all of it, also while the window moves, and after nodes were
killed."""
import random
import subprocess
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
COLUMNS, ROWS = 200, 100  # of the mesh
PROGRAM = (build_folder() / "bench" / "buffers", "--off-window", "--size", "%dx%d" % WINDOW, "--frames", "1000000",
           "--mesh", f"{COLUMNS}x{ROWS}")
HABIT = 10  # frames, by which it is drawn in parts
PLACES = ((0, 0, 400, 300), (30, 20, 360, 270), (100, 0, 200, 300), (-150, -100, 400, 300), (0, 0, 200, 150),
          (0, 0, 400, 300))
RIGHT_AGAIN = 15.0  # seconds from a node's start until the wall is right; about 1 where the machine does nothing else


class DrawnParts(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())

    def setUp(self) -> None:
        self.wall = self.enterContext(Wall(tiles=(2, 2), tile_size=TILE, environment={"LP_NUM_THREADS": "0"}))

    def start(self, in_parts: bool) -> int:
        """The program, held behind the frames that make a habit."""
        app = self.wall.run(*map(str, PROGRAM), rect=(0, 0, *WINDOW), hold=True, stdout=subprocess.DEVNULL,
                            env=self.x.environment(WALLGL_DRAWN_PARTS="1" if in_parts else "0"))
        session = self.wall.wait_session(app)
        self.step(session, HABIT)
        return session

    def step(self, session: int, frames: int = 1) -> None:
        frame = next(s for s in self.wall.sessions() if s["id"] == session)["surfaces"][0]["frame"]
        self.wall.step(session, frames)
        self.wall.wait(session, frame + frames)

    def picture(self) -> numpy.ndarray:
        return cv2.imdecode(numpy.frombuffer(self.wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)

    def elements(self) -> int:
        """What all nodes have processed, when they have said so: they do once a second."""
        time.sleep(2.5)
        return sum(node["array_elements"] for node in self.wall.nodes())

    def test_each_node_processes_its_part(self) -> None:
        of_mesh = {}
        for in_parts in (True, False):
            session = self.start(in_parts)
            before = self.elements()
            self.step(session, 20)
            of_mesh[in_parts] = (self.elements() - before) / 20 / (6 * COLUMNS * ROWS)
            self.wall.ctl("close", session)
        print(f"all nodes together process {of_mesh[True]:.2f} times the mesh in parts, {of_mesh[False]:.2f} as a "
              "whole", flush=True)
        self.assertLess(of_mesh[True], 2.5)  # pieces of so small a mesh are large
        self.assertGreater(of_mesh[False], 3.9)

    def test_every_frame_is_right_while_the_window_moves(self) -> None:
        shown: dict[bool, list[numpy.ndarray]] = {True: [], False: []}
        for in_parts, pictures in shown.items():
            session = self.start(in_parts)
            pictures.append(self.picture())
            for place in PLACES:
                self.wall.ctl("place", session, *place)
                for _ in range(3):
                    self.step(session)
                    pictures.append(self.picture())
            self.wall.ctl("close", session)
            self.wall._until(lambda: not self.wall.sessions(), "the program has ended")
        self.assertGreater(len(numpy.unique(shown[False][0].reshape(-1, 3), axis=0)), 10, "a picture of several shades")
        for number, (parts, whole) in enumerate(zip(shown[True], shown[False], strict=True)):
            self.assertEqual(int((parts != whole).any(axis=2).sum()), 0, f"picture {number}")

    def test_nodes_that_are_killed_come_back(self) -> None:
        session = self.start(True)
        expected = self.picture()
        self.wall.hold(session, False)
        chance = random.Random(5)
        for _ in range(4):
            name = chance.choice(self.wall.node_names)
            node = self.wall.daemons[name]
            node.kill()
            node.wait()
            self.wall.start_node(name)
            begin = time.monotonic()
            while (self.picture() != expected).any():
                self.assertLess(time.monotonic() - begin, RIGHT_AGAIN, f"{name} is not right again")
                time.sleep(0.1)


if __name__ == "__main__":
    unittest.main()
