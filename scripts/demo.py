# SPDX-License-Identifier: MIT
"""Runs a wall of virtual tiles on this machine with programs on it. scripts/demo.sh builds first, then comes here."""
from __future__ import annotations

import argparse
import contextlib
import os
import pwd
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
os.environ.setdefault("WALLGL_CACHE", "")  # as usual, which tests do not want
from wall import Wall, WallError  # noqa: E402
from xserver import XServer  # noqa: E402

DEFAULT_HTTP = 7780
FIRST_FRAME_LIMIT = 20.0  # seconds for the programs to show something
PICTURE_AFTER = 3.0  # seconds after the first frame until a screenshot without --seconds
POLL = 0.1  # seconds
EXIT_NOT_STARTED = 2

DESCRIPTION = """\
A wall of virtual tiles on this machine, with real OpenGL programs on it. Without programs: glxgears and xscreensaver's
atlantis, side by side, until Ctrl-C. With programs and without --seconds it ends when the last of them ends, with the
worst of their exit codes. With no X display it starts Xvfb for the programs' windows; also with --windows, which shows
the tiles themselves as windows of the desktop."""
EXAMPLES = """\
examples:
  scripts/demo.sh
  scripts/demo.sh --windows
  scripts/demo.sh --tiles 3x1 --tile-size 640x480 --backend osmesa
  scripts/demo.sh --seconds 8 --screenshot out.png -- glxgears -geometry 1024x768
  scripts/demo.sh -- glxgears --and /usr/libexec/xscreensaver/atlantis --window"""


def pair(text: str) -> tuple[int, int]:
    first, cross, second = text.partition("x")
    if not cross or not first.isdigit() or not second.isdigit() or not int(first) or not int(second):
        raise argparse.ArgumentTypeError(f"'{text}': expected two numbers as in 2x2")
    return int(first), int(second)


def parse(words: list[str]) -> tuple[argparse.Namespace, list[list[str]]]:
    """Options, and the programs that follow `--`, separated by `--and`."""
    ours, programs = words, []
    if "--" in words:
        at = words.index("--")
        ours, rest = words[:at], words[at + 1:]
        programs = [[]]
        for word in rest:
            if word == "--and":
                programs.append([])
            else:
                programs[-1].append(word)
    parser = argparse.ArgumentParser(prog="scripts/demo.sh", description=DESCRIPTION, epilog=EXAMPLES,
                                     usage="%(prog)s [options] [-- APP ARGS... [--and APP ARGS...]...]",
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tiles", type=pair, default=(2, 2), metavar="CxR", help="columns and rows (2x2)")
    parser.add_argument("--tile-size", type=pair, default=(512, 384), metavar="WxH", help="pixels of a tile (512x384)")
    parser.add_argument("--backend", choices=["egl", "osmesa"], default="egl", help="what the tiles render with (egl)")
    parser.add_argument("--windows", action="store_true",
                        help="show the tiles as windows of this desktop, beside each other from its top left")
    parser.add_argument("--seconds", type=float, metavar="N", help="end this long after the programs show something")
    parser.add_argument("--screenshot", metavar="FILE",
                        help="write the wall's picture as PNG: before the end with --seconds, "
                        f"else {PICTURE_AFTER:.0f} seconds after the first frame and at Ctrl-C")
    parser.add_argument("--http", type=int, metavar="PORT",
                        help=f"port of the status page ({DEFAULT_HTTP}, or a free one)")
    options = parser.parse_args(ours)
    if any(not program for program in programs):
        parser.error("a program is missing after -- or --and")
    if options.windows and not os.environ.get("DISPLAY"):
        parser.error("--windows: there is no desktop here, DISPLAY is not set: start this in a terminal of the "
                     "desktop, or leave --windows out")
    if options.windows and options.backend != "egl":
        parser.error(f"--windows: {options.backend} draws into memory only: use --backend egl")
    return options, programs


def default_programs(size: tuple[int, int]) -> list[list[str]]:
    half = f"{size[0] // 2}x{size[1]}"
    return [["glxgears", "-geometry", half], ["/usr/libexec/xscreensaver/atlantis", "--window", "--geometry", half]]


def http_port(asked: int | None) -> int:
    if asked is not None:
        return asked
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        return DEFAULT_HTTP if probe.connect_ex(("127.0.0.1", DEFAULT_HTTP)) != 0 else 0


def display(stack: contextlib.ExitStack, size: tuple[int, int], own: bool) -> str:
    """Where the programs have their windows; `own`: not on the desktop, which shows the tiles."""
    if os.environ.get("DISPLAY") and not own:
        return os.environ["DISPLAY"]
    server = stack.enter_context(XServer((max(size[0], 1280), max(size[1], 1024))))
    why = "the desktop shows the tiles" if own else "no X display here"
    print(f"demo: {why}, started Xvfb {server.display} for the programs' windows", flush=True)
    return server.display


def environment(display_name: str) -> dict[str, str]:
    user = pwd.getpwuid(os.getuid())
    return {"USER": user.pw_name, "HOME": user.pw_dir, **os.environ, "DISPLAY": display_name}


def running(apps: list[subprocess.Popen]) -> list[subprocess.Popen]:
    return [app for app in apps if app.poll() is None]


def wait_first_frames(wall: Wall, apps: list[subprocess.Popen]) -> None:
    end = time.monotonic() + FIRST_FRAME_LIMIT
    while running(apps) and time.monotonic() < end:
        drawing = {session["pid"] for session in wall.sessions() if any(s["frame"] > 0 for s in session["surfaces"])}
        if all(app.pid in drawing for app in running(apps)):
            return
        time.sleep(POLL)


def wait_end(apps: list[subprocess.Popen], seconds: float | None) -> None:
    end = None if seconds is None else time.monotonic() + seconds
    while running(apps) and (end is None or time.monotonic() < end):
        time.sleep(POLL)


def screenshot(wall: Wall, path: str | None) -> None:
    if path:
        wall.screenshot(path)
        print(f"demo: wrote {path}", flush=True)


def exit_code(app: subprocess.Popen) -> int:
    """As a shell has it; 0 for one that still runs and is ended by us."""
    code = app.poll() or 0
    return 128 - code if code < 0 else code


def run(wall: Wall, apps: list[subprocess.Popen], options: argparse.Namespace) -> int:
    wait_first_frames(wall, apps)
    if options.seconds is None:
        wait_end(apps, PICTURE_AFTER if options.screenshot else 0)
        screenshot(wall, options.screenshot)
        try:
            wait_end(apps, None)
        except KeyboardInterrupt:
            screenshot(wall, options.screenshot)
            raise
    else:
        wait_end(apps, options.seconds)
        screenshot(wall, options.screenshot)
    return max(map(exit_code, apps))


def interrupt(*_) -> None:
    raise KeyboardInterrupt


def main() -> int:
    options, programs = parse(sys.argv[1:])
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, interrupt)
    with contextlib.ExitStack() as stack:
        try:
            size = (options.tiles[0] * options.tile_size[0], options.tiles[1] * options.tile_size[1])
            around = environment(display(stack, size, options.windows))
            wall = stack.enter_context(Wall(options.tiles, options.tile_size, options.backend, name="demo",
                                            die_with_parent=True,
                                            windows=os.environ["DISPLAY"] if options.windows else "",
                                            http=f"127.0.0.1:{http_port(options.http)}"))
            print(f"demo: a wall of {options.tiles[0]}x{options.tiles[1]} tiles, {wall.size[0]}x{wall.size[1]} pixels, "
                  f"drawn with {options.backend}\n"
                  f"demo: status page {wall.url}\n"
                  f"demo: operate with build/release/bin/wallctl --walld {wall.address} status", flush=True)
            apps = []
            for program in programs or default_programs(wall.size):
                apps.append(wall.run(*program, env=around))
                print(f"demo: on the wall: {' '.join(program)}", flush=True)
            if options.seconds is None:
                print("demo: Ctrl-C ends it", flush=True)
            return run(wall, apps, options)
        except KeyboardInterrupt:
            print("\ndemo: ending", flush=True)
            return 0
        except (WallError, OSError, RuntimeError) as error:
            print(f"demo: {error}", file=sys.stderr)
            return EXIT_NOT_STARTED


if __name__ == "__main__":
    sys.exit(main())
