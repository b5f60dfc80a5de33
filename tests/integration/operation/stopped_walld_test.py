# SPDX-License-Identifier: MIT
"""walld stands still (SIGSTOP) or is killed and started again: programs draw on as fast as before, what is held stays
held, and afterwards everything is where it was, under the same numbers and with the same pixels. Frames tell their
number by their colour (frame_clock.cpp)."""
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
CLOCK = build_folder() / "tests" / "frame_clock"
STILL = build_folder() / "tests" / "still_windows"  # draws a window, of one colour, only when X asks
USUAL = 3.0  # seconds in which the usual frame rate is taken
STOP = 6.0  # seconds; many times the swap limit
KEPT = 0.7  # of the usual frame rate, the first limit's wait included; without walld's help one frame a limit were left
ATTEMPTS = 3  # what else the machine does may slow a program for some seconds; a walld that is waited for always does
AGAIN = 10.0  # seconds until all programs are back


def pixels(png: bytes) -> numpy.ndarray:
    return cv2.imdecode(numpy.frombuffer(png, numpy.uint8), cv2.IMREAD_COLOR)


def until(done, what: str, limit: float = AGAIN) -> None:
    end = time.monotonic() + limit
    while not done():
        if time.monotonic() > end:
            raise AssertionError(what)
        time.sleep(0.05)


class StoppedWalld(unittest.TestCase):
    RECT, HELD = (0, 0, 400, 100), (0, 100, 400, 100)  # over both nodes

    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 1), tile_size=TILE, environment={"LP_NUM_THREADS": "0"}))
        cls.session = cls.start(cls.RECT, "runs")
        cls.held = cls.start(cls.HELD, "held")
        cls.wall.wait(cls.session, 20)
        cls.wall.wait(cls.held, 20)
        cls.wall.hold(cls.held)

    @classmethod
    def start(cls, rect: tuple[int, int, int, int], name: str) -> int:
        size = f"{rect[2]}x{rect[3]}"
        app = cls.wall.run(CLOCK, "--size", size, "--fps", "40", rect=rect, name=name, env=cls.x.environment())
        return cls.wall.wait_session(app)

    def frame(self, session: int) -> int:
        return next(s for s in self.wall.sessions() if s["id"] == session)["surfaces"][0]["frame"]

    def rate(self, seconds: float) -> float:
        begin, first = time.monotonic(), self.frame(self.session)
        time.sleep(seconds)
        return (self.frame(self.session) - first) / (time.monotonic() - begin)

    def rate_while_stopped(self) -> float:
        begin, first = time.monotonic(), self.frame(self.session)
        walld = self.wall.daemons["walld"]
        walld.send_signal(signal.SIGSTOP)
        try:
            time.sleep(STOP)
            took = time.monotonic() - begin
        finally:
            walld.send_signal(signal.SIGCONT)
        until(lambda: self.frame(self.session) > first, "walld does not hear of the frames that were shown without it")
        return (self.frame(self.session) - first) / took

    def numbers(self, rect: tuple[int, int, int, int]) -> set[int]:
        """The frames that the window's pixels belong to; -1 for a pixel that is of no frame."""
        x, y, width, height = rect
        window = pixels(self.wall.screenshot())[y:y + height, x:x + width].reshape(-1, 3).astype(int)
        blue, green, red = window.T
        return set(numpy.where(blue == 255, red + 256 * green, -1).tolist())

    def test_programs_draw_on_and_walld_finds_everything_in_order(self) -> None:
        held = self.frame(self.held)
        self.assertEqual(self.numbers(self.HELD), {held})
        for attempt in range(ATTEMPTS):
            usual, stopped = self.rate(USUAL), self.rate_while_stopped()
            print(f"frames/s before and while walld stood still: {usual:.1f}, {stopped:.1f}", flush=True)
            if stopped >= KEPT * usual:
                break
        else:
            self.fail(f"the frame rate fell from {usual:.1f} to {stopped:.1f}")
        self.assertEqual(self.frame(self.held), held, "what is held stays held")
        self.assertEqual(self.numbers(self.HELD), {held})
        self.wall.hold(self.session)
        try:
            time.sleep(0.3)  # what was told to be shown when hold came, is
            self.assertEqual(self.numbers(self.RECT), {self.frame(self.session)}, "both nodes show one frame again")
        finally:
            self.wall.hold(self.session, on=False)
        self.wall.step(self.held)
        self.wall.wait(self.held, held + 1)
        for app in self.wall.apps:
            self.assertIsNone(app.poll(), "no program has ended")
        self.assertTrue(all(node["up"] for node in self.wall.nodes()))
        self.assertIn("walld_silent", self.wall.log("node-0-0"))
        self.assertIn("walld_answers", self.wall.log("node-0-0"))


class KilledWalld(unittest.TestCase):
    """All that walld knew comes back from those who live on."""

    KEPT = ("id", "pid", "program", "name", "owner", "held")
    KEPT_OF_WINDOWS = ("id", "title", "width", "height", "rect", "shown_rect", "scaled", "z", "held")

    def setUp(self) -> None:
        self.x = self.enterContext(XServer())
        self.wall = self.enterContext(Wall(tiles=(2, 1), tile_size=TILE, environment={"LP_NUM_THREADS": "0"}))

    def start(self, *command: object, name: str) -> int:
        return self.wall.wait_session(self.wall.run(*command, name=name, env=self.x.environment()))

    def state(self) -> list[dict]:
        return [{key: s[key] for key in self.KEPT} |
                {"surfaces": [{key: w[key] for key in self.KEPT_OF_WINDOWS} for w in s["surfaces"]]}
                for s in self.wall.sessions()]

    def back(self, windows: int) -> bool:
        return sum(len(s["surfaces"]) for s in self.wall.sessions()) == windows

    def test_all_is_as_it_was(self) -> None:
        red, green, blue = (self.start(STILL, colour, name=colour) for colour in ("red", "green", "blue"))
        clock = self.start(CLOCK, "--size", "100x60", "--fps", "20", name="clock")
        self.wall.wait(clock, 5)
        self.wall.ctl("place", red, 150, 20, 120, 90)
        self.wall.ctl("place", green, 180, 40, 100, 100)
        self.wall.ctl("place", blue, 130, 60, 120, 60)
        self.wall.ctl("raise", red)
        self.wall.ctl("lower", blue)
        self.wall.ctl("place", clock, 0, 0, 200, 120)
        until(lambda: all(w["rect"] == w["shown_rect"] for s in self.wall.sessions() for w in s["surfaces"]),
              "the windows do not move")
        self.wall.hold(clock)
        self.wall.ctl("layout", "save", "kept")
        self.assertEqual(len(self.wall.sessions()), 4)
        time.sleep(0.5)
        state, picture = self.state(), pixels(self.wall.screenshot())
        frame = self.wall.sessions()[3]["surfaces"][0]["frame"]
        pids = {name: daemon.pid for name, daemon in self.wall.daemons.items() if name != "walld"}

        for _ in range(2):  # what was told to this walld is told to the next one
            self.wall.restart_walld(pause=1)
            until(lambda: self.back(4), "not all windows came back")
            until(lambda: self.state() == state, f"\nbefore: {state}\nafter:  {self.state()}")
            numpy.testing.assert_array_equal(pixels(self.wall.screenshot()), picture)
            until(lambda: self.wall.sessions()[3]["surfaces"][0]["frame"] == frame,
                  "the held window's frame is another one")
        self.assertEqual({node["name"]: node["pid"] for node in self.wall.nodes()}, pids)
        for name in pids:
            self.assertNotIn("stream_ended", self.wall.log(name), "the programs' streams went on")

        later = self.start(STILL, "red", name="later")
        self.assertGreater(later, clock, "a number is given once, by whatever walld")
        self.wall.hold(clock, on=False)
        self.wall.wait(clock, frame + 5)

    def test_a_layout_still_waits(self) -> None:
        self.start(STILL, "red", name="first")
        self.wall.ctl("place", self.wall.sessions()[0]["id"], 210, 30, 60, 40)
        self.wall.ctl("layout", "save", "kept")
        self.wall.apps[0].terminate()
        until(lambda: not self.wall.sessions(), "the program does not end")
        self.wall.ctl("layout", "load", "kept")
        self.wall.restart_walld()
        again = self.start(STILL, "red", name="first")
        self.assertEqual(self.wall.ctl("sessions")[0]["surfaces"][0]["rect"], [210, 30, 60, 40])
        self.assertGreater(again, 0)

    def test_with_its_nodes_the_windows_still_come_back(self) -> None:
        """Nobody has the session any more: the program begins a new one, in the same place."""
        red = self.start(STILL, "red", name="red")
        self.wall.ctl("place", red, 150, 20, 120, 90)
        until(lambda: self.wall.sessions()[0]["surfaces"][0]["shown_rect"] == [150, 20, 120, 90],
              "the window does not move")
        time.sleep(0.3)
        picture = pixels(self.wall.screenshot())
        for name in ("walld", *self.wall.node_names):
            self.wall.daemons[name].kill()
            self.wall.daemons[name].wait()
        (self.wall.folder / "ready").unlink()
        self.wall.start_walld()
        for name in self.wall.node_names:
            self.wall.start_node(name)
        self.wall.wait_nodes()
        until(lambda: self.back(1), "the window did not come back")
        until(lambda: (pixels(self.wall.screenshot()) == picture).all(), "the picture is another one")


if __name__ == "__main__":
    unittest.main()
