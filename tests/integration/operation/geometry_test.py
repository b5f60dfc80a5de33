# SPDX-License-Identifier: MIT
"""Tiles that are turned, have other pixels than the canvas, are warped, overlap and fade: what their outputs show is
what OpenCV makes of the canvas. All of it changes while a program runs, and what makes no sense changes nothing."""
from __future__ import annotations

import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy as np  # noqa: E402
from compare import load_png  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from wall import WallError  # noqa: E402
from xserver import XServer  # noqa: E402

QUIET = {"LP_NUM_THREADS": "0"}
SIZE = 240, 180  # of a tile
OVERLAP = 40
PLAN = {"a": {"left": (0, 0, *SIZE), "right": (SIZE[0] - OVERLAP, 0, *SIZE)},
        "b": {"low": (0, SIZE[1], *SIZE), "last": (SIZE[0], SIZE[1], *SIZE)}}
GAMMA = 2.2
KEYS = {"left": f"blend = {{ right = {OVERLAP} }}", "right": f"blend = {{ left = {OVERLAP} }}",
        "low": "rotation = 90", "last": "pixels = [400, 310]"}
BEYOND = 0.001  # of the pixels may differ by more than a level where they are filtered
HOMOGRAPHY = np.array([[0.86, 0.05, 0.06], [-0.03, 0.9, 0.08], [0.02, 0.06, 1]])


def sampled(picture: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Linear between the centres of pixels, which is at half numbers; black beyond the picture. In full precision:
    cv2.remap knows places to 1/32 pixel."""
    height, width = picture.shape[:2]
    inside = (x >= 0) & (x <= width) & (y >= 0) & (y <= height)
    x0, y0 = np.floor(x - 0.5), np.floor(y - 0.5)
    tx, ty = (x - 0.5 - x0)[..., None], (y - 0.5 - y0)[..., None]

    def texel(dx: int, dy: int) -> np.ndarray:
        return picture[np.clip(y0 + dy, 0, height - 1).astype(int), np.clip(x0 + dx, 0, width - 1).astype(int)]

    top, bottom = texel(0, 0) * (1 - tx) + texel(1, 0) * tx, texel(0, 1) * (1 - tx) + texel(1, 1) * tx
    return (top * (1 - ty) + bottom * ty) * inside[..., None]


def places(width: int, height: int) -> np.ndarray:
    """Of an output's pixels, fractions, as (height, width, 2)."""
    return np.stack(np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height), axis=-1)


def load_png_of(wall: PlannedWall) -> np.ndarray:
    path = wall.folder / "whole.png"
    wall.screenshot(path)
    return load_png(path)[:, :, :3]


class AWallOfOddOutputs(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())

    def setUp(self) -> None:
        self.wall = self.enterContext(PlannedWall(PLAN, KEYS, environment=QUIET, die_with_parent=True))
        app = self.wall.run("glxgears", fullscreen=True, env=self.x.environment(), stdout=subprocess.DEVNULL)
        self.session = self.wall.wait_session(app)
        self.wall.wait(self.session, 3)
        self.wall.hold(self.session)

    def canvas(self, tile: str) -> np.ndarray:
        return self.picture(tile, output=False)

    def picture(self, tile: str, output: bool = True) -> np.ndarray:
        path = self.wall.folder / f"{tile}-{output}.png"
        self.wall.screenshot(path, tile=tile, output=output)
        return load_png(path)[:, :, :3]

    def assert_close(self, picture: np.ndarray, expected: np.ndarray, what: str) -> None:
        self.assertEqual(picture.shape, expected.shape, what)
        apart = np.abs(picture.astype(float) - expected).max(axis=2)
        self.assertLessEqual((apart > 1).mean(), BEYOND, f"{what}: at most {apart.max():.1f} levels")
        self.assertGreater(picture.max(), 100, f"{what}: there is something to be seen")

    def test_outputs_show_what_opencv_makes_of_the_canvas(self) -> None:
        with self.subTest("turned"):
            turned = cv2.rotate(self.canvas("low"), cv2.ROTATE_90_COUNTERCLOCKWISE)
            self.assertTrue((self.picture("low") == turned).all())
        with self.subTest("more pixels"):
            larger = cv2.resize(self.canvas("last").astype(np.float32), (400, 310), interpolation=cv2.INTER_LINEAR)
            self.assert_close(self.picture("last"), larger, "last")
        with self.subTest("overlapping"):
            shine = np.zeros((SIZE[1], 2 * SIZE[0] - OVERLAP, 3))
            wanted = np.zeros_like(shine)
            for name in ("left", "right"):
                x = PLAN["a"][name][0]
                shine[:, x:x + SIZE[0]] += (self.picture(name) / 255) ** GAMMA
                wanted[:, x:x + SIZE[0]] = (self.canvas(name) / 255) ** GAMMA
            self.assertLess(np.abs(shine - wanted).max(), 0.01, "of white's light")
            self.assertGreater(wanted[:, SIZE[0] - OVERLAP:SIZE[0]].max(), 0.3, "there is something in the overlap")
        with self.subTest("the tiles as people see them"):
            tiles = {tile["name"]: tile for tile in self.wall.ctl("tiles")}
            self.assertEqual((tiles["low"]["rotation"], tiles["low"]["pixels"]), (90, [SIZE[1], SIZE[0]]))
            self.assertEqual((tiles["left"]["shown"], tiles["last"]["shown"]), (["blend"], []))

    def test_it_changes_while_a_program_runs(self) -> None:
        before = {node["name"]: (node["pid"], node["incarnation"]) for node in self.wall.nodes()}
        numbers = ", ".join(map(str, HOMOGRAPHY.ravel()))
        (self.wall.folder / "last.warp").write_text(f"homography = [{numbers}]\n")
        self.wall.keys = {**KEYS, "low": "rotation = 270", "last": 'warp = "last.warp"\ncolor = { curve = [1, 0] }'}
        self.wall.reload(PLAN)
        turned = cv2.rotate(self.canvas("low"), cv2.ROTATE_90_CLOCKWISE)
        self.assertTrue((self.picture("low") == turned).all(), "the other way round")
        canvas = self.canvas("last")
        there = cv2.perspectiveTransform(places(*SIZE).reshape(1, -1, 2), HOMOGRAPHY).reshape(SIZE[1], SIZE[0], 2)
        self.assert_close(self.picture("last"), 255 - sampled(canvas, there[..., 0] * SIZE[0], there[..., 1] * SIZE[1]),
                          "warped and inverted")
        self.assertEqual({node["name"]: (node["pid"], node["incarnation"]) for node in self.wall.nodes()}, before,
                         "no node has begun anew")
        self.wall.hold(self.session, False)
        self.wall.wait(self.session, self.wall.sessions()[0]["surfaces"][0]["frame"] + 5)

        with self.subTest("a warp that makes no sense"):
            (self.wall.folder / "last.warp").write_text("homography = [1, 0, 0, 2, 0, 0, 0, 0, 1]\n")
            with self.assertRaisesRegex(WallError, r"last\.warp:1: this warp makes a line or a point of the output"):
                self.wall.ctl("reload")
            checked = subprocess.run([self.wall.bin / "walld", "--check", "--config", self.wall.folder / "wall.toml"],
                                     capture_output=True, text=True)
            self.assertEqual(checked.returncode, 2)
            self.assertIn("last.warp:1: this warp makes a line", checked.stderr)
            self.assertEqual({t["name"]: t["shown"] for t in self.wall.ctl("tiles")}["last"], ["warp", "color"])
        with self.subTest("as it was in the beginning, by a signal"):
            self.wall.keys = {}
            self.wall.reload(PLAN, by_signal=True)
            self.wall._until(lambda: all(not t["shown"] for t in self.wall.ctl("tiles")), "reloaded", "walld")
            self.wall.hold(self.session)
            self.assertTrue((self.picture("last") == self.canvas("last")).all())

    def test_test_pictures_take_the_place_of_programs(self) -> None:
        before = self.canvas("left")
        self.wall.ctl("pattern", "grid")
        self.assertEqual({tile["pattern"] for tile in self.wall.ctl("tiles")}, {"grid"})
        whole = load_png_of(self.wall)
        for x in (300, 400):
            self.assertTrue((whole[20:60, x] == 128).all(), "a line of the canvas, through two tiles")
        self.assertTrue((self.picture("low") == cv2.rotate(self.canvas("low"), cv2.ROTATE_90_COUNTERCLOCKWISE)).all())
        self.assertFalse((self.picture("left") == self.canvas("left")).all(), "it fades")
        self.wall.ctl("pattern", "white", "--tile", "left", "--output")
        self.assertTrue((self.picture("left") == 255).all(), "untouched by the blend")
        self.assertTrue((self.canvas("left") == before).all(), "the canvas has the program")
        self.wall.ctl("pattern", "names", "--tile", "last")
        self.assertGreater(self.picture("last").max(), 200)

        with self.subTest("a node that comes anew shows it"):
            self.wall.daemons["a"].kill()
            self.wall.daemons["a"].wait()
            self.wall.start_node("a")
            self.wall.wait_nodes()
            self.wall._until(lambda: (self.picture("left") == 255).all(), "white again", "walld")
        with self.subTest("a bit of a code, by the API"):
            status, answer = self.wall.rest("POST", "/api/v1/pattern", {"kind": "code", "bit": 3, "axis": "y"})
            self.assertIn(status, (200, 403), answer)  # over HTTP only where that may operate
            self.wall.ctl("pattern", "code", "--bit", 3, "--axis", "y", "--output")
            rows = np.arange(SIZE[1])
            wanted = np.where((rows ^ rows >> 1) >> 3 & 1, 255, 0)
            self.assertTrue((self.picture("right")[:, 5, 1] == wanted).all())
        for wrong, why in (({"kind": "stars"}, "expected grid"), ({"kind": "code", "bit": 15}, "'bit'"),
                           ({"kind": "code", "axis": "z"}, "expected x or y"),
                           ({"kind": "grid", "tile": "x"}, "no tile")):
            with self.subTest(wrong=wrong), self.assertRaisesRegex(WallError, why):
                self.wall.ctl("pattern", wrong["kind"], *(["--tile", "x"] if "tile" in wrong else []),
                              *(["--bit", wrong["bit"]] if "bit" in wrong else []),
                              *(["--axis", wrong["axis"]] if "axis" in wrong else []))
        self.wall.ctl("pattern", "off")
        self.assertEqual({tile["pattern"] for tile in self.wall.ctl("tiles")}, {None})
        self.wall.hold(self.session, False)
        self.wall.wait(self.session, self.wall.sessions()[0]["surfaces"][0]["frame"] + 3)
        self.wall.hold(self.session)
        self.assertGreater(self.canvas("left")[:, :, 0].max(), 100, "the program again")

    def test_recordings_and_the_api_have_outputs(self) -> None:
        self.wall.ctl("record", self.wall.folder / "low.avi", "--tile", "low", "--output", "--seconds", 0.3)
        film = cv2.VideoCapture(str(self.wall.folder / "low.avi"))
        good, frame = film.read()
        self.assertTrue(good)
        self.assertTrue((cv2.cvtColor(frame, cv2.COLOR_BGR2RGB) == self.picture("low")).all())
        self.assertEqual(self.wall.rest("GET", "/api/v1/snapshot.png?output=1")[0], 400)
        self.assertEqual(self.wall.rest("GET", "/api/v1/snapshot.png?tile=low&output=1")[0], 200)


if __name__ == "__main__":
    unittest.main()
