#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A connection between a program and a node that breaks while both live: the program opens it again, and the node's
tile is right again. The test stands between them, where the node listens."""
import contextlib
import socket
import sys
import threading
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

TILE = (200, 150)
ORIGIN = (TILE[0], 0)  # of the node's tile, on the wall
STILL = (120, 90)  # of a window that is drawn only when X asks for it
RIGHT_AGAIN = 8.0  # seconds after a connection broke; the second of two in a row is made after one more


class Between:
    """Takes the place of a Unix socket and passes on what comes, until cut() breaks all connections."""

    def __init__(self, path: Path):
        self._behind = path.with_suffix(".behind")
        path.rename(self._behind)
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(str(path))
        self._listener.listen()
        self._lock = threading.Lock()
        self._open: list[socket.socket] = []
        self.came = 0  # connections so far
        self._thread = threading.Thread(target=self._accept)
        self._thread.start()

    def _accept(self) -> None:
        while True:
            try:
                client, _ = self._listener.accept()
            except OSError:
                return
            node = socket.socket(socket.AF_UNIX)
            node.connect(str(self._behind))
            with self._lock:
                self._open += [client, node]
                self.came += 1
            threading.Thread(target=self._pass_on_both, args=(client, node)).start()

    def _pass_on_both(self, client: socket.socket, node: socket.socket) -> None:
        with client, node:
            back = threading.Thread(target=self._pass_on, args=(node, client))
            back.start()
            self._pass_on(client, node)
            back.join()
            with self._lock:
                self._open = [end for end in self._open if end not in (client, node)]

    @staticmethod
    def _pass_on(source: socket.socket, sink: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while data := source.recv(1 << 16):
                sink.sendall(data)
        for end in (source, sink):
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)

    def __enter__(self) -> "Between":
        return self

    def __exit__(self, *_) -> None:
        self.cut()
        self._listener.shutdown(socket.SHUT_RDWR)
        self._thread.join()
        self._listener.close()

    def cut(self) -> None:
        with self._lock:
            for end in self._open:
                with contextlib.suppress(OSError):
                    end.shutdown(socket.SHUT_RDWR)


class BrokenStream(unittest.TestCase):
    def setUp(self) -> None:
        self.x = self.enterContext(XServer())
        self.wall = self.enterContext(Wall(tiles=(2, 1), tile_size=TILE, environment={"LP_NUM_THREADS": "0"}))
        self.between = self.enterContext(Between(self.wall.folder / "node-1-0.sock"))

    def tile_is_right(self, size: tuple[int, int]) -> bool:
        """The programs' windows are blue all over."""
        picture = cv2.imdecode(numpy.frombuffer(self.wall.screenshot(tile="1-0"), numpy.uint8), cv2.IMREAD_COLOR)
        return bool((picture[:size[1], :size[0], 0] == 255).all())

    def wait_until_right(self, connections: int, size: tuple[int, int] = TILE) -> None:
        end = time.monotonic() + RIGHT_AGAIN
        while self.between.came < connections or not self.tile_is_right(size):
            self.assertLess(time.monotonic(), end, f"the tile is wrong after {self.between.came} connections")
            time.sleep(0.05)

    def test_it_is_opened_again(self) -> None:
        app = self.wall.run(build_folder() / "tests" / "frame_clock", "--size", "400x150", "--fps", "50",
                            rect=(0, 0, 400, 150), env=self.x.environment())
        session = self.wall.wait_session(app)
        self.wait_until_right(1)
        for connections in (2, 3):
            self.between.cut()
            self.wait_until_right(connections)
        frame = self.wall.sessions()[0]["surfaces"][0]["frame"]
        self.wall.wait(session, frame + 20)
        self.assertIsNone(app.poll())

    def test_a_program_that_stands_still_is_asked_to_draw(self) -> None:
        app = self.wall.run(build_folder() / "tests" / "still_windows", "blue", rect=(*ORIGIN, *STILL),
                            env=self.x.environment())
        self.wall.wait_session(app)
        self.wait_until_right(1, STILL)
        self.between.cut()
        self.wait_until_right(2, STILL)
        self.assertIsNone(app.poll())


if __name__ == "__main__":
    unittest.main()
