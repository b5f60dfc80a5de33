#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A program whose link is slow: what it sends is coded, which is found by measure, and its vertices lie a little off
where the wall allows it and that makes the stream smaller (docs/lossy-geometry.md)."""
import subprocess
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from machine_wall import MachineWall  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

MARCH = (build_folder() / "examples" / "march", "--cells", "24", "--size", "320x240", "--frames", "1000000")
RATE, ALLOWED = "20mbit", 0.25
KINDS = ("state", "object", "geometry")


class SlowLink(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(MachineWall((1, 1), (320, 240), environment={"LP_NUM_THREADS": "0"},
                                                     options=f"lossy_pixels = {ALLOWED}"))
        cls.wall.hosts.limit("desk", RATE)

    def start(self, **environment: str) -> int:
        app = self.wall.run_at("desk", *MARCH, rect=(0, 0, 320, 240), env=self.x.environment(**environment),
                               stdout=subprocess.DEVNULL)
        session = self.wall.wait_session(app)
        self.addCleanup(lambda: self.wall.ctl("close", session))
        return session

    def traffic(self, session: int) -> dict:
        return next(s for s in self.wall.sessions() if s["id"] == session)["traffic"]

    def wait_coded(self, session: int) -> None:
        """What went out in the last second is at most half of what was packed."""
        def is_coded() -> bool:
            now = self.traffic(session)
            packed = sum(now[f"{kind}_bytes_per_second"] for kind in KINDS)
            return packed > 0 and now["link_bytes_per_second"] < packed / 2
        self.wall._until(is_coded, "the link is found to be slow", "walld", limit=60)

    def test_vertices_lie_off_where_the_wall_allows_it(self) -> None:
        session = self.start()
        self.wait_coded(session)
        self.wall._until(lambda: self.traffic(session)["lossy_vertices"] > 0, "it is tried", "walld", limit=60)

    def test_a_program_may_have_it_exact(self) -> None:
        session = self.start(WALLGL_LOSSY_PIXELS="0")
        self.wait_coded(session)
        time.sleep(5)
        self.assertEqual(self.traffic(session)["lossy_vertices"], 0)


if __name__ == "__main__":
    unittest.main()
