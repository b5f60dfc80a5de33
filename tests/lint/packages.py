# SPDX-License-Identifier: MIT
"""Which installed packages a fresh machine would get from a list, and which files belong to packages outside of it."""
from __future__ import annotations

import re
import subprocess
from pathlib import Path
from typing import Iterable

ROOT = Path(__file__).resolve().parents[2]
CHUNK = 500  # files asked about in one command
NAME = re.compile(r"[a-z0-9][a-z0-9+.-]*")


def listed(purpose: str) -> set[str]:
    """The packages that scripts/install-deps.sh names."""
    script = ROOT / "scripts" / "install-deps.sh"
    return set(subprocess.run([script, "--list", purpose], check=True, capture_output=True, text=True).stdout.split())


class Installed:
    """The packages of this machine, and what they pull in (without what they only recommend)."""

    def __init__(self, status: str | None = None) -> None:
        """`status`: lines as query() returns them."""
        self.needs: dict[str, list[list[str]]] = {}
        self.providers: dict[str, set[str]] = {}
        self.essential: set[str] = set()
        for line in (status if status is not None else self.query()).splitlines():
            package, essential, provides, *depends = line.split("\t")
            groups = [group for text in depends for group in text.split(",") if group.strip()]
            self.needs[package] = [self.names(group, "|") for group in groups]
            for name in [package, *self.names(provides, ",")]:
                self.providers.setdefault(name, set()).add(package)
            if essential:
                self.essential.add(package)

    FORMAT = r"${db:Status-Status}\t${Package}\t${Essential} ${Priority}\t${Provides}\t${Depends}\t${Pre-Depends}\n"

    @classmethod
    def query(cls) -> str:
        """A line for each package: name, "base" or nothing, what it provides, what it needs (in two fields)."""
        # Of priority `required` is what a minimal system has beside the essential packages.
        text = subprocess.run(["dpkg-query", "-W", "-f", cls.FORMAT], check=True, capture_output=True, text=True).stdout
        lines = []
        for line in text.splitlines():
            status, package, importance, *rest = line.split("\t")
            if status == "installed":
                base = "base" if importance.startswith("yes") or importance.endswith("required") else ""
                lines.append("\t".join([package, base, *rest]))
        return "\n".join(lines)

    @staticmethod
    def names(text: str, separator: str) -> list[str]:
        return [NAME.match(part.strip())[0] for part in text.split(separator) if NAME.match(part.strip())]

    def closure(self, packages: Iterable[str]) -> set[str]:
        """What is there when only these were installed. Of alternatives the first one that is here counts: a fresh
        machine would take the first as well."""
        reached: set[str] = set()
        waiting = [*packages, *self.essential]
        while waiting:
            package = waiting.pop()
            if package in reached or package not in self.needs:
                continue
            reached.add(package)
            for alternatives in self.needs[package]:
                here = [name for name in alternatives if name in self.providers]
                waiting += sorted(self.providers[here[0]]) if here else []
        return reached


def owners(files: Iterable[Path]) -> dict[str, Path]:
    """The packages that own the files, each with one of its files. Files that no package owns are left out."""
    found: dict[str, Path] = {}
    names = sorted({str(file.resolve()) for file in files})
    for i in range(0, len(names), CHUNK):
        answer = subprocess.run(["dpkg", "-S", *names[i:i + CHUNK]], capture_output=True, text=True).stdout
        for line in answer.splitlines():
            packages, colon, file = line.partition(": ")
            if colon and not packages.startswith("diversion "):
                for package in packages.split(", "):
                    found.setdefault(package.split(":")[0], Path(file))
    return found


def missing(files: Iterable[Path], purpose: str, installed: Installed) -> list[str]:
    """A line for each package that owns one of the files and would not be on a fresh machine."""
    there = installed.closure(listed(purpose))
    return [f"{package} (has {file}): neither named in scripts/install-deps.sh for '{purpose}' nor pulled in"
            for package, file in sorted(owners(files).items()) if package not in there]
