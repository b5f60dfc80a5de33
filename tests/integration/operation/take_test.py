#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Programs off the wall and in their own X windows while they run, and back (`wallctl take`): what is seen there is the
picture that was on the wall."""
import json
import os
import re
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from wall import Wall, build_folder, end_all  # noqa: E402
from window_test import XLIB  # noqa: E402
from xserver import XServer  # noqa: E402

WINDOW = (400, 300)
SOON = 20.0  # seconds
DRIVEN = {"LP_NUM_THREADS": "0"}

RESIZE = """
x.XResizeWindow(d, window, 200, 150)
x.XSync(d, 0)
"""
# As X does with a key that is pressed there: it goes to the first window around that listens to keys.
ESCAPE = """
class Key(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("sent", ctypes.c_int),
                ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("root", ctypes.c_ulong),
                ("subwindow", ctypes.c_ulong), ("time", ctypes.c_ulong), ("places", ctypes.c_int * 4),
                ("state", ctypes.c_uint), ("keycode", ctypes.c_uint), ("same_screen", ctypes.c_int),
                ("room", ctypes.c_char * 96)]
key = Key(2, 0, 1, d, window, 0, 0, 0, (ctypes.c_int * 4)(), 0, x.XKeysymToKeycode(d, ctypes.c_ulong(0xff1b)), 1)
assert x.XSendEvent(d, window, 1, ctypes.c_long(1), ctypes.byref(key))
x.XSync(d, 0)
"""


class Taken:
    """wallctl take, from a desktop on which its output is seen."""

    def __init__(self, wall: Wall, session: int, x: XServer, *options: object):
        self.process = subprocess.Popen(
            [wall.bin / "wallctl", "--walld", wall.address, "--json", "take", str(session), *map(str, options)],
            env=x.environment(**DRIVEN), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            start_new_session=True)

    def end(self, ask: bool = True) -> dict:
        if ask:
            self.process.send_signal(signal.SIGINT)
        said, error = self.process.communicate(timeout=SOON)
        if self.process.returncode != 0:
            raise AssertionError(said + error)
        return json.loads(said)

    def refusal(self) -> str:
        _, error = self.process.communicate(timeout=SOON)
        return error if self.process.returncode == 1 else f"it ended with {self.process.returncode}"


class Takes(unittest.TestCase):
    def setUp(self) -> None:
        self.x = self.enterContext(XServer((800, 600)))
        self.wall = self.enterContext(Wall(tiles=(1, 1), tile_size=WINDOW, environment=DRIVEN))

    def start(self, name: str, *options: object) -> tuple[subprocess.Popen, int]:
        app = self.wall.run(build_folder() / "tests" / name, "--size", "%dx%d" % WINDOW, *options,
                            env=self.x.environment())
        session = self.wall.wait_session(app)
        self.wall.wait(session, 5)
        return app, session

    def on_wall(self) -> numpy.ndarray:
        return cv2.imdecode(numpy.frombuffer(self.wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)

    def on_screen(self) -> numpy.ndarray:
        """The X screen's left top; where programs have their windows, as nobody manages them."""
        width, height = self.x.size
        raw = subprocess.run(["ffmpeg", "-v", "error", "-f", "x11grab", "-draw_mouse", "0", "-video_size",
                              f"{width}x{height}", "-i", self.x.display, "-frames:v", "1", "-f", "rawvideo", "-pix_fmt",
                              "bgr24", "-"], check=True, capture_output=True).stdout
        return numpy.frombuffer(raw, numpy.uint8).reshape(height, width, 3)[:WINDOW[1], :WINDOW[0]]

    def assert_shows(self, picture, expected: numpy.ndarray, where: str) -> None:
        end = time.monotonic() + SOON
        while (wrong := int((picture() != expected).any(axis=2).sum())) != 0:
            self.assertLess(time.monotonic(), end, f"{wrong} pixels are wrong {where}")
            time.sleep(0.1)

    def there_and_back(self, name: str, *options: object) -> None:
        app, session = self.start(name, *options)
        expected = self.on_wall()
        self.assertGreater(len(numpy.unique(expected.reshape(-1, 3), axis=0)), 50, "a picture of many colours")
        self.assertGreater(int((self.on_screen() != expected).any(axis=2).sum()), 1000, "nothing is in its window yet")
        taken = Taken(self.wall, session, self.x)
        self.assert_shows(self.on_screen, expected, "in its window")
        self.assertEqual(self.wall.sessions(), [], "it has left the wall")
        said = taken.end()
        self.assertEqual(said["ended"], "interrupted")
        self.assertEqual(said["session"], self.wall.wait_session(app))
        self.assert_shows(self.on_wall, expected, "on the wall again")
        end_all([app])

    def test_pictures_that_only_nodes_have(self) -> None:
        self.there_and_back("drawn_once")

    def test_windows_that_are_never_cleared(self) -> None:
        self.there_and_back("drawn_over")

    def test_the_window_gets_what_is_typed_and_may_be_resized(self) -> None:
        app = self.wall.run("glxgears", "-geometry", "%dx%d" % WINDOW, env=self.x.environment(),
                            stdout=subprocess.DEVNULL)
        session = self.wall.wait_session(app)
        self.wall.wait(session, 5)
        native = self.wall.sessions()[0]["surfaces"][0]["x_window"]
        self.assertEqual(native["display"], self.x.display)
        taken = Taken(self.wall, session, self.x)
        end = time.monotonic() + SOON
        while len(numpy.unique(self.on_screen().reshape(-1, 3), axis=0)) < 20:
            self.assertLess(time.monotonic(), end, "it is not in its window")
            time.sleep(0.1)
        self.ask(RESIZE, native["id"])
        while self.on_screen()[160:, :].any() or self.on_screen()[:, 210:].any() or not self.on_screen()[75, 100].any():
            self.assertLess(time.monotonic(), end, "it does not fill the smaller window")
            time.sleep(0.1)
        self.ask(ESCAPE, self.tile(native["id"]))
        self.assertEqual(app.wait(SOON), 0, "the key came through to the program")
        said = taken.end(ask=False)
        self.assertEqual((said["session"], said["ended"]), (None, "the program has ended"))

    def tile(self, window: int) -> int:
        """The window that lies in the program's."""
        tree = subprocess.run(["xwininfo", "-children", "-id", hex(window)], env=self.x.environment(), check=True,
                              capture_output=True, text=True).stdout
        [child] = re.findall(r"^ +(0x[0-9a-f]+) ", tree.split("children:")[-1] if "children:" in tree
                             else tree.split("child:")[-1], re.MULTILINE)
        return int(child, 16)

    def ask(self, request: str, window: int) -> None:
        """Something of Xlib that another client does with a window."""
        subprocess.run(["/usr/bin/python3", "-c", XLIB + request, hex(window)], env=self.x.environment(), check=True)

    def test_it_comes_back_by_itself(self) -> None:
        app, session = self.start("drawn_once")
        self.assertEqual(Taken(self.wall, session, self.x, "--seconds", 1).end(ask=False)["ended"], "time")
        self.wall.wait_session(app)

    def test_it_comes_back_when_nobody_draws_in_its_window(self) -> None:
        app, session = self.start("frame_clock")
        taken = Taken(self.wall, session, self.x)
        end = time.monotonic() + SOON
        while self.wall.sessions():
            self.assertLess(time.monotonic(), end, "it does not leave the wall")
            time.sleep(0.1)
        children = Path(f"/proc/{taken.process.pid}/task/{taken.process.pid}/children").read_text().split()
        [node] = [pid for pid in map(int, children) if Path(f"/proc/{pid}/comm").read_text().strip() == "tileserver"]
        os.kill(node, signal.SIGKILL)
        self.assertIn("tileserver has ended", taken.end(ask=False)["ended"])
        session = self.wall.wait_session(app)
        self.wall.wait(session, self.wall.wait(session, 1) + 5)

    def test_a_wall_that_is_gone_does_not_get_it(self) -> None:
        app, session = self.start("drawn_once")
        expected = self.on_wall()
        taken = Taken(self.wall, session, self.x)
        self.assert_shows(self.on_screen, expected, "in its window")
        self.wall.daemons["walld"].kill()
        self.wall.daemons["walld"].wait()
        taken.process.send_signal(signal.SIGINT)
        time.sleep(1)
        self.assertIsNone(taken.process.poll(), "it stays in its window")
        self.assertIsNone(app.poll())
        self.assert_shows(self.on_screen, expected, "in its window still")
        self.wall.start_walld()
        self.assertEqual(taken.end()["ended"], "interrupted")
        self.assert_shows(self.on_wall, expected, "on the wall again")

    def test_what_cannot_be_taken_is_said(self) -> None:
        self.assertIn("no session 99", Taken(self.wall, 99, self.x).refusal())
        self.wall.run(build_folder() / "tests" / "turns", parallel=2, env=self.x.environment(),
                      stdout=subprocess.DEVNULL)
        self.assertIn("parallel program", Taken(self.wall, self.wall.wait_session(), self.x).refusal())


if __name__ == "__main__":
    unittest.main()
