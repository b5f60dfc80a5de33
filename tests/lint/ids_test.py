# SPDX-License-Identifier: MIT
"""Ids are types (common/base/ids.h) in headers; numbers belong to the wire's edge (ids.toml says how many are left)."""

import pathlib
import re
import tomllib
import unittest

import project

CEILINGS = tomllib.loads((pathlib.Path(__file__).parent / "ids.toml").read_text(encoding="utf-8"))["raw"]
# A parameter, a member or a variable that is a number and is called like something that has an id.
RAW = re.compile(r"\bstd::uint(?:32|64)_t (?:\w+_)?(?:id|surface|context|session|node|request)_?\b(?!\()")
COMMENT = re.compile(r"//[^\n]*")


def raw_ids(text: str) -> int:
    return len(RAW.findall(COMMENT.sub("", text)))


def by_folder(headers: dict[str, str]) -> dict[str, int]:
    counts: dict[str, int] = {}
    for path, text in headers.items():
        folder = path.split("/")[0]
        counts[folder] = counts.get(folder, 0) + raw_ids(text)
    return counts


def wrong_counts(counts: dict[str, int], ceilings: dict[str, int]) -> list[str]:
    found = []
    for folder in sorted(set(counts) | set(ceilings)):
        count, ceiling = counts.get(folder, 0), ceilings.get(folder, 0)
        if count > ceiling:
            found.append(f"{folder}: {count} ids are numbers in headers, at most {ceiling} may (common/base/ids.h)")
        if count < ceiling:
            found.append(f"{folder}: only {count} ids left that are numbers; say so in ids.toml")
    return found


class Checker(unittest.TestCase):
    def test_numbers_that_are_ids(self):
        self.assertEqual(raw_ids("void open(std::uint32_t surface, std::uint32_t width);\nstd::uint64_t last_id_ = 0;"),
                         2)

    def test_what_is_none(self):
        self.assertEqual(raw_ids("SurfaceId surface; std::uint32_t surfaces, count; // std::uint32_t id\n"), 0)
        self.assertEqual(raw_ids("std::uint32_t next_id();"), 0)

    def test_a_ceiling_holds_exactly(self):
        counts = by_folder({"a/x.h": "std::uint32_t id;", "a/y.h": "std::uint32_t node;"})
        self.assertEqual(wrong_counts(counts, {"a": 2}), [])
        for ceiling in (0, 1, 3):
            self.assertEqual(len(wrong_counts(counts, {"a": ceiling})), 1)


class Project(unittest.TestCase):
    def test_ids(self):
        headers = {path: project.text(path) for path in project.files(".h")}
        project.expect_none(self, wrong_counts(by_folder(headers), CEILINGS))


if __name__ == "__main__":
    unittest.main()
