#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What watching costs the programs: frames a second on 2x2 tiles of 1920x1080 while nobody watches, and while one
viewer gets all four tiles losslessly at full size and 10 frames a second. Both take turns.

stream_cost.py [--rounds N] [--seconds S] [--codec NAME] [--json FILE]
exit code 1 if the program that leaves the processors time loses 5 % or more; the others are shown, too
"""
from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from wall import Wall  # noqa: E402
from websocket import WebSocket  # noqa: E402
from xserver import XServer  # noqa: E402

BAR = 0.95
TILE = (1920, 1080)
HACKS = Path("/usr/libexec/xscreensaver")
WINDOW = (1440, 810, 960, 540)  # over all four tiles


class Viewer(threading.Thread):
    """Reads whatever comes, and counts it."""

    def __init__(self, wall: Wall, codec: str):
        super().__init__(daemon=True)
        self.frames = self.bytes = 0
        self.socket = WebSocket(wall.url)
        self.socket.watch({"wall": True, "codec": codec, "fps": 10})
        self.start()

    def run(self) -> None:
        try:
            while True:
                message = self.socket.message(60)
                if isinstance(message, bytes):
                    self.frames += 1
                    self.bytes += len(message)
        except (OSError, ValueError, ConnectionError):
            pass

    def close(self) -> None:
        self.socket.socket.shutdown(2)
        self.join()


def busy() -> tuple[float, float]:
    """Seconds of all processors together: used, and in all."""
    fields = [int(word) for word in Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:9]]
    ticks = os.sysconf("SC_CLK_TCK")
    return (sum(fields) - fields[3] - fields[4]) / ticks, sum(fields) / ticks


def rate(wall: Wall, session: int, seconds: float) -> tuple[float, float]:
    """Frames a second that the wall shows, and how much of the processors was used."""
    start, first, used = time.monotonic(), wall.wait(session, 1), busy()
    time.sleep(seconds)
    last, spent, now = wall.wait(session, 1), time.monotonic() - start, busy()
    return (last - first) / spent, (now[0] - used[0]) / (now[1] - used[1])


def measure(program: list[str], options: argparse.Namespace, x: XServer) -> dict:
    with Wall(tiles=(2, 2), tile_size=TILE, name="stream-cost", swap_timeout_ms=10000) as wall:
        app = wall.run(*program, rect=WINDOW, env=x.environment(), stdout=subprocess.DEVNULL)
        session = wall.wait_session(app)
        wall.wait(session, 10, limit=60)
        alone, watched, streams = [], [], []
        for _ in range(options.rounds):
            alone.append(rate(wall, session, options.seconds))
            viewer = Viewer(wall, options.codec)
            time.sleep(1)
            frames, size = viewer.frames, viewer.bytes
            watched.append(rate(wall, session, options.seconds))
            streams.append(((viewer.frames - frames) / options.seconds / 4, (viewer.bytes - size) / options.seconds))
            viewer.close()
            time.sleep(0.5)
    median = statistics.median
    return {"alone_per_second": median(r for r, _ in alone), "watched_per_second": median(r for r, _ in watched),
            "ratio": median(w / a for (a, _), (w, _) in zip(alone, watched)),
            "processors_alone": median(u for _, u in alone), "processors_watched": median(u for _, u in watched),
            "stream_frames_per_tile_and_second": median(f for f, _ in streams),
            "stream_bytes_per_second": median(b for _, b in streams)}


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--rounds", type=int, default=5)
    arguments.add_argument("--seconds", type=float, default=6)
    arguments.add_argument("--codec", default="huffyuv-tiles")
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    programs = {"paced, 15 frames/s": [str(HACKS / "sballs"), "-delay", "66000"],
                "as fast as it can": ["glxgears"]}
    results = {}
    with XServer() as x:
        for name, program in programs.items():
            result = results[name] = measure(program, options, x)
            print(f"{name:20} {result['alone_per_second']:7.2f} frames/s alone, {result['watched_per_second']:7.2f} "
                  f"watched ({result['ratio']:.3f}); "
                  f"processors used {result['processors_alone']:.0%} and {result['processors_watched']:.0%}; viewer "
                  f"gets "
                  f"{result['stream_frames_per_tile_and_second']:.1f} frames/s a tile, "
                  f"{result['stream_bytes_per_second'] / 1e6:.1f} MB/s", flush=True)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")
    ratio = next(iter(results.values()))["ratio"]
    print(f"with processors to spare: {ratio:.3f}, more than {BAR} wanted")
    return 0 if ratio > BAR else 1


if __name__ == "__main__":
    sys.exit(main())
