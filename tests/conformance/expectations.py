# SPDX-License-Identifier: MIT
"""The list of tests that are known to be worse on a wall than on Mesa (expectations.toml)."""
from __future__ import annotations

import tomllib
from pathlib import Path

from results import RANKS, Expected


def load(path: Path) -> list[Expected]:
    listed = []
    for entry in tomllib.loads(path.read_text()).get("expected", []):
        names = entry["tests"]
        if not entry.get("reason", "").strip():
            raise ValueError(f"{path}: the entry of {names[0]} gives no reason")
        status = entry.get("status", "fail")
        if RANKS.get(status, 0) == 0:
            raise ValueError(f"{path}: {names[0]}: status is '{status}', expected one of "
                             f"{', '.join(s for s, rank in RANKS.items() if rank)}")
        listed += [Expected(name, status, frozenset(entry.get("walls", [])), entry["reason"],
                            entry.get("sometimes", False)) for name in names]
    return listed


def on_wall(expected: list[Expected], wall: str) -> dict[str, Expected]:
    """By the test's name."""
    return {each.test: each for each in expected if not each.walls or wall in each.walls}
