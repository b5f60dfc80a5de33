#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""How soon a node that comes late has what a program draws with (bench/late_node.cpp): the node is killed and started
again, and the frame with which it gets all of the program's buffers and textures is looked at. The program goes on
meanwhile, and is on a wall of one node over a local socket.

late_node.py [--rounds N] [--megabytes N] [--json FILE]      exit code 1 if it takes more than a second
"""
from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

SIDE = 256  # pixels
MOST_SECONDS = 1.0
START_LIMIT = 60.0
SETTLED_FRAMES = 10


class Frames:
    """What the program says of its frames, as it says it."""

    def __init__(self, program: subprocess.Popen) -> None:
        self.all: list[tuple[float, float]] = []  # when it was done, how long it took; seconds
        threading.Thread(target=self._read, args=(program,), daemon=True).start()

    def _read(self, program: subprocess.Popen) -> None:
        for line in program.stdout:
            done, took = map(float, line.split())
            self.all.append((done, took))

    def after(self, when: float) -> list[float]:
        return [took for done, took in self.all if done - took > when]

    def wait(self, when: float, count: int) -> None:
        """Until the program has drawn so many frames that began after `when`."""
        end = time.monotonic() + START_LIMIT
        while len(self.after(when)) < count:
            if time.monotonic() > end:
                raise TimeoutError(f"{len(self.after(when))} frames instead of {count}")
            time.sleep(0.02)


def once(megabytes: int, x: XServer) -> tuple[float, int]:
    """Seconds of the longest frame after the node has come back, and the bytes that it got by then."""
    with Wall(tiles=(1, 1), tile_size=(SIDE, SIDE), name="late_node", swap_timeout_ms=10000) as wall:
        program = wall.run(build_folder() / "bench" / "late_node", "--megabytes", megabytes,
                           env=x.environment(), stdout=subprocess.PIPE, text=True)
        frames = Frames(program)
        frames.wait(0, SETTLED_FRAMES)
        [name] = wall.node_names
        wall.daemons[name].kill()
        wall.daemons[name].wait()
        started = time.time()
        wall.start_node(name)
        wall.wait_nodes()
        got = lambda: wall.nodes()[0]["bytes_received"]  # noqa: E731
        end = time.monotonic() + START_LIMIT
        while got() < megabytes << 20:
            if time.monotonic() > end:
                raise TimeoutError("the node does not get the objects")
            time.sleep(0.1)
        frames.wait(time.time(), SETTLED_FRAMES)
        return max(frames.after(started)), got()


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--rounds", type=int, default=3)
    arguments.add_argument("--megabytes", type=int, default=256)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    with XServer() as x:
        rounds = [once(options.megabytes, x) for _ in range(options.rounds)]
    seconds = statistics.median(took for took, _ in rounds)
    print(f"a late node has {options.megabytes} MiB of buffers and textures after {seconds:.2f} s "
          f"({', '.join(f'{took:.2f}' for took, _ in rounds)}), at most {MOST_SECONDS:.0f} s wanted")
    if options.json:
        options.json.write_text(json.dumps({"megabytes": options.megabytes, "seconds": seconds}, indent=1) + "\n")
    return 1 if seconds > MOST_SECONDS else 0


if __name__ == "__main__":
    sys.exit(main())
