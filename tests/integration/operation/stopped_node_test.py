# SPDX-License-Identifier: MIT
"""A node that stands still (SIGSTOP) for seconds: the programs and the other nodes go on as before, and when it goes on
it is right again at once. Frames tell their number by their colour (frame_clock.cpp)."""
import signal
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
STOP = 10.0  # seconds; many times the swap limit, and enough to fill every queue of the busy program
# seconds before, and again after, in which the usual frame rates are taken: a machine gets faster and slower by itself
BESIDE = 4.0
# seconds after SIGCONT until a program that started meanwhile is on it: an attempt that ends, a pause, another
TAKEN_UP = 8.0
CATCH_UP = 10.0  # seconds after SIGCONT until every tile is right; less than 2 where the machine does nothing else
QUIET = 1.0  # seconds until what has queued up is done
STANDING = 6.0  # seconds from the program's start on; it asks a node for 2, and again after 1
KEPT = 0.9  # of the usual frame rate
ATTEMPTS = 3  # what else the machine does may slow a program for some seconds; the node's standstill does so each time


class StoppedNode(unittest.TestCase):
    # Each over at least two tiles of the node-0-0 side or beside it: name -> rectangle and how it draws. `busy` draws
    # as fast as it can, far more than sockets and queues hold; `paced` builds each frame on the one before.
    PROGRAMS = {
        "busy": ((0, 0, 400, 100), ["--vertices", "20000"]),
        "paced": ((0, 100, 400, 100), ["--fps", "20", "--egl", "--incremental"]),
        "elsewhere": ((0, 200, 400, 100), ["--fps", "20"]),
    }

    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 2), tile_size=TILE, environment={"LP_NUM_THREADS": "0"}))
        cls.session = {}
        for name, (rect, options) in cls.PROGRAMS.items():
            program = build_folder() / "tests" / "frame_clock"
            app = cls.wall.run(program, "--size", f"{rect[2]}x{rect[3]}", *options, rect=rect, name=name,
                               env=cls.x.environment())
            cls.session[name] = cls.wall.wait_session(app)
        for session in cls.session.values():
            cls.wall.wait(session, 10)

    def frames(self) -> dict[str, int]:
        shown = {s["name"]: s["surfaces"][0]["frame"] for s in self.wall.sessions()}
        return {name: shown[name] for name in self.PROGRAMS}

    def rates(self, seconds: float) -> dict[str, float]:
        begin, first = time.monotonic(), self.frames()
        time.sleep(seconds)
        took, last = time.monotonic() - begin, self.frames()
        return {name: (last[name] - first[name]) / took for name in first}

    def stop(self, seconds: float) -> dict[str, float]:
        """Frame rates while a node stands still."""
        node = self.wall.daemons["node-0-0"]
        node.send_signal(signal.SIGSTOP)
        try:
            return self.rates(seconds)
        finally:
            node.send_signal(signal.SIGCONT)

    def numbers(self, picture: numpy.ndarray, name: str) -> set[int]:
        """The frames that the window's pixels belong to; -1 for a pixel that is of no frame."""
        x, y, width, height = self.PROGRAMS[name][0]
        window = picture[y:y + height, x:x + width].reshape(-1, 3).astype(int)  # blue, green, red
        return set(numpy.where(window[:, 0] == 255, window[:, 2] + 256 * window[:, 1], -1).tolist())

    def wrong_windows(self) -> list[str]:
        """With the frames held, the windows of which some pixels do not show the frame that walld says is shown."""
        for session in self.session.values():
            self.wall.hold(session)
        try:
            time.sleep(0.3)  # what was told to be shown when hold came, is
            shown = self.frames()
            picture = cv2.imdecode(numpy.frombuffer(self.wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)
            return [name for name in self.PROGRAMS if self.numbers(picture, name) != {shown[name] & 0xffff}]
        finally:
            for session in self.session.values():
                self.wall.hold(session, on=False)

    def assert_all_tiles_become_right(self) -> None:
        begin = time.monotonic()
        while wrong := self.wrong_windows():
            self.assertLess(time.monotonic() - begin, CATCH_UP, f"{wrong} show another frame on some tile")
        print(f"all tiles were right after {time.monotonic() - begin:.1f} s", flush=True)

    def test_the_others_do_not_notice_and_it_catches_up(self) -> None:
        self.assert_all_tiles_become_right()
        for attempt in range(ATTEMPTS):
            before, during = self.rates(BESIDE), self.stop(STOP)
            self.assert_all_tiles_become_right()
            time.sleep(QUIET)
            after = self.rates(BESIDE)
            usual = {name: (before[name] + after[name]) / 2 for name in before}
            said = ", ".join(f"{name} {before[name]:.1f}, {during[name]:.1f}, {after[name]:.1f}" for name in before)
            print(f"frames/s before, during and after the standstill: {said}", flush=True)
            if all(during[name] >= KEPT * usual[name] for name in before):
                break
        else:
            self.fail(f"frame rates fell: {said}")
        for app in self.wall.apps:
            self.assertIsNone(app.poll(), "no program has ended")
        for session in self.wall.sessions():
            self.assertEqual(session["fault"], "")


class StoppedAtTheStart(unittest.TestCase):
    """A program that starts while a node stands still leaves it out, and takes it up when it goes on."""

    def test_it_reaches_the_node_later(self) -> None:
        with XServer() as x, Wall(tiles=(2, 1), tile_size=TILE, environment={"LP_NUM_THREADS": "0"}) as wall:
            node = wall.daemons["node-1-0"]
            node.send_signal(signal.SIGSTOP)
            try:
                app = wall.run(build_folder() / "tests" / "frame_clock", "--size", "400x150", "--fps", "20",
                               rect=(0, 0, 400, 150), env=x.environment())
                wall.wait_session(app)
                time.sleep(STANDING)
                drawn = wall.sessions()[0]["surfaces"][0]["frame"]
                self.assertGreater(drawn, 20, "the program draws without the node")
            finally:
                node.send_signal(signal.SIGCONT)
            end = time.monotonic() + TAKEN_UP
            while True:
                picture = cv2.imdecode(numpy.frombuffer(wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)
                if (picture[:, :, 0] == 255).all():
                    break
                self.assertLess(time.monotonic(), end, "the node that stood still shows nothing of the program")
                time.sleep(0.1)
            self.assertEqual(wall.sessions()[0]["fault"], "")


if __name__ == "__main__":
    unittest.main()
