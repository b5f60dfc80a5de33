# SPDX-License-Identifier: MIT
"""Every test in C++ is built: a CMakeLists.txt in its folder or above names it, from there. (Others cannot fail.)"""

import pathlib
import unittest

import project


def unbuilt(tests: list[str], lists: dict[str, str]) -> list[str]:
    """Those of `tests` that no list names; `lists`: folder of each CMakeLists.txt, its text."""
    found = []
    for path in tests:
        folders = [str(folder) for folder in pathlib.PurePosixPath(path).parents]
        named = any(str(pathlib.PurePosixPath(path).relative_to(folder)) in lists[folder].split()
                    for folder in folders if folder in lists)
        if not named:
            found.append(f"{path}: no CMakeLists.txt names it, so it is not built")
    return found


class Built(unittest.TestCase):
    def test_a_test_that_nobody_names_is_found(self):
        lists = {"tests/unit": "wall_test(all a_test.cpp\n  sub/b_test.cpp LINK x)"}
        self.assertEqual(unbuilt(["tests/unit/a_test.cpp", "tests/unit/sub/b_test.cpp"], lists), [])
        self.assertEqual(unbuilt(["tests/unit/b_test.cpp"], lists),
                         ["tests/unit/b_test.cpp: no CMakeLists.txt names it, so it is not built"])

    def test_the_project(self):
        lists = {str(pathlib.PurePosixPath(path).parent): project.text(path).replace(")", " ")
                 for path in project.files("CMakeLists.txt")}
        project.expect_none(self, unbuilt(project.files("_test.cpp"), lists))


if __name__ == "__main__":
    unittest.main()
