# SPDX-License-Identifier: MIT
"""What a run found, for people (report.txt) and for programs (report.json)."""
from __future__ import annotations

import dataclasses
import json
from pathlib import Path

from results import VERDICTS, Expected, Judgement, Outcome

SHOWN_LINES = 12  # of a failed test's output
SHOWN_SKIPS = 20  # reasons


@dataclasses.dataclass(frozen=True)
class Run:
    wall: str  # as "4x3 of 144x150"
    seconds: float
    left_out: dict[str, int]  # tests by the reason
    aftermath: list[str]  # what is wrong with the wall afterwards

    def good(self, judgement: Judgement) -> bool:
        return judgement.good and not self.aftermath


def table(judgement: Judgement) -> list[str]:
    rows = [("group", "tests", *VERDICTS)]
    rows += [(group, str(counts.total()), *(str(counts[verdict]) for verdict in VERDICTS)) for group,
             counts in judgement.table()]
    width = max(len(row[0]) for row in rows)
    return ["".join([row[0].ljust(width), *(cell.rjust(10) for cell in row[1:])]) for row in rows]


def failure(outcome: Outcome) -> list[str]:
    return [f"FAILED {outcome.name}: {outcome.worse}"] + ["    " + line
                                                          for line in outcome.given.last_lines(SHOWN_LINES)]


def text(run: Run, judgement: Judgement, expected: dict[str, Expected]) -> str:
    lines = [f"piglit on a wall: tiles {run.wall}", "", *table(judgement), ""]
    reasons = judgement.skips().most_common()
    lines += [f"skipped {count}: {reason}" for reason, count in reasons[:SHOWN_SKIPS]]
    lines += [f"skipped {sum(count for _, count in reasons[SHOWN_SKIPS:])} for {len(reasons) - SHOWN_SKIPS} other "
              f"reasons"] * (len(reasons) > SHOWN_SKIPS)
    lines += [f"left out {count}: {reason}" for reason, count in run.left_out.items()]
    lines += [f"as Mesa {outcome.name}: {outcome.given.status}, there {outcome.reference.status}"
              for outcome in judgement.of("as Mesa")]
    lines += [f"expected {outcome.name}: {outcome.worse}; {expected[outcome.name].reason}"
              for outcome in judgement.of("expected")]
    lines += [line for outcome in judgement.of("FAILED") for line in failure(outcome)]
    lines += [f"STALE {outcome.name}: no worse than on Mesa; take it out of expectations.toml"
              for outcome in judgement.of("STALE")]
    lines += [f"STALE {name}: there is no such test; take it out of expectations.toml" for name in judgement.strangers]
    lines += [f"FAILED wall: {each}" for each in run.aftermath]
    return "\n".join(lines) + "\n"


def summary(run: Run, judgement: Judgement) -> str:
    sums = judgement.table()[-1][1]
    return (f"{sums.total()} tests on tiles {run.wall} in {run.seconds:.0f} s: "
            + ", ".join(f"{sums[each]} {each}" for each in VERDICTS) +
            f", {len(judgement.strangers)} expected of no test, {len(run.aftermath)} wrong with the wall")


def as_json(run: Run, judgement: Judgement) -> dict:
    def entry(outcome: Outcome) -> dict:
        told = {"name": outcome.name, "group": outcome.group, "verdict": judgement.verdicts[outcome.name],
                "status": outcome.given.status, "seconds": outcome.given.seconds, "subtests": outcome.given.subtests}
        if outcome.given.status == "skip":
            told["reason"] = outcome.given.reason
        if outcome.reference:
            told |= {"worse": outcome.worse, "output": outcome.given.output,
                     "mesa": {"status": outcome.reference.status, "subtests": outcome.reference.subtests,
                              "output": outcome.reference.output}}
        return told

    return {"wall": run.wall, "seconds": round(run.seconds, 1), "good": run.good(judgement), "aftermath": run.aftermath,
            "left_out": run.left_out, "strangers": judgement.strangers, "skips": dict(judgement.skips()),
            "groups": {group: dict(counts) for group, counts in judgement.table()},
            "tests": [entry(each) for each in judgement.outcomes]}


def write(folder: Path, run: Run, judgement: Judgement, expected: dict[str, Expected]) -> str:
    """Gives the text."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "report.json").write_text(json.dumps(as_json(run, judgement), indent=1) + "\n")
    told = text(run, judgement, expected) + "\n" + summary(run, judgement) + "\n"
    (folder / "report.txt").write_text(told)
    return told
