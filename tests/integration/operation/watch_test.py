# SPDX-License-Identifier: MIT
"""wallctl watch: in a terminal, in a pipe, as JSON, and while walld is away."""
import fcntl
import json
import os
import pty
import select
import signal
import struct
import subprocess
import sys
import termios
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from wall import Wall  # noqa: E402
from websocket import WebSocket  # noqa: E402
from xserver import XServer  # noqa: E402

SOON = 20.0  # seconds


class OfAWall(unittest.TestCase):
    wall: Wall

    def watch(self, *options: object, **popen) -> subprocess.Popen:
        return subprocess.Popen([str(word) for word in (self.wall.bin / "wallctl", "--walld", self.wall.address,
                                                        "watch", *options)], **popen)


class Watch(OfAWall):
    @classmethod
    def setUpClass(cls) -> None:
        x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 1), tile_size=(160, 120)))
        app = cls.wall.run("glxgears", rect=(0, 0, 320, 120), env=x.environment(), stdout=subprocess.DEVNULL)
        cls.addClassCleanup(app.wait)
        cls.addClassCleanup(app.kill)
        cls.session = cls.wall.wait_session(app)

    def blocks(self, *options: object, **environment: str) -> list[str]:
        watching = self.watch(*options, stdout=subprocess.PIPE, text=True, env=dict(os.environ, **environment))
        out = watching.communicate(timeout=SOON)[0]
        self.assertEqual(watching.returncode, 0)
        return ["wall test" + block for block in out.split("wall test")[1:]]

    def test_a_pipe_gets_a_block_for_each_refresh(self) -> None:
        viewer = self.enterContext(WebSocket(self.wall.url))
        viewer.watch({"wall": True})
        viewer.message()
        first, second = self.blocks("--count", 2)
        self.assertNotIn("\x1b", first + second)
        for block in (first, second):
            self.assertRegex(block, rf"(?m)^{self.wall.tile_names[0]} +up ")
            self.assertRegex(block, rf"(?m)^{self.session}\.\d+ +glxgears ")
            self.assertIn("huffyuv", block)
        self.assertRegex(second, rf"(?m)^{self.session}\.\d+ +glxgears +\w+ +[1-9][0-9.]* ", "frames a second")

    def test_a_narrow_one_is_as_narrow_as_it_is_said(self) -> None:
        for block in self.blocks("--count", 1, COLUMNS="24"):
            self.assertLessEqual(max(map(len, block.splitlines())), 24)

    def test_json_is_a_document_a_line(self) -> None:
        watching = self.watch("--json", "--count", 3, "--interval", 0.2, stdout=subprocess.PIPE, text=True)
        documents = [json.loads(line) for line in watching.communicate(timeout=SOON)[0].splitlines()]
        self.assertEqual(len(documents), 3)
        self.assertLess(documents[0]["time"], documents[2]["time"])
        self.assertGreater(documents[2]["status"]["tiles"][0]["frames_per_second"], 0)

    def test_a_terminal_is_drawn_in_place_until_ctrl_c(self) -> None:
        controller, terminal = pty.openpty()
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 8, 30, 0, 0))
        watching = self.watch("--interval", 0.2, stdin=terminal, stdout=terminal, stderr=terminal)
        os.close(terminal)
        shown = b""
        while shown.count(b"\x1b[J") < 3:
            self.assertTrue(select.select([controller], [], [], SOON)[0])
            shown += os.read(controller, 65536)
        watching.send_signal(signal.SIGINT)
        self.assertEqual(watching.wait(SOON), 0)
        shown += os.read(controller, 65536)
        self.assertTrue(shown.startswith(b"\x1b[?25l"))
        self.assertTrue(shown.endswith(b"\x1b[?25h"), shown[-40:])
        for drawn in shown.split(b"\x1b[H")[1:]:
            lines = drawn.split(b"\x1b[J")[0].decode().replace("\x1b[K", "").split("\r\n")[:-1]
            self.assertLessEqual(len(lines), 7)
            self.assertLessEqual(max(map(len, lines)), 30)
        os.close(controller)

    def test_a_walld_that_never_was_is_an_error(self) -> None:
        done = subprocess.run([self.wall.bin / "wallctl", "--walld", "unix:/nowhere", "watch"], capture_output=True,
                              text=True, timeout=SOON)
        self.assertEqual(done.returncode, 1)
        self.assertIn("cannot be reached", done.stderr)


class WatchWithoutWalld(OfAWall):
    def setUp(self) -> None:
        self.wall = self.enterContext(Wall(tiles=(1, 1), tile_size=(64, 48)))

    def test_a_walld_that_is_started_again_is_waited_for(self) -> None:
        watching = self.watch("--interval", 0.2, stdout=subprocess.PIPE, text=True)
        self.addCleanup(watching.communicate)
        self.addCleanup(watching.kill)
        self.heads(watching, "wall test")
        self.wall.daemons["walld"].kill()
        self.wall.daemons["walld"].wait()
        self.heads(watching, "DOES NOT ANSWER")
        self.wall.start_walld()
        self.wall.wait_nodes()
        self.heads(watching, "walld is back after")
        watching.send_signal(signal.SIGTERM)
        self.assertEqual(watching.wait(SOON), 0)

    def heads(self, watching: subprocess.Popen, words: str) -> None:
        """Reads until a line has the words."""
        end = time.monotonic() + SOON
        while words not in watching.stdout.readline():
            self.assertLess(time.monotonic(), end, words)


if __name__ == "__main__":
    unittest.main()
