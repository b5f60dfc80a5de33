# SPDX-License-Identifier: MIT
"""No dead declarations: a function that a header of ours declares is called by somebody, a test at least. By text: its
name stands somewhere else than in its declaration and its definition. A name that two functions have is not judged."""

import os
import pathlib
import re
import unittest

import project

# Comments and literals hold no uses. (A name that only a macro puts together with ## would have to be excepted here.)
NO_CODE = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<!\w)'(?:\\.|[^'\\\n])'""", re.DOTALL)
NAME = re.compile(r"\b[A-Za-z_]\w*")
# A type, a name and a parenthesis; no statement begins with a type's name and goes on so.
DECLARATION = re.compile(r"\b(?!return\b|co_\w+\b|else\b|throw\b|new\b)[A-Za-z_]\w*(?:<[^;{}()]*>)?[ &*]+"
                         r"([A-Za-z_]\w*)\(")
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*$", re.MULTILINE)
# The same at the beginning of a line of a source file, with a body.
DEFINITION = re.compile(r"^[A-Za-z_](?:[^;{}()]*[ &*:])?([A-Za-z_]\w*)\([^;{}]*\)[^;{}()]*\{", re.MULTILINE)


def code_of(text: str) -> str:
    """Without comments and literals; an apostrophe that separates digits stays."""
    return NO_CODE.sub(" ", text)


def dead_declarations(sources: dict[str, str], generated: dict[str, str]) -> list[str]:
    """`FILE: NAME` of each; generated code counts as a user, and is not judged."""
    code = {path: code_of(text) for path, text in sources.items()}
    uses: dict[str, int] = {}
    for text in [*code.values(), *map(code_of, generated.values())]:
        for name in NAME.findall(text):
            uses[name] = uses.get(name, 0) + 1
    defined = {name for path, text in code.items() if not path.endswith(".h") for name in DEFINITION.findall(text)}
    found = {f"{path}: {name}" for path, text in code.items() if path.endswith(".h")
             for name in DECLARATION.findall(DIRECTIVE.sub("", text))
             if uses[name] == 1 or uses[name] == 2 and name in defined}
    return sorted(found)


def generated_sources() -> dict[str, str]:
    root = pathlib.Path(os.environ["WALLGL_GEN_ROOT"])
    return {str(path): path.read_text(encoding="utf-8") for path in root.rglob("*.gen.*")}


class Checker(unittest.TestCase):
    HEADER = "/// Not this: word(1).\nint sum(int a, int b);\ninline int twice(int a) { return sum(a, a); }\n"

    def dead(self, source: str, generated: str = "") -> list[str]:
        return dead_declarations({"a.h": self.HEADER, "a.cpp": source}, {"b.gen.cpp": generated})

    def test_what_nobody_calls_is_found(self):
        self.assertEqual(self.dead(""), ["a.h: twice"])
        self.assertEqual(self.dead("int twice(int a) {\n    return a;\n}\n"), ["a.h: twice"])
        self.assertEqual(self.dead("// twice(1)\nconst char* name = \"twice\";\n"), ["a.h: twice"])

    def test_what_somebody_calls_is_not(self):
        self.assertEqual(self.dead("int four = twice(2);\n"), [])
        self.assertEqual(self.dead("", "int four = twice(2);\n"), [])

    def test_calls_in_headers_are_no_declarations(self):
        self.assertEqual(dead_declarations({"a.h": "struct S { ~S() { free_it(this); return give(1); } };"}, {}), [])


class Project(unittest.TestCase):
    def test_declarations(self):
        sources = {path: project.text(path) for path in project.files(*project.CPP)}
        project.expect_none(self, dead_declarations(sources, generated_sources()))


if __name__ == "__main__":
    unittest.main()
