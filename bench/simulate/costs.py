# SPDX-License-Identifier: MIT
"""What things cost on this machine, from walls of one and of two nodes (and of four, where nodes
leave out parts of draws): all else is foretold from it."""
from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np

from counted import Count, count
from measured import DESK, elements, measure
from programs import Subject
from sampled import Rates
from xserver import XServer

# A TCP segment of 1448 bytes is an Ethernet frame of 1514, and a record of TLS has 22 bytes more than the 16 KiB in it.
LINK_FACTOR = 1514 / 1448 * (1 + 22 / 16384)
LINK_MESSAGE = 66 + 22  # bytes: the headers of a segment, a record


@dataclasses.dataclass(frozen=True)
class DrawCost:
    """Seconds of a node's processor. `in_pieces`: what two columns of nodes process together of a draw in pieces, and
    what each further column adds, of what it names; nothing: it is never in pieces. `seen`: what a vertex costs more
    that is seen, in costs of one that is only processed."""

    vertex: float
    frame: float
    in_pieces: tuple[float, float] | None = None
    seen: float = 0.0

    def processed(self, columns: int, rows: int) -> float:
        """What a node processes of a draw. Pieces lie along rows, so rows of nodes have few in common."""
        if self.in_pieces is None:
            return 1.0
        two, more = self.in_pieces
        return (min(1.0, (two + more * (columns - 2)) / columns) if columns > 1 else 1.0) / rows

    def share(self, columns: int, rows: int) -> float:
        """Of a draw's vertices, as if all that a node has to do were to process them."""
        return self.processed(columns, rows) + self.seen / (columns * rows)


@dataclasses.dataclass(frozen=True)
class Costs:
    """Seconds of processor time."""

    draw: dict[str, DrawCost]  # by subject
    agent_byte: float  # wallagent and TLS, of the client's host
    agent_message: float
    walld_frame: float
    walld_message: float
    processors: dict[str, float]  # of this machine that a wall of two nodes keeps busy, by subject; the rest they wait


@dataclasses.dataclass(frozen=True)
class Trial:
    """A subject on a real wall, and counted on the same one."""

    subject: Subject
    counted: Count
    rates: Rates

    @property
    def busy(self) -> float:
        """Processors, on average."""
        own = self.rates.packing + self.rates.sending
        return self.rates.frames_per_second * (own + sum(self.rates.daemons.values()))

    @property
    def node_times(self) -> list[float]:
        return [time for name, time in self.rates.daemons.items() if name.startswith("node-")]


def trials(of: list[Subject], folder: Path, x: XServer) -> list[Trial]:
    return [Trial(subject, count(subject, (nodes, 1), folder, x), measure(subject, (nodes, 1), 0, x)) for subject in of
            for nodes in ((1, 2, 4) if subject.in_pieces else (1, 2))]


def not_negative(rows: list[list[float]], values: list[float]) -> list[float]:
    """Least squares of two factors, neither below 0."""
    a, b = np.array(rows, float), np.array(values, float)
    best = np.linalg.lstsq(a, b, rcond=None)[0]
    if (best >= 0).all():
        return list(map(float, best))
    alone = [max(0.0, float(a[:, i] @ b / (a[:, i] @ a[:, i]))) for i in range(2)]
    left = [float(np.sum((a[:, i] * alone[i] - b) ** 2)) for i in range(2)]
    return [alone[0], 0.0] if left[0] < left[1] else [0.0, alone[1]]


def pieces_of(subject: Subject, folder: Path, x: XServer) -> tuple[float, float]:
    """DrawCost.in_pieces, from walls of two and of four columns."""
    named = count(subject, (1, 1), folder, x).vertices
    two, four = (elements(subject, columns, x) / named for columns in (2, 4))
    return two, max(0.0, (four - two) / 2)


def draw_cost(of: list[Trial], folder: Path, x: XServer) -> DrawCost:
    subject = of[0].subject
    values = [sum(trial.node_times) / trial.counted.nodes for trial in of]
    named = [trial.counted.vertices / trial.counted.nodes for trial in of]
    if not subject.in_pieces:
        return DrawCost(*not_negative([[vertices, 1.0] for vertices in named], values))
    in_pieces = pieces_of(subject, folder, x)
    processed = DrawCost(0, 0, in_pieces).processed
    rows = [[vertices * processed(trial.counted.nodes, 1), vertices / trial.counted.nodes]
            for vertices, trial in zip(named, of)]
    vertex, seen = not_negative(rows, values)
    return DrawCost(vertex, 0.0, in_pieces, seen / vertex)


def costs(of: list[Trial], folder: Path, x: XServer) -> Costs:
    by_name: dict[str, list[Trial]] = {}
    for trial in of:
        by_name.setdefault(trial.subject.name, []).append(trial)
    agent = not_negative([[t.counted.bytes, t.counted.messages] for t in of], [t.rates.daemons[DESK] for t in of])
    walld = not_negative([[1.0, t.counted.messages] for t in of], [t.rates.daemons["walld"] for t in of])
    busy = {name: max(trial.busy for trial in own if trial.counted.nodes == 2) for name, own in by_name.items()}
    return Costs({name: draw_cost(own, folder, x) for name, own in by_name.items()}, *agent, *walld, busy)
