# SPDX-License-Identifier: MIT
"""The status page in a real browser, on a real wall with two programs: what it shows, and what people do with it."""
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import numpy  # noqa: E402
from browser import Browser  # noqa: E402
from compare import load_png  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

OUTPUT = build_folder() / "test-output" / "page"
TILE = (320, 240)
SECRET = "a secret of the lobby's screen"
SOON = 20.0  # seconds; the machine may have other work
LIT = 50  # of 255: brighter than the wall's background
PHONE = {"viewport": {"width": 360, "height": 740}, "deviceScaleFactor": 2, "hasTouch": True, "isMobile": True}
ROUNDING = 3  # canvas pixels that a drag by whole screen pixels may be off


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        secret = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="wallgl-"))) / "lobby.token"
        secret.touch(mode=0o600)
        secret.write_text(SECRET)
        lobby = f'[[people.token]]\nname = "lobby"\nfile = "{secret}"\nrole = "viewer"'
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 2), tile_size=TILE, people=lobby))
        cls.browser = cls.enterClassContext(Browser())
        cls.big, cls.small = cls.gears("200x150"), cls.gears("160x120")

    @classmethod
    def gears(cls, size: str) -> int:
        app = cls.wall.run("glxgears", "-geometry", size, env=cls.x.environment(), stdout=subprocess.DEVNULL)
        return cls.wall.wait_session(app)

    def setUp(self) -> None:
        self.place(self.big, [0, 0, 200, 150])
        self.place(self.small, [200, 0, 160, 120])

    def tearDown(self) -> None:
        self.browser.screenshot(OUTPUT / f"{self._testMethodName}.png")
        self.assertEqual(self.browser.errors(), [])

    def open(self, **options) -> None:
        self.browser.open(self.wall.url, **options)
        self.browser.until("document.querySelectorAll('.window').length === 2 && "
                           "document.querySelectorAll('.tile').length === 4")

    def until(self, done, what: str) -> None:
        end = time.monotonic() + SOON
        while not done():
            self.assertLess(time.monotonic(), end, f"{what}: {self.wall.sessions()}\n{self.wall.log('walld')[-3000:]}")
            time.sleep(0.05)

    # ---- the wall ----

    def surface(self, session: int) -> dict:
        return next(s for s in self.wall.sessions() if s["id"] == session)["surfaces"][0]

    def rect(self, session: int) -> list[int]:
        return self.surface(session)["rect"]

    def place(self, session: int, rect: list[int]) -> None:
        self.wall.ctl("place", session, *rect)
        self.until(lambda: self.surface(session)["shown_rect"] == rect, "the window is at its place")

    def lit_box(self, rect: list[int]) -> list[int]:
        """Where the wall shows something in that rectangle: x, y, width, height."""
        x, y, width, height = rect
        lit = load_png_of(self.wall)[y:y + height, x:x + width].max(axis=2) > LIT
        columns, rows = numpy.flatnonzero(lit.any(axis=0)), numpy.flatnonzero(lit.any(axis=1))
        if not len(columns):
            return [x, y, 0, 0]
        return [int(n) for n in (x + columns[0], y + rows[0], columns[-1] - columns[0] + 1, rows[-1] - rows[0] + 1)]

    # ---- the page ----

    def window(self, session: int) -> str:
        """The page's element of a program's window."""
        return f"document.querySelector('.window[data-key=\"{self.surface(session)['id']}\"]')"

    def pixels(self, rect: list[int]) -> str:
        """An expression: the pixels in a rectangle of the canvas of the page that stands for that one of the wall."""
        scale = "(document.getElementById('picture').width / 640)"
        at = ", ".join(f"Math.round({side} * {scale})" for side in rect)
        return f"document.getElementById('picture').getContext('2d').getImageData({at}).data"

    def path(self, session: int, dx: int, dy: int,
             grip: tuple[float, float] = (0.5, 0.5)) -> tuple[float, float, float, float]:
        """Where a drag by canvas pixels begins and ends on the page; `grip`: the point of the window (0 to 1)."""
        box = self.browser.get(f"{self.window(session)}.getBoundingClientRect().toJSON()")
        scale = self.browser.get("document.getElementById('wall').clientWidth") / 640
        x, y = box["x"] + box["width"] * grip[0], box["y"] + box["height"] * grip[1]
        return x, y, x + dx * scale, y + dy * scale

    def drag(self, session: int, dx: int, dy: int, **grip) -> None:
        from_x, from_y, x, y = self.path(session, dx, dy, **grip)
        self.browser.call("mouse.move", from_x, from_y)
        self.browser.call("mouse.down")
        self.browser.call("mouse.move", x, y, {"steps": 5})
        self.browser.call("mouse.up")

    def touch(self, kind: str, *points: tuple[float, float]) -> None:
        self.browser.call("devtools", "Input.dispatchTouchEvent",
                          {"type": kind, "touchPoints": [{"x": x, "y": y} for x, y in points]})

    def press(self, session: int, *keys: str) -> None:
        self.browser.get(f"{self.window(session)}.focus()")
        for key in keys:
            self.browser.call("keyboard.press", key)

    def test_both_programs_move_in_the_live_picture(self) -> None:
        self.open()
        self.browser.until("document.getElementById('connection').dataset.state === 'live'")
        for session in (self.big, self.small):
            pixels = f"[...{self.pixels(self.rect(session))}]"
            self.browser.until(f"{pixels}.some((byte, i) => i % 4 < 3 && byte > {LIT})")
            self.browser.get(f"window.before = {pixels}.join()")
            self.browser.until(f"{pixels}.join() !== window.before")

    def test_a_window_is_dragged_to_another_tile(self) -> None:
        self.open()
        self.drag(self.small, 240, 260)
        self.until(lambda: near(self.surface(self.small)["shown_rect"], [440, 260, 160, 120]),
                   "the window is where it was dropped")
        x, y, width, height = self.rect(self.small)
        box = self.lit_box([0, 180, 640, 300])
        self.assertTrue(x <= box[0] and y <= box[1] and box[0] + box[2] <= x + width and box[1] + box[3] <= y + height,
                        (box, (x, y, width, height)))
        self.assertGreater(box[2], width / 2)
        self.assertEqual(self.lit_box([200, 0, 440, 180])[2:], [0, 0], "nothing is left where it was")

    def test_a_window_is_resized_by_its_handle(self) -> None:
        self.open()
        self.press(self.small)
        self.drag(self.small, 80, 60, grip=(0.98, 0.98))
        self.until(lambda: near(self.rect(self.small), [200, 0, 240, 180]), "the window is larger")

    def test_the_keyboard_moves_resizes_and_stacks(self) -> None:
        self.open()
        self.press(self.small, "ArrowRight", "ArrowDown", "Control+ArrowDown", "Shift+ArrowRight")
        self.until(lambda: self.rect(self.small) == [210, 11, 170, 120], "the window has moved")
        self.press(self.small, "PageDown")
        self.until(lambda: self.surface(self.small)["z"] == 0, "it is below")
        self.press(self.small, "PageUp")
        self.until(lambda: self.surface(self.small)["z"] == 1, "it is above")

    def test_a_window_is_closed_after_a_question(self) -> None:
        extra = self.gears("100x75")
        self.browser.open(self.wall.url)
        self.browser.until("document.querySelectorAll('.window').length === 3")
        self.press(extra, "Delete")
        self.browser.until("document.getElementById('confirm').open")
        self.browser.call("click", "#confirm-no")
        self.assertIn(extra, [s["id"] for s in self.wall.sessions()])
        self.browser.call("click", "#close")
        self.browser.call("click", "#confirm-yes")
        self.until(lambda: extra not in [s["id"] for s in self.wall.sessions()], "its session has ended")
        self.browser.until("document.querySelectorAll('.window').length === 2")

    def test_a_killed_tileserver_turns_its_tile_red_until_it_is_back(self) -> None:
        self.open()
        state = "document.querySelector('.tile[data-key=\"1-1\"]').dataset.state"
        red = f"(([r, g, b]) => r > 80 && g < 60 && b < 60)({self.pixels([480, 360, 1, 1])})"
        self.browser.until(f"{state} === 'up' && !{red}")
        self.wall.daemons["node-1-1"].kill()
        self.wall.daemons["node-1-1"].wait()
        self.browser.until(f"{state} === 'away' && {red}")
        self.browser.until("document.getElementById('announce').textContent.includes('Tile 1-1 is away')")
        self.browser.screenshot(OUTPUT / "a_tile_is_away.png")
        self.wall.start_node("node-1-1")
        self.browser.until(f"{state} === 'up' && !{red}")

    def test_a_viewer_changes_nothing(self) -> None:
        self.open(extraHTTPHeaders={"Authorization": f"Bearer {SECRET}"})
        self.browser.until("document.getElementById('who').textContent === 'lobby, viewer'")
        self.drag(self.small, 100, 100)
        self.assertTrue(self.browser.get("document.getElementById('raise').disabled && "
                                         "document.getElementById('close').disabled"))
        self.press(self.small, "ArrowRight", "Delete")
        self.browser.until("!document.getElementById('problem').hidden")
        self.assertFalse(self.browser.get("document.getElementById('confirm').open"))
        self.assertEqual(self.rect(self.small), [200, 0, 160, 120])

    def test_layouts_are_saved_loaded_and_deleted(self) -> None:
        self.open()
        self.browser.call("fill", "#layout-name", "morning")
        self.browser.call("click", "#save")
        self.browser.until("document.querySelector('#layouts li span')?.textContent === 'morning'")
        self.place(self.small, [400, 300, 160, 120])
        self.browser.call("click", "#layouts >> text=Load")
        self.until(lambda: self.surface(self.small)["shown_rect"] == [200, 0, 160, 120], "the window is back")
        self.browser.call("click", "#layouts >> text=Delete")
        self.browser.until("document.querySelectorAll('#layouts li').length === 0")

    def test_a_tile_shows_its_lossless_picture(self) -> None:
        self.open()
        self.browser.call("click", ".tile[data-key='0-1'] button")
        image = "document.getElementById('tile-image')"
        self.browser.until(f"document.getElementById('tile-picture').open && {image}.naturalWidth === {TILE[0]} && "
                           f"{image}.naturalHeight === {TILE[1]}")
        self.browser.call("keyboard.press", "Escape")
        self.browser.until("!document.getElementById('tile-picture').open")
        place = self.browser.get("(({x, y, width, height}) => [x + width * 0.75, y + height * 0.75])"
                                 "(document.getElementById('picture').getBoundingClientRect())")
        self.browser.call("mouse.click", *place)
        self.browser.until("document.getElementById('tile-picture').open && "
                           "document.getElementById('tile-name').textContent === 'Tile 1-1'")

    def test_a_finger_drags_a_window(self) -> None:
        self.open(**PHONE)
        from_x, from_y, x, y = self.path(self.small, 100, 200)
        self.touch("touchStart", (from_x, from_y))
        for part in (0.3, 0.7, 1):
            self.touch("touchMove", (from_x + part * (x - from_x), from_y + part * (y - from_y)))
        self.touch("touchEnd")
        self.until(lambda: near(self.rect(self.small), [300, 200, 160, 120]), "the window has moved")

    def test_a_phone_in_the_dark(self) -> None:
        self.open(**PHONE, colorScheme="dark", reducedMotion="reduce")
        self.assertEqual(self.browser.get("document.documentElement.scrollWidth"), 360)
        self.assertEqual(self.browser.get("document.getElementById('picture').width"),
                         self.browser.get("Math.min(640, 2 * document.getElementById('wall').clientWidth)"))
        self.assertTrue(self.browser.get("getComputedStyle(document.body).backgroundColor.match(/\\d+/g).every(part => "
                                         "part < 50)"))

    def test_everything_that_can_be_used_has_a_name(self) -> None:
        self.open()
        unnamed = ("[...document.querySelectorAll('button, a, input, [role=group], [role=toolbar], "
                   "canvas')].filter(element => "
                   "!(element.getAttribute('aria-label') || element.textContent.trim() || "
                   "element.labels?.length)).map(element => element.outerHTML)")
        self.assertEqual(self.browser.get(unnamed), [])

    def test_a_page_that_did_not_come_as_a_whole_is_loaded_again(self) -> None:
        self.browser.open("about:blank")
        self.browser.call("devtools", "Network.enable")
        self.browser.call("devtools", "Network.setBlockedURLs", {"urls": ["*/model.js"]})
        self.browser.call("goto", self.wall.url)
        self.browser.until("document.getElementById('connection').textContent.includes('did not come as a whole')")
        self.browser.call("devtools", "Network.setBlockedURLs", {"urls": []})
        self.browser.until("document.getElementById('connection').dataset.state === 'live'")
        self.assertEqual(self.browser.get("sessionStorage.length"), 0, "the next time it waits for a second again")
        self.browser.open(self.wall.url)  # without the errors that there were

    def test_every_file_comes_with_its_type_and_a_strict_policy(self) -> None:
        self.open()
        types = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}
        for file in (file for file in (ROOT / "web-ui-min").iterdir() if file.suffix in types):
            path = "" if file.name == "index.html" else file.name
            with urllib.request.urlopen(self.wall.url + path) as answer:
                self.assertEqual(answer.read().decode(), file.read_text(), path)
                self.assertIn(types[file.suffix], answer.headers["Content-Type"])
                self.assertNotIn("unsafe", answer.headers["Content-Security-Policy"])


def load_png_of(wall: Wall) -> numpy.ndarray:
    path = wall.folder / "page.png"
    wall.screenshot(path)
    return load_png(path)


def near(rect: list[int], wanted: list[int]) -> bool:
    return all(abs(a - b) <= ROUNDING for a, b in zip(rect, wanted))


if __name__ == "__main__":
    unittest.main()
