# SPDX-License-Identifier: MIT
"""What people see of a build (scripts/build.py)."""
import io
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from build import Progress  # noqa: E402

FAILING = ["[1/3] Building CXX object a.o", "[2/3] Building CXX object b.o", "FAILED: b.o ", "/usr/bin/c++ -c b.cpp",
           "b.cpp:1:10: fatal error: GL/osmesa.h: No such file or directory", "[3/3] Building CXX object c.o",
           "c.cpp:1: warning: odd", "ninja: build stopped: subcommand failed."]


def shown(lines: list[str], terminal: bool, result: int) -> str:
    out = io.StringIO()
    ticks = iter(range(10_000))
    progress = Progress("building", terminal, out, lambda: float(next(ticks)))
    for line in lines:
        progress.line(line)
    progress.end(result)
    return out.getvalue()


class Build(unittest.TestCase):
    def test_a_line_for_each_tenth(self) -> None:
        lines = shown([f"[{n}/400] Building CXX object {n}.o" for n in range(1, 401)], False, 0).splitlines()
        self.assertEqual(len(lines), 12)
        self.assertEqual(lines[1], "building: 40 of 400, 0:40")
        self.assertEqual(lines[-1], "building: done after 6:41")

    def test_on_a_terminal_in_place(self) -> None:
        text = shown([f"[{n}/400] Building CXX object {n}.o" for n in range(1, 401)], True, 0)
        self.assertEqual(text.count("\n"), 1)
        self.assertIn("\rbuilding: 7 of 400, 0:07, Building CXX object 7.o", text)

    def test_a_failing_command_is_shown_with_what_it_printed_and_nothing_else(self) -> None:
        for terminal in (False, True):
            text = shown(FAILING, terminal, 1)
            self.assertIn("building: FAILED after", text)
            self.assertIn("\n".join(FAILING[2:5]), text)
            self.assertNotIn("odd", text)

    def test_a_failure_outside_of_commands_is_shown(self) -> None:
        text = shown(["ninja: error: unknown target 'x'"], False, 1)
        self.assertIn("unknown target 'x'", text)


if __name__ == "__main__":
    unittest.main()
