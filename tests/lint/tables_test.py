# SPDX-License-Identifier: MIT
"""One fact once: code that lists by hand what a table of proto/gl has. Of texture targets: their words stand in no code
but what the table makes, except those of plain two-dimensional textures, which a daemon has for work of its own, and
that of buffers, which is a target of theirs, too."""

import re
import tomllib
import unittest

import project

PROGRAMS = ("client_lib/", "common/", "tileserver/", "walld/", "tools/")
PLAIN = ("2d", "buffer")


def target_words() -> list[str]:
    targets = tomllib.loads(project.text("proto/gl/texture_targets.toml"))["texture_target"]
    return [f"GL_{proxy}TEXTURE_{name.upper()}" for name in targets for proxy in ("", "PROXY_")
            if proxy or name not in PLAIN]


def listed_anew(path: str, text: str, words: list[str]) -> list[str]:
    """`FILE:LINE: WORD` of each, with what is derived from a word (a face's, a binding's)."""
    pattern = re.compile(rf"\b(?:{'|'.join(words)})(?:_(?:POSITIVE|NEGATIVE)_[XYZ])?\b")
    return [f"{path}:{number}: {word}" for number, line in enumerate(text.split("\n"), 1)
            for word in pattern.findall(line)]


class Tables(unittest.TestCase):
    def test_a_word_is_found_with_its_place(self):
        words = target_words()
        for word in ("GL_TEXTURE_3D", "GL_PROXY_TEXTURE_2D", "GL_TEXTURE_CUBE_MAP_NEGATIVE_Y"):
            self.assertEqual(listed_anew("a.cpp", f"x;\nswitch ({word})", words), [f"a.cpp:2: {word}"])

    def test_other_words_are_none(self):
        words = target_words()
        for word in ("GL_TEXTURE_2D", "GL_TEXTURE_WRAP_S", "GL_ARB_texture_rectangle", "GL_MAX_3D_TEXTURE_SIZE"):
            self.assertEqual(listed_anew("a.cpp", word, words), [])

    def test_the_project(self):
        words = target_words()
        project.expect_none(self, [found for path in project.files(*project.CPP) if path.startswith(PROGRAMS)
                                   for found in listed_anew(path, project.text(path), words)])


if __name__ == "__main__":
    unittest.main()
