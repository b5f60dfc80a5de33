# SPDX-License-Identifier: MIT
"""Documents: what they link to exists, and so do the files that they and the comments name."""

import pathlib
import posixpath
import re
import unittest

import project

LINK = re.compile(r"\]\(([^)\s]+)\)")
QUOTED = re.compile(r"`([^`\n]+)`")
FENCE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
PATH = re.compile(r"[\w.*{},-]+(/[\w.*{},-]+)*/?$")
SOURCE = re.compile(r".+\.(h|cpp|inl|py|js|mjs|sh|md)$")
DOCUMENT = re.compile(r"\bdocs/[\w-]+\.md\b")


def anchor(heading: str) -> str:
    """GitHub's name of a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def anchors(text: str) -> set[str]:
    return {anchor(heading) for heading in re.findall(r"^#+ (.+)$", FENCE.sub("", text), re.MULTILINE)}


def expanded(path: str) -> list[str]:
    """a.{h,cpp} → a.h, a.cpp."""
    found = re.match(r"(.*?)\{([^{}]*)\}(.*)$", path)
    if not found:
        return [path]
    start, choices, end = found.groups()
    return [whole for choice in choices.split(",") for whole in expanded(start + choice + end)]


class Tree:
    """The project's files and folders, by path."""

    def __init__(self, files: list[str]):
        self.folders = {str(parent) for path in files for parent in pathlib.PurePosixPath(path).parents} - {"."}
        self.paths = set(files) | self.folders
        self.folder_names = {posixpath.basename(folder) for folder in self.folders}

    def has(self, path: str) -> bool:
        """Whether a path of the tree is that, or ends so; `*` is any part of a name."""
        pattern = re.compile("(.*/)?" + re.escape(path.rstrip("/")).replace(r"\*", "[^/]*") + "$")
        return any(map(pattern.match, self.paths))

    def names_one_of_ours(self, quoted: str) -> bool:
        """Whether it is written like a file of the project: in a folder of ours, or with a source file's ending."""
        if not PATH.match(quoted) or ".gen." in quoted:
            return False
        first, slash, _ = quoted.partition("/")
        return first in self.folder_names if slash else bool(SOURCE.match(quoted))


def wrong_links(path: str, text: str, tree: Tree, text_of) -> list[str]:
    wrong = []
    for link in LINK.findall(FENCE.sub("", text)):
        if re.match(r"[a-z]+:", link):
            continue
        name, _, place = link.partition("#")
        target = posixpath.normpath(posixpath.join(posixpath.dirname(path), name)) if name else path
        if target not in tree.paths:
            wrong.append(f"{path}: links to {link}, which is not there")
        elif place and place not in anchors(text if target == path else text_of(target)):
            wrong.append(f"{path}: links to {link}, and there is no such heading")
    return wrong


def wrong_names(path: str, text: str, tree: Tree) -> list[str]:
    """Files that a document names between backticks."""
    names = [words.split()[0] for words in QUOTED.findall(FENCE.sub("", text)) if words.strip()]
    return [f"{path}: names {name}, which is not there" for name in names
            if tree.names_one_of_ours(name) and not all(tree.has(whole) for whole in expanded(name))]


def wrong_documents(path: str, text: str, tree: Tree) -> list[str]:
    """Documents that any file names."""
    return [f"{path}: names {name}, which is not there" for name in DOCUMENT.findall(text) if name not in tree.paths]


class Checker(unittest.TestCase):
    TREE = Tree(["docs/a.md", "docs/b.md", "src/x.h", "src/x.cpp", "src/deep/y_one.cpp"])
    TEXTS = {"docs/a.md": "# First thing: `a`, b\n", "docs/b.md": "```\n# no heading\n```\n"}

    def links(self, text: str) -> int:
        return len(wrong_links("docs/a.md", text, self.TREE, self.TEXTS.get))

    def names(self, text: str) -> int:
        return len(wrong_names("docs/a.md", text, self.TREE))

    def test_links(self):
        self.assertEqual(self.links("[b](b.md) [x](../src/x.h) [web](https://x.org/) [folder](../src)"), 0)
        self.assertEqual(self.links("[c](c.md)"), 1)

    def test_headings(self):
        self.assertEqual(self.links("# Here\n[there](b.md) [me](#here)"), 0)
        self.assertEqual(len(wrong_links("docs/b.md", "[a](a.md#first-thing-a-b)", self.TREE, self.TEXTS.get)), 0)
        self.assertEqual(self.links("[me](#nowhere) [b](b.md#no-heading)"), 2)

    def test_names(self):
        self.assertEqual(self.names("`src/x.{h,cpp}` `deep/y_*.cpp` `x.h` `src/` `GL/gl.h` `a / b` `wall.toml`"), 0)
        for gone in ("`src/z.h`", "`z.cpp`", "`src/x.{h,inl}`", "`deep/z_*.cpp`"):
            self.assertEqual(self.names(gone), 1, gone)

    def test_documents_named_in_comments(self):
        self.assertEqual(wrong_documents("src/x.h", "// (docs/a.md)", self.TREE), [])
        self.assertEqual(len(wrong_documents("src/x.h", "// (docs/c.md).", self.TREE)), 1)


class Project(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tree = Tree(project.files(data=True))
        cls.documents = project.files(".md")

    def test_links(self):
        project.expect_none(self, [line for path in self.documents
                                   for line in wrong_links(path, project.text(path), self.tree, project.text)])

    def test_names(self):
        project.expect_none(self, [line for path in self.documents
                                   for line in wrong_names(path, project.text(path), self.tree)])

    def test_documents_named_anywhere(self):
        paths = project.files(*project.CPP, ".py", ".js", ".mjs", ".sh", ".cmake", ".txt", ".toml", ".md", ".conf",
                              ".service")
        project.expect_none(self, [line for path in paths if path != "tests/lint/documents_test.py"
                                   for line in wrong_documents(path, project.text(path), self.tree)])


if __name__ == "__main__":
    unittest.main()
