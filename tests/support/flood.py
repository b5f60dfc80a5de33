#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Somebody who connects again and again and says nothing: flood.py unix:PATH|HOST:PORT COUNT → JSON on stdout,
{"connected": ..., "refused": ..., "seconds": ...}. As many connections stay open as fit OPEN."""
from __future__ import annotations

import collections
import json
import resource
import socket
import sys
import time

OPEN = 2000  # more than anybody may have, and those that wait in a queue besides
PATIENCE = 0.05  # seconds for a connection, whose queue may be full


def connect(address: str) -> socket.socket:
    if address.startswith("unix:"):
        out = socket.socket(socket.AF_UNIX)  # which waits while the queue is full
        to: object = address.removeprefix("unix:")
    else:
        out = socket.socket(socket.AF_INET)
        host, port = address.rsplit(":", 1)
        to = (host, int(port))
        out.settimeout(PATIENCE)
    try:
        out.connect(to)
    except BaseException:
        out.close()
        raise
    return out


def flood(address: str, count: int) -> dict[str, float]:
    resource.setrlimit(resource.RLIMIT_NOFILE, (OPEN + 64, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
    open_now: collections.deque[socket.socket] = collections.deque()
    begin, connected, refused = time.monotonic(), 0, 0
    for _ in range(count):
        try:
            open_now.append(connect(address))
            connected += 1
        except OSError:
            refused += 1
        if len(open_now) > OPEN:
            open_now.popleft().close()
    for each in open_now:
        each.close()
    return {"connected": connected, "refused": refused, "seconds": time.monotonic() - begin}


if __name__ == "__main__":
    print(json.dumps(flood(sys.argv[1], int(sys.argv[2]))))
