# SPDX-License-Identifier: MIT
"""The project's own files, for the checks of this folder."""

import contextlib
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CPP = (".h", ".cpp", ".inl")
# Foreign or recorded data, in whose text the project has no say.
DATA = ("tests/fuzz/corpus/", "tests/golden/recordings/")


def listed_by_git() -> list[str] | None:
    """What git tracks, and what it would offer to track; None outside of a repository."""
    command = ["git", "-c", f"safe.directory={ROOT}", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.split("\0")[:-1] if done.returncode == 0 else None


def walked() -> list[str]:
    """All files, for a copy of the sources without their repository."""
    found = []
    for folder, folders, names in os.walk(ROOT):
        folders[:] = [name for name in folders if name != "build" and not name.startswith(".")]
        found += [str((pathlib.Path(folder) / name).relative_to(ROOT)) for name in names]
    return found


def files(*suffixes: str, data: bool = False) -> list[str]:
    """Paths from the root of the files with one of these endings (none given: all files), in order."""
    listed = listed_by_git()
    paths = walked() if listed is None else listed
    return sorted(path for path in set(paths) if path.endswith(suffixes or ("",))
                  and (data or not path.startswith(DATA)) and (ROOT / path).is_file())


def text(path: str) -> str:
    return (ROOT / path).read_text(encoding="utf-8")


@contextlib.contextmanager
def scratch_file(content: str, suffix: str):
    """The path of a file that holds this, while the block runs."""
    with tempfile.NamedTemporaryFile("w", suffix=suffix, encoding="utf-8") as file:
        file.write(content)
        file.flush()
        yield file.name


def expect_none(case: unittest.TestCase, found: list[str]) -> None:
    """Fails with all that was found, a line each."""
    if found:
        case.fail(f"{len(found)} found:\n" + "\n".join(found))
