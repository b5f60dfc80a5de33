#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Frames for the codec benchmark: real programs on plain Mesa under Xvfb, and a desktop of terminals, grabbed at
1920x1080.

codec_frames.py FOLDER      writes FOLDER/SCENE.bgra, each 5 frames of 1920x1080 BGRA in a row; scenes that exist stay
"""
from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "tests" / "support"))
from xserver import XServer  # noqa: E402

SIZE = (1920, 1080)
FRAMES = 5
FRAME_BYTES = SIZE[0] * SIZE[1] * 4
HACKS = Path("/usr/libexec/xscreensaver")


def hack(name: str, *arguments: str) -> list[list[str]]:
    return [[str(HACKS / name), "-root", *arguments]]


def terminal(place: str, font: list[str], colours: tuple[str, str], command: str) -> list[str]:
    return ["xterm", "-b", "4", *font, "-bg", colours[0], "-fg", colours[1], "-geometry", place, "-e", "sh", "-c",
            command]


SMOOTH, BITMAP = ["-fa", "DejaVu Sans Mono", "-fs", "10"], ["-fn", "fixed"]
SCENES: dict[str, list[list[str]]] = {
    "atlantis": hack("atlantis"),
    "gears": hack("gears"),
    "glxgears": [["glxgears", "-geometry", f"{SIZE[0]}x{SIZE[1]}+0+0"]],
    "pipes": hack("pipes"),
    "sballs": hack("sballs"),
    "superquadrics": hack("superquadrics"),
    "text": [
        terminal("110x60+0+0", SMOOTH, ("white", "black"), f"cat '{REPOSITORY}/docs/architecture.md'; sleep 60"),
        terminal("110x60-0+0", SMOOTH, ("#101820", "#d0d0d0"),
                 f"ls -lR --color=always '{REPOSITORY}/common'; sleep 60"),
        terminal("120x20+300-0", BITMAP, ("#fdf6e3", "#586e75"),
                 f"while read line; do echo \"$line\"; sleep 0.1; done < '{REPOSITORY}/HACKING.md'; sleep 60"),
    ],
}


def grab(scene: str, target: Path) -> None:
    with XServer(SIZE) as x:
        programs = [subprocess.Popen(command, env=x.environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                    for command in SCENES[scene]]
        time.sleep(4)
        unfinished = target.with_suffix(".part")
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "x11grab", "-draw_mouse", "0", "-framerate", "5",
                        "-video_size",
                        f"{SIZE[0]}x{SIZE[1]}", "-i", x.display, "-frames:v", str(FRAMES), "-pix_fmt", "bgra", "-f",
                        "rawvideo", str(unfinished)], check=True, timeout=120)
        for program in programs:
            program.terminate()
            program.wait()
    if unfinished.stat().st_size != FRAMES * FRAME_BYTES:
        raise RuntimeError(f"{scene}: {unfinished.stat().st_size} bytes grabbed, {FRAMES * FRAME_BYTES} wanted")
    unfinished.rename(target)


def main() -> int:
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__)
        return 2
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for scene in SCENES:
        target = folder / f"{scene}.bgra"
        if not target.exists():
            grab(scene, target)
    return 0


if __name__ == "__main__":
    sys.exit(main())
