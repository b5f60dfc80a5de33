#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What a program sends to walls of 1x1 to 8x4 tiles, a frame: state, objects and geometry, bucketed, ideal (each
primitive goes to just the tiles that its own box touches, counted by the library in the same run) and broadcast.
`matrices` is how often, in that ideal, a node would need other matrices: where a program moves every object, its state
cannot grow less than this. The program is recorded first, so that every wall gets the same frames.

traffic.py [--seconds N] [--recording NAME] [--tiles CxR]... [--json FILE] [-- PROGRAM ARGS...]
    without a program: xscreensaver's atlantis without the gradient behind the fish, which the papers' did not have
    --recording: one of the golden tests' instead (a few frames)
    exit code 1 if, from 1x1 to 5x5 tiles, state grows by more than 1.1 times what the matrices must, if atlantis takes
    over 1,000 bytes of state a frame on 5x5, or if geometry is over 1.2 times the ideal
"""
from __future__ import annotations

import argparse
import dataclasses
import json
import math
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1] / "tests"
sys.path[:0] = [str(TESTS / "support"), str(TESTS / "golden")]
from subjects import WINDOW, Recording, load_recordings, signal_group  # noqa: E402
from wall import Wall  # noqa: E402
from xserver import XServer  # noqa: E402

LAYOUTS = ["1x1", "2x1", "2x2", "3x2", "4x3", "5x5", "8x4"]
STATE_OVER_MATRICES = 1.1  # the state's growth from 1x1 to 5x5 tiles, at most, relative to theirs
ATLANTIS_STATE = 1000  # bytes a frame on 5x5 tiles, at most; Buck et al. sent 4,530
OVER_IDEAL = 1.2  # geometry, at most
KINDS = ("state", "object", "geometry")
ATLANTIS = ["/usr/libexec/xscreensaver/atlantis", "--window", "--geometry", "1000x750", "-no-gradient"]


@dataclasses.dataclass(frozen=True)
class Clip(Recording):
    """A program recorded just now."""

    file: Path = Path()

    @property
    def path(self) -> Path:
        return self.file


def record(command: list[str], seconds: float, folder: Path, x: XServer) -> Clip:
    clip = Clip(Path(command[0]).name, "egl", command, frames=0, covers="", file=folder / "clip.trace")
    process = subprocess.Popen(["apitrace", "trace", f"--api={clip.api}", "-o", clip.path, *command],
                               env=x.environment(),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    time.sleep(seconds)
    signal_group(process, signal.SIGINT)
    process.wait(30)
    return clip


def replay(recording: Recording, wall: Wall, x: XServer, **environment: str) -> dict:
    """The library's statistics of one run."""
    with tempfile.TemporaryDirectory() as folder:
        stats = Path(folder) / "stats.json"
        subprocess.run(wall.wallrun(*recording.silent_argv(), fullscreen=True), check=True, timeout=600,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                       env=x.environment(WALLGL_STATS=str(stats), **recording.environment(), **environment))
        return json.loads(stats.read_text())


def a_frame(stats: dict, kind: str) -> float:
    """Bytes to all nodes in one frame; what only the first one needs is left out."""
    nodes = stats["nodes"]
    later = sum(node["total"][f"{kind}_bytes"] - node["first_frame"][f"{kind}_bytes"] for node in nodes)
    return later / max(1, stats["frames"] - 1)


def measure(recording: Recording, tiles: str, x: XServer) -> dict:
    columns, rows = map(int, tiles.split("x"))
    size = (-(-2 * WINDOW[0] // columns), -(-2 * WINDOW[1] // rows))
    with Wall(tiles=(columns, rows), tile_size=size, name="traffic", swap_timeout_ms=10000,
              environment={"LP_NUM_THREADS": "0"}) as wall:
        bucketed = replay(recording, wall, x, WALLGL_IDEAL="1")
        broadcast = replay(recording, wall, x, WALLGL_BROADCAST="1")
    row = {"tiles": tiles, "frames": bucketed["frames"]}
    for name, stats in (("bucketed", bucketed), ("broadcast", broadcast)):
        row[name] = {kind: a_frame(stats, kind) for kind in KINDS}
        row[name]["all_geometry"] = stats["total"]["geometry_bytes"]
    row["ideal_all_geometry"] = bucketed["counters"].get("ideal_geometry_bytes", 0)
    row["matrices"] = bucketed["counters"].get("ideal_matrices", 0) / max(1, bucketed["frames"])
    row["over_ideal"] = row["bucketed"]["all_geometry"] / max(1, row["ideal_all_geometry"])
    return row


def print_row(row: dict, first: dict) -> None:
    bucketed, broadcast = row["bucketed"], row["broadcast"]
    print(f"{row['tiles']:>6}{bucketed['state']:12,.0f}{bucketed['state'] / max(1, first['bucketed']['state']):7.2f}"
          f"{row['matrices']:9.2f}{row['matrices'] / max(1e-9, first['matrices']):7.2f}"
          f"{broadcast['state']:12,.0f}{bucketed['object']:12,.0f}{bucketed['geometry']:14,.0f}"
          f"{row['over_ideal']:12.3f}{broadcast['geometry']:14,.0f}{row['frames']:8}", flush=True)


def judge_state(rows: dict[str, dict], most: float) -> bool:
    """`most`: bytes of state a frame on 5x5 tiles."""
    if not {"1x1", "5x5"} <= rows.keys():
        return True
    small, large = rows["1x1"], rows["5x5"]
    state = large["bucketed"]["state"]
    growth = state / max(1, small["bucketed"]["state"])
    least = large["matrices"] / max(1e-9, small["matrices"])
    print(f"state, 1x1 to 5x5: {growth:.2f} times, where matrices must grow {least:.2f} times: {growth / least:.3f}, "
          f"at most {STATE_OVER_MATRICES} wanted")
    print(f"state on 5x5: {state:,.0f} bytes a frame" + (f", at most {most:,.0f} wanted" if most < math.inf else ""))
    return growth <= STATE_OVER_MATRICES * least and state <= most


def judge(rows: dict[str, dict], most_state: float) -> bool:
    good = judge_state(rows, most_state)
    worst = max(row["over_ideal"] for row in rows.values())
    counted = all(row["ideal_all_geometry"] for row in rows.values())
    print(f"geometry: at most {worst:.3f} times the ideal, at most {OVER_IDEAL} wanted"
          if counted else "geometry: no ideal was counted")
    return good and counted and worst <= OVER_IDEAL


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--seconds", type=float, default=60,
                           help="how long the program is recorded; in short clips much depends on where the fish swim")
    arguments.add_argument("--recording")
    arguments.add_argument("--tiles", action="append")
    arguments.add_argument("--json", type=Path)
    arguments.add_argument("program", nargs="*")
    options = arguments.parse_args()
    rows: dict[str, dict] = {}
    with XServer() as x, tempfile.TemporaryDirectory() as folder:
        if options.recording:
            recording = next(r for r in load_recordings() if r.name == options.recording)
        else:
            recording = record(options.program or ATLANTIS, options.seconds, Path(folder), x)
        print(f"{' '.join(recording.command)}: bytes a frame to all nodes together")
        print(f"{'tiles':>6}{'state':>12}{'growth':>7}{'matrices':>9}{'growth':>7}{'broadcast':>12}{'objects':>12}"
              f"{'geometry':>14}{'over ideal':>12}{'broadcast':>14}{'frames':>8}")
        for tiles in options.tiles or LAYOUTS:
            rows[tiles] = measure(recording, tiles, x)
            print_row(rows[tiles], next(iter(rows.values())))
    if options.json:
        options.json.write_text(json.dumps(list(rows.values()), indent=1) + "\n")
    return 0 if judge(rows, math.inf if options.recording or options.program else ATLANTIS_STATE) else 1


if __name__ == "__main__":
    sys.exit(main())
