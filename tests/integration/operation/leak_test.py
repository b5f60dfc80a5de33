# SPDX-License-Identifier: MIT
"""Programs come and go, orderly and not: what the daemons took for them they give back, down to the objects of the
nodes' drivers."""
import os
import random
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from wall import Wall, WallError, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

SEED = 50
WARM_UP, RUNS = 10, 50
TOGETHER = 3  # programs at a time
WINDOW = (400, 300)
# A session's layers take about 2.4 MiB here: if each run left them behind, that would be 120 MiB.
GROWTH = 30 << 20  # bytes
GONE_LIMIT = 20.0  # seconds


def memory(pid: int) -> int:
    """Resident bytes."""
    fields = Path(f"/proc/{pid}/statm").read_text().split()
    return int(fields[1]) * os.sysconf("SC_PAGE_SIZE")


def descriptors(pid: int) -> int:
    return len(os.listdir(f"/proc/{pid}/fd"))


class Leaks(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 1), tile_size=(200, 300), environment={"LP_NUM_THREADS": "0"}))
        cls.random = random.Random(SEED)
        cls.seen = set()  # kinds of driver objects that there were
        cls.chosen = cls.commands()

    @classmethod
    def commands(cls) -> list[list[str]]:
        size = f"{WINDOW[0]}x{WINDOW[1]}"
        tests = build_folder() / "tests"
        listed = subprocess.run([tests / "golden_scenes", "--list"], check=True, capture_output=True,
                                text=True).stdout.split("\n")
        scenes = [line.split()[0] for line in listed if line and line.split()[2] == "swaps"]
        return [["glxgears", "-geometry", size], [tests / "frame_clock", "--size", size],
                [tests / "frame_clock", "--size", size, "--egl"],
                *([tests / "golden_scenes", scene, "--frames=1000"] for scene in cls.random.sample(scenes, 6))]

    def start(self, command: list) -> subprocess.Popen:
        return self.wall.run(*command, rect=(0, 0, *WINDOW), env=self.x.environment(vblank_mode="0"),
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def end(self, app: subprocess.Popen) -> None:
        """As a user, an operator or an accident ends it."""
        how = self.random.choice(["kill", "terminate", "close"])
        if how == "close":
            for session in self.wall.sessions():
                if session["pid"] == app.pid:
                    try:
                        self.wall.ctl("close", session["id"])
                    except WallError:  # it has ended meanwhile
                        pass
        if app.poll() is None:
            app.send_signal(signal.SIGKILL if how == "kill" else signal.SIGTERM)
        try:
            app.wait(GONE_LIMIT)
        except subprocess.TimeoutExpired:
            app.kill()
            app.wait()

    def run_programs(self, commands: list[list]) -> None:
        running = []
        for command in commands:
            running.append(self.start(command))
            if self.random.random() < 0.8:  # others are ended before they have a window
                try:
                    session = self.wall.wait_session(running[-1])
                    self.wall.wait(session, self.random.randint(1, 5))
                except WallError:  # a short one has ended by itself
                    pass
            self.seen |= {kind for objects in self.objects().values() for kind, count in objects.items() if count > 0}
            while len(running) >= TOGETHER:
                self.end(running.pop(self.random.randrange(len(running))))
        self.wall.screenshot()
        for app in running:
            self.end(app)
        end = time.monotonic() + GONE_LIMIT
        while self.wall.sessions():
            self.assertLess(time.monotonic(), end, "sessions end")
            time.sleep(0.05)
        time.sleep(1.0)  # the nodes' streams are closed, their objects freed
        self.wall.apps.clear()

    def used(self) -> dict[str, tuple[int, int]]:
        return {name: (descriptors(daemon.pid), memory(daemon.pid)) for name, daemon in self.wall.daemons.items()}

    def objects(self) -> dict[str, dict[str, int]]:
        """Of each node's driver, as it has told; it tells once a second."""
        return {node["name"]: node["objects"] for node in self.wall.nodes()}

    def test_what_programs_took_is_given_back(self) -> None:
        # What daemons keep from the first use on, such as a compiler of shaders, there is by then.
        self.run_programs(self.chosen + self.random.choices(self.chosen, k=WARM_UP))
        before, objects = self.used(), self.objects()
        self.run_programs(self.random.choices(self.chosen, k=RUNS))
        after = self.used()
        for name in before:
            print(f"{name}: {before[name][0]} -> {after[name][0]} descriptors, {before[name][1] >> 20} -> "
                  f"{after[name][1] >> 20} MiB", flush=True)
        for name, (files, bytes_used) in before.items():
            self.assertEqual(after[name][0], files, f"descriptors of {name}")
            self.assertLess(after[name][1] - bytes_used, GROWTH, f"memory of {name}")
        end = time.monotonic() + GONE_LIMIT
        while self.objects() != objects and time.monotonic() < end:
            time.sleep(0.1)
        self.assertEqual(self.objects(), objects, "objects in the drivers")
        print(f"driver objects: {objects}, meanwhile also {sorted(self.seen)}", flush=True)
        self.assertLessEqual({"textures", "framebuffers", "lists"}, self.seen, "the programs had some")


if __name__ == "__main__":
    unittest.main()
