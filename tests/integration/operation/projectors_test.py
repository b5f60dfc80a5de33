# SPDX-License-Identifier: MIT
"""Tiles of projectors that an MPCDI file describes (docs/walls.md, "MPCDI"): files of this test's own hand, of flat
media and of a simulation, beside what OpenCV makes of the canvas and beside the same wall in wall.toml's own words."""
from __future__ import annotations

import io
import struct
import subprocess
import sys
import unittest
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
sys.path.insert(0, str(Path(__file__).resolve().parent))
import cv2  # noqa: E402
import numpy as np  # noqa: E402
from compare import load_png  # noqa: E402
from geometry_test import places, sampled  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from wall import WallError  # noqa: E402
from xserver import XServer  # noqa: E402

QUIET = {"LP_NUM_THREADS": "0"}
SIZE = 240, 180  # pixels of a tile
PROJECTOR = 320, 256
PLAN = {"n": {"left": (0, 0, *SIZE), "right": (SIZE[0], 0, *SIZE)}}
BEYOND = 0.001  # of the pixels may differ by more than a level


def pfm(x: np.ndarray, y: np.ndarray) -> bytes:
    height, width = x.shape
    values = np.stack([x, y, np.zeros_like(x)], axis=-1).astype("<f4")
    return f"PF\n{width} {height}\n-1.0\n".encode() + values.tobytes()


def png(picture: np.ndarray) -> bytes:
    return cv2.imencode(".png", picture)[1].tobytes()


def description(profile: str, regions: dict[str, str], files: str) -> str:
    return (f'<?xml version="1.0" encoding="utf-8"?>\n<MPCDI profile="{profile}" geometry="1" version="1.0">\n'
            '<display><buffer id="wall">\n' + "".join(
                f'<region id="{name}" Xresolution="{PROJECTOR[0]}" Yresolution="{PROJECTOR[1]}" x="0" y="0" xsize="1" '
                f'ysize="1">{inside}</region>\n' for name, inside in regions.items())
            + f"</buffer></display>\n<files>{files}</files>\n</MPCDI>\n")


def archive(xml: str, **files: bytes) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr("mpcdi.xml", xml)
        for name, content in files.items():
            packed.writestr(name.replace("_", "."), content)
    return out.getvalue()


def fileset(name: str, more: str = "") -> str:
    return (f'<fileset region="{name}"><geometryWarpFile><path>{name}.pfm</path><interpolation>linear</interpolation>'
            f"</geometryWarpFile>{more}</fileset>")


ALPHA = "<alphaMap><path>left.png</path><componentDepth>1</componentDepth><gammaEmbedded>2.2</gammaEmbedded></alphaMap>"


class AWallOfProjectors(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())

    def wall_of(self, file: bytes) -> PlannedWall:
        keys = {tile: f'mpcdi = "room.mpcdi"\npixels = {list(PROJECTOR)}' for tile in PLAN["n"]}
        wall = PlannedWall(PLAN, keys, environment=QUIET, die_with_parent=True)
        start = wall._start

        def with_file() -> None:
            (wall.folder / "room.mpcdi").write_bytes(file)
            start()
        wall._start = with_file
        return self.enterContext(wall)

    def show(self, wall: PlannedWall) -> int:
        app = wall.run("glxgears", fullscreen=True, env=self.x.environment(), stdout=subprocess.DEVNULL)
        session = wall.wait_session(app)
        wall.hold(session)
        wall.step(session, 3)
        wall.wait(session, 3)
        return session

    def picture(self, wall: PlannedWall, tile: str, output: bool) -> np.ndarray:
        path = wall.folder / "picture.png"
        wall.screenshot(path, tile=tile, output=output)
        return load_png(path)[:, :, :3]

    def assert_close(self, picture: np.ndarray, expected: np.ndarray) -> None:
        self.assertEqual(picture.shape, expected.shape)
        apart = np.abs(picture.astype(float) - expected).max(axis=2)
        self.assertLessEqual((apart > 1).mean(), BEYOND, f"at most {apart.max():.1f} levels")
        self.assertGreater(picture.max(), 100, "there is something to be seen")

    def test_flat_media(self) -> None:
        """A picture bent as on a column, round, and fading to its right edge."""
        width, height = PROJECTOR
        at = places(width, height)
        x = 0.5 + 0.47 * np.sin((at[..., 0] - 0.5) * 1.9)
        y = at[..., 1] + 0.08 * (at[..., 0] - 0.5) ** 2 - 0.01
        outside = np.hypot(at[..., 0] - 0.5, at[..., 1] - 0.5) > 0.55
        x[outside] = y[outside] = np.nan
        fade = np.tile(np.linspace(255, 0, width).round().astype(np.uint8), (height, 1))
        straight = pfm(at[..., 0], at[..., 1])
        xml = description("2d", {"left": "", "right": ""}, fileset("left", ALPHA) + fileset("right"))
        wall = self.wall_of(archive(xml, left_pfm=pfm(x, y), left_png=png(fade), right_pfm=straight))
        self.show(wall)
        canvas = self.picture(wall, "left", output=False).astype(float)
        expected = sampled(canvas, np.nan_to_num(x, nan=-1) * SIZE[0], np.nan_to_num(y, nan=-1) * SIZE[1])
        self.assert_close(self.picture(wall, "left", output=True), expected * (fade / 255.0)[..., None])
        canvas = self.picture(wall, "right", output=False).astype(float)
        self.assert_close(self.picture(wall, "right", output=True),
                          sampled(canvas, at[..., 0] * SIZE[0], at[..., 1] * SIZE[1]))

        with self.subTest("what makes no sense changes nothing"):
            (wall.folder / "room.mpcdi").write_bytes(archive(description("2d", {"left": ""}, fileset("left"))))
            with self.assertRaisesRegex(WallError, "room.mpcdi: 'left.pfm' is not in the archive"):
                wall.ctl("reload")
            check = subprocess.run([wall.bin / "walld", "--check", "--config", wall.folder / "wall.toml"],
                                   capture_output=True, text=True)
            self.assertEqual(check.returncode, 2)
            self.assertIn("room.mpcdi: 'left.pfm' is not in the archive", check.stderr)
            self.assert_close(self.picture(wall, "left", output=True),
                              sampled(self.picture(wall, "left", output=False).astype(float),
                                      np.nan_to_num(x, nan=-1) * SIZE[0], np.nan_to_num(y, nan=-1) * SIZE[1])
                              * (fade / 255.0)[..., None])
        with self.subTest("another file while programs run"):
            (wall.folder / "room.mpcdi").write_bytes(
                archive(description("2d", {"left": "", "right": ""}, fileset("left") + fileset("right")),
                        left_pfm=straight, right_pfm=straight))
            wall.ctl("reload")
            self.assert_close(self.picture(wall, "left", output=True),
                              sampled(self.picture(wall, "left", output=False).astype(float), at[..., 0] * SIZE[0],
                                      at[..., 1] * SIZE[1]))

    def test_a_simulation(self) -> None:
        """Two projectors beside each other around the user: they look where tiles with this `yaw` and `fov` look."""
        def region(yaw: float) -> str:
            return (f"<frustum><yaw>{yaw}</yaw><pitch>0</pitch><roll>0</roll><rightAngle>20</rightAngle>"
                    "<leftAngle>-20</leftAngle><upAngle>15</upAngle><downAngle>-15</downAngle></frustum>")
        at = places(*PROJECTOR)
        flat = pfm(at[..., 0], at[..., 1])
        by_file = self.wall_of(archive(description("3d", {"left": region(0), "right": region(12)},
                                                   fileset("left") + fileset("right")), left_pfm=flat, right_pfm=flat))
        keys = {"left": "yaw = 0\nfov = [40, 30]", "right": "yaw = 12\nfov = [40, 30]"}
        by_words = self.enterContext(PlannedWall(PLAN, keys, environment=QUIET, die_with_parent=True))
        views = [{tile["name"]: tile["view"] for tile in wall.ctl("tiles")} for wall in (by_file, by_words)]
        for tile in PLAN["n"]:
            np.testing.assert_allclose(views[0][tile], views[1][tile], atol=1e-6)
        session = self.show(by_file)
        by_file._until(
            lambda: next(s for s in by_file.sessions() if s["id"] == session)["surfaces"][0]["views"] == "seen",
            "the window is seen", "walld")
        for tile in PLAN["n"]:
            self.assert_close(self.picture(by_file, tile, output=True),
                              sampled(self.picture(by_file, tile, output=False).astype(float), at[..., 0] * SIZE[0],
                                      at[..., 1] * SIZE[1]))


if __name__ == "__main__":
    unittest.main()
