# SPDX-License-Identifier: MIT
"""Nodes on machines of their own that draw for each other (docs/sort-last.md), over TLS, coded by codecs of their own:
what the wall shows is what each would have drawn for itself."""
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from machine_wall import MachineWall  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

QUIET = {"LP_NUM_THREADS": "0"}
EXAMPLES = build_folder() / "examples"  # where the codec plz4 is, too
MARCH = (EXAMPLES / "march", "--cells", "24", "--size", "600x300")
FRAME = 3


class Dealt(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())

    def shown(self, wall: MachineWall, sort_last: bool) -> tuple[numpy.ndarray, dict]:
        """A frame of the program, and what was done for it."""
        app = wall.run_at("desk", *MARCH, rect=(0, 0, 600, 300), hold=True, sort_last=sort_last,
                          env=self.x.environment(), stdout=subprocess.DEVNULL)
        session = wall.wait_session(app)
        wall.step(session, FRAME)
        wall.wait(session, FRAME)
        picture = cv2.imdecode(numpy.frombuffer(wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)
        partials = lambda: next(s for s in wall.sessions() if s["id"] == session)["partials"]  # noqa: E731
        if sort_last:
            wall._until(lambda: partials()["merged"] > 0, "nodes merge what others draw", "walld")
        done = partials()
        wall.ctl("close", session)
        return picture, done

    def test_what_they_draw_for_each_other_is_the_same(self) -> None:
        for codec in "none lz4 plz4".split():
            with self.subTest(codec), MachineWall(
                    node_keys=f'partial_codec = "{codec}"', swap_timeout_ms=5000,
                    environment=QUIET | {"WALLGL_CODECS": str(EXAMPLES)}) as wall:
                plain, undealt = self.shown(wall, False)
                self.assertGreater((plain != plain[0, 0]).any(axis=2).mean(), 0.05, "there is something to be seen")
                self.assertEqual(undealt["merged"], 0)
                dealt, done = self.shown(wall, True)
                self.assertEqual(int((dealt != plain).any(axis=2).sum()), 0)
                self.assertEqual(done["missed"], 0)


if __name__ == "__main__":
    unittest.main()
