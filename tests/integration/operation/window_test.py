# SPDX-License-Identifier: MIT
"""Tiles as windows of an X display without a screen: what is seen there is the wall's picture, bit for bit."""
import re
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import numpy  # noqa: E402
from compare import load_png  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

SCREEN = (640, 480)
TILE = (200, 150)
BACKGROUND = (0x20, 0x40, 0x60)
OPTIONS = 'background = "#204060"'
SOON = 20.0  # seconds
CLOCK = build_folder() / "tests" / "frame_clock"


class Screen(XServer):
    """That tiles are seen on. Programs have their windows elsewhere."""

    def picture(self, pointer: bool = False) -> numpy.ndarray:
        width, height = self.size
        raw = subprocess.run(["ffmpeg", "-v", "error", "-f", "x11grab", "-draw_mouse", str(int(pointer)), "-video_size",
                              f"{width}x{height}", "-i", self.display,
                              "-frames:v", "1", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"], check=True,
                             capture_output=True).stdout
        return numpy.frombuffer(raw, numpy.uint8).reshape(height, width, 3)

    def windows(self) -> dict[str, str]:
        """The id of each tile's window by the tile's name."""
        tree = subprocess.run(["xwininfo", "-root", "-tree"], env=self.environment(), check=True, capture_output=True,
                              text=True).stdout
        return {name: window for window, name in re.findall(r'(0x[0-9a-f]+) "WallGL tile (.+?)"', tree)}

    def ask(self, request: str, window: str) -> None:
        """Something of Xlib (XLIB) that another client does with a window."""
        subprocess.run(["/usr/bin/python3", "-c", XLIB + request, window], env=self.environment(), check=True)


class OnAScreen(unittest.TestCase):
    def setUp(self) -> None:
        self.screen = self.enterContext(Screen(SCREEN))
        self.programs = self.enterContext(XServer())

    def wall(self, **options) -> Wall:
        return self.enterContext(Wall(**{"tiles": (2, 2), "tile_size": TILE, "options": OPTIONS,
                                         "windows": self.screen.display, **options}))

    def run_clock(self, wall: Wall, rect: tuple[int, int, int, int]) -> int:
        """A program that ends each frame in another colour; its session."""
        app = wall.run(CLOCK, "--size", f"{rect[2]}x{rect[3]}", rect=rect, env=self.programs.environment())
        session = wall.wait_session(app)
        wall.wait(session, 2)
        wall.hold(session)
        return session

    def gears(self, wall: Wall, rect: tuple[int, int, int, int] = (50, 20, 300, 250)) -> int:
        app = wall.run("glxgears", rect=rect, env=self.programs.environment(), stdout=subprocess.DEVNULL)
        session = wall.wait_session(app)
        wall.wait(session, 2)
        wall.hold(session)
        return session

    def until(self, done, what: str) -> None:
        end = time.monotonic() + SOON
        while not done():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.05)

    def seen(self, wall: Wall) -> bool:
        """Each tile's window has the pixels of the tile's screenshot, and nothing else is on the screen."""
        wanted = numpy.zeros((SCREEN[1], SCREEN[0], 3), numpy.uint8)
        for name in wall.tile_names:
            column, row = map(int, name.split("-"))
            y, x = row * wall.tile_size[1], column * wall.tile_size[0]
            wanted[y:y + wall.tile_size[1], x:x + wall.tile_size[0]] = tile_picture(wall, name)
        return bool((self.screen.picture() == wanted).all())


def tile_picture(wall: Wall, tile: str) -> numpy.ndarray:
    png = wall.folder / f"{tile}.png"
    wall.screenshot(png, tile=tile)
    return load_png(png)[:, :, :3]


class Windows(OnAScreen):
    def shows_a_moving_program(self, one_node: bool) -> None:
        wall = self.wall(one_node=one_node)
        self.assertEqual({tile["output"] for tile in wall.ctl("tiles")}, {"window"})
        self.until(lambda: self.seen(wall), "the background")
        self.assertEqual(tuple(self.screen.picture()[149, 199]), BACKGROUND)
        session = self.gears(wall)
        self.until(lambda: self.seen(wall), "a program over four tiles")
        before = self.screen.picture()
        self.assertGreater(before[:, :, 0].max(), 100, "gears are to be seen")
        wall.step(session)
        self.until(lambda: self.seen(wall) and (self.screen.picture() != before).any(), "its next frame")
        wall.hold(session, False)
        wall.ctl("place", session, 0, 0, 180, 120)
        self.until(lambda: wall.sessions()[0]["surfaces"][0]["shown_rect"] == [0, 0, 180, 120], "it is moved")
        wall.hold(session)
        self.until(lambda: self.seen(wall), "the program at its new place")
        self.assertEqual(tuple(self.screen.picture()[200, 100]), BACKGROUND, "it has left the lower tiles")

    def test_a_node_for_each_window(self) -> None:
        self.shows_a_moving_program(one_node=False)

    def test_one_node_for_all_windows(self) -> None:
        self.shows_a_moving_program(one_node=True)

    def test_monitors_on_their_sides(self) -> None:
        wall = self.wall(tiles=(2, 1), tile_keys="rotation = 90")
        self.gears(wall)

        def turned(name: str) -> numpy.ndarray:
            """As its window is to show it, which is 150 x 200."""
            return numpy.rot90(tile_picture(wall, name))

        def seen() -> bool:
            wanted = numpy.zeros((SCREEN[1], SCREEN[0], 3), numpy.uint8)
            for i, name in enumerate(wall.tile_names):
                wanted[:TILE[0], i * TILE[0]:i * TILE[0] + TILE[1]] = turned(name)
            return bool((self.screen.picture() == wanted).all())

        self.until(seen, "the program, turned")
        self.assertGreater(self.screen.picture()[:, :, 0].max(), 100, "gears are to be seen")

    def test_the_order_of_programs(self) -> None:
        wall = self.wall(one_node=True)
        below, above = self.run_clock(wall, (20, 20, 300, 200)), self.gears(wall)
        self.until(lambda: self.seen(wall), "one over the other")
        before = self.screen.picture()
        wall.ctl("raise", below)
        self.until(lambda: self.seen(wall) and (self.screen.picture() != before).any(), "the other way round")
        wall.ctl("close", above)
        wall.ctl("close", below)
        self.until(lambda: not wall.sessions() and self.seen(wall), "nothing but background")

    def test_a_node_is_killed_and_comes_back(self) -> None:
        wall = self.wall()
        session = self.gears(wall)
        self.until(lambda: self.seen(wall), "a program")
        name = wall.node_names[0]
        wall.daemons[name].kill()
        wall.daemons[name].wait()
        self.until(lambda: not self.screen.picture()[:TILE[1], :TILE[0]].any(), "its window is gone")
        wall.start_node(name)
        wall.wait_nodes()
        wall.hold(session, False)
        wall.wait(session, wall.sessions()[0]["surfaces"][0]["frame"] + 5)
        wall.hold(session)
        self.until(lambda: self.seen(wall) and self.screen.picture()[20:TILE[1], 50:TILE[0], 0].max() > 100,
                   "the same on the new window")

    def test_a_watched_tile_too(self) -> None:
        wall = self.wall(one_node=True)
        session = self.gears(wall)
        film = wall.folder / "film.avi"
        recording = subprocess.Popen([wall.bin / "wallctl", "--walld", wall.address, "record", film, "--seconds", "2"],
                                     stdout=subprocess.DEVNULL)
        while recording.poll() is None:
            wall.step(session)
        self.assertEqual(recording.returncode, 0)
        self.assertGreater(film.stat().st_size, 0)
        self.until(lambda: self.seen(wall), "windows while somebody watches")

    def test_what_covered_it_has_gone(self) -> None:
        wall = self.wall()
        self.gears(wall)
        self.until(lambda: self.seen(wall), "a program")
        cover = subprocess.Popen(["xterm", "-geometry", "40x10+100+50"], env=self.screen.environment(),
                                 stderr=subprocess.DEVNULL)
        self.until(lambda: not self.seen(wall), "a window over the tiles")
        cover.terminate()
        cover.wait()
        self.until(lambda: self.seen(wall), "the program again")

    def test_nothing_is_drawn_while_nothing_changes(self) -> None:
        wall = self.wall(tiles=(1, 1))
        session = self.run_clock(wall, (0, 0, *TILE))
        self.until(lambda: self.seen(wall), "the program")
        time.sleep(0.5)
        self.screen.ask(CLEAR, self.screen.windows()["0-0"])
        time.sleep(1)
        self.assertTrue((self.screen.picture()[:TILE[1], :TILE[0]] == BACKGROUND).all(), "what was cleared stays so")
        wall.step(session)
        self.until(lambda: self.seen(wall), "the next frame")

    def test_a_window_that_somebody_resizes_is_filled(self) -> None:
        wall = self.wall(tiles=(1, 1))
        self.run_clock(wall, (0, 0, TILE[0] // 2, TILE[1]))
        self.until(lambda: self.seen(wall), "the program")
        self.screen.ask(RESIZE, self.screen.windows()["0-0"])

        def filled() -> bool:
            picture = self.screen.picture()[:300, :400]
            left, right = picture[:, :197], picture[:, 203:]
            return bool((left[..., 2] == 255).all() and (left == left[0, 0]).all() and (right == BACKGROUND).all())
        self.until(filled, "both halves are twice as large")
        self.assertIn('tile_scaled tile="0-0" size=200x150 window=400x300', wall.log("node-0-0"))

    def test_a_window_that_somebody_destroys_ends_the_node(self) -> None:
        wall = self.wall(tiles=(1, 1))
        self.until(lambda: self.seen(wall), "the tile")
        self.screen.ask(DESTROY, self.screen.windows()["0-0"])
        self.assertEqual(wall.daemons["node-0-0"].wait(SOON), 1)
        self.assertEqual(wall.log("node-0-0").splitlines()[-1], "tileserver: the window of tile '0-0' was destroyed")

    def test_the_pointer_is_not_seen(self) -> None:
        self.wall(tiles=(3, 3))
        self.until(lambda: (self.screen.picture(pointer=True)[:450, :600] == BACKGROUND).all(),
                   "no pointer, which X puts in the middle")

    def test_a_close_button_does_nothing(self) -> None:
        wall = self.wall(tiles=(1, 1))
        self.until(lambda: self.seen(wall), "the tile")
        window = self.screen.windows()["0-0"]
        self.screen.ask(CLOSE, window)
        time.sleep(0.5)
        self.assertIsNone(wall.daemons["node-0-0"].poll())
        self.assertTrue(self.seen(wall))

    def test_what_window_managers_are_told(self) -> None:
        self.wall(tiles=(1, 1))
        told = subprocess.run(["xprop", "-id", self.screen.windows()["0-0"]], env=self.screen.environment(), check=True,
                              capture_output=True, text=True).stdout
        for line in ("_MOTIF_WM_HINTS(_MOTIF_WM_HINTS) = 0x2, 0x0, 0x0, 0x0, 0x0",
                     'WM_CLASS(STRING) = "tileserver", "WallGL"', "user specified location: 0, 0",
                     "program specified minimum size: 200 by 150", "WM_DELETE_WINDOW",
                     "Client accepts input or input focus: False"):
            self.assertIn(line, told)
        self.assertNotIn("FULLSCREEN", told)


# An X client in a process of its own; Python's own Xlib would be one package more.
XLIB = """
import ctypes, sys
x = ctypes.CDLL("libX11.so.6")
x.XOpenDisplay.restype = ctypes.c_void_p
d, window = ctypes.c_void_p(x.XOpenDisplay(None)), ctypes.c_ulong(int(sys.argv[1], 16))
"""
# A window manager's close button: the message WM_DELETE_WINDOW.
CLOSE = """
class Message(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("sent", ctypes.c_int),
                ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("message_type", ctypes.c_ulong),
                ("format", ctypes.c_int), ("data", ctypes.c_long * 5), ("room", ctypes.c_char * 96)]
data = (ctypes.c_long * 5)(x.XInternAtom(d, b"WM_DELETE_WINDOW", 0))
message = Message(33, 0, 1, d, window, x.XInternAtom(d, b"WM_PROTOCOLS", 0), 32, data)
assert x.XSendEvent(d, window, 0, ctypes.c_long(0), ctypes.byref(message))
x.XSync(d, 0)
"""
RESIZE = """
x.XResizeWindow(d, window, 400, 300)
x.XSync(d, 0)
"""
DESTROY = """
x.XDestroyWindow(d, window)
x.XSync(d, 0)
"""
# Its content is lost, and nobody is told.
CLEAR = """
x.XClearWindow(d, window)
x.XSync(d, 0)
"""


def with_monitors(*lines: str):
    """A wall whose tiles' places are these lines of wall.toml."""
    class Described(Wall):
        def _output(self, x: int, y: int) -> str:
            return 'output = "window"\n' + lines[x // self.tile_size[0]] + "\n"
    return Described


class Monitors(OnAScreen):
    def described(self, *lines: str, **options) -> Wall:
        """Tiles in a row with these lines of wall.toml, on the screen that DISPLAY names."""
        return self.enterContext(with_monitors(*lines)(tiles=(len(lines), 1), tile_size=TILE, options=OPTIONS,
                                                       environment=self.screen.environment(), **options))

    def set_monitor(self, name: str, geometry: str) -> None:
        subprocess.run(["xrandr", "--setmonitor", name, geometry, "none"], env=self.screen.environment(), check=True)

    def test_a_window_covers_its_monitor(self) -> None:
        self.set_monitor("left", "200/50x150/40+30+40")
        self.set_monitor("right", "200/50x150/40+300+40")
        wall = self.described('monitor = "left"', 'monitor = "right"')
        self.gears(wall, (20, 10, 360, 130))

        def seen() -> bool:
            wanted = numpy.zeros((SCREEN[1], SCREEN[0], 3), numpy.uint8)
            for x, tile in ((30, "0-0"), (300, "1-0")):
                wanted[40:190, x:x + 200] = tile_picture(wall, tile)
            return bool((self.screen.picture() == wanted).all())
        self.until(seen, "each tile on its monitor")
        told = subprocess.run(["xprop", "-id", self.screen.windows()["0-0"]], env=self.screen.environment(), check=True,
                              capture_output=True, text=True).stdout
        self.assertIn("_NET_WM_STATE(ATOM) = _NET_WM_STATE_FULLSCREEN", told)
        self.assertNotIn("tile_scaled", wall.log("node-0-0"))

    def test_a_monitor_of_another_size_is_filled(self) -> None:
        wall = self.described('monitor = "screen"')
        session = self.run_clock(wall, (0, 0, 100, 150))
        self.until(lambda: tuple(self.screen.picture()[479, 639]) == BACKGROUND, "the tile is as large as the screen")
        picture = self.screen.picture()
        self.assertTrue((picture[:, :318, 2] == 255).all(), "the left half")
        self.assertTrue((picture[:, 322:] == BACKGROUND).all(), "the right half")
        wall.step(session)
        self.until(lambda: self.screen.picture()[0, 0, 0] != picture[0, 0, 0], "the next frame")
        said = wall.log("node-0-0")
        self.assertEqual(said.count("tile_scaled"), 1, said)
        self.assertIn('tile_scaled tile="0-0" size=200x150 window=640x480', said)

    def test_a_monitor_that_is_not_there(self) -> None:
        self.fails('monitor = "DP-7"', f'tile \'0-0\': the X display "{self.screen.display}" has no monitor "DP-7": it '
                                       f'has "screen" (640x480+0+0)')

    def test_a_display_that_is_not_there(self) -> None:
        self.fails('display = ":987"', 'the X display ":987" cannot be opened: is an X server running there')

    def test_no_display_at_all(self) -> None:
        self.fails("position = [0, 0]", "set 'display' in wall.toml, or DISPLAY", DISPLAY="")

    def fails(self, line: str, said: str, **environment: str) -> None:
        with tempfile.TemporaryDirectory(prefix="wallgl-") as folder:
            description = Path(folder) / "wall.toml"
            description.write_text(f'[[node]]\nname = "n"\nlisten = "unix:{folder}/n.sock"\n[[node.tile]]\n'
                                   f'name = "0-0"\nrect = [0, 0, 200, 150]\noutput = "window"\n{line}\n')
            done = subprocess.run([build_folder() / "bin" / "tileserver", "--config", description, "--node", "n"],
                                  env=self.screen.environment(**environment), capture_output=True, text=True,
                                  timeout=SOON)
        self.assertEqual(done.returncode, 1)
        self.assertIn(said, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_the_x_server_goes_away(self) -> None:
        wall = self.described("position = [0, 0]")
        session = self.gears(wall, (0, 0, 200, 150))
        for running in (False, True):
            with self.subTest(running=running):
                wall.hold(session, not running)
                node = wall.daemons["node-0-0"]
                self.screen.kill()
                self.assertEqual(node.wait(SOON), 1)
                last = wall.log("node-0-0").splitlines()[-1]
                self.assertEqual(last, f'tileserver: the X server of display "{self.screen.display}" has gone away')
                self.screen = self.enterContext(Screen(SCREEN))
                wall._environment["DISPLAY"] = self.screen.display
                wall.start_node("node-0-0")
                wall.wait_nodes()
        self.until(lambda: self.screen.picture()[:150, :200, 0].max() > 100, "gears on the new X server")


if __name__ == "__main__":
    unittest.main()
