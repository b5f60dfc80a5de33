# SPDX-License-Identifier: MIT
"""Objects are one concept: what is special about a kind is in the kind's own files, and generic code names none. What a
new kind needs beside its own files is counted here (kinds.toml), on the client and on the node."""

import pathlib
import re
import tomllib
import unittest

import project

TABLE = tomllib.loads((pathlib.Path(__file__).parent / "kinds.toml").read_text(encoding="utf-8"))
NO_CODE = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*\"""", re.DOTALL)
WORD = re.compile(r"\b(?:ObjectKind::)?[A-Za-z_]\w*")
TYPE = re.compile(r"^(?:class|struct|enum class) (\w+)[^;\n]*[{:]", re.MULTILINE)
DERIVED = re.compile(r"^(?:class|struct) (\w+)(?: final)? : (?:public )?(\w+)", re.MULTILINE)

Files = dict[str, str]  # path: text


def code_of(text: str) -> str:
    return NO_CODE.sub("", text)


def stem_of(path: str) -> str:
    return pathlib.PurePosixPath(path).stem


def kinds_of(files: Files, base: str) -> set[str]:
    """Stems of the headers that define classes of `base`, or of a class of it."""
    bases, stems, grows = {base}, set(), True
    while grows:
        found = {(name, stem_of(path)) for path, text in files.items() if path.endswith(".h")
                 for name, parent in DERIVED.findall(code_of(text)) if parent in bases}
        grows = not {name for name, _ in found} <= bases
        bases |= {name for name, _ in found}
        stems |= {stem for _, stem in found}
    return stems


def belongs(path: str, kind: str, folders: list[str]) -> bool:
    return path.startswith(tuple(folders)) and re.fullmatch(rf"{kind}(_\w+)?", stem_of(path)) is not None


def names_of(kind: str, files: Files, folders: list[str]) -> set[str]:
    """The types that a kind's headers define."""
    return {name for path, text in files.items() if path.endswith(".h") and belongs(path, kind, folders)
            for name in TYPE.findall(code_of(text))}


def who_names(kind: str, files: Files, side: dict) -> dict[str, set[str]]:
    """Files of the generic code that do not belong to the kind, with what of it they name."""
    names = names_of(kind, files, side["own"]) | {f"ObjectKind::{kind}"}
    found = {path: names & set(WORD.findall(code_of(text))) for path, text in files.items()
             if path.startswith(tuple(side["code"])) and not belongs(path, kind, side["own"])}
    return {path: named for path, named in found.items() if named}


def wrong(files: Files, side: dict) -> list[str]:
    found, unused = [], {(path, kind) for path, kinds in side.get("also", {}).items() for kind in kinds}
    kinds = sorted(kinds_of({p: t for p, t in files.items() if p.startswith(tuple(side["own"]))}, side["base"]))
    for kind in kinds:
        named = who_names(kind, files, side)
        found += [f"{path}: has no line for {kind}" for path in side["lists"] if path not in named]
        for path in sorted(named.keys() - set(side["lists"])):
            if (path, kind) not in unused:
                found.append(f"{path}: is generic code, but knows a {kind}: {' '.join(sorted(named[path]))}")
            unused.discard((path, kind))
    found += [f"{path}: knows no {kind} any more; say so in kinds.toml" for path, kind in sorted(unused)]
    return found if kinds else ["no kinds found"]


class Checker(unittest.TestCase):
    SIDE = {"base": "Base", "own": ["things/"], "code": ["code/", "things/"], "lists": ["code/list.h"],
            "also": {"code/switch.cpp": ["ball"]}}
    FILES = {"things/ball.h": "class Ball final : public Base<Kind::ball> {\n};\nstruct Bounce {\n};\n",
             "things/ball_commands.h": "class BallCommands {\n};\n", "things/ball.cpp": "Ball ball;",
             "things/cup.h": "struct Vessel : Base {\n};\nstruct Cup : Vessel {\n};\n",
             "code/list.h": "BallCommands balls; Cup cup;", "code/switch.cpp": "find<Ball>(id);",
             "code/table.h": "Base* find(Id id);  // a Ball, a Cup\n"}

    def test_kinds_are_found_with_what_belongs_to_them(self):
        self.assertEqual(kinds_of(self.FILES, "Base"), {"ball", "cup"})
        self.assertEqual(names_of("ball", self.FILES, ["things/"]), {"Ball", "Bounce", "BallCommands"})
        self.assertFalse(belongs("things/balloon.h", "ball", ["things/"]))

    def test_what_the_table_says(self):
        self.assertEqual(wrong(self.FILES, self.SIDE), [])

    def test_generic_code_that_knows_a_kind(self):
        for text in ("Ball* ball;", "Bounce bounce;", 'if (object.kind() == ObjectKind::ball) "x";'):
            found = wrong(self.FILES | {"code/table.h": text}, self.SIDE)
            self.assertEqual(len(found), 1, text)
            self.assertIn("code/table.h: is generic code, but knows a ball", found[0])

    def test_a_kind_that_knows_another(self):
        self.assertEqual(len(wrong(self.FILES | {"things/cup.cpp": "Ball inside;"}, self.SIDE)), 1)

    def test_a_list_has_all_kinds(self):
        self.assertEqual(wrong(self.FILES | {"code/list.h": "Ball ball;"}, self.SIDE),
                         ["code/list.h: has no line for cup"])

    def test_what_nobody_needs_any_more(self):
        self.assertEqual(len(wrong(self.FILES | {"code/switch.cpp": ""}, self.SIDE)), 1)

    def test_no_kinds_at_all_is_a_mistake_of_the_table(self):
        self.assertEqual(wrong(self.FILES, self.SIDE | {"base": "Basis"}), ["no kinds found"])


class Project(unittest.TestCase):
    def test_sides(self):
        files = {path: project.text(path) for path in project.files(".h", ".cpp")}
        for name, side in TABLE.items():
            with self.subTest(name):
                project.expect_none(self, wrong(files, side))


if __name__ == "__main__":
    unittest.main()
