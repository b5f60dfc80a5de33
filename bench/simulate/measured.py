# SPDX-License-Identifier: MIT
"""Subjects on real walls: a client host, walld and a node for each tile on hosts of their own (network namespaces,
TLS, links of a given rate), all on the processors of this machine."""
from __future__ import annotations

import http.client
import json
import subprocess
import sys
import time
import urllib.parse
from pathlib import Path

from counted import LIMIT, NO_LIMIT_MS, TILE
from programs import Subject
from sampled import Rates, watch

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "support"))
from machine_wall import WALLD, MachineWall  # noqa: E402
from wall import Wall, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

DESK = "desk"
SPAN = 6.0  # seconds that a program is watched
LEAST_FRAMES = 8
ONE_THREAD = {"LP_NUM_THREADS": "0"}  # llvmpipe in the node's own thread
UNCODED = {"WALLGL_CODING": "0"}


class TileWall(MachineWall):
    """A host for each tile."""

    @property
    def node_names(self) -> list[str]:
        return [f"node-{tile}" for tile in self.tile_names]

    def tiles_of(self, node: str) -> list[str]:
        return [node.removeprefix("node-")]


class StatusLink:
    """walld's HTTP from here, though it listens in its host's network only. One connection, so that looking costs
    little."""

    def __init__(self, wall: MachineWall):
        self.address = urllib.parse.urlparse(wall.url)
        self.connection = http.client.HTTPConnection(self.address.hostname, self.address.port)
        self.connection.sock = wall.hosts.connect(WALLD, (self.address.hostname, self.address.port))

    def sessions(self) -> list[dict]:
        self.connection.request("GET", "/api/v1/sessions")
        return json.loads(self.connection.getresponse().read())


def measure(subject: Subject, tiles: tuple[int, int], megabits: int, x: XServer) -> Rates:
    """`megabits`: a second, to and from each host; 0: no limit."""
    with TileWall(tiles, TILE, clients=[DESK], name="measure", swap_timeout_ms=NO_LIMIT_MS,
                  environment=ONE_THREAD) as wall:
        for host in (DESK, *wall.node_names) if megabits else ():
            wall.hosts.limit(host, f"{megabits}mbit")
        status = StatusLink(wall)
        app = wall.run_at(DESK, *subject.command, rect=(0, 0, *wall.size), env=x.environment(**UNCODED),
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if subject.recorded:
            return watch(wall, app, subject.first, lambda _, now: now.frame >= subject.first + subject.frames, LIMIT,
                         status.sessions)
        return watch(wall, app, subject.first,
                     lambda then, now: now.time - then.time >= SPAN and now.frame - then.frame >= LEAST_FRAMES, LIMIT,
                     status.sessions)


def elements(subject: Subject, columns: int, x: XServer) -> float:
    """How many elements of its arrays so many nodes together process in a frame."""
    frames = 60
    command = [str(frames) if word == subject.command[-1] else word for word in subject.command]
    with Wall((columns, 1), TILE, name="pieces", swap_timeout_ms=NO_LIMIT_MS) as wall:
        app = wall.run(*command, rect=(0, 0, *wall.size), env=x.environment(), stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        app.wait(LIMIT)
        before, now = -1, 0
        while now != before:  # nodes say it once a second
            before = now
            time.sleep(2.5)
            now = sum(node["array_elements"] for node in wall.nodes())
        end_all(wall.apps)
    return now / frames
