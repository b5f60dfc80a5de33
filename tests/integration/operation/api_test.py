# SPDX-License-Identifier: MIT
"""The HTTP API and wallctl --json against docs/openapi.yaml, and who may do what: people, tokens, limits."""
import os
import re
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import jsonschema
import yaml

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from wall import Wall, build_folder  # noqa: E402
from websocket import WebSocket  # noqa: E402
from xserver import XServer  # noqa: E402

STILL = build_folder() / "tests" / "still_windows"
API = yaml.safe_load((ROOT / "docs" / "openapi.yaml").read_text())
ASKED_FOR, CAP = 10_000, 5
VERSION = int(re.search(r"kProtocolVersion =\s+(\d+)", (ROOT / "common" / "wire" / "limits.h").read_text())[1])
# Its length, and an Envelope with ClientHello{version}.
CLIENT_HELLO = b"\x04\x00\x00\x00\x0a\x02\x08" + bytes([VERSION])
SOON = 5.0  # seconds


def check(answer: object, schema: str) -> None:
    jsonschema.Draft202012Validator({**API["components"]["schemas"][schema],
                                     "components": API["components"]}).validate(answer)


def walld_log_lines(wall: Wall, word: str) -> list[str]:
    return [line for line in wall.log("walld").splitlines() if f" {word} " in line]


class Api(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(Wall(tiles=(2, 1), tile_size=(160, 120)))

    def setUp(self) -> None:
        self.app = self.wall.run(STILL, "--close", "red", env=self.x.environment(), stdout=subprocess.DEVNULL)
        self.session = self.wall.wait_session(self.app)
        self.wall.wait(self.session, 1)
        self.addCleanup(self.end)

    def end(self) -> None:
        self.app.kill()
        self.app.wait()
        end = time.monotonic() + SOON
        while self.wall.sessions():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.02)

    def get(self, path: str) -> object:
        status, answer = self.wall.rest("GET", path)
        self.assertEqual(status, 200, answer)
        return answer

    def without_traffic(self) -> list[dict]:
        """All sessions, but for what goes on by itself."""
        return [{key: value for key, value in session.items() if key != "traffic"}
                for session in self.get("/api/v1/sessions")]

    def refused(self, status: int, code: str, method: str, path: str, body: object = None, **options) -> str:
        got, answer = self.wall.rest(method, path, body, **options)
        self.assertEqual(got, status, answer)
        check(answer, "Error")
        self.assertEqual(answer["error"]["code"], code)
        return answer["error"]["message"]

    def test_the_description_is_well_formed(self) -> None:
        for name, schema in API["components"]["schemas"].items():
            with self.subTest(name):
                jsonschema.Draft202012Validator.check_schema(schema)
        for reference in re.findall(r'\$ref: "#/components/([^"]+)"', (ROOT / "docs" / "openapi.yaml").read_text()):
            kind, name = reference.split("/")
            self.assertIn(name, API["components"][kind])

    def test_answers_are_as_described(self) -> None:
        check(self.get("/api/v1/status"), "Status")
        check(self.get("/api/v1/whoami"), "Person")
        check(self.get(f"/api/v1/sessions/{self.session}"), "Session")
        viewer = self.enterContext(WebSocket(self.wall.url))
        viewer.watch({"wall": True, "region": [80, 0, 160, 120]}, {"session": self.session})
        viewer.message()
        for path, schema in (("nodes", "Node"), ("tiles", "Tile"), ("sessions", "Session"), ("streams", "Stream")):
            answers = self.get(f"/api/v1/{path}")
            self.assertTrue(answers)
            for answer in answers:
                check(answer, schema)

    def test_wallctl_prints_the_same(self) -> None:
        for verb, schema in (("status", "Status"), ("whoami", "Person")):
            check(self.wall.ctl(verb), schema)
        for verb, schema in (("nodes", "Node"), ("tiles", "Tile"), ("sessions", "Session"), ("streams", "Stream")):
            for answer in self.wall.ctl(verb):
                check(answer, schema)
        done = subprocess.run([self.wall.bin / "wallctl", "--walld", self.wall.address, "--json", "raise", "999"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        check(yaml.safe_load(done.stdout), "Error")

    def test_every_path_of_the_description_is_there(self) -> None:
        for path, methods in API["paths"].items():
            for method in sorted(set(methods) - {"parameters"}):
                with self.subTest(f"{method} {path}"):
                    status, answer = self.wall.rest(method.upper(),
                                                    path.replace("{id}", "999").replace("{name}", "nothing"),
                                                    {"rect": [0, 0, 10, 10]})
                    self.assertNotIn(status, (405, 415, 500))
                    self.assertTrue({str(status), "default"} & set(methods[method]["responses"]),
                                    f"{status} is not described")
                    if status == 404:
                        self.assertNotEqual(answer["error"]["message"], "not found")
        self.wall.rest("DELETE", "/api/v1/layouts/nothing", {})

    def test_every_route_is_described(self) -> None:
        routes = set(re.findall(r'\{"([A-Z]+)", "(/[^"]*)"', (ROOT / "walld" / "http" / "rest.cpp").read_text()))
        header = (ROOT / "walld" / "http" / "rest.h").read_text()
        routes |= {("POST", path) for path in re.findall(r'kLog(?:in|out) = "(/[^"]*)"', header)}
        routes |= {("GET", path) for path in re.findall(r'k\w+Path = "(/[^"]*)"', header)}
        described = {(method.upper(), re.sub(r"\{\w+\}", "*", path)) for path,
                     methods in API["paths"].items() for method in set(methods) - {"parameters"}}
        self.assertIn(("GET", "/metrics"), routes)
        self.assertIn(("DELETE", "/api/v1/layouts/*"), routes)
        self.assertEqual(routes, described)

    def test_traffic_is_told(self) -> None:
        end = time.monotonic() + SOON
        while (traffic := self.get(f"/api/v1/sessions/{self.session}")["traffic"])["geometry_bytes"] == 0:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)
        self.assertGreaterEqual(traffic["frames"], 1)
        self.assertGreater(traffic["state_bytes"], 0)
        while self.get("/api/v1/nodes")[0]["objects"]["framebuffers"] == 0:
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)

    def test_windows_are_moved_and_closed(self) -> None:
        here = f"/api/v1/sessions/{self.session}"
        for method, path, body in (("PUT", "/placement", {"rect": [100, 10, 120, 90]}), ("POST", "/raise", None),
                                   ("POST", "/lower", None),
                                   ("POST", "/hold", {"on": True}), ("POST", "/step", {"frames": 2}),
                                   ("POST", "/hold", {"on": False})):
            self.assertEqual(self.wall.rest(method, here + path, body), (200, {}), path)
        self.assertEqual(self.get(here)["surfaces"][0]["rect"], [100, 10, 120, 90])
        for method, path, schema in (("PUT", "", "Saved"), ("GET", "", "Layout"), ("POST", "/load", "Loaded")):
            status, answer = self.wall.rest(method, "/api/v1/layouts/api" + path)
            self.assertEqual(status, 200, answer)
            check(answer, schema)
        self.assertIn("api", self.get("/api/v1/layouts"))
        self.assertEqual(self.wall.rest("DELETE", "/api/v1/layouts/api"), (200, {}))
        status, closed = self.wall.rest("DELETE", here)
        self.assertEqual(status, 200)
        check(closed, "Closed")
        self.assertEqual(self.app.wait(SOON), 0)

    def test_wrong_use_is_refused_and_changes_nothing(self) -> None:
        before = self.without_traffic()
        here = f"/api/v1/sessions/{self.session}"
        self.assertIn("off the canvas", self.refused(400, "invalid", "PUT", here + "/placement",
                                                     {"rect": [320, 0, 10, 10]}))
        self.refused(400, "invalid", "PUT", here + "/placement", {"rect": [0, 0, 0, 10]})
        self.refused(400, "invalid", "PUT", here + "/placement", {"rect": [0, 0, 10]})
        self.refused(400, "invalid", "PUT", here + "/placement", {})
        self.refused(400, "invalid", "PUT", here + "/placement", [1])
        self.refused(400, "invalid", "PUT", "/api/v1/sessions/x/placement", {"rect": [0, 0, 10, 10]})
        self.refused(404, "not_found", "PUT", "/api/v1/sessions/999/placement", {"rect": [0, 0, 10, 10]})
        self.refused(404, "not_found", "PUT", here + ".99/placement", {"rect": [0, 0, 10, 10]})
        self.refused(404, "not_found", "DELETE", "/api/v1/sessions/999")
        self.refused(404, "not_found", "POST", "/api/v1/layouts/nothing/load")
        self.refused(404, "not_found", "GET", "/api/v1/elsewhere")
        self.refused(405, "invalid", "POST", "/api/v1/status")
        self.refused(400, "invalid", "PUT", "/api/v1/layouts/.hidden")
        self.assertEqual(self.without_traffic(), before)

    def test_a_page_of_another_site_changes_nothing(self) -> None:
        here = f"/api/v1/sessions/{self.session}/raise"
        self.refused(415, "invalid", "POST", here, headers={"Content-Type": "text/plain"})
        self.refused(415, "invalid", "POST", here, headers={"Content-Type": "application/x-www-form-urlencoded"})
        self.refused(403, "forbidden", "POST", here, headers={"Origin": "http://evil.example"})
        self.refused(403, "forbidden", "POST", here, headers={"Sec-Fetch-Site": "cross-site"})
        self.assertEqual(self.wall.rest("POST", here, headers={"Host": "evil.example"})[0], 421)


@unittest.skipUnless(os.geteuid() == 0, "needs other users")
class People(unittest.TestCase):
    SECRET = "a secret of more than sixteen bytes"

    @classmethod
    def setUpClass(cls) -> None:
        folder = cls.enterClassContext(tempfile.TemporaryDirectory())
        cls.token_file = Path(folder) / "kiosk"
        cls.token_file.write_text(cls.SECRET + "\n")
        cls.token_file.chmod(0o600)
        cls.x = cls.enterClassContext(XServer())
        people = ('operators = ["daemon"]\nusers = ["games", "nobody"]\nviewers = ["man"]\n'
                  f'[[people.token]]\nname = "kiosk"\nfile = "{cls.token_file}"\nrole = "user"\n')
        cls.wall = cls.enterClassContext(Wall(tiles=(1, 1), tile_size=(160, 120), people=people))
        cls.wall.folder.chmod(0o755)

    def setUp(self) -> None:
        self.app = self.start("nobody")
        self.session = self.wall.wait_session(self.app)
        self.addCleanup(self.app.communicate)
        self.addCleanup(self.app.kill)

    def start(self, user: str, **environment: str) -> subprocess.Popen:
        return subprocess.Popen(self.wall.wallrun(STILL, "--close", "red"), env=self.x.environment(**environment),
                                user=user, group="nogroup", extra_groups=[],
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def ctl(self, user: str, *arguments: object) -> subprocess.CompletedProcess:
        return subprocess.run([self.wall.bin / "wallctl", "--walld", self.wall.address, *map(str, arguments)],
                              user=user, group="nogroup", extra_groups=[], capture_output=True, text=True)

    def curl(self, user: str, method: str, path: str, *more: str) -> int:
        done = subprocess.run(["curl", "-s", "-o", "/dev/null", "-w", "%{http_code}", "-X", method, "-H",
                               "Content-Type: application/json", *more,
                               self.wall.url.rstrip("/") + path], user=user, group="nogroup", extra_groups=[],
                              capture_output=True, text=True)
        return int(done.stdout)

    def test_a_session_belongs_to_the_user_who_started_it(self) -> None:
        self.assertEqual(self.wall.sessions()[0]["owner"], {"kind": "user", "name": "nobody", "role": "user"})

    def test_nobody_joins_another_users_parallel_program(self) -> None:
        first = self.start("games", WALLGL_PARALLEL="team:0:2")
        self.addCleanup(first.communicate)
        self.addCleanup(first.kill)
        end = time.monotonic() + 20
        while not (team := [s for s in self.wall.sessions() if "group" in s]):
            self.assertLess(time.monotonic(), end)
        check(team[0], "Session")
        self.assertEqual([m["rank"] for m in team[0]["group"]["members"]], [0])
        stranger = self.start("nobody", WALLGL_PARALLEL="team:1:2")
        self.addCleanup(stranger.communicate)
        self.addCleanup(stranger.kill)
        self.assertIn("parallel program 'team' belongs to games", stranger.stderr.readline())

    def test_each_role_may_what_it_may(self) -> None:
        place = ("place", self.session, 10, 10, 50, 50)
        for user, role, may in (("nobody", "user", True), ("games", "user", False), ("man", "viewer", False),
                                ("daemon", "operator", True)):
            with self.subTest(user):
                self.assertEqual(self.ctl(user, "whoami").stdout, f"{user}, role {role}\n")
                done = self.ctl(user, *place)
                self.assertEqual(done.returncode, 0 if may else 1, done.stderr)
                self.assertEqual(self.curl(user, "POST", f"/api/v1/sessions/{self.session}/raise"), 200 if may else 403)
                self.assertEqual(self.ctl(user, "layout", "save", "x").returncode, 0 if role == "operator" else 1)
        self.assertIn("games may not place session", self.ctl("games", *place).stderr)
        self.assertIn("it belongs to nobody", self.ctl("games", *place).stderr)
        self.assertIn("needs the role user, and theirs is viewer", self.ctl("man", *place).stderr)

    def test_strangers_see_over_http_only(self) -> None:
        done = self.ctl("mail", "status")
        self.assertEqual(done.returncode, 1)
        self.assertIn("mail may not use this wall", done.stderr)
        self.assertEqual(self.curl("mail", "GET", "/api/v1/status"), 200)
        self.assertEqual(self.curl("mail", "POST", f"/api/v1/sessions/{self.session}/raise"), 403)

    def test_a_viewer_puts_no_program_on_the_wall(self) -> None:
        app = self.start("man")
        self.addCleanup(app.communicate)
        self.addCleanup(app.kill)
        self.assertIn("man may not put programs on this wall", app.stderr.readline())

    def test_only_an_operator_runs_a_node(self) -> None:
        node = self.wall.daemons["node-0-0"]
        node.kill()
        node.wait()
        (self.wall.folder / "node-0-0.sock").unlink()  # its own, in a folder where others can listen as well
        self.wall.folder.chmod(0o777)
        other = subprocess.Popen([self.wall.bin / "tileserver", "--config", self.wall.folder / "wall.toml", "--node",
                                  "node-0-0"], user="games", group="nogroup",
                                 extra_groups=[], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            end = time.monotonic() + 20
            while not any("games may not run a node" in line
                          for line in walld_log_lines(self.wall, "refused")):
                self.assertLess(time.monotonic(), end)
                time.sleep(0.05)
            self.assertFalse(self.wall.nodes()[0]["up"])
        finally:
            other.kill()
            other.wait()
            self.wall.folder.chmod(0o755)
            self.wall.start_node("node-0-0")
            self.wall.wait_nodes()

    def test_a_token_stands_for_its_name(self) -> None:
        bearer = ("-H", f"Authorization: Bearer {self.SECRET}")
        self.assertEqual(self.curl("mail", "POST", f"/api/v1/sessions/{self.session}/raise", *bearer), 403,
                         "a user's token, another's session")
        self.assertEqual(self.curl("daemon", "GET", "/api/v1/whoami", "-H", "Authorization: Bearer wrong"), 401)
        own = subprocess.Popen(self.wall.wallrun(STILL, "--close", "red"),
                               env=self.x.environment(WALLGL_TOKEN_FILE=str(self.token_file)),
                               stdout=subprocess.DEVNULL)
        self.addCleanup(own.wait)
        self.addCleanup(own.kill)
        session = self.wall.wait_session(own)
        owner = next(s["owner"] for s in self.wall.sessions() if s["id"] == session)
        self.assertEqual((owner["kind"], owner["name"]), ("token", "kiosk"))
        self.assertEqual(self.curl("mail", "POST", f"/api/v1/sessions/{session}/raise", *bearer), 200)
        self.assertEqual(self.ctl("games", "raise", session).returncode, 1)
        self.assertEqual(self.wall.ctl("--token-file", self.token_file, "whoami")["name"], "kiosk")

    def test_the_log_says_who_did_what(self) -> None:
        self.ctl("nobody", "place", self.session, 1, 2, 30, 40)
        self.ctl("games", "close", self.session)
        self.curl("daemon", "POST", f"/api/v1/sessions/{self.session}/lower")
        lines = walld_log_lines(self.wall, "audit")
        for wanted in (rf'who="nobody" role=user via=control what=place target="{self.session}" '
                       rf'arguments=\{{.*"rect":\[1,2,30,40\]\}} result=ok$',
                       rf'who="games" role=user via=control what=close target="{self.session}" .* result=forbidden '
                       rf'reason="games may not close .*"$',
                       rf'who="daemon" role=operator via=http what=lower target="{self.session}" .* result=ok$'):
            self.assertTrue(any(re.search(wanted, line) for line in lines), wanted)


class Limits(unittest.TestCase):
    def ask_for_a_session(self, address: str) -> tuple[socket.socket, bytes]:
        connection = socket.socket(socket.AF_UNIX)
        connection.settimeout(20)
        connection.connect(address.removeprefix("unix:"))
        connection.sendall(CLIENT_HELLO)
        return connection, connection.recv(1 << 16)

    def test_ten_thousand_sessions_asked_for(self) -> None:
        with Wall(tiles=(1, 1), tile_size=(64, 48), options=f"max_sessions = {CAP}") as wall:
            taken = [self.ask_for_a_session(wall.address) for _ in range(CAP)]
            before = wall.status()
            refused = 0
            for _ in range(ASKED_FOR - CAP):
                connection, answer = self.ask_for_a_session(wall.address)
                refused += b"the wall is full: 5 programs are on it ('max_sessions' in [wall] of wall.toml)" in answer
                connection.close()
            self.assertEqual(refused, ASKED_FOR - CAP)
            after = wall.status()
            self.assertEqual([s["id"] for s in after["sessions"]], [s["id"] for s in before["sessions"]])
            self.assertTrue(after["nodes"][0]["up"])
            taken[0][0].close()
            end = time.monotonic() + SOON
            while len(wall.sessions()) == CAP:
                self.assertLess(time.monotonic(), end)
            taken.append(self.ask_for_a_session(wall.address))
            self.assertNotIn(b"the wall is full", taken[-1][1], "there is room again")
            for connection, _ in taken:
                connection.close()


if __name__ == "__main__":
    unittest.main()
