# SPDX-License-Identifier: MIT
"""A Result that nobody looks at does not compile, with the options of every target (WALLGL_CXX, WALLGL_CXX_OPTIONS)."""

import os
import subprocess
import unittest

import project

HEAD = """
#include "walld/wall/refusal.h"
wall::Result<int> number();
wall::Result<void> nothing();
wall::walld::Outcome<int> outcome();
wall::Result<int> next(int);
void use() {
"""


def messages(statement: str) -> str:
    """What the compiler says; empty: it compiles."""
    command = [os.environ["WALLGL_CXX"], "-std=c++20", "-fsyntax-only", "-I", str(project.ROOT),
               *os.environ["WALLGL_CXX_OPTIONS"].split(";")]
    with project.scratch_file(HEAD + statement + "}\n", ".cpp") as path:
        done = subprocess.run([*command, path], capture_output=True, text=True, check=False)
    return done.stderr if done.returncode != 0 else ""


class Results(unittest.TestCase):
    def test_what_is_looked_at_compiles(self):
        self.assertEqual(messages("if (number() && nothing() && outcome()) (void)number().and_then(next);"), "")

    def test_what_is_ignored_does_not(self):
        for ignored in ("number();", "nothing();", "outcome();", "number().and_then(next);"):
            self.assertRegex(messages(ignored), "error: ignoring return", ignored)


if __name__ == "__main__":
    unittest.main()
