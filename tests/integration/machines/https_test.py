#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The status page and the API from other machines: over TLS with walld's key, for people with a token
(docs/security.md, "HTTP")."""
from __future__ import annotations

import contextlib
import hashlib
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
from token_wall import PAGE_PORT, SECRETS, TokenWall  # noqa: E402
from wall import build_folder  # noqa: E402
from websocket import Refused, WebSocket  # noqa: E402

OF_ONE, HANDSHAKE = 64, 5.0  # walld/wall/quota.h; seconds, walld/http/web_stream.h
COOKIE = "__Host-wallgl"


class Browser:
    """What a program on another machine asks, over one connection for each request."""

    def __init__(self, wall: TokenWall, host: str):
        self.wall, self.host, self.cookie = wall, host, ""
        self.address, self.origin = wall.page_address, wall.page_url

    def connect(self, version: ssl.TLSVersion = ssl.TLSVersion.TLSv1_3) -> ssl.SSLSocket:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE  # its key is compared, see certificate()
        context.minimum_version = context.maximum_version = version
        return context.wrap_socket(self.wall.hosts.connect(self.host, self.address))

    def certificate(self) -> str:
        with self.connect() as connected:
            digest = hashlib.sha256(connected.getpeercert(binary_form=True)).hexdigest().upper()
        return ":".join(digest[i:i + 2] for i in range(0, len(digest), 2))

    def headers(self) -> dict[str, str]:
        return {"Cookie": self.cookie} if self.cookie else {}

    def ask(self, method: str, path: str, body: object = None, **headers: str) -> tuple[int, dict[str, str], bytes]:
        """Status, headers by their lower names, body."""
        asked = self.headers() | {name.replace("_", "-"): value for name, value in headers.items()}
        text = None if body is None else json.dumps(body)
        if text is not None:
            asked.setdefault("Content-Type", "application/json")
        with contextlib.closing(http.client.HTTPConnection(*self.address)) as connection:
            connection.sock = self.connect()
            connection.request(method, path, text, asked)
            answer = connection.getresponse()
            return answer.status, {k.lower(): v for k, v in answer.getheaders()}, answer.read()

    def login(self, secret: str) -> dict[str, str]:
        status, headers, body = self.ask("POST", "/api/v1/login", {"token": secret})
        if status != 200:
            raise AssertionError(f"{status}: {body}")
        self.cookie = headers["set-cookie"].split(";")[0]
        return headers

    def watch(self, **headers: str) -> WebSocket:
        return WebSocket(self.origin, connected=self.connect(), **(self.headers() | headers))


class FromOtherMachines(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.wall = cls.enterClassContext(TokenWall((2, 1), clients=["desk", "other"]))

    def setUp(self) -> None:
        self.browser = Browser(self.wall, "desk")

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
        self.assertEqual(Browser(self.wall, "other").ask("GET", "/api/v1/whoami", Cookie=in_plain)[0], 401)
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
            self.assertEqual(Browser(self.wall, "other").ask("GET", "/healthz")[0], 200, "another machine is served")
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
