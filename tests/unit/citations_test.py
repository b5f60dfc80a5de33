#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Comments and documents cite the design (DESIGN, section 4) and the papers behind it (T3.2): docs/design.md must have
every section that is cited, and cite every section of a paper that it lists."""
import re
import subprocess
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DESIGN = "docs/design.md"
COMMENT_STARTS = {".h": "//", ".cpp": "//", ".inl": "//", ".proto": "//", ".js": "//", ".toml": "#", ".py": "#",
                  ".txt": "#", ".cmake": "#", ".sh": "#"}
NOT_READ = {"docs/opengl-coverage.md", str(Path(__file__).resolve().relative_to(ROOT))}
PAPER = re.compile(r"(?<![-\"'\w.])[TWAO][1-9](?:\.\d)?(?![\"\w]|\.\d)")
DESIGN_WORD = re.compile(r"\bDESIGN\b(?:, sections? (\d+)(?: and (\d+))?)?")


def prose(path: str, text: str) -> str:
    """What is written for people: a document without its code, a source's comments."""
    if path.endswith(".md"):
        return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", text, flags=re.S | re.M))
    start = COMMENT_STARTS[Path(path).suffix]
    return "\n".join(line.split(start, 1)[1] for line in text.splitlines() if start in line)


def documents() -> dict[str, str]:
    listed = subprocess.run(["git", "-C", ROOT, "ls-files"], check=True, capture_output=True, text=True).stdout
    wanted = [path for path in listed.split("\n") if Path(path).suffix in {*COMMENT_STARTS, ".md"}
              and path not in NOT_READ and not path.startswith("tests/fuzz/corpus/") and (ROOT / path).exists()]
    return {path: prose(path, (ROOT / path).read_text(errors="replace")) for path in wanted}


class Citations(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        text = (ROOT / DESIGN).read_text()
        cls.sections = set(re.findall(r"^## (\d+)\. ", text, flags=re.M))
        body, sources = text.split("## Sources")
        cls.listed = set(PAPER.findall("\n".join(line for line in sources.splitlines() if line.startswith("| **"))))
        cls.documents = {**documents(), DESIGN: prose(DESIGN, body)}

    def test_sections_of_the_design_exist(self):
        for path, text in self.documents.items():
            for found in DESIGN_WORD.finditer(text):
                numbers = {number for number in found.groups() if number}
                if path == DESIGN:
                    continue  # tells how it is cited
                self.assertTrue(numbers, f"{path} cites the design without a section: {found[0]}")
                self.assertLessEqual(numbers, self.sections, f"{path}: {found[0]}")

    def test_sections_of_papers_are_listed(self):
        for path, text in self.documents.items():
            self.assertLessEqual(set(PAPER.findall(text)), self.listed, path)

    def test_what_is_listed_is_cited(self):
        cited = {each for text in self.documents.values() for each in PAPER.findall(text)}
        self.assertEqual(self.listed - cited, set())

    def test_code_and_comments_are_told_apart(self):
        self.assertEqual(PAPER.findall(prose("a.h", 'int T4; // as T3.2\nf("A1");  // of "A2", -O3\n')), ["T3.2"])
        self.assertEqual(PAPER.findall(prose("a.md", "T5, `T6`\n```\nT7\n```\n")), ["T5"])


if __name__ == "__main__":
    unittest.main()
