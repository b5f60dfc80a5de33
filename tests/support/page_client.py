# SPDX-License-Identifier: MIT
"""What a browser of another machine asks of walld, without a browser."""
from __future__ import annotations

import contextlib
import hashlib
import http.client
import json
import ssl

from token_wall import TokenWall
from websocket import WebSocket


class PageClient:
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
