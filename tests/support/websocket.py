# SPDX-License-Identifier: MIT
"""A WebSocket client (RFC 6455) for tests: messages of a stream of walld. It can also be rude and not read."""
from __future__ import annotations

import base64
import json
import os
import socket
import struct
from urllib.parse import urlparse


class Refused(Exception):
    def __init__(self, status: int, body: str):
        super().__init__(f"{status}: {body}")
        self.status = status


class WebSocket:
    def __init__(self, url: str, path: str = "/api/v1/stream", timeout: float = 10,
                 connected: socket.socket | None = None, **headers: str):
        """`connected`: a socket that is connected already, for what is not reached from here, or over TLS."""
        where = urlparse(url)
        self.socket = connected or socket.create_connection((where.hostname, where.port), timeout)
        self.buffer = bytearray()
        lines = [f"GET {path} HTTP/1.1", f"Host: {where.netloc}", "Upgrade: websocket", "Connection: Upgrade",
                 "Sec-WebSocket-Version: 13",
                 "Sec-WebSocket-Key: " + base64.b64encode(os.urandom(16)).decode()]
        lines += [f"{name}: {value}" for name, value in headers.items()]
        self.socket.sendall("\r\n".join(lines + ["", ""]).encode())
        while b"\r\n\r\n" not in self.buffer:
            self._more()
        head = self._take(self.buffer.index(b"\r\n\r\n") + 4)
        status = int(head.split()[1])
        if status != 101:
            self.socket.close()
            raise Refused(status, bytes(self.buffer).decode(errors="replace"))

    def __enter__(self) -> "WebSocket":
        return self

    def __exit__(self, *_) -> None:
        self.socket.close()

    def watch(self, *streams: dict) -> None:
        self.send(json.dumps({"watch": streams}))

    def send(self, text: str) -> None:
        payload, mask = text.encode(), os.urandom(4)
        length = bytes([0x80 | len(payload)]) if len(payload) < 126 else b"\xfe" + struct.pack(">H", len(payload))
        self.socket.sendall(b"\x81" + length + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(payload)))

    def message(self, timeout: float = 10) -> dict | bytes:
        """The next message: parsed text, or bytes. TimeoutError if none comes."""
        self.socket.settimeout(timeout)
        whole = bytearray()
        while True:
            first, second = self._take(2)
            size = second & 0x7F
            if size > 125:
                size = int.from_bytes(self._take(2 if size == 126 else 8), "big")
            payload = self._take(size)
            kind = first & 0x0F
            if kind == 8:
                raise ConnectionError("closed")
            if kind > 8:
                continue
            binary = kind == 2 if kind else binary
            whole += payload
            if first & 0x80:
                return bytes(whole) if binary else json.loads(whole)

    def _take(self, count: int) -> bytes:
        while len(self.buffer) < count:
            self._more()
        out = bytes(self.buffer[:count])
        del self.buffer[:count]
        return out

    def _more(self) -> None:
        got = self.socket.recv(1 << 16)
        if not got:
            raise ConnectionError("closed")
        self.buffer += got
