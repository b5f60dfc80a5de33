# SPDX-License-Identifier: MIT
"""Includes: who may include whom (layers.toml), and no circles among the modules of a folder."""

import pathlib
import re
import tomllib
import unittest

import project

TABLE = tomllib.loads((pathlib.Path(__file__).parent / "layers.toml").read_text(encoding="utf-8"))
INCLUDE = re.compile(r'^\s*#\s*include\s+(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)

Includes = dict[str, list[str]]  # of a file: what it includes, as it stands there


def layer_of(path: str, layers) -> str | None:
    """The longest name among `layers` that the path lies under; None if it lies under none."""
    if path.startswith("gen/"):
        path = path.removeprefix("gen/")
        path = path if path.startswith(tuple(layers)) else "common/" + path
    found = [name for name in layers if path.startswith(name + "/")]
    return max(found, key=len, default=None)


def reachable(uses: dict[str, list[str]], layer: str) -> set[str]:
    """The layer and all that it may include, directly or not."""
    seen, waiting = set(), [layer]
    while waiting:
        name = waiting.pop()
        if name not in seen:
            seen.add(name)
            waiting += uses[name]
    return seen


def wrong_includes(includes: Includes, table: dict) -> list[str]:
    uses, wrong = table["uses"], []
    for path, names in includes.items():
        layer = layer_of(path, uses)
        if layer is None:
            wrong.append(f"{path}: lies in no folder of layers.toml")
            continue
        allowed = reachable(uses, layer)
        for name in names:
            target = layer_of(name, uses)
            who = next((folders for start, folders in table["outside"].items() if name.startswith(start)), None)
            if target is not None and target not in allowed:
                wrong.append(f"{path}: {layer} may not include {name}")
            if who is not None and layer_of(path, who) is None:
                wrong.append(f"{path}: {layer} may not include <{name}>")
    return wrong


def module_of(path: str) -> str:
    return re.sub(r"\.(h|cpp|inl)$", "", path)


def circles(includes: Includes) -> dict[str, list[str]]:
    """By folder: its modules that reach themselves through other modules of it."""
    edges: dict[str, set[str]] = {}
    for path, names in includes.items():
        edges.setdefault(module_of(path), set()).update(module_of(name) for name in names)

    def reached(start: str) -> set[str]:
        seen, waiting = set(), [start]
        while waiting:
            new = edges.get(waiting.pop(), set()) - seen
            seen |= new
            waiting += new
        return seen

    found: dict[str, list[str]] = {}
    for module in edges:
        if any(module in reached(other) for other in edges[module] - {module}):
            found.setdefault(module.split("/")[0], []).append(module)
    return found


def wrong_circles(found: dict[str, list[str]], ceilings: dict[str, int]) -> list[str]:
    wrong = []
    for folder in sorted(set(found) | set(ceilings)):
        modules, ceiling = sorted(found.get(folder, [])), ceilings.get(folder, 0)
        if len(modules) > ceiling:
            wrong.append(f"{folder}: {len(modules)} modules include each other in circles, at most {ceiling} may: "
                         + " ".join(modules))
        if len(modules) < ceiling:
            wrong.append(f"{folder}: only {len(modules)} modules left in circles; say so in layers.toml")
    return wrong


def read_includes(source: str) -> list[str]:
    return [ours or theirs for ours, theirs in INCLUDE.findall(source)]


class Checker(unittest.TestCase):
    TABLE = {"uses": {"base": [], "wire": ["base"], "app": ["wire"], "other": []}, "outside": {"boost/": ["other"]}}

    def test_what_is_below_may_be_included(self):
        good = {"app/a.h": ["wire/w.h", "base/b.h", "app/z.h", "vector"], "other/o.cpp": ["boost/asio.hpp"]}
        self.assertEqual(wrong_includes(good, self.TABLE), [])

    def test_what_is_above_or_beside_may_not(self):
        for path, name in [("base/b.h", "wire/w.h"), ("app/a.h", "other/o.h"), ("wire/w.h", "boost/asio.hpp")]:
            self.assertEqual(len(wrong_includes({path: [name]}, self.TABLE)), 1, (path, name))

    def test_a_file_has_to_lie_in_a_folder_of_the_table(self):
        self.assertEqual(len(wrong_includes({"new/n.h": []}, self.TABLE)), 1)

    def test_generated_headers_count_as_their_folder(self):
        layers = ["common/glapi", "walld"]
        self.assertEqual([layer_of(p, layers) for p in ("gen/glapi/wire.gen.h", "gen/walld/http/page.gen.h", "vector")],
                         ["common/glapi", "walld", None])

    def test_circles(self):
        straight = {"f/a.cpp": ["f/a.h", "f/b.h"], "f/b.h": ["f/c.h"], "f/c.h": []}
        self.assertEqual(circles(straight), {})
        self.assertEqual(circles(straight | {"f/c.cpp": ["f/a.h"]}), {"f": ["f/a", "f/b", "f/c"]})

    def test_a_ceiling_holds_exactly(self):
        found = {"f": ["f/a", "f/b"]}
        self.assertEqual(wrong_circles(found, {"f": 2}), [])
        for ceiling in (0, 1, 3):
            self.assertEqual(len(wrong_circles(found, {"f": ceiling})), 1)

    def test_includes_are_found(self):
        self.assertEqual(read_includes('#include "a/b.h"\n  # include <c.h>\n// #include "no.h"\n'), ["a/b.h", "c.h"])


class Project(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.includes = {path: read_includes(project.text(path)) for path in project.files(*project.CPP)}

    def test_layers(self):
        project.expect_none(self, wrong_includes(self.includes, TABLE))

    def test_circles(self):
        project.expect_none(self, wrong_circles(circles(self.includes), TABLE["circles"]))


if __name__ == "__main__":
    unittest.main()
