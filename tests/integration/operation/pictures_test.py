# SPDX-License-Identifier: MIT
"""Pictures of what is large, and of what many want at once: a tile larger than any message, and 250 screenshots."""
import sys
import threading
import time
import unittest
import urllib.error
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from wall import Wall  # noqa: E402
from websocket import WebSocket  # noqa: E402

LARGE = (7680, 4320)  # a raw picture of it is 99 MB, one with alpha 133 MB; a message has at most 64 MiB
BACKGROUND = "#204060"
RGB = (0x20, 0x40, 0x60)
FRAME_HEAD = 24  # bytes of a stream's frame before the packet, docs/streams.md
MANY = 250
LONGEST = 15.0  # seconds for all of them


def picture(png: bytes) -> numpy.ndarray:
    return cv2.imdecode(numpy.frombuffer(png, numpy.uint8), cv2.IMREAD_COLOR)[:, :, ::-1]


class LargeTile(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.wall = cls.enterClassContext(Wall(tiles=(1, 1), tile_size=LARGE, options=f'background = "{BACKGROUND}"'))

    def tearDown(self) -> None:
        node = self.wall.nodes()[0]
        self.assertEqual((node["up"], node["incarnation"]), (True, 1), self.wall.log("node-0-0"))

    def check(self, pixels: numpy.ndarray) -> None:
        self.assertEqual(pixels.shape[:2], (LARGE[1], LARGE[0]))
        self.assertTrue((pixels[:, :, :3] == RGB).all())

    def test_wallctl_takes_a_screenshot(self) -> None:
        self.check(picture(self.wall.screenshot()))

    def test_http_gives_a_snapshot(self) -> None:
        with urllib.request.urlopen(self.wall.url + "api/v1/snapshot.png?tile=0-0", timeout=60) as answer:
            self.check(picture(answer.read()))

    def test_a_raw_stream_is_watched(self) -> None:
        with WebSocket(self.wall.url) as viewer:
            viewer.watch({"tile": "0-0", "codec": "raw"})
            message = viewer.message(30)
            while not isinstance(message, bytes):
                message = viewer.message(30)
        self.assertEqual(len(message), FRAME_HEAD + 4 * LARGE[0] * LARGE[1])
        self.check(numpy.frombuffer(message, numpy.uint8, offset=FRAME_HEAD).reshape(LARGE[1], LARGE[0], 4))


class ManyAtOnce(unittest.TestCase):
    """Somebody's script takes far more screenshots at once than the wall makes in a while."""

    def take(self, url: str, done: list[bytes], told_to_wait: list[str]) -> None:
        end = time.monotonic() + LONGEST
        while time.monotonic() < end:
            try:
                with urllib.request.urlopen(url, timeout=LONGEST) as answer:
                    return done.append(answer.read())
            except urllib.error.HTTPError as error:
                if error.code != 429:
                    raise
                told_to_wait.append(error.headers["Retry-After"])
                time.sleep(float(error.headers["Retry-After"]))

    def test_they_share_pictures_and_no_node_is_away(self) -> None:
        with Wall(tiles=(2, 1), tile_size=(1920, 1080)) as wall:
            done: list[bytes] = []
            told_to_wait: list[str] = []
            what = (wall.url + "api/v1/snapshot.png", done, told_to_wait)
            takers = [threading.Thread(target=self.take, args=what) for _ in range(MANY)]
            begin = time.monotonic()
            for taker in takers:
                taker.start()
            for taker in takers:
                taker.join()
            took = time.monotonic() - begin
            self.assertEqual(len(done), MANY)
            self.assertEqual({len(png) for png in done}, {len(done[0])})
            self.assertLess(took, LONGEST)
            self.assertTrue(set(told_to_wait) <= {"1"}, told_to_wait)
            self.assertNotIn("node_down", wall.log("walld"))
            self.assertEqual([node["incarnation"] for node in wall.nodes()], [1, 1])


if __name__ == "__main__":
    unittest.main()
