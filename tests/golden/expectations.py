# SPDX-License-Identifier: MIT
"""The list of what is known to be wrong (expectations.toml): it may neither miss a failure nor hold one that is
gone."""
from __future__ import annotations

import dataclasses
import tomllib
from collections.abc import Iterable
from pathlib import Path

VIEWS = ("read", "shown", "text", "exit", "round_trips", "reference")


@dataclasses.dataclass(frozen=True, order=True)
class Check:
    """One thing that was compared. `frame` is -1 for what concerns the whole run."""

    subject: str
    tiles: str
    view: str
    frame: int = -1

    def __str__(self) -> str:
        return f"{self.subject} on {self.tiles}, {self.view}" + (f", frame {self.frame}" if self.frame >= 0 else "")


@dataclasses.dataclass(frozen=True)
class Outcome:
    check: Check
    good: bool
    detail: str
    near: bool = False  # a picture whose every pixel lies near those around it in the reference (compare.py)


@dataclasses.dataclass(frozen=True)
class Expected:
    reason: str
    sometimes: bool = False  # chance decides: it may be right as well
    near: bool = False  # it may be wrong only so far


def load(path: Path) -> dict[Check, Expected]:
    """Failures that are expected."""
    expected = {}
    for entry in tomllib.loads(path.read_text()).get("expected", []):
        if not entry.get("reason", "").strip():
            raise ValueError(f"{path}: the entry of {entry['subject']} gives no reason")
        if entry["view"] not in VIEWS:
            raise ValueError(f"{path}: {entry['subject']}: view is '{entry['view']}', expected one of "
                             f"{', '.join(VIEWS)}")
        for tiles in entry["tiles"]:
            for frame in entry.get("frames", [-1]):
                check = Check(entry["subject"], tiles, entry["view"], frame)
                expected[check] = Expected(entry["reason"], entry.get("sometimes", False),
                                           entry.get("near", False))
    return expected


@dataclasses.dataclass
class Judgement:
    failures: list[Outcome]
    expected: list[Outcome]
    unexpected_passes: list[Check]

    @property
    def good(self) -> bool:
        return not self.failures and not self.unexpected_passes


def judge(outcomes: Iterable[Outcome], expected: dict[Check, Expected]) -> Judgement:
    judgement = Judgement([], [], [])
    for outcome in outcomes:
        known = expected.get(outcome.check)
        if outcome.good and known and not known.sometimes:
            judgement.unexpected_passes.append(outcome.check)
        elif not outcome.good:
            excused = known and (outcome.near or not known.near)
            (judgement.expected if excused else judgement.failures).append(outcome)
    return judgement
