#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What dealing geometry to nodes gains and costs (docs/sort-last.md; AnyGL, section 3).

Geometry: frames a second of a mesh of a million triangles that the nodes keep, on one tile, drawn by the tile's node
alone, by one, two and four nodes that only render, and by two if that is found to be faster (`sort_last = "measured"`).
Walls stand side by side and have their turns; medians.

Composition: the same mesh in 1920x1080 pixels by four nodes that render: bytes of partial pictures a frame beside the
least that must travel (8 bytes for each pixel that each node has drawn), and the time that reading, coding and merging
takes of all nodes together.

sort_last.py [--rounds N] [--seconds S] [--json FILE]      exit code 1 if a figure is below its bar
"""
from __future__ import annotations

import argparse
import contextlib
import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / "tests" / "support"), str(Path(__file__).resolve().parent)]
from fair import rates  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from wall import build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

SMALL, LARGE = (600, 600), (1920, 1080)  # pixels of the tile
RENDERERS = (0, 1, 2, 4)
BY_ITSELF, ITS_RENDERERS = "measured", 2
SETTLE = 4.0  # seconds until it has been tried
FOREVER = "1000000"  # frames
LEAST_GAINED = 1.5  # by the second node that renders
LEAST_KEPT = 0.9  # of that, where nobody asks for it


def wall_of(renderers: int, size: tuple[int, int], sort_last: str = "asked") -> PlannedWall:
    """One node that shows a tile of that size, and some that render."""
    plan = {"shows": {"tile": (0, 0, *size)}} | {f"draws{i}": {} for i in range(renderers)}
    keys = ({"shows": 'role = "display"'} if renderers else {}) | {f"draws{i}": 'role = "render"'
                                                                   for i in range(renderers)}
    return PlannedWall(plan, node_keys=keys, name="sort_last", swap_timeout_ms=10000,
                       options=f'sort_last = "{sort_last}"', environment={"LP_NUM_THREADS": "0"})


@contextlib.contextmanager
def mesh(wall: PlannedWall, x: XServer, size: tuple[int, int], dealt: bool):
    """The session of the program that draws it."""
    line = wall.wallrun(build_folder() / "bench" / "buffers", "--size", f"{size[0]}x{size[1]}", "--frames", FOREVER,
                        sort_last=dealt)
    app = wall.run_line(line, env=x.environment(vblank_mode="0"), stdout=subprocess.DEVNULL)
    session = wall.wait_session(app)
    wall.wait(session, 5, limit=60)
    try:
        yield session
    finally:
        end_all([app])
        while any(s["id"] == session for s in wall.sessions()):
            time.sleep(0.05)


def geometry(x: XServer, rounds: int, seconds: float) -> dict[str, list[float]]:
    measured: dict[str, list[float]] = {}
    with contextlib.ExitStack() as stack:
        walls = {str(renderers): stack.enter_context(wall_of(renderers, SMALL)) for renderers in RENDERERS}
        walls[BY_ITSELF] = stack.enter_context(wall_of(ITS_RENDERERS, SMALL, BY_ITSELF))
        for _ in range(rounds):
            for name, wall in walls.items():
                with mesh(wall, x, SMALL, name not in ("0", BY_ITSELF)) as session:
                    if name == BY_ITSELF:
                        time.sleep(SETTLE)
                    measured.setdefault(name, []).append(rates(wall, seconds, session)[0])
    return measured


def composition(x: XServer, seconds: float) -> dict[str, float]:
    with wall_of(4, LARGE) as wall, mesh(wall, x, LARGE, True) as session:
        def figures() -> dict:
            its = next(s for s in wall.sessions() if s["id"] == session)
            return its["partials"] | {"frames": its["surfaces"][0]["frame"]}
        first = figures()
        time.sleep(seconds)
        last = figures()
    more = {name: last[name] - first[name] for name in last}
    frames = max(more["merged"] / 4, 1)
    return {"frames": frames, "bytes_a_frame": more["bytes"] / frames, "ms_a_frame": 1e3 * more["seconds"] / frames,
            "missed": more["missed"], "limit_bytes": 8 * LARGE[0] * LARGE[1]}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    with XServer() as x:
        measured = geometry(x, options.rounds, options.seconds)
        composed = composition(x, 3 * options.seconds)
    figures = {how: statistics.median(values) for how, values in measured.items()}
    print("a million triangles on one tile: " + ", ".join(
        f"{value:.2f} frames/s " + {"0": "by its node", BY_ITSELF: f"by {ITS_RENDERERS}, unasked"}.get(
            how, f"by {how} that render")
        for how, value in figures.items()))
    gained = figures["2"] / figures["1"]
    print(f"two nodes that render are {gained:.2f} times as fast as one, at least {LEAST_GAINED} wanted")
    kept = figures[BY_ITSELF] / max(figures["0"], figures[str(ITS_RENDERERS)])
    print(f"unasked: {kept:.2f} of the better one, at least {LEAST_KEPT} wanted")
    print(f"composition of {LARGE[0]}x{LARGE[1]} by 4 nodes: {composed['bytes_a_frame'] / 1e6:.2f} MB a frame, of "
          f"{composed['limit_bytes'] / 1e6:.2f} MB for each pixel once; {composed['ms_a_frame']:.1f} ms of all nodes")
    if options.json:
        options.json.write_text(json.dumps({"cores": os.cpu_count(), "frames_per_second": figures, "all": measured,
                                            "gained": gained, "kept": kept, "composition": composed}, indent=1) + "\n")
    return 1 if gained < LEAST_GAINED or kept < LEAST_KEPT else 0


if __name__ == "__main__":
    sys.exit(main())
