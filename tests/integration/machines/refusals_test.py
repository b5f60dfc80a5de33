#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Everybody who may not, at every door of a wall: control, data, HTTP, WebSocket, page and metrics of other machines,
and those of this one. Each is told no or nothing at all, is one line of a log, and changes nothing for the others.

What is over only with time (a join line of 15 minutes, a cookie of 12 hours) has its tests with a clock of their own:
tests/unit/walld/control/machines_test.cpp, tests/unit/walld/http/logins_test.cpp."""
from __future__ import annotations

import collections
import concurrent.futures
import contextlib
import dataclasses
import functools
import json
import os
import re
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
import strangers  # noqa: E402
from machine_wall import CONTROL_PORT, WALLD  # noqa: E402
from page_client import PageClient  # noqa: E402
from show import PROGRAMS, until  # noqa: E402
from token_wall import SECRETS, TokenWall  # noqa: E402
from wall import build_folder  # noqa: E402
from websocket import Refused  # noqa: E402
from xserver import XServer  # noqa: E402

GENERATED = build_folder() / "generated" / "gen" / "glapi" / "wire.gen.h"
FLOOD = ROOT / "tests" / "support" / "flood.py"
VERSION = strangers.constant("kStreamVersion", GENERATED)
TILES, TILE = (2, 1), (200, 150)
NODE = "node-0"
PATIENCE = 10.0  # seconds; whoever is silent is sent away after 5
SOON = 5.0  # seconds
FPS, MEASURED = 20, 4.0  # frames a second of the program that the others see; seconds
SLOWED = 0.9  # of its rate, at least, while somebody floods a port
FLOODED = 10_000  # connections
AT_ONCE, THEN_EACH = 20, 5.0  # lines, seconds: common/log/refusals.h
SECRET = os.urandom(16)
CLIENT_WELCOME = 10  # of proto/control.proto
WELCOME = 16  # of common/wire/frame.h
NOT_FOR_MACHINES = "expected a machine that joins"
UNKNOWN = "does not know this machine's key"


@dataclasses.dataclass(frozen=True)
class Row:
    """Who comes to which door, what they are told (words, an HTTP status, or None: nothing), and what the log of
    `daemon` says of them, once; "": nothing, since it is no refusal."""

    door: str
    who: str
    comes: Callable[[], bytes | int]
    told: str | int | None
    line: str
    daemon: str = "walld"


def say(words: bytes, connection: socket.socket) -> bytes:
    if words:
        connection.sendall(words)
    return strangers.read_to_end(connection)


class Refusals(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.folder.chmod(0o755)
        cls.wall = cls.enterClassContext(TokenWall(TILES, TILE, clients=["desk"], guests=["guest", "reader", "flooder"],
                                                   people='viewers = ["man"]\nusers = ["games"]\n'))
        cls.wall.folder.chmod(0o755)
        app = cls.wall.run_at("desk", PROGRAMS / "frame_clock", "--fps", FPS, "--size", "400x150",
                              rect=(0, 0, 400, 150), env=cls.x.environment())
        cls.app, cls.session = app, cls.wall.wait_session(app)
        cls.stranger = strangers.make_key(cls.folder)
        cls.foreign = cls.key_of_another_wall()
        cls.wall.join_client("guest")
        cls.revoked = cls.folder / "revoked.pem"
        cls.revoked.write_bytes((cls.wall.state_of("guest") / "key.pem").read_bytes())
        cls.wall.remove_client("guest")
        cls.desk = cls.wall.state_of("desk") / "key.pem"

    @classmethod
    def key_of_another_wall(cls) -> Path:
        """Of a client host that has joined it; it has lived on the guest's machine."""
        folder = cls.folder / "another"
        folder.mkdir()
        address = f"{cls.wall.hosts.address('guest')}:{CONTROL_PORT}"
        (folder / "wall.toml").write_text(
            f'[wall]\nname = "another"\nstate_directory = "{folder}/state"\n'
            f'[control]\nlisten = ["unix:{folder}/walld.sock", "{address}"]\n'
            f'[[node]]\nname = "n"\n[[node.tile]]\nname = "t"\nrect = [0, 0, 64, 48]\n')
        (folder / "state").mkdir(mode=0o700)
        walld = cls.wall.hosts.popen("guest", [cls.wall.bin / "walld", "--config", folder / "wall.toml"],
                                     stderr=subprocess.DEVNULL)
        until((folder / "walld.sock").exists, "the other walld listens", SOON)
        ctl = [cls.wall.bin / "wallctl", "--walld", f"unix:{folder}/walld.sock"]
        line = json.loads(subprocess.run([*ctl, "--json", "join-token", "client", "guest"], check=True,
                                         capture_output=True, text=True).stdout)["line"]
        cls.wall.hosts.run("guest", [*ctl, "join", line, "--state", folder / "guest"], check=True)
        walld.terminate()
        walld.wait()
        return folder / "guest" / "key.pem"

    # ---- how they come ----

    def at(self, host: str, port: tuple[str, int]) -> contextlib.closing:
        return contextlib.closing(self.wall.hosts.connect(host, port, PATIENCE))

    def in_clear(self, host: str, port: tuple[str, int], words: bytes) -> bytes:
        with self.at(host, port) as connection:
            return say(words, connection)

    def in_old_tls(self, host: str, port: tuple[str, int]) -> bytes:
        with self.at(host, port) as connection:
            try:
                strangers.speak_tls(connection, self.stranger, ssl.TLSVersion.TLSv1_2).close()
            except ssl.SSLError as refused:
                return str(refused.reason).encode()
        return b"they speak TLS 1.2"

    def in_tls(self, host: str, port: tuple[str, int], key: Path | None, words: bytes) -> bytes:
        with self.at(host, port) as connection, strangers.speak_tls(connection, key) as tls:
            return say(words, tls)

    def ask_as_desk(self, request: bytes) -> bytes:
        with self.at("desk", self.wall.control_port) as plain, strangers.speak_tls(plain, self.desk) as tls:
            tls.sendall(strangers.host_hello() + request)
            return strangers.read_control(tls)[1]

    def stalling(self, host: str, port: tuple[str, int]) -> bytes:
        """It takes the other end's part of the handshake, which says nothing, and does not go on."""
        with self.at(host, port) as connection:
            say(strangers.first_flight(), connection)
        return b""

    def over_http(self, *request: object, host: str = "guest", **headers: str) -> int:
        return PageClient(self.wall, host).ask(*request, **headers)[0]

    def watching(self, **headers: str) -> int:
        try:
            PageClient(self.wall, "guest").watch(**headers).socket.close()
        except Refused as refused:
            return refused.status
        return 101

    def here(self, user: str, *command: object) -> bytes:
        """A program of a user of walld's machine; what it has said on stdout and stderr."""
        return self.wall.hosts.run(WALLD, ["setpriv", "--reuid", user, "--regid", "nogroup", "--clear-groups",
                                           *command], text=False, stderr=subprocess.STDOUT,
                                   capture_output=False, stdout=subprocess.PIPE).stdout

    def ctl(self, user: str, *arguments: object) -> bytes:
        return self.here(user, self.wall.bin / "wallctl", "--walld", self.wall.address, *arguments)

    def curl(self, user: str, path: str, *options: str) -> int:
        return int(self.here(user, "curl", "-s", "-o", "/dev/null", "-w", "%{http_code}", "-H",
                             "Content-Type: application/json", *options, self.wall.url.rstrip("/") + path))

    # ---- the table ----

    def any_port(self, door: str, port: tuple[str, int], daemon: str, at: str) -> list[Row]:
        """Those that come to any port that other machines reach."""
        row = functools.partial(Row, door, daemon=daemon)
        line = f"refused at={at} from=\"{self.wall.hosts.address('guest')}\" reason="
        return [
            row("plain text", lambda: self.in_clear("guest", port, b"GET / HTTP/1.0\r\n\r\n"), None,
                line + ".*http request"),
            row("plain text, of the protocol",
                lambda: self.in_clear("guest", port, strangers.client_hello()), None, line + ".*(version|record)"),
            row("nothing but TLS 1.2", lambda: self.in_old_tls("guest", port), "ALERT_PROTOCOL_VERSION",
                line + ".*unsupported protocol"),
            row("stalls before the handshake", lambda: self.in_clear("guest", port, b""), None,
                line + ".*longer than 5 s"),
            row("stalls in the handshake", lambda: self.stalling("guest", port), None, line + ".*longer than 5 s"),
        ]

    def with_keys(self, door: str, port: tuple[str, int], daemon: str, at: str) -> list[Row]:
        """Where a machine's key is asked for."""
        line = f"refused at={at} from=\"{self.wall.hosts.address('guest')}\" reason="
        return [Row(door, "no key", lambda: self.in_tls("guest", port, None, strangers.client_hello()), None,
                    line + ".*certificate", daemon)]

    def control(self) -> list[Row]:
        port = self.wall.control_port
        keyed = f"refused at=control from=\"{self.wall.hosts.address('guest')} with the key [^\"]*\" reason="

        def row(who: str, key: Path, words: bytes, told: str, line: str = "") -> Row:
            return Row("control", who, lambda: self.in_tls("guest", port, key, words), told,
                       line or keyed + f".*{told}")

        keys = {"unknown key": self.stranger, "another wall's key": self.foreign, "revoked key": self.revoked}
        return [
            *self.any_port("control", port, "walld", "control"), *self.with_keys("control", port, "walld", "control"),
            *(row(f"{name}: a {kind}", key, hello, UNKNOWN) for name, key in keys.items()
              for kind, hello in (("client host", strangers.host_hello()), ("node", strangers.node_hello(NODE)))),
            row("unknown key: a program", self.stranger, strangers.client_hello(), NOT_FOR_MACHINES),
            row("unknown key: a secret that it has made up", self.stranger, strangers.join_request(SECRET, True),
                "join line is used up"),
            row("unknown key: silent", self.stranger, b"", "", keyed + ".*no first message"),
            Row("control", "a client host that says it is a node",
                lambda: self.in_tls("desk", port, self.desk, strangers.node_hello(NODE)), "has joined as client host",
                "refused at=control .*has joined as client host desk"),
            Row("control", "a client host's user with a token that is none",
                lambda: self.ask_as_desk(strangers.operator_request("status", "x" * 20)),
                "does not know that token", "refused at=control from=\"root@desk\" .*does not know that token"),
        ]

    def data(self, tickets: dict[str, tuple[int, bytes]]) -> list[Row]:
        port = self.wall.data_port(NODE)
        line = f"refused at=data from=\"{self.wall.hosts.address('guest')}\" reason="
        desk = line.replace(self.wall.hosts.address("guest"), self.wall.hosts.address("desk"))
        first, second, over = (tickets[name] for name in ("first", "second", "over"))
        hello = functools.partial(strangers.data_hello, VERSION)

        def row(who: str, host: str, key: Path, words: bytes, told: str) -> Row:
            return Row("data", who, lambda: self.in_tls(host, port, key, words), told,
                       (desk if host == "desk" else line) + f".*{told}", NODE)

        return [
            *self.any_port("data", port, NODE, "data"), *self.with_keys("data", port, NODE, "data"),
            row("a ticket that it has made up", "guest", self.stranger, hello(first[0], SECRET), "no valid ticket"),
            row("no frame at all", "guest", self.stranger, b"\xff" * 64, "frame of 4294967295 bytes"),
            row("silent", "guest", self.stranger, b"", "no hello came"),
            row("another session's ticket", "desk", self.desk, hello(first[0], second[1]), "no valid ticket"),
            row("the ticket of a session that is over", "desk", self.desk, hello(*over), "no valid ticket"),
            row("a ticket at another machine, with another wall's key", "guest", self.foreign, hello(*first),
                "no valid ticket"),
            row("a ticket with a revoked key", "guest", self.revoked, hello(*first), "no valid ticket"),
            row("another version", "desk", self.desk, strangers.data_hello(VERSION + 1, *first), "another version"),
        ]

    def http(self) -> list[Row]:
        line = f"refused at=http from=\"{self.wall.hosts.address('guest')}\" reason="
        cookie = {"Cookie": "__Host-wallgl=" + "x" * 43}
        credentials = {
            "no token": ({}, "sign in with a token"),
            "a token that is none": ({"Authorization": "Bearer no-such-secret-as-this"}, "does not know that token"),
            "a token as a password": ({"Authorization": f"Basic {SECRETS['leads']}"}, "expected 'Authorization"),
            "a revoked token": ({"Authorization": f"Bearer {SECRETS['guest']}"}, "token guest was revoked"),
            "a cookie that is none": (cookie, "sign in with a token"),
            "the cookie of who has signed out": ({"Cookie": self.signed_out}, "sign in with a token"),
        }
        doors = {"http": "/api/v1/status", "metrics": "/metrics", "picture": "/api/v1/snapshot.png"}
        reader = line.replace(self.wall.hosts.address("guest"), self.wall.hosts.address("reader"))
        asked = [Row(door, who, lambda path=path, sent=sent: self.over_http("GET", path, host="reader", **sent), 401,
                     reader + f".*{why}") for door, path in doors.items() for who, (sent, why) in credentials.items()]
        watched = [Row("websocket", who, lambda headers=headers: self.watching(**headers), 401, line + f".*{why}")
                   for who, (headers, why) in credentials.items()]
        leads = {"Authorization": f"Bearer {SECRETS['leads']}"}
        elsewhere = {**leads, "Origin": "https://elsewhere.example"}
        return [
            *self.any_port("http", self.wall.page_address, "walld", "http"), *asked, *watched,
            Row("page", "anybody", lambda: self.over_http("GET", "/"), 200, ""),
            Row("page", "anybody", lambda: self.over_http("GET", "/healthz"), 200, ""),
            Row("http", "a viewer's token, to change something",
                lambda: self.over_http("POST", "/api/v1/reload", {}, Authorization=f"Bearer {SECRETS['looks']}"), 403,
                "audit who=\"token looks\" role=viewer via=http what=reload .*result=forbidden"),
            Row("http", "a page of another site", lambda: self.over_http("POST", "/api/v1/reload", {}, **elsewhere),
                403, line + ".*may not change this wall"),
            Row("http", "a page of another site, to sign in",
                lambda: self.over_http("POST", "/api/v1/login", {"token": SECRETS["leads"]}, **elsewhere), 403,
                line + ".*may not sign in"),
            Row("http", "a wrong token, to sign in",
                lambda: self.over_http("POST", "/api/v1/login", {"token": "no-such-secret-as-this"}), 401,
                line + ".*does not know that token"),
            Row("websocket", "a page of another site", lambda: self.watching(**elsewhere), 403,
                line + ".*may not watch"),
        ]

    def to_the_agent(self, words: bytes) -> bytes:
        """A program of the client host, to its agent."""
        with socket.socket(socket.AF_UNIX) as agent:
            agent.settimeout(PATIENCE)
            agent.connect(self.wall.agent_address("desk").removeprefix("unix:"))
            return say(words, agent)

    def of_this_machine(self) -> list[Row]:
        wrong = self.folder / "wrong"
        wrong.write_text("no-such-secret-as-this")
        wrong.chmod(0o644)
        return [
            Row("control, here", "another user", lambda: self.ctl("mail", "status"), "mail may not use this wall",
                "refused at=control from=\"mail\" .*may not use this wall"),
            Row("control, here", "a viewer, to change something", lambda: self.ctl("man", "reload"), "may not reload",
                "audit who=\"man\" role=viewer via=control what=reload .*result=forbidden"),
            Row("control, here", "a user with another's program",
                lambda: self.ctl("games", "close", self.session), "it belongs to root@desk",
                "audit who=\"games\" role=user via=control what=close .*result=forbidden"),
            Row("control, here", "a token that is none", lambda: self.ctl("games", "--token-file", wrong, "status"),
                "does not know that token", "refused at=control from=\"games\" .*does not know that token"),
            Row("http, here", "another user, to change something",
                lambda: self.curl("mail", f"/api/v1/sessions/{self.session}/raise", "-X", "POST"), 403,
                "audit who=\"mail\" role=viewer via=http what=raise .*result=forbidden"),
            Row("agent", "a program that speaks as a machine",
                lambda: self.to_the_agent(strangers.host_hello()), None,
                "refused at=agent .*speaks as a machine", "desk"),
            Row("agent", "a program that tells of its end as its agent does",
                lambda: self.to_the_agent(strangers.program_ended()), None,
                "refused at=agent .*speaks as a machine", "desk"),
            Row("http, here", "under a foreign name", lambda: self.curl("mail", "/", "-H", "Host: evil.example"), 421,
                "refused at=http from=\"mail\" .*local names only"),
        ]

    # ---- the tests ----

    def tickets(self) -> dict[str, tuple[int, bytes]]:
        """Sessions of the client host and their tickets for NODE: two that are there, and one that is over."""
        out: dict[str, tuple[int, bytes]] = {}
        for name in ("first", "second", "over"):
            with contextlib.ExitStack() as stack:
                plain = stack.enter_context(self.at("desk", self.wall.control_port))
                tls = stack.enter_context(strangers.speak_tls(plain, self.desk))
                tls.sendall(strangers.host_hello() + strangers.client_hello())
                number, message = strangers.read_control(tls)
                self.assertEqual(number, CLIENT_WELCOME, message)
                welcome = strangers.fields(message)
                nodes = [dict(strangers.fields(value)) for number, value in welcome if number == 5]
                out[name] = dict(welcome)[1], next(node[3] for node in nodes if node.get(1, 0) == 0)
                if name == "over":
                    tls.sendall(strangers.program_ended())  # else its program would be awaited
                else:
                    self.addCleanup(stack.pop_all().close)
        until(lambda: out["over"][0] not in [s["id"] for s in self.wall.sessions()], "a session is over", SOON)
        return out

    def assert_good(self, ticket: tuple[int, bytes]) -> None:
        """Else nothing would follow from a ticket that is refused."""
        with self.at("desk", self.wall.data_port(NODE)) as plain, strangers.speak_tls(plain, self.desk) as tls:
            tls.sendall(strangers.data_hello(VERSION, *ticket))
            self.assertEqual(strangers.read_frame(tls)[0], WELCOME, "and no error")

    def answer(self, row: Row) -> bytes | int | Exception:
        try:
            return row.comes()
        except Exception as error:  # noqa: BLE001  told with the row
            return error

    def test_everybody_who_may_not(self) -> None:
        browser = PageClient(self.wall, "desk")
        browser.login(SECRETS["looks"])
        self.signed_out = browser.cookie
        browser.ask("POST", "/api/v1/logout", {})
        self.wall.ctl("token", "revoke", "guest")
        tickets = self.tickets()
        self.assert_good(tickets["first"])
        before = self.wall.status()["sessions"]
        for name, rows in (("control", self.control()), ("data", self.data(tickets)), ("http", self.http()),
                           ("here", self.of_this_machine())):
            self.come(name, rows)
        self.assertEqual([s["id"] for s in before], [s["id"] for s in self.wall.sessions()])
        self.assertTrue(all(n["up"] for n in self.wall.nodes()))
        self.assertIsNone(self.app.poll())

    def come(self, name: str, rows: list[Row]) -> None:
        said = {daemon: len(self.wall.log(daemon)) for daemon in self.wall.daemons}
        with concurrent.futures.ThreadPoolExecutor(len(rows)) as together:
            answers = list(together.map(self.answer, rows))
        time.sleep(0.2)  # the last lines
        lines = {daemon: self.wall.log(daemon)[at:].splitlines() for daemon, at in said.items()}
        for row, told in zip(rows, answers):
            print(f"{row.door}: {row.who}: {str(told)[:60]}", flush=True)
            with self.subTest(f"{row.door}: {row.who}"):
                if isinstance(row.told, str):
                    self.assertIsInstance(told, bytes)
                    self.assertIn(row.told.encode(), told)
                elif row.told is None:
                    self.assertIsInstance(told, bytes)
                    self.assertLess(len(told), 16, "no more than TLS says itself")
                else:
                    self.assertEqual(told, row.told)
                if row.line:
                    found = [line for line in lines[row.daemon] if re.search(row.line, line)]
                    alike = [other for other in rows if (other.line, other.daemon) == (row.line, row.daemon)]
                    self.assertEqual(len(found), len(alike), f"{row.line}\n" + "\n".join(lines[row.daemon]))
        with self.subTest(f"{name}: nothing else is refused"):
            for daemon, all_lines in lines.items():
                refused = [line for line in all_lines if " refused at=" in line]
                wanted = [row for row in rows if row.daemon == daemon and row.line.startswith("refused")]
                self.assertEqual(len(refused), len(wanted), "\n".join(refused))

    # ---- floods ----

    def frames(self, seconds: float) -> float:
        """A second, of the program that is there."""
        first, begin = self.frame(), time.monotonic()
        time.sleep(seconds)
        return (self.frame() - first) / (time.monotonic() - begin)

    def frame(self) -> int:
        return next(s["surfaces"][0]["frame"] for s in self.wall.sessions() if s["id"] == self.session)

    def test_ten_thousand_connections_slow_nobody_down(self) -> None:
        text = "{}:{}".format
        doors = {  # what is flooded, from where, whose log, and what it calls that
            "control": (text(*self.wall.control_port), "flooder", "walld", "control"),
            "data": (text(*self.wall.data_port(NODE)), "flooder", NODE, "data"),
            "https": (text(*self.wall.page_address), "flooder", "walld", "http"),
            "control, here": (self.wall.address, WALLD, "walld", "control"),
            "http, here": (self.wall.url.split("/")[2], WALLD, "walld", "http"),
        }
        before = self.frames(MEASURED)
        for name, (address, host, daemon, at) in doors.items():
            with self.subTest(name):
                said, begin = len(self.wall.log(daemon)), time.monotonic()
                first = self.frame()
                user = ["setpriv", "--reuid", "games", "--regid", "nogroup", "--clear-groups"] if host == WALLD else []
                flood = self.wall.hosts.popen(host, [*user, sys.executable, FLOOD, address, FLOODED],
                                              stdout=subprocess.PIPE, text=True)
                served = 0
                while flood.poll() is None:
                    self.assertEqual(PageClient(self.wall, "desk").ask("GET", "/healthz")[0], 200)
                    self.wall.ctl_at("desk", "whoami")
                    served += 1
                    time.sleep(0.2)
                took = time.monotonic() - begin
                rate = (self.frame() - first) / took
                result = json.loads(flood.communicate()[0])
                lines = collections.Counter(re.findall(rf"refused at={at} from=(\S+)", self.wall.log(daemon)[said:]))
                print(f"{name}: {result}, {served} others served meanwhile, {rate:.1f} of {before:.1f} frames/s, "
                      f"lines: {dict(lines)}", flush=True)
                self.assertEqual(result["connected"] + result["refused"], FLOODED)
                self.assertGreaterEqual(rate, SLOWED * before)
                self.assertTrue(lines)
                self.assertLessEqual(max(lines.values()), AT_ONCE + 1 + took / THEN_EACH)
        self.assertIsNone(self.app.poll())


if __name__ == "__main__":
    unittest.main()
