#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Programs of OpenGL ES on a wall, as they are: through EGL and GLVND's libGLESv2."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from show import counters  # noqa: E402
from wall import Wall  # noqa: E402
from xserver import XServer  # noqa: E402

TILE = (200, 150)
GEARS = {"red": (0, 0, 1), "green": (0, 1, 0), "blue": (1, 0, 0)}  # the brightest channel: blue, green, red
FRAMES = 20


class Es(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())

    def setUp(self) -> None:
        self.wall = self.enterContext(Wall(tiles=(2, 2), tile_size=TILE, environment={"LP_NUM_THREADS": "0"}))
        self.stats = Path(self.enterContext(tempfile.TemporaryDirectory())) / "stats.json"

    def test_es2gears_turns_over_four_tiles(self) -> None:
        app = self.wall.run("es2gears_x11", rect=(50, 0, 300, 300),
                            env=self.x.environment(WALLGL_STATS=str(self.stats)))
        session = self.wall.wait_session(app)
        self.wall.wait(session, FRAMES)
        picture = cv2.imdecode(numpy.frombuffer(self.wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)
        for name, color in GEARS.items():
            brightest = picture.argmax(axis=2) == color.index(1)
            self.assertGreater(int((brightest & (picture.max(axis=2) > 100)).sum()), 500, f"pixels of the {name} gear")
        self.assertEqual(counters(self.stats, FRAMES)["unsupported"], {})
        app.terminate()
        app.wait(10)

    def test_a_context_says_what_it_is(self) -> None:
        told = subprocess.run(self.wall.wallrun("es2_info"), env=self.x.environment(), capture_output=True, text=True,
                              timeout=60, check=True).stdout
        self.assertIn("GL_VERSION: OpenGL ES 3.2 WallGL", told)
        self.assertIn("EGL_CLIENT_APIS: OpenGL OpenGL_ES", told)
        self.assertIn("GL_OES_element_index_uint", told)
        self.assertNotIn("GL_ARB_", told)


if __name__ == "__main__":
    unittest.main(verbosity=2)
