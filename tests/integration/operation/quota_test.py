# SPDX-License-Identifier: MIT
"""What programs and people may have ([quota] in wall.toml): who wants more is told and held, nobody else notices."""
from __future__ import annotations

import subprocess
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from show import until  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

PROGRAMS = build_folder() / "tests"
SOON = 10.0  # seconds
MEASURED = 3.0  # seconds
STEADY = 0.8  # of its frame rate, that a program keeps beside a hungry one
FPS = 20  # of it
MIB = 1 << 20


class Quotas(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 1), tile_size=(160, 120), swap_timeout_ms=2000))
        cls.text = (cls.wall.folder / "wall.toml").read_text()

    def setUp(self) -> None:
        self.addCleanup(self.end_programs)
        self.heard = {}  # files with what programs say on their standard error, by their process ids
        self.quota()
        self.other = self.start("frame_clock", "--fps", FPS, rect=(0, 0, 320, 20))
        self.other_session = self.wall.wait_session(self.other)

    def end_programs(self) -> None:
        for app in self.wall.apps:
            app.kill()
            app.wait()
        self.wall.apps.clear()
        until(lambda: not self.wall.sessions(), "all programs are gone", SOON)

    def quota(self, **figures: int) -> None:
        """From now on."""
        lines = "".join(f"{name} = {figure}\n" for name, figure in figures.items())
        (self.wall.folder / "wall.toml").write_text(self.text + "[quota]\n" + lines)
        self.wall.ctl("reload")

    def start(self, program: str, *arguments: object, rect=(0, 20, 320, 100)) -> subprocess.Popen:
        return self.start_line(program, "--size", f"{rect[2]}x{rect[3]}", *arguments, rect=rect)

    def start_line(self, program: str, *arguments: object, **options) -> subprocess.Popen:
        file = self.wall.folder / f"said-{time.monotonic_ns()}"
        with file.open("wb") as said:
            app = self.wall.run(PROGRAMS / program, *arguments, env=self.x.environment(), stdout=subprocess.DEVNULL,
                                stderr=said, **options)
        self.heard[app.pid] = file
        return app

    def session(self, number: int) -> dict | None:
        return next((s for s in self.wall.sessions() if s["id"] == number), None)

    def frame(self, session: int) -> int:
        return self.session(session)["surfaces"][0]["frame"]

    def rates(self, *sessions: int) -> list[float]:
        """Frames a second of each."""
        begin, first = time.monotonic(), [self.frame(session) for session in sessions]
        time.sleep(MEASURED)
        last = [self.frame(session) for session in sessions]
        return [(b - a) / (time.monotonic() - begin) for a, b in zip(first, last)]

    def assert_others_go_on(self) -> None:
        rate, = self.rates(self.other_session)
        self.assertGreater(rate, STEADY * FPS)
        self.assertEqual(self.session(self.other_session)["fault"], "")

    def said(self, app: subprocess.Popen, words: str) -> None:
        """On its standard error."""
        until(lambda: words in self.heard[app.pid].read_text(), f"it is told: {words}", SOON)

    # ---- programs ----

    def test_a_window_has_no_more_frames_than_it_may(self) -> None:
        self.quota(program_fps=15)
        app = self.start("frame_clock")
        session = self.wall.wait_session(app)
        rate, other = self.rates(session, self.other_session)
        print(f"{rate:.1f} frames/s of 15 at most, and {other:.1f} of the other, which wants {FPS}", flush=True)
        self.assertTrue(13 < rate < 15.7, rate)
        self.assertTrue(13 < other < 15.7, other)
        self.quota(program_fps=40)
        rate, other = self.rates(session, self.other_session)
        self.assertTrue(30 < rate < 42, rate)
        self.assertGreater(other, STEADY * FPS)
        self.quota()
        rate, = self.rates(session)
        self.assertGreater(rate, 50, "without a limit")

    def test_a_program_has_no_more_memory_than_it_may(self) -> None:
        self.quota(program_memory=48)
        modest = self.wall.wait_session(self.start("hungry", "--keep", 30))
        until(lambda: self.session(modest)["memory_bytes"] > 30 * MIB, "it has its textures", SOON)
        self.assertLess(self.session(modest)["memory_bytes"], 40 * MIB)
        greedy = self.start("hungry", "--keep", 100)
        number = self.wall.wait_session(greedy)
        until(lambda: "program_memory" in self.session(number)["fault"], "a node says so", SOON)
        self.said(greedy, "program_memory")
        self.assertIsNone(greedy.poll(), "the program itself goes on")
        self.assertEqual(self.session(modest)["fault"], "")
        self.assert_others_go_on()

    def test_a_program_has_no_more_objects_than_it_may(self) -> None:
        self.quota(program_objects=20)
        greedy = self.start("hungry", "--keep", 40)
        number = self.wall.wait_session(greedy)
        until(lambda: "more objects" in self.session(number)["fault"], "a node says so", SOON)
        self.assert_others_go_on()

    def test_a_program_sends_no_more_than_it_may(self) -> None:
        self.quota(program_bandwidth=20)
        session = self.wall.wait_session(self.start("hungry", "--write", 4, "--fps", 0))
        rate, other = self.rates(session, self.other_session)
        print(f"{4 * rate:.1f} MiB/s of 20 at most, and {other:.1f} frames/s of the other", flush=True)
        self.assertTrue(12 < 4 * rate < 24, rate)
        self.assertGreater(other, STEADY * FPS)
        self.quota()
        rate, = self.rates(session)
        self.assertGreater(4 * rate, 40, "without a limit")

    def test_a_program_has_no_more_windows_than_it_may(self) -> None:
        self.quota(program_windows=1)
        app = self.start_line("still_windows", "red", "green", "blue")
        self.said(app, "more than 1 windows ('program_windows' in [quota] of wall.toml)")
        self.assert_others_go_on()

    # ---- people ----

    def test_a_person_has_no_more_programs_than_they_may(self) -> None:
        self.quota(person_programs=2)
        self.wall.wait_session(self.start("frame_clock", "--fps", 5))
        third = self.start("frame_clock", "--fps", 5)
        self.said(third, "has 2 programs on this wall, as many as a person may have ('person_programs'")
        self.assertEqual(len(self.wall.sessions()), 2)
        self.wall.restart_walld()
        until(lambda: len([s for s in self.wall.sessions() if s["surfaces"]]) == 2, "both come back", SOON)

    def test_a_person_has_no_more_memory_than_they_may(self) -> None:
        self.quota(person_memory=60)
        small = self.wall.wait_session(self.start("hungry", "--keep", 20))
        large = self.start("hungry", "--keep", 50)
        number = self.wall.wait_session(large)
        until(lambda: self.session(number) is None, "the largest is ended", SOON)
        self.said(large, "('person_memory' in [quota] of wall.toml)")
        self.assertIn(f"session_cut session={number}", self.wall.log("walld"))
        time.sleep(2)
        self.assertIsNotNone(self.session(small))
        self.assert_others_go_on()

    def record(self, name: str, seconds: float) -> subprocess.Popen:
        line = [self.wall.bin / "wallctl", "--walld", self.wall.address, "record", self.wall.folder / name, "--seconds",
                str(seconds)]
        recording = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(recording.stderr.close)
        self.addCleanup(recording.wait)
        return recording

    def test_a_person_has_no_more_live_views_than_they_may(self) -> None:
        self.quota(person_views=1)
        first = self.record("first.avi", 3)
        until(lambda: self.wall.ctl("streams"), "it is watched", SOON)
        second = self.record("second.avi", 1)
        self.assertNotEqual(second.wait(SOON), 0)
        self.assertIn("('person_views' in [quota] of wall.toml)", second.stderr.read())
        self.assertEqual(first.wait(SOON), 0, "the first is not disturbed")
        self.quota(person_views=2)
        both = [self.record(f"{name}.avi", 1) for name in ("third", "fourth")]
        self.assertEqual([recording.wait(SOON) for recording in both], [0, 0])

    # ---- who sees it ----

    def test_it_is_told(self) -> None:
        self.quota(program_memory=48, person_programs=7)
        self.assertEqual(self.wall.status()["wall"]["quota"], {"program_memory": 48 * MIB, "person_programs": 7})
        session = self.wall.wait_session(self.start("hungry", "--keep", 10))
        until(lambda: self.session(session)["objects"] >= 10, "it has its textures", SOON)
        _, metrics = self.wall.rest("GET", "/metrics")
        self.assertRegex(metrics, rf'wallgl_session_memory_bytes{{[^}}]*session="{session}"[^}}]*}} 1[0-9]+\n')
        table = subprocess.run([self.wall.bin / "wallctl", "--walld", self.wall.address, "sessions"],
                               capture_output=True, text=True, check=True).stdout
        self.assertRegex(table, r"hungry .* 1\d\.\d MB")


if __name__ == "__main__":
    unittest.main()
