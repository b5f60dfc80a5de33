#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A program that starts again asks no node about its shaders: what was said is on the client's disk."""
from __future__ import annotations

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from show import counters  # noqa: E402
from wall import Wall, build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

PROGRAM = build_folder() / "tests" / "drawn_once"
DRAWN = 3  # frames, after which everything was asked
ABOUT_SHADERS = ("glCompileShader", "glLinkProgram")


class KeptAnswers(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 1), tile_size=(160, 120)))

    def setUp(self) -> None:
        self.cache = Path(self.enterContext(tempfile.TemporaryDirectory())) / "wallgl"

    def play(self, cache: str) -> tuple[bytes, int]:
        """What the wall shows of the program, and how often a node was asked about shaders."""
        stats = self.wall.folder / "stats.json"
        stats.unlink(missing_ok=True)
        app = self.wall.run(PROGRAM, "--size", "320x120", "--by", "computing", rect=(0, 0, 320, 120),
                            stdout=subprocess.DEVNULL,
                            env=self.x.environment(WALLGL_CACHE=cache, WALLGL_STATS=str(stats)))
        try:
            session = self.wall.wait_session(app)
            self.wall.wait(session, DRAWN)
            self.wall.hold(session)
            picture = self.wall.screenshot()
            asked = counters(stats, DRAWN)["round_trips_by_function"]
        finally:
            end_all([app])
        return picture, sum(asked.get(name, 0) for name in ABOUT_SHADERS)

    def test_the_second_time_nobody_is_asked(self) -> None:
        first, asked = self.play(str(self.cache))
        self.assertGreater(asked, 0)
        self.assertEqual(self.play(str(self.cache)), (first, 0))

    def test_what_is_not_whole_is_asked_again(self) -> None:
        first, asked = self.play(str(self.cache))
        for file in self.cache.iterdir():
            file.write_bytes(file.read_bytes()[:-1])
        self.assertEqual(self.play(str(self.cache)), (first, asked))
        self.assertEqual(self.play(str(self.cache)), (first, 0), "it was kept again")

    def test_off_means_that_it_is_asked(self) -> None:
        first, asked = self.play("off")
        self.assertGreater(asked, 0)
        self.assertEqual(self.play("off"), (first, asked))
        self.assertFalse(self.cache.exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
