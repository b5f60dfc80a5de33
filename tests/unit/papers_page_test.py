#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The page of the papers' figures (bench/papers): what it says of reports, and that the papers' data are sound."""
import json
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench" / "papers"))
import page  # noqa: E402

PAPERS = tomllib.loads((ROOT / "bench" / "papers" / "papers.toml").read_text())["paper"]
REPORT = {"commit": "0123456789abcdef", "machine": "a machine", "benchmarks": {
    "state": {"benchmarks": [{"name": "A", "cpu_time": 500.0}, {"name": "B", "cpu_time": 2.0}]},
    "rates": {"all": {"one": 4.0, "two": 10.0}},
    "scaling": {"march": {"1x1": {"sorted": {"efficiency": 1.0}}, "8x4": {"sorted": {"efficiency": 0.9}}}}}}


class Page(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "a.json").write_text(json.dumps(REPORT))
        self.reports = page.read_reports([self.folder / "a.json"])

    def row(self, **keys) -> tuple[str, bool]:
        return page.table_row(self.reports, {"what": "it", **keys})

    def test_ways_lead_to_numbers(self):
        self.assertEqual(page.find(self.reports, ["state", "benchmarks", "name=B", "cpu_time"]), 2)
        for way in (["nothing"], ["state", "benchmarks", "name=C", "cpu_time"], ["rates", "all", "three"]):
            with self.assertRaises(page.Missing):
                page.find(self.reports, way)
        self.assertEqual(page.ours(self.reports, {"ours": ["rates", "all", "two"], "over": ["rates", "all", "one"]}),
                         2.5)
        self.assertEqual(page.ours(self.reports, {"ours": ["rates", "all", "one"], "inverse": True, "times": 100}), 25)

    def test_what_is_better_is_said_by_the_numbers(self):
        self.assertEqual(self.row(theirs=9, ours=["rates", "all", "two"], better="higher"),
                         ("| it | 9.00 | 10.0 |  |", True))
        self.assertEqual(self.row(theirs=9, ours=["rates", "all", "two"], better="lower"),
                         ("| it | 9.00 | 10.0 | not better: nobody has said why |", False))
        self.assertEqual(self.row(theirs=9, ours=["rates", "all", "two"], better="lower", why="it is cold"),
                         ("| it | 9.00 | 10.0 | not better: it is cold |", True))
        self.assertEqual(self.row(theirs="a picture", ours=["rates", "all", "two"]),
                         ("| it | a picture | 10.0 |  |", True))
        self.assertEqual(self.row(theirs=9, ours=["later"], better="higher"), ("| it | 9.00 | not run |  |", True))
        self.assertEqual(self.row(theirs=9, why="later"), ("| it | 9.00 | none | later |", True))
        self.assertFalse(self.row(theirs=9)[1])

    def test_the_last_report_counts(self):
        later = REPORT | {"commit": "f" * 40, "benchmarks": {"rates": {"all": {"one": 7.0}}}}
        (self.folder / "b.json").write_text(json.dumps(later))
        reports = page.read_reports([self.folder / "a.json", self.folder / "b.json"])
        self.assertEqual(page.find(reports, ["rates", "all", "one"]), 7)
        self.assertEqual(reports["rates"].commit, "f" * 40)
        self.assertEqual(reports["state"].commit, REPORT["commit"])

    def test_numbers_have_three_digits(self):
        for value, text in ((5817152, "5,817,152"), (22.6, "22.6"), (0.81, "0.810"), (0.0044, "0.00440"), (0, "0")):
            self.assertEqual(page.number(value), text)

    def test_the_papers_data_makes_a_page_of_any_reports(self):
        text, unexplained = page.page(PAPERS, self.reports, self.folder)
        self.assertEqual(unexplained, [])
        for paper in PAPERS:
            self.assertIn(f"## {paper['letter']}: ", text)
        self.assertIn("![network efficiency]", text)
        self.assertIn("March", (self.folder / "papers-efficiency.svg").read_text())
        self.assertIn("| `scaling` | 012345678 | a machine |", text)

    def test_all_rows_have_what_they_need(self):
        known = {"what", "theirs", "ours", "over", "times", "inverse", "better", "why"}
        runs = (ROOT / "bench" / "run.sh").read_text()
        for table in (table for paper in PAPERS for table in paper["table"]):
            for row in table["row"]:
                self.assertLessEqual(set(row), known, row)
                self.assertIn(row.get("better", "higher"), ("higher", "lower"))
                if "better" in row:
                    self.assertNotIsInstance(row["theirs"], str, row)
                for way in (row[name] for name in ("ours", "over") if name in row):
                    self.assertIn(f"\nrun {way[0]} ", runs)


if __name__ == "__main__":
    unittest.main()
