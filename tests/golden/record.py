#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes the recordings anew: runs each program of recordings.toml under apitrace on plain Mesa, keeps its first frames,
compresses them, and checks that they replay to the same pixels however many threads llvmpipe uses.

record.py [NAME...]     (without names: all; needs apitrace and the recorded programs, see scripts/install-deps.sh)
"""
from __future__ import annotations

import re
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[1] / "support")]
from subjects import HERE, Recording, load_recordings, play_through, signal_group  # noqa: E402
from xserver import XServer  # noqa: E402

_SWAP = r"^\d+ (?:glX|egl)SwapBuffers\(dpy = \w+, (?:drawable|surface) = (\w+)"
END_SECONDS = 3  # that a program may take to end


def record(recording: Recording, environment: dict[str, str]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        whole, shown, first = (Path(folder) / f"{name}.trace" for name in ("whole", "shown", "first"))
        home = Path(folder) / "home"
        home.mkdir()
        for name, text in recording.files.items():
            (home / name).parent.mkdir(parents=True, exist_ok=True)
            (home / name).write_text(text)
        _trace(recording, whole, dict(environment, HOME=str(home), USER="root", SDL_AUDIODRIVER="dummy",
                                      ALSOFT_DRIVERS="null", **recording.needs))
        calls = f"--calls={calls_of_shown(_dump(whole), recording.most_image_bytes)}"
        for command in (["apitrace", "trim", calls, "-o", shown, whole], [*_cut(recording), "-o", first, shown]):
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        subprocess.run(["apitrace", "repack", "-b", first, recording.path], check=True)


def _dump(trace: Path) -> str:
    return subprocess.run(["apitrace", "dump", "--color=never", trace], check=True, capture_output=True,
                          text=True, errors="replace").stdout


def calls_of_shown(dump: str, most_image_bytes: int = 0) -> str:
    """The calls of a trace, as ranges, without those that are made while a window is current that never swaps: SDL and
    Qt ask such a window what OpenGL there is, and destroy it, which a replay does not. The other window would be the
    second one then. Frames are those of the window that swaps most: swaps of another one (Blender has one of a single
    pixel for a context that draws to framebuffer objects) are left out, too. So are images of textures of more than
    `most_image_bytes`, if that is not 0."""
    swaps = re.findall(_SWAP, dump, re.M)
    swapping, frames = set(swaps), Counter(swaps).most_common(1)[0][0] if swaps else ""
    pbuffers = set(re.findall(r"^\d+ (?:glX|egl)CreatePbuffer\w*\(.*\) = (\w+)$", dump, re.M))
    kept, dropping, last = [], False, -1
    for number, name, rest in re.findall(r"^(\d+) (\w+)(\(.*)", dump, re.M):
        if current := re.match(r"(?:glX|egl)Make(?:Context)?Current$", name) and re.search(r"dra\w* = (\w+)", rest):
            dropping = current[1] not in swapping | pbuffers | {"0", "NULL", "EGL_NO_SURFACE"}
        swapped = re.match(_SWAP, f"{number} {name}{rest}")
        image = most_image_bytes and re.match(r"glTexImage\dD", name) and re.search(r"blob\((\d+)\)", rest)
        large = image and int(image[1]) > most_image_bytes
        if not dropping and not large and (not swapped or swapped[1] == frames):
            if kept and last == int(number) - 1:
                kept[-1][1] = int(number)
            else:
                kept.append([int(number), int(number)])
            last = int(number)
    return ",".join(f"{first}-{end}" for first, end in kept)


def _cut(recording: Recording) -> list[str]:
    """The first frames; or later ones, before which a frame has what they need."""
    if recording.cut:
        return ["gltrim", f"--frames={recording.cut}-{recording.cut + recording.frames - 2}"]
    return ["apitrace", "trim", f"--frames=0-{recording.frames - 1}"]


def _trace(recording: Recording, to: Path, environment: dict[str, str]) -> None:
    """Interrupts the program after a while; some end only when killed."""
    folders = {"here": HERE / "recordings", "live": HERE.parents[1] / "bench" / "live"}
    command = [word.format(**folders) for word in recording.command]
    process = subprocess.Popen(["apitrace", "trace", f"--api={recording.api}", "-o", to, *command],
                               env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True)
    for key in recording.keys:
        time.sleep(1)
        subprocess.run(["xdotool", "key", key], env=environment, check=False)
    for sign, seconds in ((None, recording.seconds), (signal.SIGINT, END_SECONDS), (signal.SIGKILL, END_SECONDS)):
        if sign:
            signal_group(process, sign)
        try:
            process.wait(seconds)
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
    for recording in load_recordings():
        if wanted and recording.name not in wanted:
            continue
        with XServer(recording.screen) as x:
            record(recording, x.environment())
            unstable = unstable_frames(recording, x.environment())
            bad += bool(unstable)
            state = f"frames {unstable} differ between runs" if unstable else "deterministic"
            print(f"{recording.name}: {recording.path.stat().st_size >> 10} KiB, {state}", flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
