# SPDX-License-Identifier: MIT
"""Two projectors that stand askew, a camera that sees both, and `wallctl calibrate`: afterwards the wall shows one
picture, as bright where they overlap as elsewhere. The projectors and the camera are made of what the tiles' outputs
show; the camera is the command that takes photographs."""
from __future__ import annotations

import re
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

SIZE = 120, 90  # pixels of a projector
PICTURE = 520, 360  # of the camera
PLAN = {"n": {"a": (0, 0, *SIZE), "b": (SIZE[0], 0, *SIZE)}}
GAMMA = 2.2
CORNERS = np.float32([[0, 0], [SIZE[0], 0], [SIZE[0], SIZE[1]], [0, SIZE[1]]])
# Where the projectors' corners are in the camera's picture.
SEEN = {"a": np.float32([[40, 60], [285, 48], [292, 262], [52, 250]]),
        "b": np.float32([[235, 52], [470, 66], [462, 268], [228, 256]])}
EVEN = 0.03  # of the light: 2 % of the calibration's, and what 8 bits do
CAMERA = r"""
import subprocess, sys
sys.path.insert(0, sys.argv[1])
import cv2
from calibrate_test import light_on_screen
wallctl, address, folder, file = sys.argv[2:]
def take(tile):
    path = f"{folder}/{tile}-now.png"
    subprocess.run([wallctl, "--walld", address, "screenshot", path, "--tile", tile, "--output"], check=True)
    return cv2.imread(path)[..., 1]
light = light_on_screen({tile: take(tile) for tile in "ab"})
cv2.imwrite(file, (20 + 200 * light.clip(0, 1)).astype("uint8"))
"""


def light_on_screen(outputs: dict[str, np.ndarray]) -> np.ndarray:
    """As the camera sees it; 1 is a projector's white."""
    light = np.zeros((PICTURE[1], PICTURE[0]), np.float32)
    for tile, picture in outputs.items():
        there = cv2.getPerspectiveTransform(CORNERS - 0.5, SEEN[tile] - 0.5)  # OpenCV's pixels have their middles at 0
        light += cv2.warpPerspective((picture / 255).astype(np.float32) ** GAMMA, there, PICTURE)
    return light


class Calibrate(unittest.TestCase):
    def setUp(self) -> None:
        self.wall = self.enterContext(PlannedWall(PLAN, environment={"LP_NUM_THREADS": "0"}, die_with_parent=True))
        (self.wall.folder / "camera.py").write_text(CAMERA)

    def calibrate(self, *options: object) -> subprocess.CompletedProcess:
        line = [self.wall.bin / "wallctl", "--walld", self.wall.address, "calibrate", *map(str, options)]
        return subprocess.run(line, capture_output=True, text=True, timeout=150)

    def outputs(self) -> dict[str, np.ndarray]:
        out = {}
        for tile in "ab":
            path = self.wall.folder / f"{tile}.png"
            self.wall.screenshot(path, tile=tile, output=True)
            out[tile] = load_png(path)[..., 1]
        return out

    def test_two_projectors_become_one_picture(self) -> None:
        shots = self.wall.folder / "shots"
        capture = (f"/usr/bin/python3 {self.wall.folder}/camera.py {Path(__file__).parent} {self.wall.bin}/wallctl "
                   f"{self.wall.address} {self.wall.folder} {{}}")
        done = self.calibrate("--pictures", shots, "--capture", capture, "--settle", 0.02, "--out", self.wall.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"95 % of the matches are off by less than 0\.\d+ pixels")
        self.assertEqual({tile["pattern"] for tile in self.wall.ctl("tiles")}, {None}, "the programs are shown again")
        self.assertEqual(len(list(shots.glob("*.png"))), 2 * (2 + 2 * 7 + 2 * 7))

        found = self.show_evenly()
        with self.subTest("the same photographs again"):
            again = self.calibrate("--pictures", shots, "--out", self.wall.folder / "again", "--tile", "a",
                                   "--tile", "b")
            self.assertEqual(again.returncode, 0, again.stderr)
            self.assertEqual((self.wall.folder / "again" / "tiles.toml").read_text(), found)
        with self.subTest("as a curved screen, which this one only happens not to be"):
            curved = self.calibrate("--pictures", shots, "--out", self.wall.folder, "--screen", "curved")
            self.assertEqual(curved.returncode, 0, curved.stderr)
            self.assertIn("[mesh]", (self.wall.folder / "a.warp").read_text())
            self.show_evenly()

    def show_evenly(self) -> str:
        """Takes what the calibration has written, and looks whether all is as bright; its text."""
        found = (self.wall.folder / "tiles.toml").read_text()
        self.assertIn('# [[node.tile]] name = "a"', found)
        tiles = dict(zip("ab", found.split("# [[node.tile]]")[1:]))
        self.wall.keys = {tile: re.search(r"pixels.*", text, re.S).group() for tile, text in tiles.items()}
        rects = {tile: tuple(map(int, re.search(r"rect = \[(.*)\]", text).group(1).split(",")))
                 for tile, text in tiles.items()}
        self.wall.reload({"n": rects})
        self.wall.ctl("pattern", "white")
        light = light_on_screen(self.outputs())
        whole = self.lit_by_both(rects)
        self.assertGreater(whole.sum(), 40_000, "most of what they light")
        self.assertLess(np.abs(light[whole] - 1).max(), 6 * EVEN, "nowhere dark, nowhere bright")
        self.assertLess(np.percentile(np.abs(light[whole] - 1), 95), EVEN)
        return found

    def lit_by_both(self, rects: dict[str, tuple[int, int, int, int]]) -> np.ndarray:
        """The camera's pixels that see the wall, but for its rim."""
        self.wall.ctl("pattern", "white", "--output")
        seen = light_on_screen(self.outputs()) > 0.99
        self.wall.ctl("pattern", "white")
        shown = light_on_screen(self.outputs()) > 0.3
        kernel = np.ones((9, 9), np.uint8)
        return cv2.erode((seen & shown).astype(np.uint8), kernel) > 0

    def test_it_says_what_is_missing(self) -> None:
        missing = self.calibrate("--pictures", self.wall.folder / "nothing")
        self.assertEqual(missing.returncode, 1)
        self.assertIn("a-white.png: cannot be read: expected a photograph", missing.stderr)
        wrong = self.calibrate("--pictures", self.wall.folder / "nothing", "--capture", "true")
        self.assertIn("expected a command with {} where the file's name goes", wrong.stderr)
        failing = self.calibrate("--pictures", self.wall.folder / "nothing", "--capture", "false {}", "--settle", 0)
        self.assertIn("failed", failing.stderr)
        self.assertEqual({tile["pattern"] for tile in self.wall.ctl("tiles")}, {None})
        self.assertIn("there is no tile 'x'", self.calibrate("--pictures", ".", "--tile", "x").stderr)
        self.assertIn("--capture", self.calibrate("--help").stdout)
        self.assertIn("--pictures is missing", self.calibrate().stderr)
        self.assertIn("--lens goes with --screen curved", self.calibrate("--pictures", ".", "--lens", "x").stderr)
        boards = self.wall.folder / "boards"
        boards.mkdir()
        for number in range(2):
            cv2.imwrite(str(boards / f"{number}.png"), np.full((200, 300), 99, np.uint8))
        lens = ["lens", "--pictures", boards, "--out", self.wall.folder / "lens.yml", "--board"]
        self.assertIn("expected the inner corners of a chessboard", self.calibrate(*lens, "9").stderr)
        self.assertIn("0 of 2 photographs show a whole board of 9x6", self.calibrate(*lens, "9x6").stderr)
        self.assertFalse((self.wall.folder / "lens.yml").exists())


if __name__ == "__main__":
    unittest.main()
