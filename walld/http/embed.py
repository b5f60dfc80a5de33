# SPDX-License-Identifier: MIT
"""Puts the status page into a header: embed.py PAGE_FOLDER HEADER. Every file of a type that pages have, with its path
and content type; no machine paths, deterministic."""
import pathlib
import sys

TYPES = {".html": "text/html; charset=utf-8", ".css": "text/css; charset=utf-8",
         ".js": "text/javascript; charset=utf-8",
         ".svg": "image/svg+xml"}
PIECE = 8000  # characters; a string literal may have 64 KiB


def literal(text: str) -> str:
    pieces = [text[i:i + PIECE] for i in range(0, len(text), PIECE)]
    return "\n".join(f'R"wallgl({piece})wallgl"' for piece in pieces)


def row(file: pathlib.Path) -> str:
    path = "/" if file.name == "index.html" else f"/{file.name}"
    return f'    {{"{path}", "{TYPES[file.suffix]}", {literal(file.read_text(encoding="utf-8"))}}},\n'


def main() -> None:
    folder, header = map(pathlib.Path, sys.argv[1:])
    rows = "".join(row(file) for file in sorted(folder.iterdir()) if file.suffix in TYPES)
    header.parent.mkdir(parents=True, exist_ok=True)
    header.write_text(
        "// Generated from web-ui-min by walld/http/embed.py.\n#pragma once\n\n#include <string_view>\n\n"
        "namespace wall::walld {\n"
        "struct PageFile {\n    std::string_view path, type, content;\n};\n"
        f"inline constexpr PageFile kPageFiles[] = {{\n{rows}}};\n}}  // namespace wall::walld\n", encoding="utf-8")


if __name__ == "__main__":
    main()
