# SPDX-License-Identifier: MIT
"""Tiles watched over WebSockets while programs run (docs/streams.md)."""
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

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import numpy  # noqa: E402
from compare import load_png  # noqa: E402
from wall import Wall  # noqa: E402
from websocket import Refused, WebSocket  # noqa: E402
from xserver import XServer  # noqa: E402

TILE = (200, 150)


class Streams(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 1), tile_size=TILE, swap_timeout_ms=10000, options='background = "#204060"'))
        cls.app = cls.wall.run("glxgears", "-geometry", "400x150", env=cls.x.environment(), stdout=subprocess.DEVNULL)
        cls.session = cls.wall.wait_session(cls.app)
        cls.wall.wait(cls.session, 2)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.app.kill()
        cls.app.wait()

    def setUp(self) -> None:
        self.wall.hold(self.session, False)

    def open(self, **headers: str) -> WebSocket:
        return self.enterContext(WebSocket(self.wall.url, **headers))

    def frame(self, viewer: WebSocket, timeout: float = 10) -> tuple[int, int, int, bytes]:
        """stream, sequence, flags, packet of the next frame; texts before it are kept in self.texts."""
        self.texts = []
        while isinstance(message := viewer.message(timeout), dict):
            self.texts.append(message)
        stream, sequence, _, flags = struct.unpack_from("<IIQI", message)
        return stream, sequence, flags, message[20:]

    def screenshot(self, tile: str) -> numpy.ndarray:
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            self.wall.screenshot(file.name, tile=tile)
            return load_png(file.name)

    def settle(self) -> None:
        """No frame is on its way any more."""
        self.wall.hold(self.session)
        time.sleep(0.3)

    def test_a_frame_is_the_tiles_picture(self) -> None:
        self.settle()
        viewer = self.open()
        names = self.wall.tile_names
        viewer.watch(*({"tile": name, "codec": "raw"} for name in names))
        got = {}
        for _ in names:
            stream, _, flags, packet = self.frame(viewer)
            self.assertEqual(flags, 1)
            self.assertEqual((self.texts[-1]["stream"], self.texts[-1]["width"], self.texts[-1]["height"]), (stream, *TILE))
            got[stream] = numpy.frombuffer(packet[-4 * TILE[0] * TILE[1]:], numpy.uint8).reshape(TILE[1], TILE[0], 4)[:, :, :3]
        for i, name in enumerate(names):
            self.assertTrue((got[i] == self.screenshot(name)[:, :, :3]).all(), name)
            self.assertGreater(got[i].max(), 50, "gears are to be seen")

    def test_an_unchanged_picture_is_sent_once(self) -> None:
        self.settle()
        viewer = self.open()
        viewer.watch({"tile": self.wall.tile_names[0]})
        self.frame(viewer)
        with self.assertRaises(TimeoutError):
            self.frame(viewer, 1)
        self.wall.step(self.session)
        self.assertEqual(self.frame(viewer)[1], 2)

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
        viewer.send("what?")
        self.assertEqual(viewer.message(), {"error": 'expected {"watch": [...]}'})

    def test_a_page_of_another_site_may_not_watch(self) -> None:
        with self.assertRaises(Refused) as refused:
            self.open(Origin="http://elsewhere.example")
        self.assertEqual(refused.exception.status, 403)

    def test_nobody_slow_costs_memory_or_holds_others(self) -> None:
        def memory() -> int:
            return int(Path(f"/proc/{self.wall.daemons['walld'].pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")

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
        raw = subprocess.run(["ffmpeg", "-v", "error", "-i", avi, "-fps_mode", "passthrough", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                             check=True, capture_output=True).stdout
        return numpy.frombuffer(raw, numpy.uint8).reshape(-1, height, width, 3)

    def wall_picture(self) -> numpy.ndarray:
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            self.wall.screenshot(file.name)
            return load_png(file.name)[:, :, :3]

    def test_a_recording_shows_what_screenshots_show(self) -> None:
        self.settle()
        shots = [self.wall_picture()]
        with tempfile.TemporaryDirectory() as folder:
            avi = Path(folder) / "wall.avi"
            recording = subprocess.Popen([self.wall.bin / "wallctl", "--walld", self.wall.address, "--json", "record", avi, "--seconds", "3", "--fps", "10"],
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
        self.settle()
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
            recording = subprocess.Popen([self.wall.bin / "wallctl", "--walld", self.wall.address, "record", avi, "--seconds", "600"], stderr=subprocess.PIPE, text=True)
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
        self.assertEqual(self.frame(viewer, 20)[0], 0)
        self.assertEqual(self.texts[-1]["tile"], name)


if __name__ == "__main__":
    unittest.main()
