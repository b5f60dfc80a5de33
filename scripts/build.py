#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Builds a preset and says how far it is: in place on a terminal, a line for each tenth elsewhere. A command that fails
is shown with all it printed."""
from __future__ import annotations

import argparse
import re
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
STEP = re.compile(r"\[(\d+)/(\d+)\] (.*)")  # Ninja's own line before each command
TENTHS = 10
FAILED = "FAILED: "
COLUMNS = 100


class Progress:
    """What a build has printed so far, and what of it people want to see now."""

    def __init__(self, name: str, terminal: bool, out=sys.stdout, clock=time.monotonic) -> None:
        self.name, self.terminal, self.out, self.clock = name, terminal, out, clock
        self.begin, self.tenth, self.failing, self.failure = clock(), -1, False, []

    def line(self, text: str) -> None:
        step = STEP.match(text)
        if step:
            self.failing = False
            self.step(int(step[1]), int(step[2]), step[3])
            return
        self.failing = self.failing or text.startswith(FAILED)
        if self.failing or text.startswith("ninja: "):
            self.failure.append(text)

    def elapsed(self) -> str:
        minutes, seconds = divmod(int(self.clock() - self.begin), 60)
        return f"{minutes}:{seconds:02}"

    def step(self, done: int, of: int, what: str) -> None:
        state = f"{self.name}: {done} of {of}, {self.elapsed()}"
        if self.terminal:
            self.out.write(f"\r{f'{state}, {what}'[:COLUMNS]:{COLUMNS}}")
            self.out.flush()
        elif done * TENTHS // of > self.tenth:
            self.tenth = done * TENTHS // of
            print(state, file=self.out, flush=True)

    def end(self, result: int) -> None:
        if self.terminal:
            self.out.write(f"\r{'':{COLUMNS}}\r")
        print(f"{self.name}: {'done' if result == 0 else 'FAILED'} after {self.elapsed()}", file=self.out)
        for text in self.failure if result else []:
            print(text, file=self.out)
        self.out.flush()


def configure(preset: str, build: Path) -> int:
    done = subprocess.run(["cmake", "--preset", preset, "--log-level=WARNING"], cwd=ROOT, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode:
        print(f"configuring {preset} in {build} failed:\n{done.stdout}", flush=True)
    return done.returncode


def build(folder: Path, targets: list[str], progress: Progress) -> int:
    """Everything that the build prints is in `last-build.log` of its folder as well."""
    command = ["cmake", "--build", str(folder), *(["--target", *targets] if targets else [])]
    with (folder / "last-build.log").open("w") as log, \
            subprocess.Popen(command, cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as running:
        for text in running.stdout:
            log.write(text)
            progress.line(text.rstrip("\n"))
    progress.end(running.returncode)
    if running.returncode:
        print(f"everything that was printed: {folder / 'last-build.log'}", flush=True)
    return running.returncode


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("preset", help="of CMakePresets.json")
    parser.add_argument("targets", nargs="*", help="all, if none is given")
    parser.add_argument("--folder", metavar="NAME", help="below build/, if not named as the preset")
    parser.add_argument("--keep", action="store_true", help="leave a folder's configuration as it is, if it has one")
    parser.add_argument("--name", default="build", help="before each line (build)")
    options = parser.parse_args()
    folder = ROOT / "build" / (options.folder or options.preset)
    kept = options.keep and (folder / "build.ninja").exists()
    result = 0 if kept else configure(options.preset, folder)
    return result or build(folder, options.targets, Progress(options.name, sys.stdout.isatty()))


if __name__ == "__main__":
    sys.exit(main())
