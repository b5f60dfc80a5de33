#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Programs that are recorded as commands (wallctl record --commands), and shown on other walls (wallplay): frame by
frame what they were, from any frame on."""
import json
import random
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
import compare  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

WINDOW = (400, 300)
DRIVER = {"LP_NUM_THREADS": "0"}
SAME_TILES = {"tiles": (2, 2), "tile_size": (200, 150)}
OTHER_TILES = {"tiles": (3, 1), "tile_size": (134, 300), "one_node": True}
LIMIT = 30.0  # seconds, for what takes a moment
# Scenes of tests/golden, and how many frames each has: arrays, textures, display lists, framebuffer objects, shaders,
# buffers, transform feedback, what is copied out of the window, and what is drawn over earlier frames.
SCENES = {"changing_arrays": 8, "texture_filters": 6, "texture_updates": 4, "list_geometry": 4, "framebuffer": 4,
          "shader_placed_mesh": 4, "vertex_buffers": 4, "captured_vertices": 5, "window_copies": 6,
          "kept_back_buffer": 5}


def picture(wall: Wall) -> numpy.ndarray:
    whole = cv2.imdecode(numpy.frombuffer(wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)
    return whole[:WINDOW[1], :WINDOW[0]]


class Scene:
    """A program of the golden tests on a wall that draws a frame when it is told to."""

    def __init__(self, wall: Wall, x: XServer, name: str):
        self.wall, self.frame = wall, 1
        self.app = wall.run(build_folder() / "tests" / "golden_scenes", name, "--pause", "--frames=1000",
                            "--read-from=1000", rect=(0, 0, *WINDOW), env=x.environment(), stdin=subprocess.PIPE,
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.session = wall.wait_session(self.app)
        wall.wait(self.session, self.frame)

    def next(self) -> numpy.ndarray:
        self.app.stdin.write(b"\n")
        self.app.stdin.flush()
        self.frame += 1
        self.wall.wait(self.session, self.frame)
        return picture(self.wall)


class Recorder:
    """wallctl, which records a session into a file."""

    def __init__(self, wall: Wall, session: int, path: Path, *options: object):
        self.path = path
        self.process = subprocess.Popen(
            [str(word) for word in (wall.bin / "wallctl", "--walld", wall.address, "--json", "record", "--commands",
                                    session, path, "--seconds", 600, *options)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        end = time.monotonic() + LIMIT
        while not any(s["id"] == session and s["recorded"] for s in wall.sessions()):
            if self.process.poll() is not None or time.monotonic() > end:
                raise AssertionError(f"it is not recorded: {self.process.communicate()[1]}")
            time.sleep(0.02)

    def finish(self) -> dict:
        self.process.send_signal(signal.SIGINT)
        said, error = self.process.communicate(timeout=LIMIT)
        if self.process.returncode != 0:
            raise AssertionError(error)
        return json.loads(said)


def wallplay(*arguments: object) -> subprocess.CompletedProcess:
    return subprocess.run([str(word) for word in (build_folder() / "bin" / "wallplay", *arguments)],
                          capture_output=True, text=True, timeout=LIMIT)


def info(path: Path) -> dict:
    return json.loads(wallplay("--info", "--json", path).stdout)


class Recordings(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.chance = random.Random(11)

    def record(self, wall: Wall, scene: str) -> tuple[Path, list[numpy.ndarray]]:
        """A scene's pictures, and a recording that begins when its first frame is over."""
        program = Scene(wall, self.x, scene)
        path = wall.folder / f"{scene}.wgl"
        recorder = Recorder(wall, program.session, path, "--snapshot", 0.1)
        pictures = []
        for _ in range(SCENES[scene] - 1):
            pictures.append(program.next())
            time.sleep(0.2)
        summary = recorder.finish()
        self.assertEqual(summary["ended"], "interrupted")
        self.assertGreaterEqual(summary["frames"], len(pictures) - 1, "the first may be over before it is heard of")
        program.app.kill()
        program.app.wait()
        return path, pictures[-summary["frames"]:]

    def shown(self, wall: Wall, path: Path, frame: int) -> numpy.ndarray:
        """The picture of a recording's frame, on that wall."""
        player = wall.run_line([str(word) for word in (
            wall.bin / "wallplay", "--walld", wall.address, path, "--rect", "0,0,%d,%d" % WINDOW, "--frame", frame,
            "--frames", 1, "--stay")])
        wall.wait(wall.wait_session(player), 1)
        out = picture(wall)
        player.terminate()
        self.assertEqual(player.wait(LIMIT), 0)
        return out

    def test_frames_are_what_they_were_from_any_on(self) -> None:
        with Wall(**SAME_TILES, environment=DRIVER) as wall, Wall(**OTHER_TILES, environment=DRIVER) as other:
            for scene in SCENES:
                with self.subTest(scene=scene):
                    path, pictures = self.record(wall, scene)
                    told = info(path)
                    self.assertEqual(told["frames"], len(pictures))
                    self.assertGreater(len(told["segments"]), 1)
                    self.assertEqual(told["windows"], [{"width": WINDOW[0], "height": WINDOW[1]}])
                    frames = range(1, len(pictures) + 1)
                    for frame in self.chance.sample(frames, 2):
                        verdict = compare.same(pictures[frame - 1], self.shown(wall, path, frame))
                        self.assertTrue(verdict.good, f"{scene}, frame {frame}: {verdict}")
                    for frame in self.chance.sample(frames, 1):
                        verdict = compare.match(pictures[frame - 1], self.shown(other, path, frame))
                        self.assertTrue(verdict.good, f"{scene}, frame {frame} on other tiles: {verdict}")

    # ---- a program that runs by itself ----

    def clock(self, wall: Wall, *options: object) -> int:
        """The session of a program whose picture tells which frame it shows."""
        app = wall.run(build_folder() / "tests" / "frame_clock", "--size", "%dx%d" % WINDOW, *options,
                       rect=(0, 0, *WINDOW), env=self.x.environment())
        session = wall.wait_session(app)
        wall.wait(session, 3)
        return session

    def recorded_clock(self, wall: Wall, seconds: float, *options: object) -> Path:
        session = self.clock(wall, "--fps", 30)
        path = wall.folder / "clock.wgl"
        recorder = Recorder(wall, session, path, *options)
        time.sleep(seconds)
        recorder.finish()
        wall.ctl("close", session)
        return path

    def player(self, wall: Wall, path: Path, *options: object) -> tuple[subprocess.Popen, int]:
        player = wall.run_line([str(word) for word in (
            wall.bin / "wallplay", "--walld", wall.address, "--json", path, "--rect", "0,0,%d,%d" % WINDOW, *options)],
            stdout=subprocess.PIPE)
        return player, wall.wait_session(player)

    def assert_shows(self, wall: Wall, expected: numpy.ndarray) -> None:
        end = time.monotonic() + LIMIT
        while (picture(wall) != expected).any():
            if time.monotonic() > end:
                self.fail(f"{int((picture(wall) != expected).any(axis=2).sum())} pixels are wrong")
            time.sleep(0.1)

    def test_from_any_time_at_any_speed(self) -> None:
        with Wall(**SAME_TILES, environment=DRIVER) as wall:
            path = self.recorded_clock(wall, 3, "--snapshot", 1)
            told = info(path)
            self.assertGreaterEqual(len(told["segments"]), 3)
            begin = time.monotonic()
            player, _ = self.player(wall, path, "--from", 1, "--speed", 2)
            said = json.loads(player.communicate(timeout=LIMIT)[0])
            took = time.monotonic() - begin
            late = sum(segment["seconds"] < 1 for segment in told["segments"])
            self.assertLess(said["frames"], told["frames"])
            self.assertGreater(said["frames"], (told["frames"] - told["segments"][late - 1]["frame"]) / 2)
            self.assertGreater(took, (told["seconds"] - 1) / 2 - 0.1)
            player, session = self.player(wall, path, "--loop", "--speed", 10)
            wall.wait(session, told["frames"] + 10)
            wall.ctl("close", session)
            self.assertEqual(player.wait(LIMIT), 0)

    def test_what_a_window_holds_that_is_never_cleared(self) -> None:
        with Wall(**SAME_TILES, environment=DRIVER) as wall:
            for options in (), ("--stencil", 0), ("--samples", 4):
                with self.subTest(options=options):
                    app = wall.run(build_folder() / "tests" / "drawn_over", *map(str, options), rect=(0, 0, *WINDOW),
                                   env=self.x.environment())
                    session = wall.wait_session(app)
                    wall.wait(session, 5)
                    expected = picture(wall)
                    path = wall.folder / "over.wgl"
                    recorder = Recorder(wall, session, path, "--snapshot", 0.3)
                    time.sleep(1)
                    recorder.finish()
                    app.kill()
                    app.wait()
                    told = info(path)
                    self.assertGreater(len(told["segments"]), 2)
                    for frame in (1, told["segments"][1]["frame"] + 1, told["frames"]):
                        self.assertEqual(int((self.shown(wall, path, frame) != expected).sum()), 0, f"frame {frame}")

    def test_windows_are_moved_and_nodes_come_late_while_it_plays(self) -> None:
        with Wall(**SAME_TILES, environment=DRIVER) as wall:
            path, pictures = self.record(wall, "texture_updates")
            _, session = self.player(wall, path, "--frame", len(pictures), "--stay")
            wall.wait(session, 1)
            self.assert_shows(wall, pictures[-1])
            node = wall.node_names[-1]
            wall.daemons[node].kill()
            wall.daemons[node].wait()
            wall.start_node(node)
            self.assert_shows(wall, pictures[-1])
            wall.ctl("place", session, 100, 0, *WINDOW)
            moved = numpy.zeros_like(pictures[-1])
            moved[:, 100:] = pictures[-1][:, :-100]
            end = time.monotonic() + LIMIT
            while not compare.match(moved[:, 100:], picture(wall)[:, 100:]).good and time.monotonic() < end:
                time.sleep(0.1)
            self.assertTrue(compare.match(moved[:, 100:], picture(wall)[:, 100:]).good)

    def test_programs_go_on_without_their_recorder(self) -> None:
        with Wall(**SAME_TILES, environment=DRIVER) as wall:
            session = self.clock(wall, "--fps", 30)
            path = wall.folder / "clock.wgl"
            recorder = Recorder(wall, session, path, "--snapshot", 0.5)
            time.sleep(2)
            recorder.process.kill()
            recorder.process.communicate()
            frame = wall.wait(session, 1)
            wall.wait(session, frame + 30)
            told = info(path)
            self.assertIn("not finished", told["recovered"])
            self.assertGreater(told["frames"], 10)
            again = Recorder(wall, session, wall.folder / "again.wgl")
            time.sleep(1)
            self.assertGreater(again.finish()["frames"], 5)

    def test_nodes_that_are_held_are_not_late_beside_a_recorder(self) -> None:
        with Wall(**SAME_TILES, environment=DRIVER) as wall:
            session = self.clock(wall, "--fps", 30)
            recorder = Recorder(wall, session, wall.folder / "clock.wgl", "--snapshot", 0.5)
            time.sleep(0.5)
            wall.hold(session)
            time.sleep(1)
            frames = lambda: wall.sessions()[0]["traffic"]["frames"]  # noqa: E731
            before = frames()
            time.sleep(1)
            self.assertLess(frames() - before, 10, "it goes on at the pace of the limit, four times a second")
            for _ in range(3):
                frame = wall.wait(session, 1)
                wall.step(session)
                wall.wait(session, frame + 1)
                colours = numpy.unique(picture(wall).reshape(-1, 3), axis=0)
                self.assertEqual(len(colours), 1, "all tiles show the same frame")
            wall.hold(session, False)
            wall.wait(session, wall.wait(session, 1) + 30)
            timeouts = [surface["swap_timeouts"] for s in wall.sessions() for surface in s["surfaces"]]
            self.assertEqual(timeouts, [0])
            self.assertGreater(recorder.finish()["frames"], 10)

    def test_a_program_that_ends_ends_its_recording(self) -> None:
        with Wall(**SAME_TILES, environment=DRIVER) as wall:
            session = self.clock(wall, "--fps", 30)
            recorder = Recorder(wall, session, wall.folder / "clock.wgl")
            time.sleep(1)
            wall.ctl("close", session)
            said, error = recorder.process.communicate(timeout=LIMIT)
            self.assertEqual(recorder.process.returncode, 0, error)
            self.assertEqual(json.loads(said)["ended"], "the program has ended")
            self.assertNotIn("recovered", info(wall.folder / "clock.wgl"))

    def test_what_cannot_be_recorded_or_played_is_said(self) -> None:
        with Wall(tiles=(1, 1), tile_size=WINDOW, environment=DRIVER) as wall:
            done = subprocess.run([wall.bin / "wallctl", "--walld", wall.address, "record", "--commands", "99",
                                   wall.folder / "none.wgl"], capture_output=True, text=True, timeout=LIMIT)
            self.assertEqual(done.returncode, 1)
            self.assertIn("no session 99", done.stderr)
            self.assertFalse((wall.folder / "none.wgl").exists())
            path = self.recorded_clock(wall, 1)
            whole = path.read_bytes()
            for what, content, said in (
                    ("text", b"no recording at all", "no recording of commands"),
                    ("later", whole[:8] + b"\x09" + whole[9:], "of format 9; this WallGL reads format 1"),
                    ("empty", b"", "no recording of commands"),
                    ("header", whole[:20], "cut short"),
                    ("program", whole[:30] + b"?" + whole[31:], "checksum")):
                with self.subTest(what=what):
                    other = wall.folder / what
                    other.write_bytes(content)
                    done = wallplay("--walld", wall.address, other)
                    self.assertEqual(done.returncode, 1)
                    self.assertIn(said, done.stderr)
                    self.assertIn(str(other), done.stderr)
            cut = wall.folder / "cut"
            cut.write_bytes(whole[:len(whole) * 2 // 3])
            done = wallplay("--walld", wall.address, "--speed", 10, cut)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("not finished", done.stderr)

    def test_is_smaller_than_lossless_video(self) -> None:
        with Wall(**SAME_TILES, environment=DRIVER) as wall:
            gears = wall.run("glxgears", rect=(0, 0, *WINDOW), env=self.x.environment())
            session = wall.wait_session(gears)
            commands, video = wall.folder / "gears.wgl", wall.folder / "gears.avi"
            summary = wall.ctl("record", "--commands", session, commands, "--seconds", 3)
            pictures = wall.ctl("record", video, "--seconds", 3, "--fps", 30)
            a_frame = summary["bytes"] / summary["frames"], pictures["bytes"] / pictures["frames"]
            print(f"glxgears, {summary['frames']} frames: {a_frame[0]:.0f} bytes a frame as commands "
                  f"({summary['plain_bytes'] / summary['frames']:.0f} before coding), {a_frame[1]:.0f} as video")
            self.assertLess(a_frame[0], a_frame[1])


if __name__ == "__main__":
    unittest.main()
