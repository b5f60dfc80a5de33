# SPDX-License-Identifier: MIT
"""Walls whose nodes draw nothing (counting_nodes): what a program sends each of them in each frame, and what that costs
the program's processor."""
from __future__ import annotations

import csv
import dataclasses
import shutil
import subprocess
from pathlib import Path

from programs import Subject
from sampled import watch
from wall import Wall, WallError, build_folder, end_all
from xserver import XServer

TILE = (400, 300)  # pixels
LIMIT = 120.0  # seconds that a program may take
NO_LIMIT_MS = 10000  # a node in a thousand is not left out because all share two cores


class CountingWall(Wall):
    """The same wall with all its nodes in one process."""

    def _start(self) -> None:
        (self.folder / "wall.toml").write_text(self._description())
        self.address = f"unix:{self.folder}/walld.sock"
        self.start_walld()
        with open(self.folder / "nodes.log", "ab") as log:
            self.daemons["nodes"] = subprocess.Popen(
                [build_folder() / "bench" / "counting_nodes", "--config", self.folder / "wall.toml", "--listen",
                 f"unix:{self.folder}/nodes.sock", "--trace", self.folder / "trace.tsv"], stdin=subprocess.DEVNULL,
                stdout=log, stderr=log, env=self._environment, start_new_session=True, preexec_fn=self._before_exec)
        self._until(lambda: all(node["up"] for node in self.nodes()), "not all nodes came up", "nodes")

    def take_trace(self, to: Path) -> None:
        """Ends the nodes. What they were asked is an error: nobody has answered."""
        end_all([self.daemons["nodes"]])
        if said := self.log("nodes").strip():
            raise WallError(f"counting_nodes: {said}")
        shutil.move(self.folder / "trace.tsv", to)


@dataclasses.dataclass(frozen=True)
class Count:
    """A subject on a wall of so many nodes. Bytes and vertices are sums over all nodes, in a frame."""

    subject: str
    tiles: tuple[int, int]
    ranks: int
    trace: Path
    skip: int  # frames
    last: int
    frames_per_second: float
    packing: float  # seconds of processor time in a frame, of a process's own thread
    sending: float  # of the one that writes to nodes
    bytes: float
    vertices: float
    messages: float

    @property
    def nodes(self) -> int:
        return self.tiles[0] * self.tiles[1]


def count(subject: Subject, tiles: tuple[int, int], folder: Path, x: XServer, *, ranks: int = 1,
          most: int = 0, environment: dict[str, str] | None = None) -> Count:
    """Of `most` frames, if the subject has more."""
    frames = min(most or subject.frames, subject.frames)
    trace = folder / f"{subject.name}-{tiles[0]}x{tiles[1]}-{ranks}.tsv"
    last = subject.first + frames
    with CountingWall(tiles, TILE, name="count", swap_timeout_ms=NO_LIMIT_MS) as wall:
        app = wall.run(*subject.command, rect=(0, 0, *wall.size), parallel=ranks if ranks > 1 else 0,
                       env=x.environment(**(environment or {})), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        rates = watch(wall, app, subject.first, lambda _, now: now.frame > last, LIMIT,
                      lambda: wall.rest("GET", "/api/v1/sessions")[1])
        end_all(wall.apps)
        wall.take_trace(trace)
    rows = [row for row in read(trace) if subject.first < row["frame"] <= last]
    return Count(subject.name, tiles, ranks, trace, subject.first, last, rates.frames_per_second,
                 rates.packing, rates.sending,
                 sum(row["link"] for row in rows) / frames, sum(row["vertices"] for row in rows) / frames,
                 len(rows) / frames)


def read(trace: Path) -> list[dict[str, int]]:
    with open(trace, newline="") as file:
        return [{name: int(value) for name, value in row.items()} for row in csv.DictReader(file, delimiter="\t")]
