# SPDX-License-Identifier: MIT
"""A wall of five machines (tests/support/hosts.py): walld, three nodes with a column of tiles each, and a client host
whose programs are drawn on it; a guest joins now and then. What is on that wall is compared with a wall of the same
tiles on one machine. Links are cut and limited, machines are revoked, and strangers come to the ports.

The programs and what is asked of them are those of tests/support/show.py."""
from __future__ import annotations

import base64
import concurrent.futures
import dataclasses
import functools
import os
import socket
import ssl
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from typing import Callable

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
import strangers  # noqa: E402
from compare import Verdict, same  # noqa: E402
from machine_wall import DATA_PORT, WALLD, MachineWall  # noqa: E402
from show import PROGRAMS, SETTLED, OneMachine, Show, until  # noqa: E402
from wall import Wall, WallError, build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

GENERATED = build_folder() / "generated" / "gen" / "glapi" / "wire.gen.h"
TILES, TILE = (3, 2), (200, 150)
QUIET = {"LP_NUM_THREADS": "0"}
FPS = 20  # frames a second while a show is not held
SOME = 10  # frames, from which one sees that a program goes on
CUT = 5.0  # seconds
BACK = 30.0  # seconds until TCP, and whoever uses it, is back after a cut
RIGHT_AGAIN = 15.0  # seconds from a node's start until the wall is right; about 1 where the machine does nothing else
NOTICED = 5.0  # seconds until all see that a machine was revoked, or has ended
STAYS_OUT = 3.0  # seconds in which a node that was revoked tries to come back
CLOSED = 10.0  # seconds; a stranger is sent away after 5
UNKNOWN = "does not know this machine's key"  # what a machine is told that has not joined, or was revoked
LIMITED, LIMITED_FRAMES = 3.0, 10  # seconds with a slow link, and what is drawn in them at least
CODED = 20.0  # seconds until what goes over it is coded, on a machine that is busy


@dataclasses.dataclass(frozen=True)
class Stranger:
    """Who comes to a port, what it does there, and words of what it is told; "": it is told nothing, None: anything."""

    name: str
    port: tuple[str, int]
    comes: Callable[[socket.socket], bytes]
    told: str | None = ""


def say(connection: socket.socket, words: bytes) -> bytes:
    if words:
        connection.sendall(words)
    return strangers.read_to_end(connection)


def say_in_tls(connection: socket.socket, key: Path | None, words: bytes) -> bytes:
    with strangers.speak_tls(connection, key) as tls:
        return say(tls, words)


def speak_older_tls(key: Path, connection: socket.socket) -> bytes:
    try:
        strangers.speak_tls(connection, key, ssl.TLSVersion.TLSv1_2).close()
    except ssl.SSLError as refused:
        return str(refused.reason).encode()
    return b"they speak TLS 1.2"


class Machines(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.wall = cls.enterClassContext(MachineWall(TILES, TILE, clients=["desk"], guests=["guest"],
                                                     gpus={"node-2": 2}, environment=QUIET))
        one = cls.enterClassContext(Wall(TILES, TILE, one_node=True, environment=QUIET, die_with_parent=True))
        cls.one_machine = OneMachine(one, cls.x)

    def run(self, result: unittest.TestResult | None = None) -> unittest.TestResult | None:
        """As it is; of a test that fails, what the wall's programs have said meanwhile is printed."""
        begin = {name: len(self.wall.log(name)) for name in self.wall.daemons}
        bad = len(result.failures) + len(result.errors) if result else 0
        out = super().run(result)
        if result and len(result.failures) + len(result.errors) > bad:
            for name in self.wall.daemons:
                print(f"--- {name}:\n{self.wall.log(name)[begin.get(name, 0):]}", file=sys.stderr, flush=True)
        return out

    # ---- what the tests do and look at ----

    def show(self, client: str = "desk") -> Show:
        show = Show(self.wall, functools.partial(self.wall.run_at, client), self.x, FPS)
        self.addCleanup(show.end)
        return show

    def is_same(self, show: Show) -> Verdict:
        return same(self.one_machine.picture(show.frames), show.picture())

    def assert_same(self, show: Show) -> None:
        verdict = self.is_same(show)
        self.assertTrue(verdict.good, f"frames {show.frames}: {verdict}")

    def assert_becomes_same(self, show: Show, limit: float = RIGHT_AGAIN) -> float:
        """With the frames to come; gives how long it took. It is held then."""
        begin = time.monotonic()
        while True:
            show.hold()
            took = time.monotonic() - begin
            if (verdict := self.is_same(show)).good:
                break
            self.assertLess(took, limit, f"frames {show.frames}: {verdict}")
            show.go_on()
            time.sleep(SETTLED)
        for app in show.apps:
            self.assertIsNone(app.poll(), "the program runs on")
        self.assertEqual([s["fault"] for s in self.wall.sessions()], [""] * len(self.wall.sessions()))
        return took

    def assert_goes_on(self, show: Show, limit: float = NOTICED) -> float:
        """With at least some frames from now on; gives how long these took."""
        begin, first = time.monotonic(), show.clock.frame_now()
        show.go_on()
        until(lambda: show.clock.frame_now() >= first + SOME, "the program goes on", limit)
        return time.monotonic() - begin

    def is_up(self, node: str) -> bool:
        """With all of its GPUs."""
        return all(n["up"] for n in self.wall.nodes() if n["process"] == node)

    def streams_from(self, host: str) -> list[str]:
        """Connections of a host to nodes."""
        printed = self.wall.hosts.run(host, ["ss", "-Htn", "state", "established", "dport", "=", f":{DATA_PORT}"],
                                      check=True).stdout
        return printed.splitlines()

    # ---- programs of another machine ----

    def test_a_program_of_another_machine_is_drawn_as_on_one_machine(self) -> None:
        show = self.show()
        self.assert_same(show)
        show.step(3)
        self.assert_same(show)
        picture = show.picture()
        self.assertGreater(len(numpy.unique(picture.reshape(-1, 3), axis=0)), 50, "a picture of many colours")
        for tile in self.wall.tile_names:
            column, row = map(int, tile.split("-"))
            part = picture[row * TILE[1]:(row + 1) * TILE[1], column * TILE[0]:(column + 1) * TILE[0]]
            self.assertGreater(int(part.max()), 0, f"tile {tile} shows something")
        self.assertGreaterEqual(len(self.streams_from("desk")), TILES[0], "it has a stream to each node")

    def test_its_owner_is_told_with_the_machine(self) -> None:
        show = self.show()
        owners = {s["id"]: s["owner"]["name"] for s in self.wall.sessions()}
        self.assertEqual({owners[session] for session in show.sessions}, {"root@desk"})
        me = self.wall.ctl_at("desk", "whoami")
        self.assertEqual((me["name"], me["role"]), ("root@desk", "user"))
        self.wall.ctl_at("desk", "raise", show.clock.session)
        with self.assertRaisesRegex(WallError, "may not"):
            self.wall.ctl_at("desk", "machines")

    def test_the_machines_are_listed(self) -> None:
        self.show()  # who has no connection is away
        listed = {(m["kind"], m["name"]): m for m in self.wall.machines()}
        self.assertEqual(set(listed), {("client", "desk"), *(("node", name) for name in self.wall.node_names)})
        self.assertTrue(all(m["up"] for m in listed.values()), listed)
        self.assertEqual(len({m["key"] for m in listed.values()}), len(listed), "each has a key of its own")
        for name in (WALLD, "desk", *self.wall.node_names):
            mode = (self.wall.state_of(name) / "key.pem").stat().st_mode
            self.assertEqual(mode & 0o077, 0, f"only its owner reads the key of {name}")

    # ---- what is started again ----

    def test_a_node_that_was_killed_comes_back_with_its_folder_alone(self) -> None:
        show = self.show()
        show.go_on()
        self.wall.kill_node("node-1")
        until(lambda: not self.is_up("node-1"), "walld notices", NOTICED)
        self.assert_goes_on(show)
        self.wall.start_node("node-1")
        until(lambda: self.is_up("node-1"), "node-1 is back", RIGHT_AGAIN)
        print(f"right {self.assert_becomes_same(show):.1f} s after the node came back", flush=True)

    def test_an_agent_that_was_killed_comes_back_with_its_folder_alone(self) -> None:
        self.wall.daemons["desk"].kill()
        self.wall.daemons["desk"].wait()
        self.wall.start_agent("desk")
        self.assert_same(self.show())

    def test_programs_whose_agent_was_killed_go_on_as_the_same_sessions(self) -> None:
        show = self.show()
        self.wall.ctl("place", show.clock.session, 0, 30, 600, 120)
        self.wall.ctl("weight", show.clock.session, 30)
        show.step()
        before, picture = self.wall.sessions(), show.picture()
        self.wall.daemons["desk"].kill()
        self.wall.daemons["desk"].wait()
        time.sleep(SETTLED)
        self.assertTrue(same(picture, show.picture()).good, "what they have drawn stays in sight")
        self.wall.start_agent("desk")
        until(lambda: show.sessions <= {s["id"] for s in self.wall.sessions() if s["surfaces"]},
              "the programs are back", RIGHT_AGAIN)
        self.assert_goes_on(show)
        kept = ("id", "owner", "held", "weight")
        self.assertEqual([[s[key] for key in kept] for s in self.wall.sessions()],
                         [[{**s, "held": False}[key] for key in kept] for s in before])
        self.assertEqual([s["surfaces"][0]["rect"] for s in self.wall.sessions()],
                         [s["surfaces"][0]["rect"] for s in before])

    def test_programs_that_end_are_gone_at_once(self) -> None:
        show = self.show()
        for app in show.apps:
            app.kill()
        until(lambda: not self.wall.sessions(), "nobody waits for them", 1.0)

    def test_walld_is_killed_and_started_again(self) -> None:
        show = self.show()
        self.wall.restart_walld()
        until(lambda: show.sessions <= {s["id"] for s in self.wall.sessions() if s["surfaces"]},
              "the programs are back", RIGHT_AGAIN)
        self.assert_goes_on(show)
        self.assert_becomes_same(show)

    # ---- links ----

    def cut(self, host: str, show: Show) -> int:
        """For some seconds; gives how many frames were shown meanwhile."""
        first = show.clock.frame_now()
        self.wall.hosts.cut(host)
        try:
            time.sleep(CUT)
            return show.clock.frame_now() - first
        finally:
            self.wall.hosts.mend(host)

    def assert_are_back(self, show: Show) -> None:
        """Walld hears of the programs."""
        until(lambda: show.sessions <= {s["id"] for s in self.wall.sessions() if s["surfaces"] and not s["silent"]},
              "walld hears of the programs", BACK)

    def assert_comes_back(self, host: str, show: Show) -> None:
        mended = time.monotonic()
        self.assert_are_back(show)
        self.assert_goes_on(show, BACK)
        went_on = time.monotonic() - mended
        self.assert_becomes_same(show, BACK - went_on)
        print(f"{host}: the program went on {went_on:.1f} s after the cut, all was right after "
              f"{time.monotonic() - mended:.1f} s", flush=True)
        self.assert_goes_on(show)
        self.assert_becomes_same(show)

    def test_the_link_of_a_client_host_is_cut(self) -> None:
        show = self.show()
        show.go_on()
        self.cut("desk", show)
        self.assert_comes_back("desk", show)
        self.assertEqual(self.wall.ctl_at("desk", "whoami")["name"], "root@desk")

    def test_walld_hears_of_programs_soon_after_a_cut(self) -> None:
        """TCP, whose pauses double, may have asked just before a cut ends, and be silent then for as long again."""
        show = self.show()
        times = []
        for seconds in (3.8, 4.2, 4.6):
            self.wall.hosts.cut("desk")
            time.sleep(seconds)
            self.wall.hosts.mend("desk")
            mended = time.monotonic()
            self.assert_are_back(show)
            times.append(time.monotonic() - mended)
        for session in show.sessions:  # while walld may wait for it anew: what people ask for is done when it is back
            self.wall.hold(session, on=False)
            self.wall.hold(session)
        print(f"walld heard of the programs {', '.join(f'{t:.1f}' for t in times)} s after cuts", flush=True)
        self.assertLess(max(times), 1.5)
        self.assert_becomes_same(show)

    def test_the_link_of_a_node_is_cut(self) -> None:
        show = self.show()
        show.go_on()
        self.assertGreater(self.cut("node-1", show), SOME, "the others go on meanwhile")
        self.assert_comes_back("node-1", show)

    def test_a_program_runs_on_over_a_slow_link(self) -> None:
        whole = (0, 0, TILES[0] * TILE[0], TILES[1] * TILE[1])
        app = self.wall.run_at("desk", PROGRAMS / "frame_clock", "--size", f"{whole[2]}x{whole[3]}", "--vertices",
                               "20000", rect=whole, env=self.x.environment())
        self.addCleanup(end_all, [app])
        session = self.wall.wait_session(app)
        self.wall.wait(session, 3)
        self.wall.hosts.limit("desk", "100mbit")
        try:
            first = self.wall.sessions()[0]["surfaces"][0]["frame"]
            time.sleep(LIMITED)
            drawn = self.wall.sessions()[0]["surfaces"][0]["frame"] - first
            self.assertGreater(drawn, LIMITED_FRAMES)

            def is_coded() -> bool:
                traffic = self.wall.sessions()[0]["traffic"]
                packed = sum(traffic[f"{kind}_bytes_per_second"] for kind in ("state", "object", "geometry"))
                link = traffic["link_bytes_per_second"]
                print(f"{packed / 1e6:.1f} MB/s as {link / 1e6:.1f} over 100 Mbit/s", flush=True)
                time.sleep(1)
                return link < 0.5 * packed
            until(is_coded, "what a slow link holds up is coded", CODED)
            self.wall.hold(session)
            until(self.one_frame_is_shown, "all tiles show the same frame", NOTICED)
        finally:
            self.wall.hosts.unlimit("desk")
        self.assertIsNone(app.poll())
        end_all([app])
        until(lambda: not self.wall.sessions(), "the program leaves the wall", NOTICED)

    def bandwidths(self) -> dict[str, tuple[str, float]]:
        """Of the nodes from the client host, as the doctor says: the verdict and MB a second."""
        found = self.wall.ctl_at("desk", "doctor", "--bandwidth", any_exit=True)
        return {f["check"]: (f["verdict"], float(f["detail"].split(" MB/s")[0])) for f in found
                if f["check"].startswith("bandwidth")}

    def test_the_doctor_measures_the_way_to_each_node(self) -> None:
        good = self.bandwidths()
        self.assertEqual(set(good), {f"bandwidth to node {n['name']}" for n in self.wall.nodes()})
        self.wall.hosts.limit("node-1", "100mbit")
        try:
            found = self.bandwidths()
        finally:
            self.wall.hosts.unlimit("node-1")
        verdict, speed = found.pop("bandwidth to node node-1")
        self.assertEqual(verdict, "note")
        self.assertTrue(6 < speed <= 13, f"{speed} MB/s over 12.5 MB/s")
        self.assertTrue(all(other > 2 * speed for _, other in found.values()), found)
        self.assertEqual(self.wall.sessions(), [], "the doctor has left")

    def one_frame_is_shown(self) -> bool:
        picture = cv2.imdecode(numpy.frombuffer(self.wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)
        return len(numpy.unique(picture.reshape(-1, 3), axis=0)) == 1 and picture[0, 0, 0] == 255

    # ---- machines that are sent away ----

    def test_a_client_host_that_was_revoked_is_cut_off_and_no_other(self) -> None:
        self.addCleanup(self.wall.remove_client, "guest")
        self.wall.join_client("guest")
        theirs, ours = self.show("guest"), self.show("desk")
        self.assertEqual({s["owner"]["name"] for s in self.wall.sessions()}, {"root@guest", "root@desk"})
        self.assertTrue(self.streams_from("guest"))
        self.wall.revoke("client", "guest")
        until(lambda: {s["id"] for s in self.wall.sessions()} == ours.sessions, "its programs are gone", NOTICED)
        until(lambda: not self.streams_from("guest"), "its streams are gone", NOTICED)
        for attempt in (["status"], ["screenshot", self.folder / "none.png"]):
            with self.assertRaisesRegex(WallError, UNKNOWN):
                self.wall.ctl_at("guest", *attempt)
        refused = self.wall.run_at("guest", "true", stderr=subprocess.PIPE, text=True)
        self.assertIn(UNKNOWN, refused.communicate(timeout=20)[1])
        self.assertEqual(refused.returncode, 2, "wallrun starts nothing")
        self.assertNotIn("guest", [m["name"] for m in self.wall.machines()])
        ours.step()
        self.assert_same(ours)
        end_all(theirs.apps)

    def test_a_node_that_was_revoked_is_let_in_when_it_joins_anew(self) -> None:
        node = "node-2"
        show = self.show()
        show.go_on()
        before = {m["name"]: m["key"] for m in self.wall.machines()}
        self.addCleanup(self.bring_back, node)
        self.wall.revoke("node", node)
        until(lambda: not self.is_up(node), "its link ends", NOTICED)
        self.assert_stays_out(node)
        self.assertIn(UNKNOWN, self.wall.log(node))
        end_all([self.wall.daemons[node]])
        self.wall.start_node(node)
        self.assert_stays_out(node)
        self.assert_goes_on(show)
        end_all([self.wall.daemons[node]])
        self.wall.join_node(node)
        self.wall.start_node(node)
        until(lambda: self.is_up(node), "it is let in", RIGHT_AGAIN)
        self.assert_becomes_same(show)
        self.assertEqual({m["name"]: m["key"] for m in self.wall.machines()}, before, "it has kept its key")

    def assert_stays_out(self, node: str) -> None:
        end = time.monotonic() + STAYS_OUT
        while time.monotonic() < end:
            self.assertFalse(any(n["up"] for n in self.wall.nodes() if n["process"] == node),
                             f"{node} is let in without having joined anew")
            time.sleep(0.1)

    def bring_back(self, node: str) -> None:
        """For the tests to come."""
        if not self.is_up(node):
            end_all([self.wall.daemons[node]])
            self.wall.start_node(node, self.wall.invite("node", node))
            self.wall.wait_nodes()

    def test_a_join_line_is_good_once_and_for_one_wall(self) -> None:
        line = self.wall.invite("client", "guest")
        address, fingerprint, secret = line.rsplit(".", 2)
        other_key, other_secret = (base64.urlsafe_b64encode(os.urandom(n)).decode().rstrip("=") for n in (32, 16))
        in_vain = {  # (program, line): what it is told
            ("wallagent", f"{address}.{other_key}.{secret}"): "another machine answers there",
            ("wallagent", f"{address}.{fingerprint}.{other_secret}"): "join line is used up",
            ("tileserver", line): "not for a node",
            ("wallagent", self.wall.invite("node", "node-0")): "not for a client host",
            ("wallagent", line[:-1]): "not a line of",
        }
        for (program, bad), told in in_vain.items():
            with self.subTest(program=program, told=told):
                self.assertIn(told, self.wall.join_in_vain("guest", program, bad))
        self.addCleanup(self.wall.remove_client, "guest")
        self.wall.start_agent("guest", line)  # none of them has used it up
        self.assertEqual(self.wall.ctl_at("guest", "whoami")["name"], "root@guest")
        self.assertIn("join line is used up", self.wall.join_in_vain("guest", "wallagent", line))
        self.assertTrue(all(n["up"] for n in self.wall.nodes()))
        self.assertEqual(self.wall.ctl_at("guest", "whoami")["name"], "root@guest", "and whoever has joined stays")

    # ---- strangers ----

    def strangers_at(self, name: str, port: tuple[str, int],
                     messages: dict[str, tuple[bytes, str | None]]) -> list[Stranger]:
        """Those that come to any port, and those with a key of their own who say one of `messages`."""
        key = self.stranger_key
        half = strangers.first_flight()[:40]
        hello = next(iter(messages.values()))[0]  # whoever took it from them would answer

        def with_key(words: bytes) -> Callable[[socket.socket], bytes]:
            return lambda connection: say_in_tls(connection, key, words)

        return [
            Stranger(f"{name}: plain text", port, lambda c: say(c, b"GET / HTTP/1.0\r\n\r\n")),
            Stranger(f"{name}: a hello in clear", port, lambda c: say(c, hello)),
            Stranger(f"{name}: nothing but TLS 1.2", port, functools.partial(speak_older_tls, key),
                     "ALERT_PROTOCOL_VERSION"),
            Stranger(f"{name}: no certificate", port, lambda c: say_in_tls(c, None, hello)),
            Stranger(f"{name}: silent", port, lambda c: say(c, b"")),
            Stranger(f"{name}: half a handshake's first message", port, lambda c: say(c, half)),
            Stranger(f"{name}: silent after its first message", port, self.listen_without_answer),
            Stranger(f"{name}: an unknown key, and silent", port, with_key(b""), None),
            *(Stranger(f"{name}: an unknown key, {what}", port, with_key(words), told)
              for what, (words, told) in messages.items()),
        ]

    @staticmethod
    def listen_without_answer(connection: socket.socket) -> bytes:
        """It takes the other end's part of the handshake, which says nothing, and does not go on."""
        connection.sendall(strangers.first_flight())
        strangers.read_to_end(connection)
        return b""

    def visit(self, stranger: Stranger) -> tuple[float, bytes | Exception]:
        """How long it was there, and what it was told or why that is not known."""
        begin = time.monotonic()
        try:
            with self.wall.hosts.connect("guest", stranger.port, CLOSED) as connection:
                told: bytes | Exception = stranger.comes(connection)
        except OSError as error:
            told = error
        return time.monotonic() - begin, told

    def test_strangers_are_sent_away(self) -> None:
        self.stranger_key = strangers.make_key(self.folder)
        version = strangers.constant("kStreamVersion", GENERATED)
        secret = os.urandom(16)
        visitors = [
            *self.strangers_at("walld", self.wall.control_port, {
                "a program": (strangers.client_hello(), "expected a machine that joins"),
                "a client host": (strangers.host_hello(), UNKNOWN),
                "a node": (strangers.node_hello("node-0"), UNKNOWN),
                "a secret that it has made up": (strangers.join_request(secret, True), "join line is used up"),
                "no message at all": (b"\xff" * 64, None),
            }),
            *self.strangers_at("node", self.wall.data_port("node-0"), {
                "a ticket that it has made up": (strangers.data_hello(version, 1, secret), "no valid ticket"),
                "no frame at all": (b"\xff" * 64, None),
            }),
        ]
        with concurrent.futures.ThreadPoolExecutor(len(visitors)) as together:
            for stranger, (took, told) in zip(visitors, together.map(self.visit, visitors)):
                with self.subTest(stranger.name):
                    self.assertNotIsInstance(told, Exception, f"after {took:.1f} s")
                    if stranger.told:
                        self.assertIn(stranger.told.encode(), told)
                    elif stranger.told is not None:
                        self.assertLess(len(told), 16, "no more than TLS says itself")
        self.assertEqual({m["name"] for m in self.wall.machines()}, {"desk", *self.wall.node_names})
        self.assertTrue(all(n["up"] for n in self.wall.nodes()))
        self.assert_same(self.show())


if __name__ == "__main__":
    unittest.main()
