# SPDX-License-Identifier: MIT
"""Real programs on real walls: where their windows go, what an operator does with them, and what goes wrong."""
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import numpy  # noqa: E402
from compare import load_png  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

BIN = build_folder() / "bin"
GONE_LIMIT = 2.0  # seconds until a killed program is gone
UNREACHABLE_LIMIT = 5.0  # seconds until a program without a wall goes on


class OnAWall(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 2), tile_size=(200, 150)))

    def tearDown(self) -> None:
        for app in self.wall.apps:
            if app.poll() is None:
                app.kill()
            app.wait()
        self.until(lambda: not self.wall.sessions(), GONE_LIMIT, "sessions end")

    def until(self, done, limit: float, what: str) -> None:
        end = time.monotonic() + limit
        while not done():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.02)

    def gears(self, geometry: str = "400x300", **options) -> tuple[subprocess.Popen, int]:
        app = self.wall.run("glxgears", "-geometry", geometry, env=self.x.environment(), stdout=subprocess.DEVNULL,
                            **options)
        session = self.wall.wait_session(app)
        self.wall.wait(session, 2)
        return app, session

    def surface(self, session: int) -> dict:
        return next(s for s in self.wall.sessions() if s["id"] == session)["surfaces"][0]

    def picture(self, **options) -> numpy.ndarray:
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            self.wall.screenshot(file.name, **options)
            return load_png(file.name)

    def lit_tiles(self) -> list[bool]:
        picture = self.picture()
        return [bool(picture[y:y + 150, x:x + 200].max() > 50) for y in (0, 150) for x in (0, 200)]

    def test_a_window_is_placed_one_to_one_where_there_is_room(self) -> None:
        _, first = self.gears("200x300")
        _, second = self.gears("200x300")
        self.assertEqual(self.surface(first)["rect"], [0, 0, 200, 300])
        self.assertEqual(self.surface(second)["rect"], [200, 0, 200, 300])

    def test_fullscreen_draws_a_small_window_at_the_walls_resolution(self) -> None:
        _, session = self.gears("100x75", fullscreen=True)
        self.assertEqual(self.surface(session)["rect"], [0, 0, 400, 300])
        self.assertEqual((self.surface(session)["width"], self.surface(session)["height"]), (100, 75))
        self.assertEqual(self.lit_tiles(), [True] * 4)

    def test_place_moves_and_scales(self) -> None:
        _, session = self.gears("200x150")
        self.assertEqual(self.lit_tiles(), [True, False, False, False])
        self.wall.ctl("place", session, 200, 150, 200, 150)
        self.until(lambda: self.lit_tiles() == [False, False, False, True], 5, "it is on the other tile")

    def test_raise_and_lower(self) -> None:
        _, below = self.gears("400x300")
        _, above = self.gears("400x300", rect=(0, 0, 400, 300))
        self.assertLess(self.surface(below)["z"], self.surface(above)["z"])
        self.wall.ctl("raise", below)
        self.assertGreater(self.surface(below)["z"], self.surface(above)["z"])
        self.wall.ctl("lower", below)
        self.assertLess(self.surface(below)["z"], self.surface(above)["z"])

    def test_a_screenshot_may_show_one_program_or_one_tile(self) -> None:
        _, below = self.gears("400x300")
        _, above = self.gears("200x150", rect=(0, 0, 200, 150))
        for session in (below, above):
            self.wall.hold(session)
        time.sleep(0.5)
        whole = self.picture()
        self.assertTrue((self.picture(tile="0-0") == whole[:150, :200]).all())
        self.assertTrue((self.picture(session=above) == whole[:150, :200]).all())
        alone = self.picture(session=below)
        self.assertEqual(alone.shape, (300, 400, 3))
        self.assertTrue((alone[150:] == whole[150:]).all())
        self.assertFalse((alone[:150, :200] == whole[:150, :200]).all(), "without the window above it")

    def test_a_held_program_shows_exactly_the_frames_stepped(self) -> None:
        app = self.wall.run("glxgears", "-geometry", "400x300", env=self.x.environment(), hold=True,
                            stdout=subprocess.DEVNULL)
        session = self.wall.wait_session(app)
        time.sleep(0.5)
        self.assertEqual(self.surface(session)["frame"], 0)
        self.assertEqual(int(self.picture().max()), 0)
        frames = []
        for frame in (1, 2, 3):
            self.wall.step(session)
            self.assertEqual(self.wall.wait(session, frame), frame)
            frames.append(self.picture())
            self.assertTrue((self.picture() == frames[-1]).all(), "a held frame stays")
        self.assertFalse((frames[0] == frames[2]).all(), "the gears turn")

    def test_a_killed_program_is_gone(self) -> None:
        app, session = self.gears()
        app.kill()
        self.until(lambda: session not in [s["id"] for s in self.wall.sessions()], GONE_LIMIT, "the session is gone")
        self.until(lambda: not any(self.lit_tiles()), GONE_LIMIT, "its layers are gone")

    def test_close_ends_a_program(self) -> None:
        app, session = self.gears()
        self.wall.ctl("close", session)
        self.assertEqual(self.wall.sessions(), [])

    def test_a_node_killed_in_mid_run_is_right_at_the_next_frame(self) -> None:
        app, session = self.gears()
        for _ in range(2):
            node = self.wall.node_names[0]
            self.wall.daemons[node].send_signal(signal.SIGKILL)
            self.wall.daemons[node].wait()
            self.until(lambda: not self.wall.nodes()[0]["up"], 2, "walld notices")
            shown = self.surface(session)["frame"]
            self.until(lambda: self.surface(session)["frame"] > shown + 10, 10, "the others go on")
            self.wall.start_node(node)
            self.wall.wait_nodes()
            self.wall.wait(session, self.surface(session)["frame"] + 10)
            self.assertEqual(self.lit_tiles(), [True] * 4)
            self.assertIsNone(app.poll())
        self.assert_no_seam(session)

    def assert_no_seam(self, session: int) -> None:
        """With the program held, the restarted node shows the same frame as the others: a second look is the same."""
        self.wall.hold(session)
        time.sleep(0.5)
        first = self.picture()
        self.assertTrue((self.picture() == first).all())
        red = (first[..., 0] > 100) & (first[..., 1] < 60)
        columns = red[:, 195:205].sum(axis=0)
        self.assertLess(int(abs(numpy.diff(columns.astype(int))).max()), 40, "the red gear goes over the seam")

    def test_doctor_finds_a_healthy_wall(self) -> None:
        done = subprocess.run([BIN / "wallctl", "--walld", self.wall.address, "doctor"], env=self.x.environment(),
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotIn("WRONG", done.stdout)


class WithoutAWall(unittest.TestCase):
    ADDRESS = "unix:/nowhere/walld.sock"

    def test_wallrun_says_where_it_looked(self) -> None:
        done = subprocess.run([BIN / "wallrun", "--walld", self.ADDRESS, "--", "true"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertIn(self.ADDRESS, done.stderr)

    def test_a_program_fails_normally_and_soon(self) -> None:
        lib = build_folder() / "lib"
        with XServer() as x:
            environment = x.environment(WALLGL_WALLD=self.ADDRESS, LD_LIBRARY_PATH=str(lib),
                                        __GLX_VENDOR_LIBRARY_NAME="wallgl")
            begin = time.monotonic()
            done = subprocess.run(["timeout", "-s", "KILL", "10", "glxinfo", "-B"], env=environment,
                                  capture_output=True, text=True)
        self.assertLess(time.monotonic() - begin, UNREACHABLE_LIMIT)
        self.assertGreaterEqual(done.returncode, 0, "no crash")
        ours = [line for line in done.stderr.splitlines() if self.ADDRESS in line]
        self.assertEqual(len(ours), 1, done.stderr)

    def test_a_missing_vendor_library_is_noticed(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "bin").mkdir()
            tool = Path(folder) / "bin" / "wallrun"
            tool.write_bytes((BIN / "wallrun").read_bytes())
            tool.chmod(0o755)
            missing = subprocess.run([tool, "--", "true"], capture_output=True, text=True)
            self.assertEqual(missing.returncode, 2)
            self.assertIn("libGLX_wallgl.so.0 is missing", missing.stderr)
            (Path(folder) / "lib").mkdir()
            (Path(folder) / "share/glvnd/egl_vendor.d").mkdir(parents=True)
            (Path(folder) / "share/glvnd/egl_vendor.d/50_wallgl.json").write_text("{}")
            (Path(folder) / "lib/libGLX_wallgl.so.0").write_text("not a library")
            broken = subprocess.run([tool, "--", "true"], capture_output=True, text=True)
            self.assertEqual(broken.returncode, 2)
            self.assertIn("does not load", broken.stderr)

    def test_a_program_that_is_not_there(self) -> None:
        with Wall(tiles=(1, 1), tile_size=(64, 48)) as wall:
            done = subprocess.run(wall.wallrun("no-such-program"), capture_output=True, text=True)
        self.assertEqual(done.returncode, 127)
        self.assertIn("no-such-program", done.stderr)

    def test_a_node_says_what_is_wrong_in_the_description(self) -> None:
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write("[wall]\nname = 3\n")
            file.flush()
            for program in (["walld"], ["tileserver", "--node", "x"]):
                done = subprocess.run([BIN / program[0], "--config", file.name, *program[1:]], capture_output=True,
                                      text=True)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(f"{file.name}:2: 'name': expected a string", done.stderr)

    def test_ctrl_c_ends_each_daemon_in_order(self) -> None:
        with Wall(tiles=(1, 1), tile_size=(64, 48)) as wall:
            for name in ("node-0-0", "walld"):
                begin = time.monotonic()
                os.kill(wall.daemons[name].pid, signal.SIGINT)
                self.assertEqual(wall.daemons[name].wait(10), 0, wall.log(name))
                self.assertLess(time.monotonic() - begin, 3)


if __name__ == "__main__":
    unittest.main()
