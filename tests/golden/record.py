#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes the recordings anew: runs each program of recordings.toml under apitrace on plain Mesa, keeps its first frames,
compresses them, and checks that they replay to the same pixels however many threads llvmpipe uses.

record.py [NAME...]     (without names: all; needs apitrace and the recorded programs, see scripts/install-deps.sh)
"""
from __future__ import annotations

import signal
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[1] / "support")]
from subjects import Recording, load_recordings, play_through, signal_group  # noqa: E402
from xserver import XServer  # noqa: E402

RUN_SECONDS = 3
SCREEN = (800, 600)  # programs that choose their own size take half the screen


def record(recording: Recording, environment: dict[str, str]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        whole, first = Path(folder) / "whole.trace", Path(folder) / "first.trace"
        _trace(recording, whole, dict(environment, HOME=folder))
        subprocess.run(["apitrace", "trim", f"--frames=0-{recording.frames - 1}", "-o", first, whole], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        subprocess.run(["apitrace", "repack", "-b", first, recording.path], check=True)


def _trace(recording: Recording, to: Path, environment: dict[str, str]) -> None:
    """Interrupts the program after a while; some end only when killed."""
    process = subprocess.Popen(["apitrace", "trace", f"--api={recording.api}", "-o", to, *recording.command],
                               env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True)
    for sign in (None, signal.SIGINT, signal.SIGKILL):
        if sign:
            signal_group(process, sign)
        try:
            process.wait(RUN_SECONDS)
            break
        except subprocess.TimeoutExpired:
            continue


def unstable_frames(recording: Recording, environment: dict[str, str]) -> list[int]:
    """Compared frames that differ between runs or between numbers of threads."""
    runs = [play_through(recording, dict(environment, LP_NUM_THREADS=threads)) for threads in "1120"]
    if len({len(run) for run in runs}) != 1 or len(runs[0]) != recording.frames:
        return list(range(recording.frames))
    return [i for i in recording.compared if any((run[i] != runs[0][i]).any() for run in runs)]


def main() -> int:
    wanted = sys.argv[1:]
    bad = 0
    with XServer(SCREEN) as x:
        for recording in load_recordings():
            if wanted and recording.name not in wanted:
                continue
            record(recording, x.environment())
            unstable = unstable_frames(recording, x.environment())
            bad += bool(unstable)
            state = f"frames {unstable} differ between runs" if unstable else "deterministic"
            print(f"{recording.name}: {recording.path.stat().st_size >> 10} KiB, {state}", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
