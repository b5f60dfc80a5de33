# SPDX-License-Identifier: MIT
"""Lines of at most 120 columns in code and documents; a table row or an address in Markdown cannot be wrapped."""

import re
import unittest

import project

LIMIT = 120
CODE = (*project.CPP, ".py", ".js", ".mjs", ".sh", ".cmake", "CMakeLists.txt", ".proto")
DOCUMENTS = (".md",)
# In Markdown: a row of a table, or a line that is one word (an address) but for its list mark.
UNWRAPPABLE = re.compile(r"\s*(\||([-*]|\d+\.)?\s*\S+$)")


def long_lines(path: str, text: str) -> list[str]:
    """`FILE:LINE: ...` for each line that is too long."""
    is_document = path.endswith(DOCUMENTS)
    return [f"{path}:{number}: {len(line)} columns, at most {LIMIT}" for number, line in enumerate(text.split("\n"), 1)
            if len(line) > LIMIT and not (is_document and UNWRAPPABLE.match(line))]


class Lines(unittest.TestCase):
    def test_a_long_line_is_found_with_its_place(self):
        self.assertEqual(long_lines("a.py", "x\n" + "y" * LIMIT + "\n" + "z " * 61),
                         ["a.py:3: 122 columns, at most 120"])

    def test_columns_are_characters(self):
        self.assertEqual(long_lines("a.py", "ü" * LIMIT), [])

    def test_markdown_that_cannot_be_wrapped(self):
        for line in ("| " + "a | " * 40, "- https://" + "a" * 120, "https://" + "a" * 120):
            self.assertEqual(long_lines("a.md", line), [])
            self.assertEqual(len(long_lines("a.py", line)), 1)
        self.assertEqual(len(long_lines("a.md", "- word" * 30)), 1)

    def test_the_project(self):
        found = [line for path in project.files(*CODE, *DOCUMENTS) for line in long_lines(path, project.text(path))]
        project.expect_none(self, found)


if __name__ == "__main__":
    unittest.main()
