#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Programs go from wall to wall while they run, with all that they have drawn (`wallctl move`). drawn_once.cpp draws
its pictures once, so that only nodes have them; a wall that shows it right has got them from the other wall's."""
import signal
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from leak_test import descriptors, memory  # noqa: E402
from wall import Wall, WallError, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

WINDOW = (400, 300)
SHOWN = 10.0  # seconds until a moved program is right; a few tenths where the machine does nothing else
WARM_UP, MOVES = 10, 100
GROWTH = 8 << 20  # bytes: pictures of 400x300 that stayed behind would be 50 MiB after as many moves
DRIVEN = {"LP_NUM_THREADS": "0"}


class Moves(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())

    def wall(self, tiles: tuple[int, int], tile_size: tuple[int, int], **options) -> Wall:
        environment = {**DRIVEN, **options.pop("environment", {})}
        return self.enterContext(Wall(tiles=tiles, tile_size=tile_size, environment=environment, **options))

    def setUp(self) -> None:
        self.first = self.wall((2, 2), (200, 150))
        self.other = self.wall((3, 1), (200, 300))

    def start(self, name: str = "drawn_once", *options: object, **how):
        return self.first.run(build_folder() / "tests" / name, "--size", "%dx%d" % WINDOW, *options,
                              env=self.x.environment(), **how)

    def move(self, app, wall: Wall, to: Wall) -> int:
        """The session on the wall it goes to."""
        wall.ctl("move", wall.wait_session(app), "--to", to.address)
        return to.wait_session(app)

    def window(self, wall: Wall, session: int) -> numpy.ndarray:
        return cv2.imdecode(numpy.frombuffer(wall.screenshot(session=session), numpy.uint8), cv2.IMREAD_COLOR)

    def assert_shown(self, wall: Wall, session: int, expected: numpy.ndarray) -> None:
        end = time.monotonic() + SHOWN
        while True:
            picture = self.window(wall, session)
            wrong = int((picture != expected).any(axis=2).sum()) if picture.shape == expected.shape else -1
            if wrong == 0:
                return
            if time.monotonic() > end:
                self.fail(f"{wrong} pixels are wrong {SHOWN} s after the move (-1: it has another size)")
            time.sleep(0.05)

    def assert_stays(self, app, reason: str, to: str) -> None:
        session = self.first.wait_session(app)
        with self.assertRaisesRegex(WallError, reason):
            self.first.ctl("move", session, "--to", to)
        shown = self.first.wait(session, 1)
        self.first.wait(session, shown + 3)

    def picture_of(self, app) -> numpy.ndarray:
        session = self.first.wait_session(app)
        self.first.wait(session, 5)
        picture = self.window(self.first, session)
        self.assertGreater(len(numpy.unique(picture.reshape(-1, 3), axis=0)), 50, "a picture of many colours")
        return picture

    def test_there_and_back(self) -> None:
        app = self.start()
        expected = self.picture_of(app)
        for _ in range(3):
            self.assert_shown(self.other, self.move(app, self.first, self.other), expected)
            self.assertEqual(self.first.sessions(), [], "it has left the wall that it was on")
            self.assert_shown(self.first, self.move(app, self.other, self.first), expected)
            self.assertEqual(self.other.sessions(), [])

    def test_what_compute_shaders_wrote(self) -> None:
        app = self.start("drawn_once", "--by", "computing")
        expected = self.picture_of(app)
        self.assert_shown(self.other, self.move(app, self.first, self.other), expected)

    def test_what_a_window_holds_that_is_never_cleared(self) -> None:
        for options in (), ("--stencil", 0), ("--samples", 4):
            with self.subTest(options=options):
                app = self.start("drawn_over", *options)
                expected = self.picture_of(app)
                self.assert_shown(self.other, self.move(app, self.first, self.other), expected)
                self.assert_shown(self.first, self.move(app, self.other, self.first), expected)
                app.kill()
                app.wait()

    def test_nodes_of_the_other_wall_get_it_from_each_other(self) -> None:
        app = self.start()
        expected = self.picture_of(app)
        session = self.move(app, self.first, self.other)
        self.assert_shown(self.other, session, expected)
        name = self.other.node_names[0]
        self.other.daemons[name].kill()
        self.other.daemons[name].wait()
        self.other.start_node(name)
        self.assert_shown(self.other, session, expected)

    def test_from_one_kind_of_driver_to_another(self) -> None:
        osmesa = self.wall((2, 1), (200, 300), backend="osmesa")
        app = self.start()
        expected = self.picture_of(app)
        self.assert_shown(osmesa, self.move(app, self.first, osmesa), expected)

    def test_frames_go_on(self) -> None:
        app = self.start("frame_clock")
        shown = self.first.wait(self.first.wait_session(app), 20)
        session = self.move(app, self.first, self.other)
        self.assertGreater(self.other.wait(session, shown + 20), shown, "its frames are counted on")

    def test_a_hundred_moves_leave_nothing_behind(self) -> None:
        app = self.start()
        expected = self.picture_of(app)
        walls = [self.first, self.other]
        daemons = [daemon.pid for wall in walls for daemon in wall.daemons.values()]

        def move(times: int) -> None:
            for _ in range(times):
                session = self.move(app, *walls)
                walls.reverse()
                self.assert_shown(walls[0], session, expected)

        move(WARM_UP)
        before = [(memory(pid), descriptors(pid)) for pid in (app.pid, *daemons)]
        move(MOVES)
        for pid, (bytes_before, open_before) in zip((app.pid, *daemons), before):
            self.assertLess(memory(pid) - bytes_before, GROWTH, f"memory of {pid}")
            self.assertLess(descriptors(pid) - open_before, 8, f"descriptors of {pid}")

    def test_it_stays_where_it_cannot_go(self) -> None:
        app = self.start("frame_clock")
        self.first.wait(self.first.wait_session(app), 3)
        self.assert_stays(app, "the wall is not there", "unix:/nowhere/walld.sock")
        self.assert_stays(app, "it is on that wall", self.first.address)
        self.assert_stays(app, "to: expected the other wall's control socket", "127.0.0.1:7700")

    def test_it_stays_where_a_wall_can_do_less(self) -> None:
        missing = "GL_EXT_texture_filter_anisotropic"
        less = self.wall((1, 1), WINDOW, environment={"MESA_EXTENSION_OVERRIDE": "-" + missing})
        app = self.start("frame_clock")
        self.first.wait(self.first.wait_session(app), 3)
        self.assert_stays(app, "the program stays: the other wall lacks " + missing, less.address)
        self.assertEqual(less.sessions(), [], "nothing is left of it there")

    def test_one_that_stands_still(self) -> None:
        app = self.start("frame_clock")
        session = self.first.wait_session(app)
        self.first.wait(session, 3)
        app.send_signal(signal.SIGSTOP)
        self.addCleanup(app.send_signal, signal.SIGCONT)
        with self.assertRaisesRegex(WallError, "has not answered"):
            self.first.ctl("move", session, "--to", self.other.address)

    def test_parallel_programs_stay(self) -> None:
        app = self.start("turns", parallel=2)
        session = self.first.wait_session()
        with self.assertRaisesRegex(WallError, "parallel program"):
            self.first.ctl("move", session, "--to", self.other.address)
        self.assertIsNone(app.poll())


if __name__ == "__main__":
    unittest.main()
