# SPDX-License-Identifier: MIT
"""Parallel programs: several processes that draw into one window (docs/parallel-programs.md). examples/march is one
whose picture does not depend on how many processes draw it; turns.cpp one whose picture depends on their order."""
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
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
SIZE = (400, 300)
LIMIT = 60.0  # seconds for what takes one or two
BACK = 20.0  # for a program to come back to another walld, on a busy machine
KEPT = 0.8  # of a program's frame rate, while another's member stands still


def until(done, what: str, limit: float = LIMIT) -> None:
    end = time.monotonic() + limit
    while not done():
        if time.monotonic() > end:
            raise AssertionError(f"not within {limit:.0f} seconds: {what}")
        time.sleep(0.02)


class OnAWall(unittest.TestCase):
    SWAP_TIMEOUT_MS = 250

    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 2), tile_size=TILE, environment={"LP_NUM_THREADS": "0"},
                                              swap_timeout_ms=cls.SWAP_TIMEOUT_MS))
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))

    def tearDown(self) -> None:
        for app in self.wall.apps:
            if app.poll() is None:
                os.killpg(app.pid, signal.SIGKILL)
                app.wait()
            for pipe in (app.stdout, app.stderr):
                if pipe:
                    pipe.close()
        self.wall.apps.clear()
        until(lambda: not self.wall.sessions(), "all sessions end")

    # ---- programs ----

    def start(self, program: str, *arguments: object, ranks: int, rect=(0, 0, *SIZE), hold: bool = False,
              log: str = "") -> subprocess.Popen:
        folder = "examples" if program == "march" else "tests"
        line = self.wall.wallrun(build_folder() / folder / program, "--size", f"{SIZE[0]}x{SIZE[1]}", *arguments,
                                 rect=rect, hold=hold)
        line[1:1] = ["--parallel", str(ranks)] if ranks else []
        environment = self.x.environment(**({"WALLGL_LOG": f"error:{log}"} if log else {}))
        return self.wall.run_line(line, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def session(self) -> int:
        return self.wall.wait_session()

    def members(self) -> dict[int, int]:
        """Process ids by rank, when all have come."""
        def all_here():
            groups = [s["group"] for s in self.wall.sessions() if "group" in s]
            return groups and len(groups[0]["members"]) == groups[0]["size"]
        until(all_here, "all members come")
        return {m["rank"]: m["pid"] for s in self.wall.sessions() if "group" in s for m in s["group"]["members"]}

    def frame(self, name: str = "") -> int:
        return next(s["surfaces"][0]["frame"] for s in self.wall.sessions() if s["name"] == name and s["surfaces"])

    def places(self) -> set[tuple[int, ...]]:
        """Where the first session's window is wanted, and where it is shown."""
        surfaces = [surface for session in self.wall.sessions()[:1] for surface in session["surfaces"]]
        return {tuple(surface[key]) for surface in surfaces for key in ("rect", "shown_rect")}

    def picture(self) -> numpy.ndarray:
        return cv2.imdecode(numpy.frombuffer(self.wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)

    def assert_last_on_top(self, picture: numpy.ndarray, ranks: int) -> int:
        """Every ring of the pile is of the last rank; gives the one frame that all pixels are of."""
        for layer, x in ((0, 10), (1, 70), (2, 200)):
            self.assertEqual(picture[SIZE[1] // 2, x, 1], 16 * layer + ranks, f"layer {layer} has another rank on top")
        frames = {(int(red), int(blue)) for blue, red in picture[..., [0, 2]].reshape(-1, 2)}
        self.assertEqual(len(frames), 1, "a mixed frame")
        return frames.pop()[0]


class Pictures(OnAWall):
    """Whole frames: a node that is late by a moment is waited for."""
    SWAP_TIMEOUT_MS = 10000

    # ---- one picture ----

    def test_one_picture_from_any_number_of_processes(self) -> None:
        read, shown = {}, {}
        for ranks in (0, 1, 2, 4):
            file = self.folder / f"march-{ranks}.ppm"
            app = self.start("march", "--cells", "40", "--frames", "12", "--picture", file, ranks=ranks, hold=True)
            session = self.session()
            self.wall.step(session, 12)
            self.wall.wait(session, 11)
            shown[ranks] = self.picture() if ranks == 0 else shown[0]
            self.assertEqual(app.wait(LIMIT), 0, app.stderr.read())
            read[ranks] = file.read_bytes()
        self.assertGreater(len(set(read[0])), 100, "there is something in the picture")
        for ranks in (1, 2, 4):
            self.assertEqual(read[ranks], read[0], f"{ranks} processes draw another picture than one")

    def test_the_wall_shows_the_same_frame_of_two_and_of_one(self) -> None:
        pictures = []
        for ranks in (0, 2):
            app = self.start("march", "--cells", "40", ranks=ranks, hold=True)
            session = self.session()
            self.wall.step(session, 7)
            self.assertEqual(self.wall.wait(session, 7), 7)
            pictures.append(self.picture())
            self.assertEqual(len(self.wall.sessions()[0]["surfaces"]), 1, "one window")
            os.killpg(app.pid, signal.SIGKILL)
            app.wait()
            until(lambda: not self.wall.sessions(), "the session ends")
        self.assertTrue((pictures[0] == pictures[1]).all())

    # ---- order ----

    def check_order(self, kind: str) -> None:
        self.start("turns", "--order", kind, ranks=3, hold=True)
        session = self.session()
        seen = set()
        for frame in range(1, 31):
            self.wall.step(session)
            self.wall.wait(session, frame)
            seen.add(self.assert_last_on_top(self.picture(), 3))
        self.assertEqual(len(seen), 30)

    def test_semaphores_make_an_order(self) -> None:
        self.check_order("semaphores")

    def test_barriers_make_an_order(self) -> None:
        self.check_order("barriers")


class Parallel(OnAWall):
    # ---- moves ----

    def test_a_move_shows_no_mixed_frame(self) -> None:
        self.start("turns", ranks=2)
        session = self.session()
        self.members()
        self.wall.wait(session, 10)
        for place in ((0, 0, 200, 150), (200, 150, 200, 150), (100, 75, 200, 150), (0, 0, *SIZE),
                      (-100, -100, 300, 200), (0, 0, *SIZE)):
            self.wall.ctl("place", session, *place)
            until(lambda: self.wall.sessions()[0]["surfaces"][0]["rect"] == list(place), "the window is there")
            shown = self.frame()
            self.wall.wait(session, shown + 20)
            self.wall.hold(session)
            time.sleep(0.3)
            picture = self.picture()
            x, y, width, height = place
            if x >= 0:
                window = picture[y:y + height, x:x + width]
                colors = {(int(red), int(blue)) for blue, red in window[..., [0, 2]].reshape(-1, 2)}
                self.assertEqual(len(colors), 1, f"a mixed frame at {place}: {colors}")
                self.assertEqual(window[height // 2, width // 2, 1], 16 * 2 + 2)
            self.wall.hold(session, on=False)
        self.assertEqual(self.wall.sessions()[0]["fault"], "")

    # ---- faults ----

    def test_a_killed_member_ends_the_program(self) -> None:
        log = self.folder / "killed.log"
        app = self.start("turns", ranks=3, log=str(log))
        self.session()
        members = self.members()
        self.wall.wait(self.session(), 5)
        os.kill(members[1], signal.SIGKILL)
        until(lambda: not self.wall.sessions(), "the session ends")
        self.assertEqual(app.wait(LIMIT), 128 + signal.SIGKILL)
        self.assertIn(f"rank 1 (process {members[1]})", self.wall.log("walld"))
        self.assertIn("ended without leaving", log.read_text())

    def test_a_member_that_leaves_is_not_waited_for(self) -> None:
        app = self.start("turns", "--order", "none", "--leave-at", "8", ranks=3)
        session = self.session()
        self.wall.wait(session, 60)
        self.assertEqual({m["left"] for m in self.wall.sessions()[0]["group"]["members"]}, {False, True})
        self.assertIsNone(app.poll())

    def test_a_stopped_member_holds_nobody_else(self) -> None:
        clock = [build_folder() / "tests" / "frame_clock", "--size", "200x150", "--fps", "30"]
        self.wall.run(*clock, rect=(200, 0, 200, 150), name="clock", env=self.x.environment())
        self.start("turns", "--fps", "20", ranks=2)
        members = self.members()
        until(lambda: self.frame() > 10 and self.frame("clock") > 10, "both run")

        def rate(name: str, seconds: float) -> float:
            first, begin = self.frame(name), time.monotonic()
            time.sleep(seconds)
            return (self.frame(name) - first) / (time.monotonic() - begin)
        before = rate("clock", 2)
        os.kill(members[1], signal.SIGSTOP)
        time.sleep(0.5)
        stood = self.frame()
        during = rate("clock", 4)
        self.assertLessEqual(self.frame(), stood + 2, "the group waits for its member")
        os.kill(members[1], signal.SIGCONT)
        until(lambda: self.frame() > stood + 20, "the group goes on")
        print(f"frames/s of the other program: {before:.1f}, while a member stood still {during:.1f}", flush=True)
        self.assertGreaterEqual(during, KEPT * before)

    def test_a_node_that_is_started_anew_is_drawn_on_again(self) -> None:
        self.start("turns", "--fps", "30", ranks=2)
        session = self.session()
        self.wall.wait(session, 10)
        node = self.wall.daemons["node-1-1"]
        os.killpg(node.pid, signal.SIGKILL)
        node.wait()
        self.wall.wait(session, self.frame() + 10)
        self.wall.start_node("node-1-1")
        self.wall.wait_nodes()
        self.wall.wait(session, self.frame() + 40)
        self.wall.hold(session)
        time.sleep(0.3)
        self.assert_last_on_top(self.picture(), 2)
        self.wall.hold(session, on=False)

    def test_a_stopped_node_does_not_hold_the_program(self) -> None:
        self.start("turns", ranks=2)
        session = self.session()
        self.wall.wait(session, 10)
        node = self.wall.daemons["node-0-1"]
        node.send_signal(signal.SIGSTOP)
        try:
            time.sleep(1)
            stood = self.frame()
            until(lambda: self.frame() > stood + 50, "the program goes on")
        finally:
            node.send_signal(signal.SIGCONT)
        time.sleep(2)  # to catch up
        self.wall.hold(session)
        time.sleep(0.5)
        self.assert_last_on_top(self.picture(), 2)
        self.wall.hold(session, on=False)

    def assert_goes_on(self, session: int, ranks: int) -> None:
        """With all its processes, and in order."""
        shown = self.frame()
        self.assertGreaterEqual(self.wall.wait(session, shown + 30), shown + 30)
        self.wall.hold(session)
        time.sleep(0.3)
        self.assert_last_on_top(self.picture(), ranks)
        self.wall.hold(session, on=False)

    def test_it_goes_on_without_walld_and_with_another_one(self) -> None:
        self.start("turns", ranks=3)
        session, members = self.session(), self.members()
        self.wall.wait(session, 10)
        for _ in range(2):
            self.wall.restart_walld(pause=1)
            until(lambda: self.wall.sessions() and self.wall.sessions()[0]["surfaces"], "it is back", BACK)
            self.assertEqual((self.session(), self.members()), (session, members))
            self.assert_goes_on(session, 3)
        # What walld says then reaches all of them at the same frame.
        for place in ((200, 150, 200, 150), (0, 0, *SIZE)):
            self.wall.ctl("place", session, *place)
            until(lambda: self.wall.sessions()[0]["surfaces"][0]["rect"] == list(place), "the window is there")
        node = self.wall.daemons["node-1-1"]
        os.killpg(node.pid, signal.SIGKILL)
        node.wait()
        self.wall.start_node("node-1-1")
        self.wall.wait_nodes()
        self.assert_goes_on(session, 3)

    def test_a_move_that_walld_does_not_live_to_see(self) -> None:
        """Some processes know where the window goes then, and some do not: they agree with the next walld."""
        self.start("turns", ranks=3)
        session = self.session()
        self.members()
        self.wall.wait(session, 10)
        for wait in (0.0, 0.002, 0.005, 0.01, 0.02):
            for place in ((200, 150, 200, 150), (0, 0, *SIZE)):
                self.wall.ctl("place", session, *place)
                time.sleep(wait)
                self.wall.restart_walld()
                # With all its processes: until then a walld that takes a wish does not tell it on.
                until(lambda: self.places() == {tuple(place)}, "it is shown where it was to move", BACK)
                shown = self.frame()
                self.assertGreaterEqual(self.wall.wait(session, shown + 10), shown + 10)
        self.assert_goes_on(session, 3)
        self.assertEqual(self.wall.sessions()[0]["fault"], "")

    def test_a_member_that_had_left_is_not_waited_for_by_another_walld(self) -> None:
        self.start("turns", "--order", "none", "--leave-at", "8", ranks=3)
        session = self.session()
        self.wall.wait(session, 60)
        self.wall.restart_walld()
        until(lambda: self.wall.sessions() and self.wall.sessions()[0]["surfaces"], "it is back", BACK)
        shown = self.frame()
        self.assertGreaterEqual(self.wall.wait(session, shown + 30), shown + 30)
        self.wall.ctl("place", session, 100, 75, 200, 150)
        until(lambda: self.wall.sessions()[0]["surfaces"][0]["rect"] == [100, 75, 200, 150], "the window is there")

    def test_it_ends_where_neither_walld_nor_nodes_know_it(self) -> None:
        log = self.folder / "walld.log"
        with Wall(tiles=(1, 1), tile_size=TILE, environment={"LP_NUM_THREADS": "0"}) as wall:
            line = wall.wallrun(build_folder() / "tests" / "turns", "--size", "200x150")
            line[1:1] = ["--parallel", "2"]
            app = wall.run_line(line, env=self.x.environment(WALLGL_LOG=f"error:{log}"), stdout=subprocess.DEVNULL)
            wall.wait(wall.wait_session(), 5)
            wall.daemons["node-0-0"].kill()
            wall.daemons["node-0-0"].wait()
            wall.restart_walld_only()
            wall.start_node("node-0-0")
            wall.wait_nodes()
            until(lambda: "session_ended" in log.read_text(), "the processes notice")
            self.assertIn("does not know parallel program", log.read_text())
            self.assertIsNone(app.poll(), "the programs themselves are not ended")
            self.assertEqual(wall.sessions(), [])

    def test_wrong_programs_end_with_a_reason(self) -> None:
        for kind, reason in (("counts", "barrier 9 was created with count"),
                             ("deadlock", "no process of the parallel program can go on")):
            with self.subTest(kind):
                log = self.folder / f"{kind}.log"
                app = self.start("turns", "--misuse", kind, ranks=2, log=str(log))
                until(lambda: log.exists() and reason in log.read_text(), reason)
                until(lambda: not self.wall.sessions(), "the session ends")
                os.killpg(app.pid, signal.SIGKILL)
                app.wait()

    def test_an_unknown_barrier_is_an_opengl_error(self) -> None:
        app = self.start("turns", "--misuse", "lonely-rank", "--frames", "5", ranks=2)
        self.wall.wait(self.session(), 5)
        os.killpg(app.pid, signal.SIGTERM)
        said = app.communicate(timeout=LIMIT)[0]
        self.assertEqual(sorted(re.findall(r"rank (\d) error (\w+)", said)), [("0", "0x0"), ("1", "0x502")])

    # ---- starting ----

    def by_hand(self, group: str, rank: int, ranks: int, *more: object) -> subprocess.Popen:
        line = self.wall.wallrun(build_folder() / "examples" / "march", "--cells", "16", *more)
        line[1:1] = ["--parallel-group", group]
        return self.wall.run_line(line, env=self.x.environment(OMPI_COMM_WORLD_RANK=str(rank),
                                                               OMPI_COMM_WORLD_SIZE=str(ranks)),
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def test_an_mpi_launchers_variables_say_the_rank(self) -> None:
        apps = [self.by_hand("mpi", rank, 2, "--frames", "5") for rank in (0, 1)]
        for rank, app in enumerate(apps):
            out, err = app.communicate(timeout=LIMIT)
            self.assertEqual(app.returncode, 0, err)
            self.assertIn(f"rank {rank} of 2: 5 frames", out)

    def test_a_rank_that_is_taken_is_refused(self) -> None:
        self.by_hand("twice", 0, 2)
        until(lambda: self.wall.sessions(), "the first is there")
        second = self.by_hand("twice", 0, 2)
        err = second.communicate(timeout=LIMIT)[1]
        self.assertIn("is here already", err)
        other = self.by_hand("twice", 1, 3)
        self.assertIn("has 2 processes, not 3", other.communicate(timeout=LIMIT)[1])

    @unittest.skipUnless(shutil.which("mpirun"), "no mpirun here")
    def test_under_mpirun(self) -> None:
        line = self.wall.wallrun(build_folder() / "examples" / "march", "--cells", "16", "--frames", "5")
        line[1:1] = ["--parallel-group", "mpirun"]
        command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2", *line]
        done = subprocess.run(command, env=self.x.environment(), capture_output=True, text=True, timeout=LIMIT)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("rank 1 of 2: 5 frames", done.stdout)


if __name__ == "__main__":
    unittest.main()
