#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""WireGL's two measurements of scaling (W4.2) on walls of 1x1 to 8x4 tiles: network efficiency, which is what a program
sends to one tile by what it sends to so many, and frames a second, both sorted and with all of it sent to all
(WALLGL_BROADCAST). March and Nurbs on nodes that draw nothing, so that what counts is the program's side and the links
(docs/simulation.md, "Counted"); for a game, OpenArena as recorded for the golden tests, on nodes that draw, bytes only.
*Over ideal* is what March's geometry takes by what it would take if each primitive went to just the tiles that show
some of it (WALLGL_IDEAL), in a run of its own.

scaling.py [--program NAME]... [--tiles CxR]... [--json FILE]
    exit code 1 if March's efficiency on 8x4 tiles is below 0.81, WireGL's, or its geometry over 1.03 of the ideal
"""
from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE / "simulate"), str(HERE), str(HERE.parent / "tests" / "support"),
                str(HERE.parent / "tests" / "golden")]
import traffic  # noqa: E402
from counted import NO_LIMIT_MS, TILE, CountingWall, count  # noqa: E402
from programs import ENDLESS, Subject  # noqa: E402
from subjects import load_recordings  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

LAYOUTS = ("1x1", "2x1", "2x2", "4x2", "4x4", "8x4")
BAR = 0.81  # of March on 8x4 tiles
OVER_IDEAL, IDEAL_FRAMES = 1.03, 12  # the same
HOW = {"sorted": {}, "broadcast": {"WALLGL_BROADCAST": "1"}}
GAME = "openarena"
FRAMES = {"sorted": 40, "broadcast": 10}


def drawn() -> dict[str, Subject]:
    size = ["--size", "800x600", "--frames", ENDLESS]
    return {"march": Subject("march", [str(build_folder() / "examples" / "march"), "--cells", "100", *size],
                             "an isosurface in 100 cells a side, anew in each frame", first=4),
            "nurbs": Subject("nurbs", [str(build_folder() / "bench" / "nurbs"), *size],
                             "102 patches, 183,600 triangles in strips", first=10)}


def tiles_of(layout: str) -> tuple[int, int]:
    columns, rows = map(int, layout.split("x"))
    return columns, rows


def of_program(subject: Subject, layout: str, folder: Path, x: XServer) -> dict[str, dict[str, float]]:
    out = {}
    for how, environment in HOW.items():
        found = count(subject, tiles_of(layout), folder, x, most=FRAMES[how], environment=environment)
        out[how] = {"bytes": found.bytes, "frames_per_second": found.frames_per_second}
    return out


def over_ideal(subject: Subject, layout: str, x: XServer) -> float:
    command = [word if word != ENDLESS else str(IDEAL_FRAMES) for word in subject.command]
    with (CountingWall(tiles_of(layout), TILE, name="ideal", swap_timeout_ms=NO_LIMIT_MS) as wall,
          tempfile.NamedTemporaryFile(suffix=".json") as stats):
        subprocess.run(wall.wallrun(*command, rect=(0, 0, *wall.size)), check=True, timeout=300,
                       stdout=subprocess.DEVNULL, env=x.environment(WALLGL_STATS=stats.name, WALLGL_IDEAL="1"))
        told = json.loads(Path(stats.name).read_text())
    return told["total"]["geometry_bytes"] / told["counters"]["ideal_geometry_bytes"]


def of_game(layout: str, x: XServer) -> dict[str, dict[str, float]]:
    recording = next(r for r in load_recordings() if r.name == GAME)
    row = traffic.measure(recording, layout, x)
    return {name: {"bytes": sum(row[kind][what] for what in ("state", "geometry"))}
            for name, kind in (("sorted", "bucketed"), ("broadcast", "broadcast"))}


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("--program", action="append", choices=["march", "nurbs", GAME])
    arguments.add_argument("--tiles", action="append", help="always with 1x1")
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    layouts = ["1x1", *(layout for layout in options.tiles or LAYOUTS if layout != "1x1")]
    results: dict[str, dict] = {}
    with XServer() as x, tempfile.TemporaryDirectory() as folder:
        subjects = drawn()
        print(f"{'program':12}{'tiles':>6}{'MB a frame':>12}{'efficiency':>12}{'over ideal':>12}{'frames/s':>10}"
              f"{'broadcast: MB':>15}{'frames/s':>10}")
        for name in options.program or [*subjects, GAME]:
            rows = results[name] = {}
            for layout in layouts:
                row = rows[layout] = (of_program(subjects[name], layout, Path(folder), x) if name in subjects
                                      else of_game(layout, x))
                for how, figures in row.items():
                    first = rows["1x1"][how]
                    figures["efficiency"] = rows["1x1"]["sorted"]["bytes"] / figures["bytes"]
                    if "frames_per_second" in figures:
                        figures["relative_rate"] = figures["frames_per_second"] / first["frames_per_second"]
                bucketed, broadcast = row["sorted"], row["broadcast"]
                if name == "march":
                    bucketed["over_ideal"] = over_ideal(subjects[name], layout, x)
                print(f"{name:12}{layout:>6}{bucketed['bytes'] / 1e6:12.3f}{bucketed['efficiency']:12.3f}"
                      f"{bucketed.get('over_ideal', 0):12.3f}"
                      f"{bucketed.get('frames_per_second', 0):10.2f}{broadcast['bytes'] / 1e6:15.3f}"
                      f"{broadcast.get('frames_per_second', 0):10.2f}", flush=True)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")
    if "8x4" not in results.get("march", {}):
        return 0
    found = results["march"]["8x4"]["sorted"]
    print(f"march on 8x4: efficiency {found['efficiency']:.3f}, at least {BAR} wanted; {found['over_ideal']:.3f} of "
          f"the ideal, at most {OVER_IDEAL} wanted")
    return 0 if found["efficiency"] >= BAR and found["over_ideal"] <= OVER_IDEAL else 1


if __name__ == "__main__":
    sys.exit(main())
