# SPDX-License-Identifier: MIT
"""Scenes for simulate_wall, and what it says of them."""
from __future__ import annotations

import json
import subprocess
import tempfile
from pathlib import Path

from costs import LINK_FACTOR, LINK_MESSAGE, Costs
from counted import Count
from wall import build_folder

BITS = 8
LATENCY = 100e-6  # seconds: two sockets and a switch
PROCESSORS = 2  # of every machine


def program(count: Count, costs: Costs, hosts: list[int], nodes: list[int]) -> dict:
    """A counted program on other machines; what a vertex costs it is known of the subject, or of one like it."""
    draw = costs.draw[count.subject]
    return {"trace": str(count.trace), "skip": count.skip, "last": count.last, "hosts": hosts, "nodes": nodes,
            "pack": count.packing + costs.walld_frame / len(hosts),
            "send": {"byte": costs.agent_byte,
                     "message": count.sending * len(hosts) / count.messages + costs.agent_message},
            "draw": {"vertex": draw.vertex, "frame": draw.frame + costs.walld_message,
                     "piece_share": draw.share(*count.tiles)},
            "link": {"byte": LINK_FACTOR, "message": LINK_MESSAGE}}


def link(megabits: float) -> dict:
    return {"up": megabits * 1e6 / BITS, "down": megabits * 1e6 / BITS} if megabits else {}


def frames(count: Count) -> int:
    """All that were counted, and many of a few."""
    return max(64, count.last - count.skip)


def on_one_machine(count: Count, costs: Costs, megabits: float) -> dict:
    """As measured.py does: each host has a link of its own, all share this machine's processors."""
    own = {"processors": costs.processors[count.subject]}
    hosts = [own | link(megabits), {"count": count.nodes, "runs_on": 0} | link(megabits)]
    return {"hosts": hosts, "nodes": list(range(1, count.nodes + 1)), "latency": LATENCY, "frames": frames(count),
            "programs": [program(count, costs, [0] * count.ranks, list(range(count.nodes)))]}


def on_machines(count: Count, costs: Costs, megabits: float) -> dict:
    """A machine for each process and each node."""
    hosts = [{"count": count.ranks + count.nodes, "processors": PROCESSORS} | link(megabits)]
    nodes = list(range(count.ranks, count.ranks + count.nodes))
    return {"hosts": hosts, "nodes": nodes, "latency": LATENCY, "frames": frames(count),
            "programs": [program(count, costs, list(range(count.ranks)), list(range(count.nodes)))]}


def simulate(scene: dict) -> dict:
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(scene, file)
        file.flush()
        done = subprocess.run([build_folder() / "bench" / "simulate_wall", file.name], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    return json.loads(done.stdout)


def rate(scene: dict) -> float:
    """Frames a second of its only program."""
    return simulate(scene)["programs"][0]["frames_per_second"]
