# SPDX-License-Identifier: MIT
"""The TOML files of proto/gl with the place of each line, so that a mistake is refused with its file and line."""

import contextlib
import pathlib
import re
import tomllib
from dataclasses import dataclass

_SECTION = re.compile(r"^\[(?P<name>[\w.]+)\]")
_KEY = re.compile(r'^"?(?P<name>[\w.-]+)"?\s*=')


@dataclass(frozen=True)
class Data:
    """A file: its sections as tomllib gives them, and where their lines stand."""
    path: pathlib.Path
    sections: dict
    lines: dict         # (section, key) -> number from 1; key "": the section's own line

    def place(self, section, key=""):
        number = self.lines.get((section, key))
        return f"{self.path}:{number}" if number else str(self.path)

    def refuse(self, why, section, key=""):
        raise AssertionError(f"{self.place(section, key)}: {why}")

    @contextlib.contextmanager
    def line(self, section, key):
        """What is wrong within is wrong with this line."""
        try:
            yield
        except (AssertionError, KeyError, TypeError, ValueError) as wrong:
            self.refuse(f"{key}: {_words(wrong)}", section, key)


def _words(wrong):
    if isinstance(wrong, AssertionError):
        return str(wrong)
    return f"no `{wrong.args[0]}`" if isinstance(wrong, KeyError) else f"not as expected ({wrong})"


def load(path):
    path = pathlib.Path(path)
    text = path.read_text()
    try:
        sections = tomllib.loads(text)
    except tomllib.TOMLDecodeError as wrong:
        raise AssertionError(f"{path}: {wrong}") from wrong
    return Data(path, sections, dict(_places(text)))


def _places(text):
    section = ""
    for number, line in enumerate(text.splitlines(), 1):
        if m := _SECTION.match(line):
            section = m["name"]
            yield (section, ""), number
        elif m := _KEY.match(line):
            yield (section, m["name"]), number
