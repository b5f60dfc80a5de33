# SPDX-License-Identifier: MIT
"""clang-format agrees with every C++ file, as .clang-format says. Versions of it differ, so it is Debian 12's."""

import re
import shutil
import subprocess
import unittest

import project

VERSION = "14"
NAMES = ("clang-format-" + VERSION, "clang-format")


def find_formatter() -> str | None:
    for name in NAMES:
        path = shutil.which(name)
        said = subprocess.run([path, "--version"], capture_output=True, text=True, check=True).stdout if path else ""
        if re.search(rf"version {VERSION}\.", said):
            return path
    return None


def disagreements(formatter: str, paths: list[str]) -> list[str]:
    """The places that would change, as `FILE:LINE:COLUMN: ...`."""
    command = [formatter, "--dry-run", "--style=file:" + str(project.ROOT / ".clang-format"), *paths]
    said = subprocess.run(command, cwd=project.ROOT, capture_output=True, text=True, check=True).stderr
    return [line for line in said.splitlines() if re.match(r".+:\d+:\d+: ", line)]


class Format(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.formatter = find_formatter()
        if cls.formatter is None:
            raise AssertionError(f"no clang-format {VERSION}: expected the package clang-format of Debian 12")

    def test_a_file_in_another_format_is_found(self):
        with project.scratch_file("int  f( ) { return 1; }\n", ".cpp") as path:
            self.assertRegex("\n".join(disagreements(self.formatter, [path])), r"^/.+\.cpp:1:\d+: ")

    def test_a_file_in_this_format_is_not(self):
        with project.scratch_file("int f() { return 1; }\n", ".cpp") as path:
            self.assertEqual(disagreements(self.formatter, [path]), [])

    def test_the_project(self):
        project.expect_none(self, disagreements(self.formatter, project.files(*project.CPP)))


if __name__ == "__main__":
    unittest.main()
