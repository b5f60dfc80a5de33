# SPDX-License-Identifier: MIT
"""What a piglit test said, and whether it is worse on the wall than on plain Mesa."""
from __future__ import annotations

import collections
import dataclasses
import json
from collections.abc import Iterable

MARK = "PIGLIT: {"  # what a test says to its harness; not always at the start of a line

# The lower the better. "crash": ended without a result and not with 0; "none": ended with 0, without a result.
RANKS = {"pass": 0, "skip": 0, "warn": 1, "fail": 2, "crash": 3, "timeout": 3, "none": 3}


@dataclasses.dataclass(frozen=True)
class Result:
    status: str
    subtests: dict[str, str] = dataclasses.field(default_factory=dict)
    output: str = ""  # without what was for the harness
    seconds: float = 0.0

    @property
    def good(self) -> bool:
        return RANKS[self.status] == 0

    def last_lines(self, count: int) -> list[str]:
        return [line for line in self.output.splitlines() if line.strip()][-count:]

    @property
    def reason(self) -> str:
        """Of a test that was skipped."""
        said = (self.last_lines(1) or ["it does not say"])[0].strip()
        return said.removeprefix("piglit: ").removeprefix("info: ").removeprefix("error: ")


def read_messages(output: str) -> tuple[dict, dict[str, str], str]:
    """The last result, all subtests and the text between them."""
    result, subtests, text = {}, {}, []
    for line in output.splitlines():
        before, mark, message = line.partition(MARK)
        if mark:
            try:
                told = json.loads("{" + message)
            except ValueError:  # cut off
                told = {}
            result = told if "result" in told else result
            subtests.update(told.get("subtest", {}))
        if before or not mark:
            text.append(before)
    return result, subtests, "\n".join(text)


def read_result(output: str, exit_code: int | None, seconds: float = 0.0) -> Result:
    """`exit_code` is None for a test that had to be ended."""
    told, subtests, text = read_messages(output)
    status = told.get("result", "none" if exit_code == 0 else "crash")
    if exit_code is None:
        status = "timeout"
    elif exit_code < 0:
        status = "crash"
    return Result(status if status in RANKS else "fail", subtests, text, seconds)


def worse(given: Result, reference: Result) -> str:
    """Why `given` is worse than `reference`, or nothing. A test that was skipped asks for what is not offered; of one
    that passed, the subtests are its own affair. Otherwise a subtest may not be worse either, nor missing."""
    if given.good:
        return ""
    if RANKS[given.status] > RANKS[reference.status]:
        return f"{given.status}, on Mesa {reference.status}"
    lost = sorted(name for name, status in reference.subtests.items()
                  if RANKS.get(given.subtests.get(name, "none"), 2) > RANKS.get(status, 2))
    return f"{given.status} as on Mesa, but worse in {len(lost)} subtests: {', '.join(lost[:4])}" if lost else ""


@dataclasses.dataclass(frozen=True)
class Outcome:
    """Of one test on one wall. `reference` is None for a test that passed or was skipped: Mesa was not asked."""

    name: str
    group: str
    given: Result
    reference: Result | None = None

    @property
    def worse(self) -> str:
        return worse(self.given, self.reference) if self.reference else ""


@dataclasses.dataclass(frozen=True)
class Expected:
    """A test that is known to be worse on the wall than on Mesa."""

    test: str
    status: str  # no worse than that
    walls: frozenset[str]  # as "4x3 of 144x150"; empty: every wall
    reason: str
    sometimes: bool = False  # chance decides, on Mesa too: one that is no worse in a run is not stale


VERDICTS = ("pass", "skip", "as Mesa", "expected", "FAILED", "STALE")


@dataclasses.dataclass
class Judgement:
    """Outcomes by verdict: `as Mesa` is wrong, but no worse than there; `STALE` is expected to be worse, and is not."""

    verdicts: dict[str, str]  # of a test, by its name
    outcomes: list[Outcome]
    strangers: list[str]  # expected failures of tests that there are not

    def of(self, verdict: str) -> list[Outcome]:
        return [outcome for outcome in self.outcomes if self.verdicts[outcome.name] == verdict]

    def table(self) -> list[tuple[str, collections.Counter]]:
        """Counts of verdicts by group, and the sum."""
        groups: dict[str, collections.Counter] = {}
        for outcome in self.outcomes:
            groups.setdefault(outcome.group, collections.Counter())[self.verdicts[outcome.name]] += 1
        return [*groups.items(), ("all", sum(groups.values(), collections.Counter()))]

    def skips(self) -> collections.Counter:
        return collections.Counter(outcome.given.reason for outcome in self.of("skip"))

    @property
    def good(self) -> bool:
        return bool(self.outcomes) and not self.strangers and not self.of("FAILED") and not self.of("STALE")


def verdict(outcome: Outcome, expected: Expected | None) -> str:
    if not outcome.worse:
        if expected and not expected.sometimes and outcome.given.status != "skip":
            return "STALE"
        return outcome.given.status if outcome.given.good else "as Mesa"
    if expected and RANKS[outcome.given.status] <= RANKS[expected.status]:
        return "expected"
    return "FAILED"


def judge(outcomes: Iterable[Outcome], expected: dict[str, Expected], known: Iterable[str]) -> Judgement:
    """`expected`: tests that are known to be worse on this wall. `known`: the names of all tests there are."""
    listed = list(outcomes)
    return Judgement({each.name: verdict(each, expected.get(each.name)) for each in listed}, listed,
                     sorted(set(expected) - set(known)))
