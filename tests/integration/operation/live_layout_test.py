# SPDX-License-Identifier: MIT
"""Windows that are moved, closed and brought back while everything runs: programs that draw only when asked, programs
with several windows, layouts, nodes that stop."""
import ctypes
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import numpy  # noqa: E402
from compare import load_png  # noqa: E402
from wall import Wall, WallError, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

STILL = build_folder() / "tests" / "still_windows"  # draws a window, of one colour, only when X asks
WINDOW = (120, 90)
COLOURS = ("red", "green", "blue")
SOON = 5.0  # seconds


def resize_x_window(display: str, title: str, width: int, height: int) -> None:
    """As a window manager does."""
    x = ctypes.CDLL("libX11.so.6")
    x.XOpenDisplay.restype = ctypes.c_void_p
    for name in ("XDefaultRootWindow", "XQueryTree", "XFetchName", "XResizeWindow", "XCloseDisplay"):
        getattr(x, name).argtypes = None
    x.XDefaultRootWindow.restype = ctypes.c_ulong
    connection = ctypes.c_void_p(x.XOpenDisplay(display.encode()))
    root, parent, windows, count = ctypes.c_ulong(), ctypes.c_ulong(), ctypes.POINTER(ctypes.c_ulong)(), ctypes.c_uint()
    x.XQueryTree(connection, ctypes.c_ulong(x.XDefaultRootWindow(connection)), ctypes.byref(root), ctypes.byref(parent),
                 ctypes.byref(windows), ctypes.byref(count))
    for window in windows[:count.value]:
        found = ctypes.c_char_p()
        if x.XFetchName(connection, ctypes.c_ulong(window), ctypes.byref(found)) and found.value == title.encode():
            x.XResizeWindow(connection, ctypes.c_ulong(window), ctypes.c_uint(width), ctypes.c_uint(height))
    x.XCloseDisplay(connection)


class LiveLayout(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 2), tile_size=(200, 150), options="close_timeout_ms = 700"))

    def tearDown(self) -> None:
        for app in self.wall.apps:
            if app.poll() is None:
                app.kill()
            app.communicate()
        self.wall.apps.clear()
        self.until(lambda: not self.wall.sessions(), "sessions end")

    def until(self, done, what: str, limit: float = SOON) -> None:
        end = time.monotonic() + limit
        while not done():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.02)

    def start(self, *command: object, **options) -> tuple[subprocess.Popen, int]:
        app = self.wall.run(*command, env=self.x.environment(), stdout=subprocess.PIPE, text=True, **options)
        session = self.wall.wait_session(app)
        self.wall.wait(session, 1)
        return app, session

    def still(self, *arguments: str, **options) -> tuple[subprocess.Popen, int]:
        app, session = self.start(STILL, *arguments, **options)
        windows = sum(colour in COLOURS for colour in arguments)
        self.until(lambda: len(self.shown_surfaces(session)) == windows, "all windows are shown")
        return app, session

    def shown_surfaces(self, session: int) -> list[dict]:
        return [s for s in self.surfaces(session) if s["frame"] > 0]

    def surfaces(self, session: int) -> list[dict]:
        return next((s["surfaces"] for s in self.wall.sessions() if s["id"] == session), [])

    def window(self, session: int, title: str) -> dict:
        return next(s for s in self.surfaces(session) if s["title"] == title)

    def picture(self) -> numpy.ndarray:
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            self.wall.screenshot(file.name)
            return load_png(file.name)

    def pixels(self, colour: str) -> int:
        channel = COLOURS.index(colour)
        picture = self.picture()
        return int(((picture[..., channel] == 255) & (picture.sum(axis=2) == 255)).sum())

    def has_arrived(self, session: int) -> bool:
        return not any(s["moving"] for s in self.surfaces(session))

    # ---- moves ----

    def test_a_program_that_draws_when_asked_follows_every_move(self) -> None:
        _, session = self.still("red")
        whole = WINDOW[0] * WINDOW[1]
        dice = random.Random(7)
        for _ in range(15):
            x, y = dice.randrange(400 - WINDOW[0]), dice.randrange(300 - WINDOW[1])
            self.wall.ctl("place", session, x, y, *WINDOW)
            end = time.monotonic() + SOON
            while not self.has_arrived(session):
                self.assertEqual(self.pixels("red"), whole, "neither a hole nor a part of it twice")
                self.assertLess(time.monotonic(), end, "it is drawn at its new place")
            self.assertTrue((self.picture()[y:y + WINDOW[1], x:x + WINDOW[0]] == (255, 0, 0)).all())
            self.assertEqual(self.pixels("red"), whole)

    def test_it_is_drawn_again_in_another_size(self) -> None:
        _, session = self.still("red")
        self.wall.ctl("place", session, 0, 0, 400, 300)
        self.until(lambda: self.pixels("red") == 400 * 300, "it covers the wall")

    def test_it_is_drawn_again_when_its_window_changes(self) -> None:
        _, session = self.still("red")
        resize_x_window(self.x.display, "red", 300, 200)
        self.until(lambda: self.pixels("red") == 300 * 200, "it has its window's size")
        resize_x_window(self.x.display, "red", 50, 40)
        self.until(lambda: self.pixels("red") == 50 * 40, "and once more")

    def test_without_a_back_buffer_it_follows_as_well(self) -> None:
        app = self.wall.run(STILL, "--single", "red", env=self.x.environment(), stdout=subprocess.PIPE, text=True)
        session = self.wall.wait_session(app)
        self.until(lambda: self.pixels("red") == WINDOW[0] * WINDOW[1], "it is shown")
        self.wall.ctl("place", session, 250, 160, *WINDOW)
        self.until(lambda: (self.picture()[160:250, 250:370] == (255, 0, 0)).all(), "it has moved")
        self.assertEqual(self.pixels("red"), WINDOW[0] * WINDOW[1])

    def test_a_restarted_node_shows_it_again(self) -> None:
        self.still("red")
        node = self.wall.node_names[0]
        self.wall.daemons[node].kill()
        self.wall.daemons[node].wait()
        self.wall.start_node(node)
        self.wall.wait_nodes()
        self.until(lambda: self.pixels("red") == WINDOW[0] * WINDOW[1], "it has drawn again")

    def test_a_moving_program_is_never_cut_apart(self) -> None:
        """A window of one colour that draws all the time, moved over all tiles: every picture shows all of it, once."""
        _, session = self.still("green")
        stop = threading.Event()

        def move() -> None:
            dice = random.Random(3)
            while not stop.is_set():
                self.wall.ctl("place", session, dice.randrange(400 - WINDOW[0]), dice.randrange(300 - WINDOW[1]),
                              *WINDOW)

        mover = threading.Thread(target=move)
        mover.start()
        try:
            counts = {self.pixels("green") for _ in range(40)}
        finally:
            stop.set()
            mover.join()
        self.assertEqual(counts, {WINDOW[0] * WINDOW[1]})

    # ---- several windows ----

    def test_each_window_of_a_process_is_a_surface(self) -> None:
        _, session = self.still("red", "green", "blue")
        self.assertEqual(sorted(s["title"] for s in self.surfaces(session)), sorted(COLOURS))
        rects = [tuple(s["rect"]) for s in self.surfaces(session)]
        self.assertEqual(len(set(rects)), 3, "each where there was room")
        self.wall.ctl("place", self.window(session, "green")["id"], 200, 150, 200, 150)
        self.until(lambda: self.pixels("green") == 200 * 150, "one of them has moved")
        for other in ("red", "blue"):
            self.assertEqual(self.pixels(other), WINDOW[0] * WINDOW[1])
            self.assertFalse(self.window(session, other)["moving"])

    def test_windows_without_a_place_go_where_there_is_room_then_cascade(self) -> None:
        sessions = [self.still("red", "green", "blue")[1] for _ in range(3)]  # nine are more than fit in three columns
        rects = [tuple(s["rect"]) for session in sessions for s in self.surfaces(session)]
        self.assertEqual(len(set(rects)), 9)
        self.assertEqual({rect[:2] for rect in rects}, {(x, y) for x in (0, 120, 240) for y in (0, 90, 180)})
        _, full = self.still("red")
        _, more = self.still("red")
        first, second = self.surfaces(full)[0]["rect"], self.surfaces(more)[0]["rect"]
        self.assertEqual([b - a for a, b in zip(first, second)], [32, 32, 0, 0], "a cascade where there is none")

    # ---- closing ----

    def test_close_asks_as_a_window_manager_does(self) -> None:
        app, session = self.still("--close", "red")
        self.assertEqual(self.wall.ctl("close", session), {"closed": "by the program"})
        self.assertEqual(app.wait(SOON), 0)
        self.assertIn("closed red", app.stdout.read())

    def test_one_window_of_several_closes_alone(self) -> None:
        app, session = self.still("--close", "red", "green")
        self.assertEqual(self.wall.ctl("close", self.window(session, "red")["id"]), {"closed": "by the program"})
        self.assertIsNone(app.poll())
        self.assertEqual([s["title"] for s in self.surfaces(session)], ["green"])
        self.until(lambda: self.pixels("red") == 0, "it is off the wall")
        self.assertEqual(self.pixels("green"), WINDOW[0] * WINDOW[1])

    def test_a_program_that_cannot_be_asked_is_cut_off_at_once(self) -> None:
        app, session = self.still("red")
        begin = time.monotonic()
        self.assertEqual(self.wall.ctl("close", session), {"closed": "by walld"})
        self.assertLess(time.monotonic() - begin, 0.6)
        self.assertEqual(self.wall.sessions(), [])
        self.assertIsNone(app.poll(), "it goes on without a wall")
        self.until(lambda: self.pixels("red") == 0, "it is off the wall")

    def test_one_that_does_not_obey_is_cut_off_in_time(self) -> None:
        app, session = self.still("--close", "red")
        app.send_signal(signal.SIGSTOP)
        begin = time.monotonic()
        self.assertEqual(self.wall.ctl("close", session), {"closed": "by walld"})
        self.assertGreater(time.monotonic() - begin, 0.6)
        self.assertEqual(self.wall.sessions(), [])

    def test_glxgears_closes(self) -> None:
        _, session = self.start("glxgears", "-geometry", "100x100")
        self.wall.ctl("close", session)
        self.assertEqual(self.wall.sessions(), [])

    # ---- layouts ----

    def test_a_layout_comes_back(self) -> None:
        _, stills = self.still("red", "green")
        _, named = self.still("blue", name="sky")
        self.wall.ctl("place", self.window(stills, "red")["id"], 10, 20, 100, 50)
        self.wall.ctl("place", named, 200, 150, 200, 150)
        self.wall.ctl("lower", named)
        self.assertEqual(self.wall.ctl("layout", "save", "evening"), {"windows": 3})
        self.assertIn("evening", self.wall.ctl("layout", "list"))
        before = {s["title"]: (s["rect"], s["z"]) for id in (stills, named) for s in self.surfaces(id)}
        self.wall.ctl("place", self.window(stills, "red")["id"], 0, 0, 400, 300)
        self.wall.ctl("raise", named)
        self.assertEqual(self.wall.ctl("layout", "load", "evening"), {"placed": 3, "waiting": 0})
        self.assertEqual({s["title"]: (s["rect"], s["z"]) for id in (stills, named) for s in self.surfaces(id)}, before)
        self.until(lambda: self.pixels("red") == 100 * 50, "and it can be seen")
        self.wall.ctl("layout", "delete", "evening")
        self.assertNotIn("evening", self.wall.ctl("layout", "list"))

    def test_a_program_that_starts_later_takes_its_place_in_the_layout(self) -> None:
        app, session = self.still("red", name="later")
        self.wall.ctl("place", session, 222, 33, 44, 55)
        self.wall.ctl("layout", "save", "morning")
        app.kill()
        app.wait()
        self.until(lambda: not self.wall.sessions(), "it is gone")
        self.assertEqual(self.wall.ctl("layout", "load", "morning"), {"placed": 0, "waiting": 1})
        _, again = self.still("red", name="later")
        self.assertEqual(self.surfaces(again)[0]["rect"], [222, 33, 44, 55])

    def test_wrong_layouts_are_refused(self) -> None:
        with self.assertRaisesRegex(WallError, "there is no layout 'nothing'"):
            self.wall.ctl("layout", "load", "nothing")
        with self.assertRaisesRegex(WallError, "a layout's name has"):
            self.wall.ctl("layout", "save", "../evil")
        folder = self.wall.folder / "state" / "layouts"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "bad.json").write_text('{"version": 1')
        with self.assertRaisesRegex(WallError, "layouts/bad.json: not a layout"):
            self.wall.ctl("layout", "load", "bad")
        self.wall.ctl("layout", "delete", "bad")

    # ---- wrong use ----

    def test_a_place_that_cannot_be_changes_nothing(self) -> None:
        _, session = self.still("red")
        before = self.wall.sessions()
        for wrong, says in (((session, 400, 0, 10, 10), "off the canvas"), ((session, 0, 0, 0, 10), "needs a width"),
                            ((session, 0, 0, 10, -1), "needs a width"),
                            ((999, 0, 0, 10, 10), "there is no session 999"),
                            ((f"{session}.99", 0, 0, 10, 10), "has no window 99"),
                            (("x", 0, 0, 10, 10), "is no session")):
            with self.assertRaisesRegex(WallError, says):
                self.wall.ctl("place", wrong[0], "--", *wrong[1:])
        self.assertEqual(self.wall.sessions(), before)

    # ---- nodes ----

    def test_a_stopped_node_does_not_hold_the_others_and_catches_up(self) -> None:
        app, session = self.start("glxgears", "-geometry", "400x300")

        def frames_in(seconds: float) -> int:
            first = self.surfaces(session)[0]["frame"]
            time.sleep(seconds)
            return self.surfaces(session)[0]["frame"] - first

        usual = frames_in(1.5)
        node = self.wall.daemons[self.wall.node_names[0]]
        node.send_signal(signal.SIGSTOP)
        try:
            time.sleep(0.5)
            self.assertGreater(frames_in(2.0) / 2.0, 0.5 * usual / 1.5, "the others go on")
            self.assertGreater(self.surfaces(session)[0]["swap_timeouts"], 0)
        finally:
            node.send_signal(signal.SIGCONT)
        time.sleep(2)
        self.wall.hold(session)
        frame = self.surfaces(session)[0]["frame"]
        self.wall.wait(session, frame, limit=2)
        self.assertIsNone(app.poll())
        skew = self.surfaces(session)[0]["skew"]
        self.assertGreater(skew["rendered"]["frames"], 10)
        self.assertGreater(skew["rendered"]["most_ms"], skew["rendered"]["mean_ms"])
        surface = self.surfaces(session)[0]["id"]
        self.assertIn(f'wallgl_surface_rendered_skew_seconds_count{{session="{session}",surface="{surface}"}}',
                      self.wall.rest("GET", "/metrics")[1])


if __name__ == "__main__":
    unittest.main()
