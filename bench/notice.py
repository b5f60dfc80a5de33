#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""How soon each kind of fault is noticed on a wall of machines (network namespaces, all over TLS), with a program of a
client host on it: from the moment at which something is killed, stopped or cut until whoever must act on it says so.
walld says it in its status, which operators see; nodes in their logs, when they show frames by themselves.

notice.py [--rounds N] [--json FILE]       needs root; exit code 1 if a kind takes longer than it may
"""
from __future__ import annotations

import argparse
import json
import signal
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Callable

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from machine_wall import WALLD, MachineWall  # noqa: E402
from wall import WallError, build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

MOST_SECONDS = 3.0
LOOK = 0.01  # seconds between two looks
LIMIT = 30.0
NODE, CLIENT = "node-1", "desk"
CLOCK = build_folder() / "tests" / "frame_clock"


class Trial:
    """A wall, and the program that is on it now."""

    def __init__(self, wall: MachineWall, x: XServer) -> None:
        self.wall, self.x = wall, x
        self.app: subprocess.Popen | None = None
        self.session = 0

    def prepare(self) -> None:
        """All is as it should be, and has been for a while."""
        self.wall.wait_nodes()
        if self.app is None or self.app.poll() is not None:
            self.app = self.wall.run_at(CLIENT, CLOCK, "--size", "600x300", "--fps", 10, rect=(0, 0, 600, 300),
                                        env=self.x.environment())
            self.session = self.wall.wait_session()
        self.until(lambda: self.is_silent() is False, "the program is on the wall")
        self.until(lambda: all(node["up"] and not node["silent"] for node in self.wall.nodes()), "all nodes answer")
        self.wall.wait(self.session, self.frame() + 10)

    def until(self, done: Callable[[], bool], what: str) -> float:
        begin = time.monotonic()
        while not done():
            if time.monotonic() > begin + LIMIT:
                raise WallError(f"not within {LIMIT:.0f} s: {what}")
            time.sleep(LOOK)
        return time.monotonic() - begin

    def node(self) -> dict:
        return next(node for node in self.wall.nodes() if node["name"] == NODE)

    def program(self) -> dict | None:
        return next((s for s in self.wall.sessions() if s["id"] == self.session), None)

    def is_silent(self) -> bool | None:
        """None: it is not there, as for a moment when it comes back over another link."""
        program = self.program()
        return program["silent"] if program else None

    def frame(self) -> int:
        """The last one shown."""
        seen: list[dict] = []

        def look() -> bool:
            seen[:] = [s for s in (self.program(),) if s]
            return bool(seen)
        self.until(look, "the program is on the wall")
        return seen[0]["surfaces"][0]["frame"]

    def heard(self, word: str, since: int) -> bool:
        """Whether the node has said so since its log was so long."""
        return word in self.wall.log(NODE)[since:]

    # ---- the kinds of faults: each gives the seconds, and leaves the wall whole ----

    def node_killed(self) -> float:
        self.wall.kill_node(NODE)
        took = self.until(lambda: not self.node()["up"], "the node is away")
        self.wall.start_node(NODE)
        return took

    def node_stopped(self) -> float:
        daemon = self.wall.daemons[NODE]
        daemon.send_signal(signal.SIGSTOP)
        took = self.until(lambda: self.node()["silent"] or not self.node()["up"], "the node is silent")
        daemon.send_signal(signal.SIGCONT)
        return took

    def node_cut_off(self) -> float:
        self.wall.hosts.cut(NODE)
        took = self.until(lambda: self.node()["silent"] or not self.node()["up"], "the node is silent")
        self.wall.hosts.mend(NODE)
        return took

    def program_killed(self) -> float:
        end_all([self.app])
        return self.until(lambda: self.program() is None, "the program is off the wall")

    def program_stopped(self) -> float:
        self.app.send_signal(signal.SIGSTOP)
        took = self.until(self.is_silent, "the program is silent")
        self.app.send_signal(signal.SIGCONT)
        return took

    def client_host_cut_off(self) -> float:
        self.wall.hosts.cut(CLIENT)
        took = self.until(self.is_silent, "the program is silent")
        self.wall.hosts.mend(CLIENT)
        return took

    def walld_stopped(self) -> float:
        said = len(self.wall.log(NODE))
        self.wall.daemons[WALLD].send_signal(signal.SIGSTOP)
        took = self.until(lambda: self.heard("walld_silent", said), "the node shows frames by itself")
        self.wall.daemons[WALLD].send_signal(signal.SIGCONT)
        return took

    def walld_killed(self) -> float:
        said = len(self.wall.log(NODE))
        begin = time.monotonic()
        self.wall.daemons[WALLD].kill()
        self.until(lambda: self.heard("walld_", said), "the node shows frames by itself")
        took = time.monotonic() - begin
        self.wall.daemons[WALLD].wait()
        self.wall.start_walld()
        return took


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("--rounds", type=int, default=5)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    kinds = [name for name in vars(Trial) if name.endswith(("killed", "stopped", "off"))]
    seconds: dict[str, list[float]] = {kind: [] for kind in kinds}
    with XServer() as x, MachineWall(clients=[CLIENT], environment={"LP_NUM_THREADS": "0"}) as wall:
        trial = Trial(wall, x)
        for _ in range(options.rounds):
            for kind in kinds:
                trial.prepare()
                seconds[kind].append(getattr(trial, kind)())
    print(f"{'fault':<22}  {'median':>7}  {'most':>7}   seconds until it is noticed, {options.rounds} rounds")
    for kind, took in seconds.items():
        print(f"{kind.replace('_', ' '):<22}  {statistics.median(took):7.2f}  {max(took):7.2f}")
    if options.json:
        options.json.write_text(json.dumps({kind: {"median": statistics.median(took), "most": max(took)}
                                            for kind, took in seconds.items()}, indent=1))
    return 1 if max(map(max, seconds.values())) > MOST_SECONDS else 0


if __name__ == "__main__":
    sys.exit(main())
