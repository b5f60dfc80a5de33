#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Vertices that are sent a little off (docs/lossy-geometry.md): how far outlines move, that no meshes open, and that
nobody has it who is not allowed to."""
import json
import subprocess
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

WINDOW = (400, 300)
SCALED = (600, 450)  # on the wall
FRAMES = 8
GROUND = numpy.array([255, 0, 255], numpy.uint8)  # of the scene closed_meshes, which shows it from outside in frame 0,
# 2, ...; in the others it is to be seen nowhere
ALLOWED = 4.0  # pixels


class LossyTest(unittest.TestCase):
    def setUp(self):
        self.x = self.enterContext(XServer())

    def wall(self, allowed: float) -> Wall:
        return self.enterContext(Wall((2, 2), (300, 225), options=f"lossy_pixels = {allowed}",
                                      environment={"LP_NUM_THREADS": "0"}))

    def app(self, wall: Wall, pixels: str, rect: tuple[int, int], **popen: object) -> subprocess.Popen:
        line = wall.wallrun(build_folder() / "tests" / "golden_scenes", "closed_meshes", "--pause",
                            f"--frames={FRAMES}", f"--read-from={FRAMES}", rect=(0, 0, *rect))
        at = line.index("--")
        given = ["--lossy-pixels", pixels] if pixels else []
        return wall.run_line(line[:at] + given + line[at:], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                             env=self.x.environment(WALLGL_IDEAL="1", WALLGL_STATS=str(wall.folder / "stats")), **popen)

    def pictures(self, wall: Wall, pixels: str, rect: tuple[int, int]) -> list[numpy.ndarray]:
        app = self.app(wall, pixels, rect)
        session = wall.wait_session(app)
        out = []
        for frame in range(1, FRAMES + 1):
            wall.wait(session, frame)
            whole = cv2.imdecode(numpy.frombuffer(wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)
            out.append(whole[:rect[1], :rect[0]])
            if frame == FRAMES:
                time.sleep(1.2)  # a program tells walld once a second
                self.said = next(s for s in wall.sessions() if s["id"] == session)
            app.stdin.write(b"\n")
            app.stdin.flush()
        app.stdin.close()
        app.wait(20)
        return out

    def check(self, exact: list[numpy.ndarray], moved: list[numpy.ndarray], pixels: float):
        """No outline lies farther off than so many pixels and the one that rasterizing rounds by."""
        reach = 2 * (int(numpy.ceil(pixels)) + 1) + 1
        around = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (reach, reach))
        for frame, (a, b) in enumerate(zip(exact, moved)):
            with self.subTest(frame=frame, pixels=pixels):
                was, is_now = ((p != GROUND).any(axis=2).astype(numpy.uint8) for p in (a, b))
                if frame % 2 == 1:
                    self.assertTrue(was.all(), "the scene itself has holes")
                    self.assertTrue(is_now.all(), f"{int((is_now == 0).sum())} pixels of the ground within a mesh")
                    continue
                self.assertTrue(was.any() and not was.all())
                holes = cv2.erode(was, around) & (1 - is_now)
                self.assertFalse(holes.any(), f"{int(holes.sum())} pixels of the ground within a mesh")
                self.assertFalse((is_now & (1 - cv2.dilate(was, around))).any(), "an outline lies too far off")

    def test_no_mesh_opens(self):
        wall = self.wall(ALLOWED)
        for rect in (WINDOW, SCALED):
            exact = self.pictures(wall, "0", rect)
            self.assertEqual(self.said["lossy_pixels"], 0)
            self.assertEqual(self.said["traffic"]["lossy_vertices"], 0)
            for pixels in (0.25, ALLOWED):
                moved = self.pictures(wall, str(pixels), rect)
                self.assertEqual(self.said["lossy_pixels"], pixels)
                self.assertGreater(self.said["traffic"]["lossy_vertices"], 10_000)
                counters = json.loads((wall.folder / "stats").read_text())["counters"]
                self.assertLessEqual(counters["lossy_micropixels"], 1e6 * pixels)
                self.assertGreater(counters["lossy_micropixels"], 1e5 * pixels, "it could be coarser")
                self.check(exact, moved, pixels)
                self.assertTrue(any((a != b).any() for a, b in zip(exact, moved)), "nothing has moved")

    def test_links_that_are_fast_lose_nothing(self):
        wall = self.wall(ALLOWED)
        exact = self.pictures(wall, "0", WINDOW)
        usual = self.pictures(wall, "", WINDOW)
        self.assertEqual(self.said["lossy_pixels"], ALLOWED)
        self.assertEqual(self.said["traffic"]["lossy_vertices"], 0)
        self.assertTrue(all((a == b).all() for a, b in zip(exact, usual)))

    def test_what_the_wall_does_not_allow(self):
        wall = self.wall(0.25)
        app = self.app(wall, "0.5", WINDOW, stderr=subprocess.PIPE)
        _, said = app.communicate(b"\n" * FRAMES, timeout=20)
        self.assertIn(b"up to 0.5 pixels off, and the wall allows 0.25", said)
        self.assertIn(b"'lossy_pixels'", said)
        self.assertEqual(wall.sessions(), [])
        self.pictures(wall, "0.25", WINDOW)
        self.assertEqual(self.said["lossy_pixels"], 0.25)

    def test_what_is_no_number(self):
        wall = self.wall(0.25)
        for wrong in ("-1", "17", "nan", "much"):
            app = self.app(wall, wrong, WINDOW, stderr=subprocess.PIPE)
            _, said = app.communicate(timeout=20)
            self.assertNotEqual(app.returncode, 0)
            self.assertIn(b"expected a number from 0 to 16", said)


if __name__ == "__main__":
    unittest.main()
