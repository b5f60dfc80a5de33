#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A framebuffer object that is brought to the window as it is, by a blit or as a texture, of which each node draws its
part (docs/framebuffers.md): what the wall shows is what it shows where every node draws all of it, also while the
window moves, and after nodes were killed."""
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
PROGRAM = (build_folder() / "bench" / "buffers", "--frames", "1000000", "--mesh", f"{COLUMNS}x{ROWS}")
WAYS = ("--off-window", "--as-texture")  # to the window
ROUNDED = 12  # pixels of 120,000: a layer is drawn with an offset, and an image without
HABIT = 10  # frames, by which it is drawn in parts
MOVED = 50  # frames until a window is seen where it was placed
PLACES = ((30, 20, 360, 270), (100, 0, 200, 300), (-150, -100, 400, 300), (0, 0, 200, 150),
          (0, 0, 400, 300))
RIGHT_AGAIN = 15.0  # seconds from a node's start until the wall is right; about 1 where the machine does nothing else


class DrawnParts(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())

    def setUp(self) -> None:
        self.wall = self.enterContext(Wall(tiles=(2, 2), tile_size=TILE, environment={"LP_NUM_THREADS": "0"}))

    def start(self, in_parts: bool, way: str | None, size: tuple[int, int] = WINDOW) -> int:
        """The program, held behind the frames that make a habit. `way`: to the window; none: it draws there."""
        options = ["--size", "%dx%d" % size, *([way] if way else [])]
        app = self.wall.run(*map(str, PROGRAM), *options, rect=(0, 0, *size), hold=True, stdout=subprocess.DEVNULL,
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

    def close(self, session: int) -> None:
        self.wall.ctl("close", session)
        self.wall._until(lambda: not self.wall.sessions(), "the program has ended")

    def test_each_node_processes_its_part(self) -> None:
        of_mesh = {}
        for way, in_parts in ((WAYS[0], True), (WAYS[1], True), (WAYS[1], False)):
            session = self.start(in_parts, way)
            before = self.elements()
            self.step(session, 20)
            of_mesh[way, in_parts] = (self.elements() - before) / 20 / (6 * COLUMNS * ROWS)
            self.close(session)
        for (way, in_parts), times in of_mesh.items():
            print(f"{way}: all nodes together process {times:.2f} times the mesh{' in parts' if in_parts else ''}",
                  flush=True)
            if in_parts:
                self.assertLess(times, 2.5, way)  # pieces of so small a mesh are large
            else:
                self.assertGreater(times, 3.9, way)

    def move(self, session: int, place: tuple[int, ...], before: numpy.ndarray) -> list[numpy.ndarray]:
        """The pictures of the frames until the window is seen elsewhere than before, which may take some, and of two
        more."""
        self.wall.ctl("place", session, *place)
        pictures = []
        while not pictures or (pictures[-1] == before).all():
            self.assertLess(len(pictures), MOVED, f"the window is not at {place}")
            self.step(session)
            pictures.append(self.picture())
        for _ in range(2):
            self.step(session)
            pictures.append(self.picture())
        return pictures

    def test_every_frame_is_right_while_the_window_moves(self) -> None:
        for way in WAYS:
            session = self.start(False, way)
            whole = [self.picture()]
            for place in PLACES:
                whole.append(self.move(session, place, whole[-1])[-1])
            self.close(session)
            self.assertGreater(len(numpy.unique(whole[0].reshape(-1, 3), axis=0)), 10, "a picture of several shades")
            session = self.start(True, way)
            self.assertEqual(int((self.picture() != whole[0]).any(axis=2).sum()), 0, way)
            for place, before, after in zip(PLACES, whole, whole[1:]):
                for number, picture in enumerate(self.move(session, place, before)):
                    wrong = min(int((picture != right).any(axis=2).sum()) for right in (before, after))
                    self.assertEqual(wrong, 0, f"{way}: picture {number} at {place}")
                self.assertEqual(int((picture != after).any(axis=2).sum()), 0, f"{way}: at {place}")
            self.close(session)

    def test_a_window_that_is_shown_larger_has_the_walls_resolution(self) -> None:
        """As if it was drawn to the window itself, of half the wall's size, but where borders are rounded otherwise."""
        shown = {}
        for way in (None, *WAYS):
            session = self.start(True, way, size=(200, 150))
            self.wall.ctl("place", session, 0, 0, *WINDOW)
            self.step(session, 70)  # the habit is a longer one once it was broken
            shown[way] = self.picture()
            self.close(session)
        small = cv2.resize(shown[None], (200, 150), interpolation=cv2.INTER_AREA)
        blown_up = cv2.resize(small, WINDOW, interpolation=cv2.INTER_NEAREST)
        self.assertGreater(int((shown[None] != blown_up).any(axis=2).sum()), 10_000, "more than the window's pixels")
        for way in WAYS:
            self.assertLess(int((shown[way] != shown[None]).any(axis=2).sum()), ROUNDED, way)

    def test_nodes_that_are_killed_come_back(self) -> None:
        chance = random.Random(5)
        for way in WAYS:
            session = self.start(True, way)
            expected = self.picture()
            self.wall.hold(session, False)
            for _ in range(3):
                self.kill_one(chance, expected)
            self.close(session)

    def kill_one(self, chance: random.Random, expected: numpy.ndarray) -> None:
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
