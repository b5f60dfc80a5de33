# SPDX-License-Identifier: MIT
"""Nodes on machines of their own that hand on to each other what all of them need (docs/hand-on.md): what the wall
shows is the same, also after one of them has gone or cannot reach the next."""
import subprocess
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from machine_wall import MachineWall  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

FILM = (build_folder() / "bench" / "cinema", "--window", "600x150", "--picture", "640x360", "--frames", "0")
PICTURE_BYTES = 4 * 640 * 360
FOREVER = 1_000_000  # frames
BUFFERS = (build_folder() / "bench" / "buffers", "--size", "600x150", "--frames", FOREVER, "--mesh", "300x100")
BUFFER_BYTES = 24 * 301 * 101 + 4 * 6 * 300 * 100  # vertices and indices
LIST = (build_folder() / "bench" / "mesh", "--list", "--size", "600x150", "--frames", FOREVER)
LIST_BYTES = 24 * 6 * 187 * 94  # normals and positions
FRAMES = 5
HEALED = 5.0  # seconds until a frame of all nodes is right again


class HandOn(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())

    def setUp(self) -> None:
        self.wall = self.enterContext(MachineWall((3, 1), (200, 150), swap_timeout_ms=1000,
                                                  environment={"LP_NUM_THREADS": "0"}))

    def start(self, hand_on: bool, *, program: tuple = FILM, sort_last: bool = False) -> int:
        """A program that is held."""
        app = self.wall.run_at("desk", *map(str, program), rect=(0, 0, 600, 150), hold=True, sort_last=sort_last,
                               stdout=subprocess.DEVNULL,
                               env=self.x.environment(WALLGL_HAND_ON="1" if hand_on else "0", WALLGL_CODING="0"))
        return self.wall.wait_session(app)

    def step(self, session: int) -> numpy.ndarray:
        """The next frame that all nodes have."""
        frame = next(s for s in self.wall.sessions() if s["id"] == session)["surfaces"][0]["frame"]
        self.wall.step(session, FRAMES)
        self.wall.wait(session, frame + FRAMES)
        return cv2.imdecode(numpy.frombuffer(self.wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)

    def handed_on(self) -> dict[str, int]:
        return {node["name"]: node["bytes_handed_on"] for node in self.wall.nodes()}

    def wait_for_handed_on(self, before: dict[str, int], size: int) -> None:
        """By each of the first two nodes, whose statistics come once a second."""
        def is_handed_on() -> bool:
            now = self.handed_on()
            return all(now[name] - before[name] >= size for name in ("node-0", "node-1"))
        self.wall._until(is_handed_on, "nodes hand on", "node-0", "node-1")

    def test_the_wall_shows_the_same(self) -> None:
        before = self.handed_on()
        to_each = self.step(self.start(False))
        time.sleep(1.5)
        self.assertEqual(self.handed_on(), before)
        handed = self.step(self.start(True))  # it lies over the other one
        self.assertGreater(to_each.std(), 20, "there is something to be seen")
        self.assertEqual(int((handed != to_each).any(axis=2).sum()), 0)
        self.wait_for_handed_on(before, FRAMES * PICTURE_BYTES)
        self.assertEqual(self.handed_on()["node-2"], before["node-2"], "it is the last one")

    def test_meshes_and_lists_too(self) -> None:
        for what, program, size, sort_last in (("buffers", BUFFERS, BUFFER_BYTES, False),
                                               ("a list", LIST, LIST_BYTES, False),
                                               ("parts of a draw", BUFFERS, BUFFER_BYTES, True)):
            with self.subTest(what):
                before = self.handed_on()
                shown = []
                for hand_on in (False, True):
                    session = self.start(hand_on, program=program, sort_last=sort_last)
                    shown.append(self.step(session))
                    self.wall.ctl("close", session)  # or the next one would find what it has on the nodes
                    self.wall._until(lambda: not self.wall.sessions(), "the program has ended")
                self.assertGreater(shown[0].std(), 2, "the mesh has light and shade")
                self.assertEqual(int((shown[0] != shown[1]).any(axis=2).sum()), 0)
                self.wait_for_handed_on(before, size)
                time.sleep(1.5)
                for node, handed in self.handed_on().items():
                    self.assertLess(handed - before[node], 1.2 * size, f"{node} hands it on once")

    def heals(self, session: int, expected: numpy.ndarray) -> None:
        """Soon a frame is shown that all nodes have drawn: it is as the columns of what is expected move."""
        end = time.monotonic() + HEALED
        while True:
            shown = self.step(session)
            if all(self.is_frame(shown[:, left:left + 200], expected[:, left:left + 200]) for left in (0, 200, 400)):
                return
            self.assertLess(time.monotonic(), end, "a node does not have what it needs")

    @staticmethod
    def is_frame(shown: numpy.ndarray, expected: numpy.ndarray) -> bool:
        """The film's blue changes from row to row alone, and so is the same in all of its frames."""
        return bool((shown[:, :, 0] == expected[:, :, 0]).all())

    def test_a_node_that_hands_on_dies(self) -> None:
        for name in ("node-0", "node-1"):
            with self.subTest(name):
                session = self.start(True)
                expected = self.step(session)
                self.wall.hold(session, False)
                time.sleep(0.5)
                self.wall.kill_node(name)
                time.sleep(1.0)
                self.wall.start_node(name)
                self.wall.wait_nodes()
                self.wall.hold(session, True)
                self.heals(session, expected)

    def test_a_node_that_cannot_reach_the_next_one_is_done_without(self) -> None:
        session = self.start(True)
        expected = self.step(session)
        for kind, here, there in (("unreachable", "node-0", "node-1"), ("blackhole", "node-2", "node-1")):
            with self.subTest(kind):
                namespace, address = self.wall.hosts.namespace(here), self.wall.hosts.address(there)
                subprocess.run(["ip", "-n", namespace, "route", "add", kind, f"{address}/32"], check=True)
                other = self.start(True)  # its links are made now
                self.heals(other, expected)
                self.heals(session, expected)
                subprocess.run(["ip", "-n", namespace, "route", "delete", kind, f"{address}/32"], check=True)

    def test_a_link_that_is_cut_for_a_moment(self) -> None:
        session = self.start(True)
        expected = self.step(session)
        self.wall.hold(session, False)
        self.wall.hosts.cut("node-1")
        time.sleep(1.5)
        self.wall.hosts.mend("node-1")
        time.sleep(1.0)
        self.wall.hold(session, True)
        self.heals(session, expected)


if __name__ == "__main__":
    unittest.main()
