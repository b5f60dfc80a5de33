# SPDX-License-Identifier: MIT
"""Puts the status page into a header: embed.py PAGE_FOLDER HEADER. One file, no machine paths, deterministic."""
import pathlib
import sys


def main() -> None:
    folder, header = map(pathlib.Path, sys.argv[1:])
    page = (folder / "index.html").read_text(encoding="utf-8")
    # A string literal may have 64 KiB; pieces keep far below.
    pieces = [page[i:i + 8000] for i in range(0, len(page), 8000)]
    literals = "\n".join(f'R"wallgl({piece})wallgl"' for piece in pieces)
    header.parent.mkdir(parents=True, exist_ok=True)
    header.write_text(
        "// Generated from web-ui-min by walld/embed.py.\n#pragma once\n\nnamespace wall::walld {\n"
        f"inline constexpr char kPage[] =\n{literals};\n}}  // namespace wall::walld\n", encoding="utf-8")


if __name__ == "__main__":
    main()
