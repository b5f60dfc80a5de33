#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The frame codecs beside FFmpeg's, on frames of real programs: grabs them once (bench/codec_frames.py), then runs
codec_bench.

codec.py [--rounds N] [--json FILE]      exit code 1 if a bar of docs/codecs.md is missed
"""
from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--rounds", type=int, default=9)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    folder = REPOSITORY / os.environ.get("WALLGL_BUILD", "build/release") / "bench"
    subprocess.run([str(REPOSITORY / "bench" / "codec_frames.py"), str(folder / "codec-frames")], check=True)
    command = [str(folder / "codec_bench"), "--rounds", str(options.rounds)]
    if options.json:
        command += ["--json", str(options.json)]
    return subprocess.run([*command, str(folder / "codec-frames")], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
