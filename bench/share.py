#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Eight programs with the same 64 MiB of textures (bench/many_textures.cpp), started at once, on 2x1 tiles: what the
nodes' memory and the bytes sent grow from one program to eight; beside them eight programs with different textures, and
eight processes of one parallel program that share theirs by name (GL_WALLGL_global_texture).

share.py [--programs N] [--json FILE]      exit code 1 if either grows 1.1 times or more
"""
from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

BAR = 1.1
WINDOW = 128
ONE, SAME = "one program", "{}, the same textures"
GLOBAL, DIFFERENT = "{} processes of one, global textures", "{}, different textures"


def resident(pid: int) -> int:
    """Bytes of a process in memory."""
    return 1024 * int(re.search(r"VmRSS:\s+(\d+)", Path(f"/proc/{pid}/status").read_text())[1])


def measure(count: int, kind: str, x: XServer) -> dict:
    """`count` programs at once, each over the border between the two tiles, on a fresh wall."""
    with Wall(tiles=(2, 1), tile_size=(512, 512), name="share",
              swap_timeout_ms=10000) as wall, tempfile.TemporaryDirectory() as folder:
        nodes = [wall.daemons[name] for name in wall.node_names]
        before = sum(resident(node.pid) for node in nodes)
        start = time.monotonic()
        apps, files = [], []
        for i in range(count):
            files.append(Path(folder) / f"{i}.json")
            group = {"WALLGL_PARALLEL": f"share:{i}:{count}"} if kind == GLOBAL else {}
            apps.append(wall.run(build_folder() / "bench" / "many_textures", "--seed", i if kind == DIFFERENT else 0,
                                 "--window", WINDOW,
                                 "--global", int(kind == GLOBAL),
                                 rect=(512 - WINDOW // 2, (i * 61) % (512 - WINDOW), WINDOW, WINDOW),
                                 env=x.environment(WALLGL_STATS=str(files[-1]), **group), stdout=subprocess.PIPE,
                                 text=True))
        for app in apps:
            if app.stdout.readline().strip() != "drawn":
                raise RuntimeError("a program ended early")
        seconds = time.monotonic() - start
        time.sleep(2.5)  # the statistics are written each second
        grown = sum(resident(node.pid) for node in nodes) - before
        totals = [json.loads(file.read_text())["total"] for file in files]
        sent = sum(total[kind] for total in totals for kind in ("state_bytes", "object_bytes", "geometry_bytes"))
    return {"memory_bytes": grown, "sent_bytes": sent, "seconds": seconds}


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--programs", type=int, default=8)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    results = {}
    with XServer() as x:
        for kind in (ONE, SAME, GLOBAL, DIFFERENT):
            name = kind.format(options.programs)
            results[name] = measure(1 if kind == ONE else options.programs, kind, x)
            one = results[ONE]
            growth = {kind: results[name][kind] / one[kind] for kind in ("memory_bytes", "sent_bytes")}
            results[name]["growth"] = growth
            print(f"{name:42} memory of both nodes {results[name]['memory_bytes'] / 2**20:7.1f} MiB "
                  f"({growth['memory_bytes']:.3f})   "
                  f"sent {results[name]['sent_bytes'] / 2**20:7.1f} MiB ({growth['sent_bytes']:.3f})   "
                  f"first frames after {results[name]['seconds']:.1f} s", flush=True)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")
    worst = max(max(results[kind.format(options.programs)]["growth"].values()) for kind in (SAME, GLOBAL))
    print(f"what is shared grows {worst:.3f} times, less than {BAR} wanted")
    return 0 if worst < BAR else 1


if __name__ == "__main__":
    sys.exit(main())
