# SPDX-License-Identifier: MIT
"""Tiles, the wall and windows watched over WebSockets while programs run (docs/streams.md)."""
import json
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from compare import load_png  # noqa: E402
from wall import Wall  # noqa: E402
from websocket import Refused, WebSocket  # noqa: E402
from xserver import XServer  # noqa: E402

TILE = (200, 150)
HACKS = Path("/usr/libexec/xscreensaver")


class Frame(NamedTuple):
    stream: int
    part: int
    sequence: int
    flags: int
    packet: bytes


def pixels(packet: bytes, width: int, height: int) -> numpy.ndarray:
    """RGB of a packet of `raw`."""
    return numpy.frombuffer(packet[-4 * width * height:], numpy.uint8).reshape(height, width, 4)[:, :, :3]


class Streams(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 1), tile_size=TILE, swap_timeout_ms=10000,
                                              options='background = "#204060"'))
        cls.app = cls.wall.run("glxgears", "-geometry", "400x150", env=cls.x.environment(), stdout=subprocess.DEVNULL)
        cls.session = cls.wall.wait_session(cls.app)
        cls.wall.wait(cls.session, 2)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.app.kill()
        cls.app.wait()

    def setUp(self) -> None:
        self.wall.hold(self.session, False)
        # A window that the test before has moved takes its place with a frame that its program begins after that.
        shown = self.wall.sessions()[0]["surfaces"][0]["frame"]
        self.wall.wait(self.session, shown + 3)

    def open(self, **headers: str) -> WebSocket:
        return self.enterContext(WebSocket(self.wall.url, **headers))

    def frame(self, viewer: WebSocket, timeout: float = 10) -> Frame:
        """The next one; texts before it are kept in self.texts."""
        self.texts = []
        while isinstance(message := viewer.message(timeout), dict):
            self.texts.append(message)
        stream, part, _, sequence, flags = struct.unpack_from("<IIQII", message)
        return Frame(stream, part, sequence, flags, message[24:])

    def parts(self, viewer: WebSocket) -> dict:
        """The next message that tells a stream's parts."""
        while not (isinstance(message := viewer.message(), dict) and "parts" in message):
            self.assertNotIn("error", message if isinstance(message, dict) else {})
        return message

    def picture(self, viewer: WebSocket, parts: dict | None = None) -> numpy.ndarray:
        """RGB of stream 0 in `raw`, once every part has come and no more comes; `parts`: as told before."""
        parts = parts or self.parts(viewer)
        out = numpy.zeros((parts["height"], parts["width"], 3), numpy.uint8)
        missing = set(range(len(parts["parts"])))
        while True:
            try:
                frame = self.frame(viewer, 10 if missing else 0.5)
            except TimeoutError:
                self.assertFalse(missing)
                return out
            x, y, width, height = parts["parts"][frame.part]["rect"]
            out[y:y + height, x:x + width] = pixels(frame.packet, width, height)
            missing.discard(frame.part)

    def screenshot(self, tile: str) -> numpy.ndarray:
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            self.wall.screenshot(file.name, tile=tile)
            return load_png(file.name)

    def let_frames_end(self) -> None:
        """No frame is on its way any more, however busy the machine is: a node is asked for a picture behind the frames
        that it was told to show, and shows these first."""
        self.wall.hold(self.session)
        self.wall.screenshot()

    def test_a_frame_is_the_tiles_picture(self) -> None:
        self.let_frames_end()
        viewer = self.open()
        names = self.wall.tile_names
        viewer.watch(*({"tile": name, "codec": "raw"} for name in names))
        got = {}
        while len(got) < len(names):
            frame = self.frame(viewer)
            self.assertEqual(frame.part, 0)
            if frame.stream not in got:
                self.assertEqual(frame.flags, 1)
                self.assertEqual(self.texts[-1], {"stream": frame.stream, "part": 0, "header": ""})
            got[frame.stream] = pixels(frame.packet, *TILE)
        for i, name in enumerate(names):
            self.assertTrue((got[i] == self.screenshot(name)[:, :, :3]).all(), name)
            self.assertGreater(got[i].max(), 50, "gears are to be seen")

    def test_an_unchanged_picture_is_sent_once(self) -> None:
        self.let_frames_end()
        viewer = self.open()
        viewer.watch({"tile": self.wall.tile_names[0]})
        self.frame(viewer)
        with self.assertRaises(TimeoutError):
            self.frame(viewer, 1)
        self.wall.step(self.session)
        self.assertEqual(self.frame(viewer).sequence, 2)

    def test_size_and_rate_are_the_viewers(self) -> None:
        viewer = self.open()
        viewer.watch({"tile": self.wall.tile_names[0], "width": 50, "height": 40, "fps": 5})
        self.frame(viewer)
        self.assertEqual((self.texts[0]["width"], self.texts[0]["height"]), (50, 40))
        begin, frames = time.monotonic(), 0
        while time.monotonic() < begin + 2:
            self.frame(viewer)
            frames += 1
        self.assertLessEqual(frames, 11)

    def test_wrong_requests_are_answered(self) -> None:
        viewer = self.open()
        viewer.watch({"tile": "nowhere"})
        self.assertEqual(viewer.message(), {"error": "watch[0].tile: there is no tile 'nowhere'"})
        viewer.watch({"wall": True, "region": [0, 0, 401, 150]})
        self.assertEqual(viewer.message(), {"error": "watch[0].region: expected a part of 400x150 pixels"})
        viewer.watch({"tile": self.wall.tile_names[0]}, {"session": 999})
        self.assertEqual(viewer.message(), {"error": "watch[1].session: there is no session 999"})
        viewer.send("what?")
        self.assertEqual(viewer.message(), {"error": 'expected {"watch": [...]}'})

    def test_the_wall_is_one_picture_of_all_tiles(self) -> None:
        self.let_frames_end()
        viewer = self.open()
        viewer.watch({"wall": True, "codec": "raw"})
        parts = self.parts(viewer)
        self.assertEqual([part["tile"] for part in parts["parts"]], self.wall.tile_names)
        self.assertEqual([part["rect"] for part in parts["parts"]], [[0, 0, *TILE], [TILE[0], 0, *TILE]])
        self.assertEqual(parts["background"], "#204060")
        self.assertTrue((self.picture(viewer, parts) == self.wall_picture()).all())

    def test_a_region_is_that_part_of_the_screenshot(self) -> None:
        self.let_frames_end()
        shot = self.wall_picture()
        viewer = self.open()
        for entry, (x, y, width, height) in (({"wall": True}, (131, 17, 150, 90)),
                                             ({"tile": self.wall.tile_names[1]}, (3, 5, 101, 77))):
            viewer.watch({**entry, "region": [x, y, width, height], "codec": "raw"})
            left = x if "wall" in entry else x + TILE[0]
            picture = self.picture(viewer)
            self.assertTrue((picture == shot[y:y + height, left:left + width]).all(), entry)

    def test_a_smaller_wall_looks_like_the_wall(self) -> None:
        self.let_frames_end()
        viewer = self.open()
        viewer.watch({"wall": True, "codec": "raw", "width": 133, "height": 133, "fit": True})
        picture = self.picture(viewer).astype(int)
        self.assertEqual(picture.shape[:2], (50, 133))
        shot = cv2.resize(self.wall_picture(), (133, 50), interpolation=cv2.INTER_AREA).astype(int)
        self.assertLess(numpy.abs(picture - shot).mean(), 6)

    def test_a_window_is_followed(self) -> None:
        self.let_frames_end()
        self.place([0, 0, 400, 150])
        viewer = self.open()
        viewer.watch({"session": self.session, "codec": "raw", "fps": 30})
        self.assertEqual(self.parts(viewer)["shows"], [0, 0, 400, 150])
        self.place([150, 30, 100, 100])
        while (parts := self.parts(viewer))["shows"] != [150, 30, 100, 100]:
            pass
        self.assertEqual([part["rect"] for part in parts["parts"]], [[0, 0, 50, 100], [50, 0, 50, 100]])
        picture = self.picture(viewer, parts)
        self.assertTrue((picture == self.wall_picture()[30:130, 150:250]).all())
        self.assertGreater(picture.max(), 50, "gears are to be seen")
        self.place([0, 0, 400, 150])

    def place(self, rect: list[int]) -> None:
        """Moves the held window; it is drawn there with its next frames."""
        self.wall.ctl("place", self.session, *rect)
        end = time.monotonic() + 10
        while (surface := self.wall.sessions()[0]["surfaces"][0])["shown_rect"] != rect:
            self.assertLess(time.monotonic(), end, surface)
            self.wall.step(self.session)
            time.sleep(0.1)

    def test_a_page_of_another_site_may_not_watch(self) -> None:
        with self.assertRaises(Refused) as refused:
            self.open(Origin="http://elsewhere.example")
        self.assertEqual(refused.exception.status, 403)

    def test_nobody_slow_costs_memory_or_holds_others(self) -> None:
        def memory() -> int:
            pages = Path(f"/proc/{self.wall.daemons['walld'].pid}/statm").read_text().split()[1]
            return int(pages) * os.sysconf("SC_PAGE_SIZE")

        watched = [{"tile": name, "codec": "raw", "fps": 60} for name in self.wall.tile_names]
        reading = self.open()
        reading.watch(*watched)
        self.frame(reading)
        rude = []
        for _ in range(200):
            viewer = self.open()
            viewer.watch(*watched)
            rude.append(viewer)
        for _ in range(20):
            self.frame(reading)
        before = memory()
        for _ in range(60):
            self.frame(reading, 5)
        self.assertLess(memory() - before, 16 << 20)

    def frames_of(self, avi: Path) -> numpy.ndarray:
        """RGB, as FFmpeg decodes them."""
        width, height = self.wall.size
        raw = subprocess.run(["ffmpeg", "-v", "error", "-i", avi, "-fps_mode", "passthrough", "-f", "rawvideo",
                              "-pix_fmt", "rgb24", "-"],
                             check=True, capture_output=True).stdout
        return numpy.frombuffer(raw, numpy.uint8).reshape(-1, height, width, 3)

    def wall_picture(self) -> numpy.ndarray:
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            self.wall.screenshot(file.name)
            return load_png(file.name)[:, :, :3]

    def test_a_recording_shows_what_screenshots_show(self) -> None:
        self.let_frames_end()
        shots = [self.wall_picture()]
        with tempfile.TemporaryDirectory() as folder:
            avi = Path(folder) / "wall.avi"
            recording = subprocess.Popen([self.wall.bin / "wallctl", "--walld", self.wall.address, "--json", "record",
                                          avi, "--seconds", "3", "--fps", "10"],
                                         stdout=subprocess.PIPE, text=True)
            for _ in range(4):
                time.sleep(0.6)
                self.wall.step(self.session)
                time.sleep(0.3)
                shots.append(self.wall_picture())
            said = json.loads(recording.communicate(timeout=20)[0])
            frames = self.frames_of(avi)
        self.assertEqual((said["frames"], len(frames)), (30, 30))
        self.assertFalse((shots[0] == shots[1]).all(), "steps are to be seen")
        places = [next((i for i, frame in enumerate(frames) if (frame == shot).all()), None) for shot in shots[:3]]
        self.assertNotIn(None, places, "each screenshot is a frame, bit for bit")
        self.assertEqual(places, sorted(set(places)), "in their order")

    def test_a_recording_has_the_background_where_a_node_is_away(self) -> None:
        self.let_frames_end()
        node = self.wall.node_names[1]
        self.wall.daemons[node].kill()
        self.wall.daemons[node].wait()
        while self.wall.nodes()[1]["up"]:
            time.sleep(0.02)
        with tempfile.TemporaryDirectory() as folder:
            avi = Path(folder) / "wall.avi"
            self.wall.ctl("record", avi, "--seconds", "0.5")
            frames, shot = self.frames_of(avi), self.wall_picture()
        self.wall.start_node(node)
        self.wall.wait_nodes()
        self.assertEqual(shot[0, TILE[0]].tolist(), [0x20, 0x40, 0x60])
        self.assertTrue((frames[-1] == shot).all())

    def test_a_recording_that_is_interrupted_is_a_whole_file(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            avi = Path(folder) / "wall.avi"
            recording = subprocess.Popen([self.wall.bin / "wallctl", "--walld", self.wall.address, "record", avi,
                                          "--seconds", "600"], stderr=subprocess.PIPE, text=True)
            while not avi.exists() or avi.stat().st_size < 20000:
                self.assertIsNone(recording.poll())
                time.sleep(0.05)
            recording.send_signal(signal.SIGINT)
            progress = recording.communicate(timeout=20)[1]
            self.assertEqual(recording.returncode, 0)
            self.assertIn("of 600.0 s", progress)
            self.assertGreater(len(self.frames_of(avi)), 0)

    def test_a_node_that_comes_back_is_seen_again(self) -> None:
        name, node = self.wall.tile_names[1], self.wall.node_names[1]
        viewer = self.open()
        viewer.watch({"tile": name})
        self.frame(viewer)
        self.wall.daemons[node].kill()
        self.wall.daemons[node].wait()
        while not (isinstance(message := viewer.message(), dict) and "ended" in message):
            pass
        self.assertIn(f"node {node} is away", message["ended"])
        self.wall.start_node(node)
        self.assertEqual(self.frame(viewer, 20).part, 0)
        self.assertIn("header", self.texts[-1])


class RecordingOfTwoPrograms(unittest.TestCase):
    """`wallctl record` on 2x2 tiles, each of them under both programs."""
    SECONDS, FPS = 5, 10

    @classmethod
    def setUpClass(cls) -> None:
        x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 2), tile_size=(160, 120), swap_timeout_ms=10000))
        cls.sessions = []
        for program, rect in ((["glxgears"], (10, 10, 200, 200)),
                              ([HACKS / "atlantis", "--window"], (120, 60, 190, 170))):
            app = cls.wall.run(*program, rect=rect, env=x.environment(), stdout=subprocess.DEVNULL)
            cls.addClassCleanup(app.wait)
            cls.addClassCleanup(app.kill)
            cls.sessions.append(cls.wall.wait_session(app))
        for session in cls.sessions:
            cls.wall.wait(session, 2)

    def start(self, avi: Path) -> subprocess.Popen:
        """A recording whose first frame is in the file."""
        recording = subprocess.Popen([self.wall.bin / "wallctl", "--walld", self.wall.address, "--json", "record", avi,
                                      "--seconds", str(self.SECONDS), "--fps", str(self.FPS)],
                                     stdout=subprocess.PIPE, text=True)
        while not avi.exists():
            self.assertIsNone(recording.poll())
            time.sleep(0.01)
        return recording

    def frames_of(self, avi: Path, recording: subprocess.Popen) -> numpy.ndarray:
        """As FFmpeg decodes them, which finds nothing wrong with the file."""
        said = json.loads(recording.communicate(timeout=30)[0])
        stream = json.loads(subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_streams", "-of", "json",
                                            avi], check=True, capture_output=True).stdout)["streams"][0]
        self.assertEqual((stream["codec_name"], stream["width"], stream["height"]), ("huffyuv", *self.wall.size))
        self.assertEqual((said["frames"], int(stream["nb_read_frames"])), (self.SECONDS * self.FPS,) * 2)
        self.assertAlmostEqual(float(stream["duration"]), self.SECONDS, places=3)
        decoded = subprocess.run(["ffmpeg", "-v", "error", "-i", avi, "-fps_mode", "passthrough", "-f", "rawvideo",
                                  "-pix_fmt", "rgb24", "-"], check=True, capture_output=True)
        self.assertEqual(decoded.stderr, b"")
        width, height = self.wall.size
        return numpy.frombuffer(decoded.stdout, numpy.uint8).reshape(-1, height, width, 3)

    def screenshot(self) -> numpy.ndarray:
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            self.wall.screenshot(file.name)
            return load_png(file.name)[:, :, :3]

    def test_every_screenshot_of_a_stepped_wall_is_a_frame(self) -> None:
        for session in self.sessions:
            self.wall.hold(session)
        time.sleep(0.5)
        shots = [self.screenshot()]
        with tempfile.TemporaryDirectory() as folder:
            avi = Path(folder) / "wall.avi"
            recording = self.start(avi)
            until = time.monotonic() + self.SECONDS - 1.5
            while time.monotonic() < until:
                for session in self.sessions:
                    self.wall.step(session)
                time.sleep(0.5)
                shots.append(self.screenshot())
            frames = self.frames_of(avi, recording)
        self.assertGreater(len(shots), 3)
        for before, after in zip(shots, shots[1:]):
            self.assertFalse((before == after).all(), "steps are to be seen")
        places = [next((i for i, frame in enumerate(frames) if (frame == shot).all()), None) for shot in shots]
        self.assertNotIn(None, places, "each screenshot is a frame, bit for bit")
        self.assertEqual(places, sorted(set(places)), "in their order")

    def test_running_programs_move_in_it(self) -> None:
        for session in self.sessions:
            self.wall.hold(session, False)
        with tempfile.TemporaryDirectory() as folder:
            avi = Path(folder) / "wall.avi"
            frames = self.frames_of(avi, self.start(avi))
        for name, (x, y, width, height) in (("gears", (10, 10, 100, 200)), ("atlantis", (220, 60, 90, 170))):
            part = frames[:, y:y + height, x:x + width]
            different = sum((before != after).any() for before, after in zip(part, part[1:]))
            self.assertGreater(different, len(frames) // 10, name)


if __name__ == "__main__":
    unittest.main()
