#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A wall of a thousand nodes that draw nothing and count what comes (bench/simulate): walld, the client library and a
real program bear it, and what is counted is what the library says that it has sent."""
from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import unittest
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "bench" / "simulate"), str(ROOT / "tests" / "support"), str(ROOT / "tests" / "golden")]
from counted import NO_LIMIT_MS, CountingWall, read  # noqa: E402
from subjects import load_recordings  # noqa: E402
from xserver import XServer  # noqa: E402

LIMIT = 120  # seconds


class ThousandNodes(unittest.TestCase):
    def counted(self, tiles: tuple[int, int]) -> tuple[list[dict[str, int]], dict]:
        """What the nodes have counted of a recording of atlantis, and what the library says."""
        recording = next(r for r in load_recordings() if r.name == "atlantis")
        with XServer() as x, tempfile.TemporaryDirectory() as name, CountingWall(
                tiles, (64, 48), name="nodes", swap_timeout_ms=NO_LIMIT_MS) as wall:
            stats, trace = Path(name) / "stats.json", Path(name) / "trace.tsv"
            subprocess.run(wall.wallrun(*recording.silent_argv(), fullscreen=True), check=True, timeout=LIMIT,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                           env=x.environment(WALLGL_STATS=str(stats), **recording.environment()))
            wall.take_trace(trace)
            return read(trace), json.loads(stats.read_text())

    def test_counts_what_the_library_has_sent(self) -> None:
        rows, said = self.counted((4, 2))
        for node in said["nodes"]:
            came = sum(row["link"] for row in rows if row["node"] == node["node"])
            self.assertEqual(came, node["total"]["link_bytes"], node)
        self.assertGreater(sum(row["vertices"] for row in rows), 1000)

    def test_every_node_gets_every_frame(self) -> None:
        rows, said = self.counted((32, 32))
        nodes_of = Counter(row["frame"] for row in rows)
        self.assertEqual(said["frames"], len(nodes_of))
        self.assertEqual(set(nodes_of.values()), {32 * 32})
        self.assertGreater(len({row["plain"] for row in rows}), 10, "tiles get different things")


if __name__ == "__main__":
    unittest.main()
