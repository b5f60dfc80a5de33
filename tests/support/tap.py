# SPDX-License-Identifier: MIT
"""Hears what programs send to a node over its Unix socket (with WALLGL_RING=0), batch by batch."""
from __future__ import annotations

import contextlib
import socket
import struct
import threading
from pathlib import Path
from typing import Callable

FRAME_HEADER = struct.Struct("<IB3x")  # common/wire/frame.h
BATCH = 2  # wire::FrameKind


class Tap:
    """Stands where a node's socket was, and passes on what comes; `take` gets each batch's payload, on other threads.
    Its threads keep it for as long as the process lives."""

    def __init__(self, path: Path, take: Callable[[bytes], None]):
        self.behind, self.take = path.with_suffix(".behind"), take
        path.rename(self.behind)
        self.listener = socket.socket(socket.AF_UNIX)
        self.listener.bind(str(path))
        self.listener.listen()
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self) -> None:
        while True:
            program, _ = self.listener.accept()
            node = socket.socket(socket.AF_UNIX)
            node.connect(str(self.behind))
            for way in ((program, node, self.take), (node, program, None)):
                threading.Thread(target=self._pass_on, args=way, daemon=True).start()

    @staticmethod
    def _pass_on(source: socket.socket, to: socket.socket, take: Callable[[bytes], None] | None) -> None:
        waiting = bytearray()
        with contextlib.suppress(OSError):
            while data := source.recv(1 << 18):
                to.sendall(data)
                if take is None:
                    continue
                waiting += data
                while len(waiting) >= FRAME_HEADER.size:
                    size, kind = FRAME_HEADER.unpack_from(waiting)
                    end = FRAME_HEADER.size + size
                    if len(waiting) < end:
                        break
                    if kind == BATCH:
                        take(bytes(waiting[FRAME_HEADER.size:end]))
                    del waiting[:end]
        for end in (source, to):
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
