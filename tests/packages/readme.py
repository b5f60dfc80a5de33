# SPDX-License-Identifier: MIT
"""Commands out of a Markdown file, so that what people read is what is tested."""
from __future__ import annotations

import re
from pathlib import Path


class Steps:
    """The code blocks of a section. The first line of each is a comment that names its place: "# on WHERE ..."."""

    def __init__(self, file: Path, section: str) -> None:
        found = re.search(rf"(?ms)^## {re.escape(section)}\n(.*?)^## ", file.read_text())
        if not found:
            raise ValueError(f"{file}: expected a section '{section}'")
        self._blocks = {}
        for block in re.findall(r"(?ms)^ *```sh\n(.*?)^ *```", found[1]):
            first, *lines = [line.strip() for line in block.splitlines()]
            place = re.fullmatch(r"# on (\w+).*", first)
            if place:
                self._blocks[place[1]] = [re.split(r"  +#", line)[0].rstrip() for line in lines]

    def of(self, place: str) -> list[str]:
        """The commands there, without what is said about them."""
        return self._blocks[place]
