#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes docs/papers.md of papers.toml and reports of bench/run.sh: what the papers measured, and what is measured here.

page.py REPORT... [--page FILE] [--pictures FOLDER]
    of several reports that have the same benchmark the last one counts
    exit code 1 if something is not better here, and papers.toml does not say why
"""
from __future__ import annotations

import argparse
import dataclasses
import json
import math
import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE.parent / "simulate"))
from chart import Line, chart, save  # noqa: E402

NOT_RUN, NOT_THERE = "not run", "none"
HEAD = """# The papers' figures, and ours

WallGL stands on four papers ([design.md](design.md#sources)). Each table and figure of theirs that can be run here is
here, theirs beside ours. Machines differ by two decades, so what compares is ratios within a system; raw rates are
shown because they are what the papers tell. `bench/papers.sh` measures all of it and writes this page.

"""


class Missing(Exception):
    """A report does not have it."""


@dataclasses.dataclass(frozen=True)
class Measured:
    """A benchmark's figures, and of what they are."""

    figures: object
    commit: str
    machine: str


Reports = dict[str, Measured]


def read_reports(paths: list[Path]) -> Reports:
    out: Reports = {}
    for path in paths:
        report = json.loads(path.read_text())
        for name, figures in report["benchmarks"].items():
            out[name] = Measured(figures, report["commit"], report["machine"])
    return out


def find(reports: Reports, way: list[str]) -> float:
    """The number at the end of the way: keys, or KEY=VALUE for an entry of a list."""
    if way[0] not in reports:
        raise Missing(way[0])
    at = reports[way[0]].figures
    for step in way[1:]:
        if isinstance(at, list):
            key, _, value = step.partition("=")
            at = next((entry for entry in at if entry.get(key) == value), None)
        else:
            at = at.get(step) if isinstance(at, dict) else None
        if at is None:
            raise Missing("/".join(way))
    return float(at)


def ours(reports: Reports, row: dict) -> float:
    value = find(reports, row["ours"])
    if "over" in row:
        value /= find(reports, row["over"])
    if row.get("inverse"):
        value = 1 / value
    return value * row.get("times", 1)


def number(value: float) -> str:
    """Three digits that count."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    digits = max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:,.{digits}f}"


def is_better(row: dict, value: float) -> bool | None:
    if "better" not in row:
        return None
    return value >= row["theirs"] if row["better"] == "higher" else value <= row["theirs"]


def table_row(reports: Reports, row: dict) -> tuple[str, bool]:
    """And whether nothing is left to be said."""
    theirs = row["theirs"] if isinstance(row["theirs"], str) else number(row["theirs"])
    why = row.get("why", "")
    if "ours" not in row:
        return f"| {row['what']} | {theirs} | {NOT_THERE} | {why} |", bool(why)
    try:
        value = ours(reports, row)
    except Missing:
        return f"| {row['what']} | {theirs} | {NOT_RUN} | {why} |", True
    better = is_better(row, value)
    said = {None: why, True: why}.get(better, f"not better: {why or 'nobody has said why'}")
    return f"| {row['what']} | {theirs} | {number(value)} | {said} |", better is not False or bool(why)


def picture(reports: Reports, drawn: dict, title: str, folder: Path) -> str:
    """Saves it; the line that shows it, empty if there is nothing to show."""
    if drawn["benchmark"] not in reports:
        return ""
    figures = reports[drawn["benchmark"]].figures
    lines, labels = [], {}
    for name, (program, how) in drawn["lines"].items():
        points = []
        for layout, row in figures.get(program, {}).items():
            if drawn["value"] not in row.get(how, {}):
                continue
            columns, rows = map(int, layout.split("x"))
            labels[float(columns * rows)] = layout
            points.append((float(columns * rows), row[how][drawn["value"]]))
        if points:
            lines.append(Line(name, points))
    if not lines:
        return ""
    save(folder / drawn["file"], chart(title.split(" (")[0], "tiles", drawn["name"], lines, labels))
    return f"![{drawn['name']}](images/{drawn['file']})\n\n"


def page(papers: list[dict], reports: Reports, pictures: Path) -> tuple[str, list[str]]:
    """And what is not better without a reason."""
    out, unexplained = HEAD, []
    for paper in papers:
        out += f"## {paper['letter']}: {paper['title']}\n\n{paper['text']}\n\n"
        for table in paper["table"]:
            out += f"**{table['title']}** ({table['section']})\n\n| | theirs | ours | |\n|---|---|---|---|\n"
            for row in table["row"]:
                line, explained = table_row(reports, row)
                out += line + "\n"
                if not explained:
                    unexplained.append(f"{table['section']}: {row['what']}")
            out += "\n"
            if "picture" in table:
                out += picture(reports, table["picture"], table["title"], pictures)
    out += "## What was measured\n\n| benchmark | commit | processor |\n|---|---|---|\n"
    out += "".join(f"| `{name}` | {measured.commit[:9]} | {measured.machine} |\n"
                   for name, measured in sorted(reports.items()) if name in used(papers))
    return out, unexplained


def used(papers: list[dict]) -> set[str]:
    """Benchmarks that some row is of."""
    rows = [row for paper in papers for table in paper["table"] for row in table["row"]]
    return {row[way][0] for row in rows for way in ("ours", "over") if way in row}


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("reports", nargs="*", type=Path)
    arguments.add_argument("--page", type=Path, default=ROOT / "docs" / "papers.md")
    arguments.add_argument("--pictures", type=Path, default=ROOT / "docs" / "images")
    arguments.add_argument("--benchmarks", action="store_true", help="prints the names of those that are used")
    options = arguments.parse_args()
    papers = tomllib.loads((HERE / "papers.toml").read_text())["paper"]
    if options.benchmarks:
        print("\n".join(sorted(used(papers))))
        return 0
    text, unexplained = page(papers, read_reports(options.reports), options.pictures)
    options.page.write_text(text)
    for what in unexplained:
        print(f"not better here, and papers.toml does not say why: {what}")
    return 1 if unexplained else 0


if __name__ == "__main__":
    sys.exit(main())
