# SPDX-License-Identifier: MIT
"""What things cost on this machine, from walls of one and of two nodes: all else is foretold from it."""
from __future__ import annotations

import dataclasses

import numpy as np

from counted import Count, count
from measured import DESK, elements_of_two, measure
from programs import Subject
from sampled import Rates
from xserver import XServer
from pathlib import Path

# A TCP segment of 1448 bytes is an Ethernet frame of 1514, and a record of TLS has 22 bytes more than the 16 KiB in it.
LINK_FACTOR = 1514 / 1448 * (1 + 22 / 16384)
LINK_MESSAGE = 66 + 22  # bytes: the headers of a segment, a record


@dataclasses.dataclass(frozen=True)
class DrawCost:
    """Seconds of a node's processor. `overlap`: of a draw in pieces, what a node more adds to what all process."""

    vertex: float
    frame: float
    overlap: float = 0.0

    def share(self, nodes: int) -> float:
        return min(1.0, (1 + self.overlap * (nodes - 1)) / nodes)


@dataclasses.dataclass(frozen=True)
class Costs:
    """Seconds of processor time."""

    draw: dict[str, DrawCost]  # by subject
    agent_byte: float  # wallagent and TLS, of the client's host
    agent_message: float
    walld_frame: float
    walld_message: float


@dataclasses.dataclass(frozen=True)
class Trial:
    """A subject on a real wall, and counted on the same one."""

    subject: Subject
    counted: Count
    rates: Rates

    @property
    def node_times(self) -> list[float]:
        return [time for name, time in self.rates.daemons.items() if name.startswith("node-")]


def trials(of: list[Subject], folder: Path, x: XServer) -> list[Trial]:
    return [Trial(subject, count(subject, (nodes, 1), folder, x), measure(subject, nodes, 0, x)) for subject in of
            for nodes in (1, 2)]


def not_negative(rows: list[list[float]], values: list[float]) -> list[float]:
    """Least squares of two factors, neither below 0."""
    a, b = np.array(rows, float), np.array(values, float)
    best = np.linalg.lstsq(a, b, rcond=None)[0]
    if (best >= 0).all():
        return list(map(float, best))
    alone = [max(0.0, float(a[:, i] @ b / (a[:, i] @ a[:, i]))) for i in range(2)]
    left = [float(np.sum((a[:, i] * alone[i] - b) ** 2)) for i in range(2)]
    return [alone[0], 0.0] if left[0] < left[1] else [0.0, alone[1]]


def draw_cost(of: list[Trial], x: XServer) -> DrawCost:
    subject, overlap = of[0].subject, 0.0
    if subject.in_pieces:
        two = next(trial for trial in of if trial.counted.nodes == 2)
        overlap = max(0.0, 2 * elements_of_two(subject, x) / two.counted.vertices - 1)
    share = DrawCost(0, 0, overlap).share if subject.in_pieces else lambda _: 1.0
    rows, values = [], []
    for trial in of:
        nodes = trial.counted.nodes
        rows.append([trial.counted.vertices / nodes * share(nodes), 1.0])
        values.append(sum(trial.node_times) / nodes)
    vertex, frame = not_negative(rows, values)
    return DrawCost(vertex, frame, overlap)


def costs(of: list[Trial], x: XServer) -> Costs:
    by_name: dict[str, list[Trial]] = {}
    for trial in of:
        by_name.setdefault(trial.subject.name, []).append(trial)
    agent = not_negative([[t.counted.bytes, t.counted.messages] for t in of], [t.rates.daemons[DESK] for t in of])
    walld = not_negative([[1.0, t.counted.messages] for t in of], [t.rates.daemons["walld"] for t in of])
    return Costs({name: draw_cost(own, x) for name, own in by_name.items()}, *agent, *walld)
