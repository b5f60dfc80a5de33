#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The status page and the API from other machines: over TLS with walld's key, for people with a token
(docs/security.md, "HTTP")."""
from __future__ import annotations

import http.client
import json
import os
import ssl
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from machine_wall import WALLD  # noqa: E402
from page_client import PageClient  # noqa: E402
from show import until  # noqa: E402
from token_wall import PAGE_PORT, SECRETS, TokenWall  # noqa: E402
from wall import build_folder  # noqa: E402
from websocket import Refused, WebSocket  # noqa: E402
from xserver import XServer  # noqa: E402

SOON = 5.0  # seconds
OF_ONE, HANDSHAKE = 64, 5.0  # walld/wall/quota.h; seconds, walld/http/web_stream.h
COOKIE = "__Host-wallgl"


class FromOtherMachines(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.wall = cls.enterClassContext(TokenWall((2, 1), clients=["desk", "other"]))

    def setUp(self) -> None:
        self.browser = PageClient(self.wall, "desk")

    def bearer(self, name: str) -> dict[str, str]:
        return {"Authorization": f"Bearer {SECRETS[name]}"}

    # ---- who asks ----

    def test_the_page_is_everybodys_and_what_it_shows_is_not(self) -> None:
        status, headers, body = self.browser.ask("GET", "/")
        self.assertEqual(status, 200)
        self.assertIn(b"sign-in", body)
        self.assertIn("frame-ancestors 'none'", headers["content-security-policy"])
        self.assertEqual(self.browser.ask("GET", "/healthz")[0], 200)
        for path in ("/api/v1/status", "/api/v1/whoami", "/api/v1/snapshot.png", "/metrics", "/api/v1/nodes"):
            with self.subTest(path):
                status, _, body = self.browser.ask("GET", path)
                self.assertEqual(status, 401)
                self.assertIn("sign in with a token", json.loads(body)["error"]["message"])
        with self.assertRaises(Refused) as refused:
            self.browser.watch()
        self.assertEqual(refused.exception.status, 401)

    def test_a_token_may_what_its_role_may(self) -> None:
        for name, role, reload in (("looks", "viewer", 403), ("leads", "operator", 200)):
            _, _, body = self.browser.ask("GET", "/api/v1/whoami", **self.bearer(name))
            self.assertEqual(json.loads(body), {"kind": "token", "name": name, "role": role})
            self.assertEqual(self.browser.ask("POST", "/api/v1/reload", {}, **self.bearer(name))[0], reload)
        for wrong in ("Bearer ", "Bearer no-such-secret-as-this-one", "Basic " + SECRETS["leads"]):
            self.assertEqual(self.browser.ask("GET", "/api/v1/status", Authorization=wrong)[0], 401)

    def test_who_has_signed_in_is_known_until_they_sign_out(self) -> None:
        said = self.browser.login(SECRETS["leads"])["set-cookie"]
        for word in (COOKIE, "HttpOnly", "SameSite=Strict", "Secure", "Path=/", "Max-Age=43200"):
            self.assertIn(word, said)
        self.assertEqual(json.loads(self.browser.ask("GET", "/api/v1/whoami")[2])["name"], "leads")
        self.assertEqual(self.browser.ask("POST", "/api/v1/reload", {})[0], 200)
        with self.browser.watch() as stream:
            stream.watch({"tile": "0-0", "codec": "huffyuv"})
            self.assertEqual(stream.message()["parts"][0]["tile"], "0-0")
            while not isinstance(stream.message(), bytes):  # of a frame; before it comes what it is coded by
                pass
        cookie = self.browser.cookie
        in_plain = f"wallgl={cookie.partition('=')[2]}"
        self.assertEqual(PageClient(self.wall, "other").ask("GET", "/api/v1/whoami", Cookie=in_plain)[0], 401)
        self.assertIn("Max-Age=0", self.browser.ask("POST", "/api/v1/logout", {})[1]["set-cookie"])
        self.assertEqual(self.browser.ask("GET", "/api/v1/whoami")[0], 401)

    def test_a_page_of_another_site_may_nothing(self) -> None:
        """Though the browser sends the cookie, as it should not with SameSite."""
        self.browser.login(SECRETS["leads"])
        for foreign in ({"Origin": "https://elsewhere.example"}, {"Sec_Fetch_Site": "cross-site"},
                        {"Origin": self.browser.origin.replace("https", "http")}):
            for path in ("/api/v1/reload", "/api/v1/login", "/api/v1/logout"):
                self.assertEqual(self.browser.ask("POST", path, {"token": SECRETS["looks"]}, **foreign)[0], 403, path)
        self.assertEqual(self.browser.ask("POST", "/api/v1/login", {"token": "x"}, Content_Type="text/plain")[0], 415)
        self.assertEqual(self.browser.ask("POST", "/api/v1/reload", {}, Origin=self.browser.origin)[0], 200)
        with self.assertRaises(Refused) as refused:
            self.browser.watch(Origin="https://elsewhere.example")
        self.assertEqual(refused.exception.status, 403)
        self.assertEqual(self.browser.ask("GET", "/api/v1/whoami")[0], 200, "nobody has signed us out")

    def test_whoever_guesses_waits(self) -> None:
        begin = time.monotonic()
        status, headers, _ = self.browser.ask("POST", "/api/v1/login", {"token": "a-guess-of-some-length"})
        self.assertEqual(status, 401)
        self.assertNotIn("set-cookie", headers)
        self.assertGreater(time.monotonic() - begin, 0.9)
        for wrong in ({}, {"token": ""}, {"token": 3}, []):
            self.assertEqual(self.browser.ask("POST", "/api/v1/login", wrong)[0], 400)

    def test_on_this_machine_the_kernel_says_who_asks(self) -> None:
        """As before, and signing in works there, too."""
        port = int(self.wall.url.rsplit(":", 1)[1].strip("/"))
        address = ("127.0.0.1", port)

        def ask(method: str, path: str, body: object = None, cookie: str = "") -> http.client.HTTPResponse:
            connection = http.client.HTTPConnection(*address)
            connection.sock = self.wall.hosts.connect(WALLD, address)
            self.addCleanup(connection.close)
            headers = {"Content-Type": "application/json", **({"Cookie": cookie} if cookie else {})}
            connection.request(method, path, None if body is None else json.dumps(body), headers)
            return connection.getresponse()
        before = json.loads(ask("GET", "/api/v1/whoami").read())
        self.assertNotEqual(before["kind"], "token")
        answer = ask("POST", "/api/v1/login", {"token": SECRETS["looks"]})
        said = answer.getheader("Set-Cookie")
        self.assertTrue(said.startswith("wallgl="))
        self.assertNotIn("Secure", said)
        self.assertEqual(json.loads(ask("GET", "/api/v1/whoami", cookie=said.split(";")[0]).read())["name"], "looks")

    # ---- who may no more ----

    def watching(self) -> WebSocket:
        stream = self.enterContext(self.browser.watch())
        stream.watch({"tile": "0-0", "codec": "huffyuv"})
        stream.message()
        return stream

    def assert_ends(self, stream: WebSocket) -> None:
        begin = time.monotonic()
        with self.assertRaises(ConnectionError):
            while time.monotonic() < begin + SOON:
                stream.message(SOON)
        self.assertLess(time.monotonic() - begin, SOON)

    def test_who_signs_out_watches_no_more(self) -> None:
        self.browser.login(SECRETS["looks"])
        stream = self.watching()
        self.browser.ask("POST", "/api/v1/logout", {})
        self.assert_ends(stream)

    def test_a_token_that_was_revoked_is_good_for_nothing(self) -> None:
        self.browser.login(SECRETS["guest"])
        stream = self.watching()
        app = self.wall.run_at("desk", build_folder() / "tests" / "frame_clock", "--fps", "20",
                               env=self.x.environment(WALLGL_TOKEN_FILE=str(self.wall.folder / "guest")))
        session = self.wall.wait_session(app)
        self.assertEqual(next(t for t in self.wall.ctl("token", "list") if t["name"] == "guest"),
                         {"name": "guest", "role": "user", "revoked": False, "programs": 1})
        self.assertEqual(self.wall.ctl("token", "revoke", "guest"), {"ended": 1})
        self.assert_ends(stream)
        until(lambda: session not in [s["id"] for s in self.wall.sessions()], "its program is gone", SOON)
        for _ in range(2):
            status, _, body = self.browser.ask("GET", "/api/v1/whoami")
            self.assertEqual(status, 401, "the cookie")
            status, _, body = self.browser.ask("GET", "/api/v1/whoami", **self.bearer("guest"))
            self.assertEqual(status, 401)
            self.assertIn("token guest was revoked", json.loads(body)["error"]["message"])
            self.assertEqual(self.browser.ask("POST", "/api/v1/login", {"token": SECRETS["guest"]})[0], 401)
            self.wall.restart_walld()
        self.assertEqual(self.browser.ask("GET", "/api/v1/whoami", **self.bearer("looks"))[0], 200)
        file = self.wall.folder / "guest"
        file.write_text("another-secret-of-the-guest")
        self.wall.ctl("reload")
        self.assertFalse(next(t for t in self.wall.ctl("token", "list") if t["name"] == "guest")["revoked"])
        self.assertEqual(self.browser.ask("GET", "/api/v1/whoami", **self.bearer("guest"))[0], 401)
        self.assertEqual(self.browser.ask("GET", "/api/v1/whoami",
                                          Authorization="Bearer another-secret-of-the-guest")[0], 200)

    # ---- the connection ----

    def test_the_certificate_is_the_one_that_wallctl_shows_also_of_the_next_walld(self) -> None:
        page = self.wall.ctl("status")["page"]
        self.assertEqual(page["certificate"], self.browser.certificate())
        self.assertIn(self.browser.origin + "/", page["urls"])
        self.browser.login(SECRETS["looks"])
        self.wall.restart_walld()
        self.assertEqual(page["certificate"], self.browser.certificate())
        self.assertEqual(self.browser.ask("GET", "/api/v1/whoami")[0], 401, "who had signed in does so again")

    def test_nothing_is_said_in_plain_or_over_old_tls(self) -> None:
        with self.wall.hosts.connect("desk", self.browser.address) as plain:
            plain.sendall(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n")
            self.assertNotIn(b"HTTP", plain.recv(4096))
        with self.assertRaises((ssl.SSLError, ConnectionError)):
            self.browser.connect(ssl.TLSVersion.TLSv1_2)

    def test_who_stalls_or_comes_too_often_keeps_nobody_else_out(self) -> None:
        begin = time.monotonic()
        stalled = [self.wall.hosts.connect("desk", self.browser.address) for _ in range(OF_ONE)]
        try:
            one_too_many = self.wall.hosts.connect("desk", self.browser.address)
            one_too_many.settimeout(2)
            self.assertEqual(one_too_many.recv(1), b"", "turned away at once")
            one_too_many.close()
            self.assertEqual(PageClient(self.wall, "other").ask("GET", "/healthz")[0], 200, "another machine is served")
            for each in stalled:
                each.settimeout(HANDSHAKE + 3)
                self.assertEqual(each.recv(1), b"")
            self.assertLess(time.monotonic() - begin, HANDSHAKE + 3)
        finally:
            for each in stalled:
                each.close()
        self.assertEqual(self.browser.ask("GET", "/healthz")[0], 200)


class WithoutAKey(unittest.TestCase):
    def test_walld_does_not_listen(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "wall.toml")
            file.write_text(f'[control]\nlisten = ["unix:{folder}/s"]\n[http]\nlisten = ["10.77.0.1:{PAGE_PORT}"]\n'
                            f'[[node]]\nname = "n"\n[[node.tile]]\nname = "t"\nrect = [0, 0, 1, 1]\n')
            done = subprocess.run([build_folder() / "bin" / "walld", "--config", file], capture_output=True, text=True,
                                  timeout=20, env={k: v for k, v in os.environ.items() if k != "STATE_DIRECTORY"})
            self.assertEqual(done.returncode, 1)
            self.assertIn("there is no key to know them by", done.stderr)


if __name__ == "__main__":
    unittest.main()
