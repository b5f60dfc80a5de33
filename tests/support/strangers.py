# SPDX-License-Identifier: MIT
"""Who comes to a port that other machines reach and does not belong to the wall: the keys that they make, and the few
messages of the protocols (proto/control.proto, common/wire/frame.h) that they say, written without any of our code."""
from __future__ import annotations

import re
import socket
import ssl
import struct
import subprocess
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
LIMITS = REPOSITORY / "common" / "wire" / "limits.h"
FRAME_HELLO = 1  # FrameKind::hello


def make_key(folder: Path, name: str = "stranger") -> Path:
    """A PEM file with a new key, and with a certificate that it has signed itself."""
    key, certificate, both = (folder / f"{name}{suffix}" for suffix in (".key", ".crt", ".pem"))
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes",
                    "-days", "1", "-subj", f"/CN={name}", "-keyout", key, "-out", certificate],
                   check=True, capture_output=True, timeout=60)
    both.write_text(key.read_text() + certificate.read_text())
    return both


def speak_tls(plain: socket.socket, key: Path | None, version: ssl.TLSVersion = ssl.TLSVersion.TLSv1_3,
              ) -> ssl.SSLSocket:
    """TLS of exactly that version with whoever is there; `key` is what make_key() has made."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    context.minimum_version = context.maximum_version = version
    if key is not None:
        context.load_cert_chain(key)
    return context.wrap_socket(plain)


def first_flight() -> bytes:
    """What a client of TLS says first, before anybody has answered."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    said = ssl.MemoryBIO()
    try:
        context.wrap_bio(ssl.MemoryBIO(), said).do_handshake()
    except ssl.SSLWantReadError:
        pass
    return said.read()


def read_to_end(connection: socket.socket) -> bytes:
    """All that comes until the other end closes; TimeoutError if it is silent for the socket's timeout."""
    answer = b""
    try:
        while portion := connection.recv(1 << 16):
            answer += portion
    except TimeoutError:
        raise
    except OSError:
        pass  # an alert of TLS, or a reset: closed all the same
    return answer


# ---- messages ----

def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 0x7f:
        out.append(value & 0x7f | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def field(number: int, value: int | bytes | str) -> bytes:
    """A field of a Protobuf message: a number, or bytes (a text, a message)."""
    if isinstance(value, int):
        return _varint(number << 3) + _varint(value)
    content = value.encode() if isinstance(value, str) else value
    return _varint(number << 3 | 2) + _varint(len(content)) + content


def constant(name: str, header: Path = LIMITS) -> int:
    """A number of one of our headers."""
    found = re.search(rf"\b{name} =\s*(0x[0-9a-f]+|\d+)\s*;", header.read_text())
    if not found:
        raise LookupError(f"{header} has no {name}")
    return int(found[1], 0)


def _control(number: int, message: bytes) -> bytes:
    envelope = field(number, message)
    return struct.pack("<I", len(envelope)) + envelope


def client_hello() -> bytes:
    return _control(1, field(1, constant("kProtocolVersion")) + field(2, 4711) + field(3, "stranger"))


def node_hello(name: str) -> bytes:
    return _control(20, field(1, constant("kProtocolVersion")) + field(2, name) + field(3, "10.77.0.99:7790"))


def host_hello() -> bytes:
    return _control(62, field(1, constant("kProtocolVersion")) + field(2, 0) + field(3, "root"))


def program_ended() -> bytes:
    return _control(63, b"")


def join_request(secret: bytes, node: bool) -> bytes:
    return _control(60, field(1, constant("kProtocolVersion")) + field(2, secret) + field(3, int(node)))


def data_hello(version: int, session: int, ticket: bytes) -> bytes:
    message = field(1, version) + field(2, session) + field(3, ticket)
    return struct.pack("<IB3x", len(message), FRAME_HELLO) + message


def operator_request(verb: str, token: str = "") -> bytes:
    return _control(40, field(1, 1) + field(2, verb) + (field(4, token) if token else b""))


def fields(message: bytes) -> list[tuple[int, int | bytes]]:
    """Numbers and values of a message's fields, in their order: numbers, and bytes of whatever has a length."""
    out: list[tuple[int, int | bytes]] = []
    at = 0

    def varint() -> int:
        nonlocal at
        value = shift = 0
        while True:
            byte = message[at]
            at += 1
            value |= (byte & 0x7f) << shift
            shift += 7
            if byte < 0x80:
                return value

    while at < len(message):
        number, kind = divmod(varint(), 8)
        if kind == 0:
            out.append((number, varint()))
        elif kind == 2:
            size = varint()
            out.append((number, message[at:at + size]))
            at += size
        else:
            raise ValueError(f"field {number} of kind {kind}: expected a number or bytes")
    return out


def _exactly(connection: socket.socket, count: int) -> bytes:
    out = b""
    while len(out) < count:
        portion = connection.recv(count - len(out))
        if not portion:
            raise ConnectionError(f"closed after {len(out)} of {count} bytes")
        out += portion
    return out


def read_control(connection: socket.socket) -> tuple[int, bytes]:
    """The next message of walld: its number in Envelope, and what is in it."""
    size, = struct.unpack("<I", _exactly(connection, 4))
    (number, message), *_ = fields(_exactly(connection, size))
    return number, message


def read_frame(connection: socket.socket) -> tuple[int, bytes]:
    """The next frame of a node: its kind, and its payload."""
    size, kind = struct.unpack("<IB3x", _exactly(connection, 8))
    return kind, _exactly(connection, size)
