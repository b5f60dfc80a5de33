# SPDX-License-Identifier: MIT
"""wallview on a desktop without a graphics card: what it shows and saves is the wall's picture, bit for bit."""
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from compare import load_png  # noqa: E402
from wall import Wall  # noqa: E402
from xserver import XServer  # noqa: E402

TILE = (200, 150)
WHOLE = ("--size", "400x150")
SOON = 20.0  # seconds


class OnADesktop(unittest.TestCase):
    wall: Wall

    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory(prefix="wallgl-")))
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 1), tile_size=TILE, options='background = "#204060"'))

    def view(self, *options: object, **popen) -> subprocess.Popen:
        where = () if "--http" in options else ("--walld", self.wall.address)
        return subprocess.Popen([str(word) for word in (self.wall.bin / "wallview", *where, *options)],
                                env=self.x.environment(SDL_RENDER_DRIVER="software"), stderr=subprocess.PIPE, text=True,
                                **popen)

    def picture(self, *options: object) -> numpy.ndarray:
        """What it saves after one picture."""
        png = self.folder / "saved.png"
        with self.view(*options, "--frames", 1, "--save", png) as viewer:
            said = viewer.communicate(timeout=SOON)[1]
        self.assertEqual((viewer.returncode, said), (0, ""))
        return load_png(png)[:, :, :3]

    def shot(self, **options) -> numpy.ndarray:
        png = self.folder / "shot.png"
        self.wall.screenshot(png, **options)
        return load_png(png)[:, :, :3]

    def until(self, done, what: str) -> None:
        end = time.monotonic() + SOON
        while not done():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.05)

    def desktop(self) -> numpy.ndarray:
        width, height = self.x.size
        raw = subprocess.run(["ffmpeg", "-v", "error", "-f", "x11grab", "-draw_mouse", "0", "-video_size",
                              f"{width}x{height}", "-i", self.x.display, "-frames:v", "1", "-f", "rawvideo", "-pix_fmt",
                              "bgr24", "-"],
                             check=True, capture_output=True).stdout
        return numpy.frombuffer(raw, numpy.uint8).reshape(height, width, 3)

    def shows(self, picture: numpy.ndarray) -> bool:
        """Somewhere on the desktop, pixel for pixel."""
        wanted = cv2.cvtColor(picture, cv2.COLOR_RGB2BGR)
        least = cv2.minMaxLoc(cv2.matchTemplate(self.desktop(), wanted, cv2.TM_SQDIFF))
        x, y = least[2]
        return bool((self.desktop()[y:y + wanted.shape[0], x:x + wanted.shape[1]] == wanted).all())

class WallView(OnADesktop):
    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        app = cls.wall.run("glxgears", rect=(50, 20, 250, 110), env=cls.x.environment(), stdout=subprocess.DEVNULL)
        cls.addClassCleanup(app.wait)
        cls.addClassCleanup(app.kill)
        cls.session = cls.wall.wait_session(app)
        cls.wall.wait(cls.session, 2)
        cls.wall.hold(cls.session)
        time.sleep(0.5)

    def test_the_whole_wall_over_both_ways(self) -> None:
        shot = self.shot()
        self.assertGreater(shot[:, :, 0].max(), 100, "gears are to be seen")
        for way in ((), ("--http", self.wall.url)):
            self.assertTrue((self.picture(*WHOLE, *way) == shot).all(), way)

    def test_a_part_of_it(self) -> None:
        shot = self.shot()
        tile = self.wall.tile_names[1]
        self.assertTrue((self.picture(*WHOLE, "--tile", tile) == shot[:, TILE[0]:]).all())
        self.assertTrue((self.picture(*WHOLE, "--region", "120,30,160,100") == shot[30:130, 120:280]).all())
        self.assertTrue((self.picture(*WHOLE, "--tile", tile, "--region",
                                      "10,20,30,40") == shot[20:60, TILE[0] + 10:TILE[0] + 40]).all())
        self.assertTrue((self.picture(*WHOLE, "--session", self.session) == self.shot(session=self.session)).all())

    def test_a_smaller_window_gets_a_smaller_picture(self) -> None:
        self.assertEqual(self.picture("--size", "200x200").shape[:2], (75, 200))

    def test_what_it_saves_is_on_the_desktop(self) -> None:
        viewer = self.view(*WHOLE)
        self.addCleanup(viewer.communicate)
        self.addCleanup(viewer.kill)
        self.until(lambda: self.shows(self.shot()), "the wall is on the desktop")
        self.wall.step(self.session)
        self.until(lambda: self.shows(self.shot()), "its next frame is")

    def test_full_screen_is_the_screen_without_a_window_manager_too(self) -> None:
        viewer = self.view("--fullscreen")
        self.addCleanup(viewer.communicate)
        self.addCleanup(viewer.kill)
        # 400x150 pixels of the wall on 1280x1024 ones of the screen
        self.until(lambda: self.desktop()[512, [2, 1277]].tolist() == [[0x60, 0x40, 0x20]] * 2,
                   "the background is seen at both edges")

    def test_what_cannot_be_seen_is_said(self) -> None:
        for options, what in ((("--tile", "nowhere"), "there is no tile 'nowhere'"),
                              (("--session", 999), "there is no session 999"), (("--codec", "mp3"), "codec"),
                              (("--http", "http://127.0.0.1:1"), "cannot be reached"),
                              (("--http", "ftp://x"), "expected http://HOST")):
            viewer = self.view(*options, "--frames", 1)
            said = viewer.communicate(timeout=SOON)[1]
            self.assertEqual(viewer.returncode, 1)
            self.assertIn(what, said)


class WithoutWalld(OnADesktop):
    def test_it_connects_again(self) -> None:
        png = self.folder / "after.png"
        viewer = self.view(*WHOLE, "--save", png)
        self.addCleanup(viewer.kill)
        self.until(lambda: self.shows(self.shot()), "the wall is on the desktop")
        self.wall.daemons["walld"].kill()
        self.wall.daemons["walld"].wait()
        self.assertIn("wallview: ", viewer.stderr.readline())
        self.wall.start_walld()
        self.wall.wait_nodes()
        while "connected" not in viewer.stderr.readline():
            pass
        shot = self.shot()
        self.until(lambda: self.shows(shot), "the wall is on the desktop again")
        viewer.send_signal(signal.SIGTERM)
        viewer.communicate(timeout=SOON)
        self.assertEqual(viewer.returncode, 0)
        self.assertTrue((load_png(png)[:, :, :3] == shot).all())


if __name__ == "__main__":
    unittest.main()
