#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A real shader that makes Mesa's compiler take 20 GB and minutes: its program is told so, and others go on."""
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from wall import Wall  # noqa: E402
from xserver import XServer  # noqa: E402

PIGLIT = Path("/usr/lib/x86_64-linux-gnu/piglit")
SHADER = PIGLIT / "tests/spec/glsl-1.10/execution/glsl-fs-inline-explosion.shader_test"


class ShaderLimits(unittest.TestCase):
    def test_a_monster_does_not_compile_and_keeps_nobody_waiting(self) -> None:
        x = self.enterContext(XServer())
        wall = self.enterContext(Wall(tiles=(2, 1), tile_size=(200, 200), environment={"LP_NUM_THREADS": "0"}))
        gears = wall.run("glxgears", rect=(50, 0, 300, 200), env=x.environment())
        session = wall.wait_session(gears)
        before = wall.wait(session, 5)
        told = subprocess.run(wall.wallrun(PIGLIT / "bin" / "shader_runner", SHADER, "-auto"), env=x.environment(),
                              capture_output=True, text=True, timeout=120)
        said = told.stdout + told.stderr
        self.assertIn("given up: the compiler took more than 10 s of processor time or 2048 MiB of memory", said)
        after = wall.wait(session, before + 1)
        self.assertGreater(after - before, 50, "frames of the other program meanwhile")
        self.assertTrue(any("shader_given_up" in wall.log(name) for name in wall.node_names))
        for name in wall.node_names:
            self.assertIsNone(wall.daemons[name].poll(), f"{name} lives")
        gears.terminate()
        gears.wait(10)


if __name__ == "__main__":
    unittest.main(verbosity=2)
