# SPDX-License-Identifier: MIT
"""A short wall whose daemons run under the thread sanitizer; the programs use the plain release build."""
import sys
import time
import unittest
from pathlib import Path

REPORT = 8000  # characters of a race that are shown
ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from wall import Wall  # noqa: E402
from xserver import XServer  # noqa: E402


class Threads(unittest.TestCase):
    def test_no_race_is_reported(self) -> None:
        environment = {"TSAN_OPTIONS": f"exitcode=66 suppressions={ROOT}/tests/support/tsan.supp",
                       "LP_NUM_THREADS": "0"}
        with XServer() as x, Wall(tiles=(2, 1), tile_size=(128, 96), environment=environment,
                                  client_build=ROOT / "build" / "release") as wall:
            apps = [wall.run("glxgears", "-geometry", "120x90", env=x.environment()) for _ in range(2)]
            sessions = [wall.wait_session(app) for app in apps]
            for session in sessions:
                wall.wait(session, 20)
            wall.screenshot()
            wall.ctl("place", sessions[0], 100, 0, 150, 90)
            apps[1].kill()
            wall.wait(sessions[0], 40)
            time.sleep(0.5)
            logs = {name: wall.log(name) for name in wall.daemons}
            codes = wall.stop()
        for name, log in logs.items():
            at = log.find("WARNING: ThreadSanitizer")
            self.assertEqual(at, -1, f"{name}:\n{log[at:at + REPORT]}")
        self.assertEqual(set(codes.values()), {0})


if __name__ == "__main__":
    unittest.main()
