#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Walls that nobody here has: what real programs send to each of a thousand nodes (counted, with the real router, by
nodes that draw nothing), what that costs this machine's processors (measured on walls of one to four nodes), and how
fast a wall would be that has so many machines and links of such a rate (docs/simulation.md).

simulate.py [--part NAME]... [--json FILE] [--pictures FOLDER]
    check: walls of 2, 4 and 8 nodes in network namespaces, foretold and measured; scaled: March on 1x1 to 8x4 tiles,
    both in one figure; grown: walls of up to 32x32; parallel: beside AnyGL's figure 11; many: 10,000 tiles
    exit code 1 if one of these is more than 15 % off, or a wall of 10,000 tiles takes over 60 s of computing
Needs root, for network namespaces.
"""
from __future__ import annotations

import argparse
import dataclasses
import json
import random
import statistics
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE / "simulate"), str(HERE.parent / "tests" / "support")]
import scenes  # noqa: E402
from chart import Line, chart, save  # noqa: E402
from costs import Costs, costs, trials  # noqa: E402
from counted import count  # noqa: E402
from measured import measure  # noqa: E402
from programs import Subject, large_march, subjects  # noqa: E402
from xserver import XServer  # noqa: E402

OFF = 0.15  # at most
ROUNDS = 3  # of what is measured; the median counts
CHECKED_NODES = (2, 4, 8)
CHECKED_MEGABITS = {"atlantis": (10, 20, 0), "march": (20, 100, 0), "buffers": (100, 0)}
SCALED = {1: (1, 1), 2: (2, 1), 4: (2, 2), 8: (4, 2), 16: (4, 4), 32: (8, 4)}  # tiles
MOST_HOSTS = 8  # of nodes that this machine can have
SCALED_MEGABITS = 100
WIREGL = 0.81  # W4.2: of 32 tiles of March, by what one takes
SIDES = (1, 2, 4, 8, 16, 32)  # tiles, of square walls
MEGABITS = (100, 1_000, 10_000, 100_000)
PROCESSES = (1, 2, 4, 8, 16, 32)
LAYOUTS = {1: (1, 1), 2: (2, 1), 4: (2, 2), 8: (4, 2), 16: (4, 4), 32: (8, 4)}  # of render nodes
FEW = 60  # frames that are counted on large walls
MANY_SIDE, MANY_PROGRAMS, MANY_TILES = 100, 1000, 4  # a wall of 10,000 tiles; each program on 4x4 of them
MOST_COMPUTING = 60.0  # seconds


def check(of: list[Subject], known: Costs, folder: Path, x: XServer) -> list[dict]:
    """The model beside real walls, on this machine's processors."""
    print("\nchecked: frames a second on walls of as many hosts here (network namespaces, TLS, links of a rate)")
    print(f"{'':10}{'nodes':>6}{'Mbit/s':>8}{'foretold':>10}{'measured':>10}{'ratio':>8}")
    rows = []
    for subject in of:
        for nodes in CHECKED_NODES:
            counted = count(subject, (nodes, 1), folder, x)
            for megabits in CHECKED_MEGABITS[subject.name]:
                foretold = scenes.rate(scenes.on_one_machine(counted, known, megabits))
                seen = statistics.median(measure(subject, (nodes, 1), megabits, x).frames_per_second
                                         for _ in range(ROUNDS))
                rows.append({"program": subject.name, "nodes": nodes, "megabits": megabits, "foretold": foretold,
                             "measured": seen, "ratio": foretold / seen})
                print(f"{subject.name:10}{nodes:6}{megabits or 'any':>8}{foretold:10.2f}{seen:10.2f}"
                      f"{foretold / seen:8.3f}", flush=True)
    return rows


def costs_of_large_march(known: Costs) -> Costs:
    """It has more of what march has."""
    name = large_march().name
    return dataclasses.replace(known, draw=known.draw | {name: known.draw["march"]},
                               processors=known.processors | {name: known.processors["march"]})


def scaled(_: list[Subject], known: Costs, folder: Path, x: XServer) -> list[dict]:
    """W4.2's figure of March: measured on walls that this machine can have, foretold for all."""
    subject, known = large_march(), costs_of_large_march(known)
    print(f"\n{subject.what}, at {SCALED_MEGABITS} Mbit/s, frames a second: on this machine, measured and foretold, "
          f"and foretold with a machine for each tile")
    print(f"{'tiles':10}{'measured':>10}{'foretold':>10}{'machines':>10}{'of 1x1':>8}")
    rows: list[dict] = []
    for nodes, tiles in SCALED.items():
        counted = count(subject, tiles, folder, x)
        seen = (statistics.median(measure(subject, tiles, SCALED_MEGABITS, x).frames_per_second for _ in range(ROUNDS))
                if nodes <= MOST_HOSTS else None)
        rows.append({"tiles": f"{tiles[0]}x{tiles[1]}", "nodes": nodes, "measured": seen, "bytes": counted.bytes,
                     "foretold": scenes.rate(scenes.on_one_machine(counted, known, SCALED_MEGABITS)),
                     "machines": scenes.rate(scenes.on_machines(counted, known, SCALED_MEGABITS))})
        row = rows[-1]
        print(f"{row['tiles']:10}{row['measured'] or 0:10.2f}{row['foretold']:10.2f}{row['machines']:10.2f}"
              f"{row['machines'] / rows[0]['machines']:8.3f}", flush=True)
    return rows


def grown(of: list[Subject], known: Costs, folder: Path, x: XServer) -> list[dict]:
    """Walls from one tile to a thousand, a machine for each."""
    print("\nforetold: frames a second with a machine for each tile, by the rate of every link (Mbit/s)")
    print(f"{'':10}{'tiles':>7}{'kB/frame':>10}{'packing ms':>11}{'sending ms':>11}"
          + "".join(f"{megabits:>9,}" for megabits in MEGABITS))
    rows = []
    for subject in of:
        for side in SIDES:
            counted = count(subject, (side, side), folder, x, most=FEW)
            rates = {megabits: scenes.rate(scenes.on_machines(counted, known, megabits)) for megabits in MEGABITS}
            rows.append({"program": subject.name, "side": side, "bytes": counted.bytes, "packing": counted.packing,
                         "sending": counted.sending, "rates": rates})
            print(f"{subject.name:10}{f'{side}x{side}':>7}{counted.bytes / 1e3:10.1f}{counted.packing * 1e3:11.2f}"
                  f"{counted.sending * 1e3:11.2f}" + "".join(f"{rate:9.1f}" for rate in rates.values()), flush=True)
    return rows


def parallel(_: list[Subject], known: Costs, folder: Path, x: XServer) -> list[dict]:
    """A7.4, figure 11: G processes and R render nodes on 100 Mbit/s."""
    subject, known = large_march(), costs_of_large_march(known)
    print("\nforetold, beside figure 11 of AnyGL: frames a second of a parallel program of G processes (rows) on R "
          "nodes\n(columns), 100 Mbit/s, a machine for each")
    print(f"{'':6}" + "".join(f"{nodes:>9}" for nodes in PROCESSES))
    rows = []
    for ranks in PROCESSES:
        line = []
        for nodes in PROCESSES:
            counted = count(subject, LAYOUTS[nodes], folder, x, ranks=ranks)
            line.append(scenes.rate(scenes.on_machines(counted, known, 100)))
            rows.append({"processes": ranks, "nodes": nodes, "frames_per_second": line[-1], "bytes": counted.bytes})
        print(f"{ranks:6}" + "".join(f"{rate:9.2f}" for rate in line), flush=True)
    return rows


def many(of: list[Subject], known: Costs, folder: Path, x: XServer) -> dict:
    """A thousand programs on ten thousand tiles, a machine for each of all of these."""
    counted = [count(subject, (MANY_TILES, MANY_TILES), folder, x, most=FEW) for subject in of]
    chosen = random.Random(1)
    programs = []
    for number in range(MANY_PROGRAMS):
        left, top = (chosen.randrange(MANY_SIDE - MANY_TILES + 1) for _ in range(2))
        nodes = [(top + row) * MANY_SIDE + left + column for row in range(MANY_TILES) for column in range(MANY_TILES)]
        programs.append(scenes.program(counted[number % len(counted)], known, [number], nodes))
    tiles = MANY_SIDE**2
    hosts = [{"count": MANY_PROGRAMS + tiles, "processors": scenes.PROCESSORS} | scenes.link(1000)]
    said = scenes.simulate({"hosts": hosts, "nodes": list(range(MANY_PROGRAMS, MANY_PROGRAMS + tiles)),
                            "latency": scenes.LATENCY, "programs": programs})
    rates = [program["frames_per_second"] for program in said["programs"]]
    row = {"tiles": tiles, "programs": MANY_PROGRAMS, "computing": said["computing"], "events": said["events"],
           "time": said["time"], "least": min(rates), "median": statistics.median(rates), "busiest": said["busiest"]}
    print(f"\n{MANY_PROGRAMS:,} programs on {tiles:,} tiles, 1 Gbit/s: {said['computing']:.1f} s of computing for "
          f"{said['time']:.2f} s and {said['events']:,} events; frames a second of a program: {min(rates):.1f} at "
          f"least, {statistics.median(rates):.1f} in the middle")
    return row


PARTS = {"check": check, "scaled": scaled, "grown": grown, "parallel": parallel, "many": many}


def picture_of_scaled(rows: list[dict]) -> str:
    first = rows[0]["machines"]
    lines = [Line("foretold", [(row["nodes"], row["machines"]) for row in rows]),
             Line("measured", [(row["nodes"], row["measured"]) for row in rows if row["measured"]]),
             Line("WireGL's share", [(1, first), (rows[-1]["nodes"], WIREGL * first)])]
    return chart(f"march, {SCALED_MEGABITS} Mbit/s: measured, and foretold", "tiles", "frames a second", lines,
                 {row["nodes"]: row["tiles"] for row in rows})


def pictures(folder: Path, results: dict) -> None:
    if "scaled" in results:
        save(folder / "simulated-scaling.svg", picture_of_scaled(results["scaled"]))
    if "grown" in results:
        pictures_of_grown(folder, results["grown"])
    if "parallel" in results:
        save(folder / "simulated-parallel.svg", picture_of_parallel(results["parallel"]))


def pictures_of_grown(folder: Path, rows: list[dict]) -> None:
    for name in {row["program"] for row in rows}:
        own = [row for row in rows if row["program"] == name]
        lines = [Line(f"{megabits:,} Mbit/s", [(row["side"]**2, row["rates"][megabits]) for row in own])
                 for megabits in MEGABITS]
        save(folder / f"simulated-{name}.svg",
             chart(f"{name}: a machine for each tile", "tiles", "frames a second", lines,
                   {row["side"]**2: f"{row['side']}x{row['side']}" for row in own}))


def picture_of_parallel(rows: list[dict]) -> str:
    lines = [Line(f"{nodes} node{'s' if nodes > 1 else ''}",
                  [(row["processes"], row["frames_per_second"]) for row in rows if row["nodes"] == nodes])
             for nodes in PROCESSES]
    return chart("march, 61,000 triangles a frame, 100 Mbit/s", "processes", "frames a second", lines,
                 {ranks: str(ranks) for ranks in PROCESSES})


def judge(results: dict) -> bool:
    ratios = [row["ratio"] for row in results.get("check", []) if row["megabits"]]
    ratios += [row["foretold"] / row["measured"] for row in results.get("scaled", []) if row["measured"]]
    off = max((abs(ratio - 1) for ratio in ratios), default=0.0)
    print(f"\nforetold and measured differ by at most {100 * off:.1f} % where links have a rate, at most "
          f"{100 * OFF:.0f} % wanted")
    good = off <= OFF
    if "many" in results:
        took = results["many"]["computing"]
        print(f"10,000 tiles: {took:.1f} s of computing, at most {MOST_COMPUTING:.0f} s wanted")
        good = good and took <= MOST_COMPUTING
    return good


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--part", action="append", choices=PARTS, help="only these")
    arguments.add_argument("--json", type=Path)
    arguments.add_argument("--pictures", type=Path, help="where charts go, as SVG")
    options = arguments.parse_args()
    results: dict = {}
    with XServer() as x, tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        of = subjects(folder, x)
        for subject in of:
            print(f"{subject.name}: {subject.what}")
        known = costs(trials(of, folder, x), folder, x)
        results["costs"] = dataclasses.asdict(known)
        for name, cost in known.draw.items():
            print(f"{name}: {cost.vertex * 1e9:.0f} ns a vertex and {cost.frame * 1e3:.2f} ms a frame of a node; two "
                  f"nodes here keep {known.processors[name]:.2f} processors busy")
        for part in options.part or PARTS:
            results[part] = PARTS[part](of, known, folder, x)
        if options.pictures:
            pictures(options.pictures, results)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")
    return 0 if judge(results) else 1


if __name__ == "__main__":
    sys.exit(main())
