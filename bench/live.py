#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Real programs, unmodified, on plain Mesa and then on a wall, each for some seconds: frames a second of both, and on
the wall bytes a frame to all nodes, round trips a frame, OpenGL errors and faults. The programs are in
live/programs.toml; one whose package is not installed is named and left out.

live.py [--only NAME]... [--tiles CxR] [--seconds N] [--xvfb-run] [--pictures FOLDER] [--json FILE]
live.py --table FILE      prints the table of docs/applications.md out of the JSON of a run
    --xvfb-run: programs are started by xvfb-run with an X server each, instead of on one that all use
    --pictures: a picture of each program's window on both at the end, as PNG
    exit code 1 if a program fails on the wall that runs on Mesa
"""
from __future__ import annotations

import argparse
import contextlib
import dataclasses
import datetime
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import tomllib
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "tests" / "support"))
from wall import Wall, WallError, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

SCREEN = (1024, 768)  # of the X server, and of the wall; most windows are smaller and touch all tiles
FIRST_FRAME_LIMIT = 120.0  # seconds; large programs compile shaders and load data first
END_LIMIT = 10.0  # seconds that a program may take to end when asked
XVFB_RUN = ["xvfb-run", "-a", "-s", f"-screen 0 {SCREEN[0]}x{SCREEN[1]}x24 +extension GLX -noreset"]
WORDS_OF_ERRORS = 80  # characters kept of a program's last words


@dataclasses.dataclass(frozen=True)
class Program:
    """One of programs.toml. `{scripts}` in a command is the folder of its scripts, `{home}` an empty home folder."""

    name: str
    package: str
    command: list[str]
    does: str
    environment: dict[str, str] = dataclasses.field(default_factory=dict)
    files: dict[str, str] = dataclasses.field(default_factory=dict)  # path in the home folder: text
    keys: list[str] = dataclasses.field(default_factory=list)  # pressed one a second after the first frame (xdotool)
    loads: float = 3.0  # seconds after the first frame that are not counted: it still loads

    def missing(self) -> str:
        """The packages it needs and that are not installed."""
        needed = [*self.package.split(), *(["xdotool"] if self.keys else [])]
        return " ".join(name for name in needed if not installed(name))

    def line(self, home: Path) -> list[str]:
        return [word.format(scripts=HERE / "live", home=home) for word in self.command]


def installed(package: str) -> bool:
    said = subprocess.run(["dpkg-query", "-W", "-f", "${db:Status-Status}", package], capture_output=True, text=True)
    return said.stdout == "installed"


def load_programs(path: Path = HERE / "live" / "programs.toml") -> list[Program]:
    """A row with `scenes` stands for a program each, with the scene in place of `{scene}`."""
    programs = []
    for name, row in tomllib.loads(path.read_text()).items():
        for scene in row.pop("scenes", [""]) if "scenes" in row else [""]:
            command = [word.replace("{scene}", scene) for word in row["command"]]
            programs.append(Program(f"{name} {scene}".strip(), **dict(row, command=command)))
    return programs


@dataclasses.dataclass
class Sample:
    """What has been counted so far. `seconds` of any clock that all samples of a run have in common."""

    seconds: float
    frames: int
    bytes: int = 0
    round_trips: Counter = dataclasses.field(default_factory=Counter)


class MesaCounts:
    """Frames on plain Mesa: counting_vendor.cpp counts them in a file that both map."""

    def __init__(self, folder: Path):
        self._file = folder / "frames"
        self._file.write_bytes(bytes(8))
        self._log = folder / "mesa.log"

    def environment(self) -> dict[str, str]:
        vendor = build_folder() / "bench" / "counting"
        return {"__GLX_VENDOR_LIBRARY_NAME": "counting",
                "__EGL_VENDOR_LIBRARY_FILENAMES": str(vendor / "counting.json"),
                "LD_LIBRARY_PATH": str(vendor), "LIVE_FRAMES": str(self._file), "MESA_DEBUG": "1",
                "MESA_LOG_FILE": str(self._log)}

    def sample(self) -> Sample:
        return Sample(time.monotonic(), struct.unpack("Q", self._file.read_bytes())[0])

    def errors(self) -> Counter:
        """OpenGL errors that the program made, by what Mesa says of them."""
        text = self._log.read_text(errors="replace") if self._log.exists() else ""
        return Counter(re.findall(r"User error: (GL_\w+ in \w+)", text))


class WallCounts:
    """Of a program on the wall: what the library writes every second (WALLGL_STATS) and its log."""

    def __init__(self, folder: Path):
        self._file, self._log = folder / "stats.json", folder / "wallgl.log"

    def environment(self) -> dict[str, str]:
        return {"WALLGL_STATS": str(self._file), "WALLGL_LOG": f"debug:{self._log}"}

    def stats(self) -> dict:
        with contextlib.suppress(OSError, ValueError):
            return json.loads(self._file.read_text())
        return {"seconds": 0.0, "frames": 0, "total": {}, "round_trips_by_function": {}, "unsupported": {}}

    def sample(self) -> Sample:
        stats = self.stats()
        sent = sum(count for name, count in stats["total"].items() if name.endswith("_bytes"))
        return Sample(stats["seconds"], stats["frames"], sent, Counter(stats["round_trips_by_function"]))

    def errors(self) -> Counter:
        text = self._log.read_text(errors="replace") if self._log.exists() else ""
        return Counter(re.findall(r" opengl_error (GL_\w+ in \w+)", text))


@dataclasses.dataclass
class Run:
    """One program in one place. `problem` is empty if it ran to the end."""

    frames_per_second: float = 0.0
    bytes_per_frame: float = 0.0
    round_trips_per_frame: float = 0.0
    round_trips: dict[str, int] = dataclasses.field(default_factory=dict)  # in the counted seconds, by function
    errors: dict[str, int] = dataclasses.field(default_factory=dict)
    unsupported: dict[str, int] = dataclasses.field(default_factory=dict)
    node_errors: int = 0  # of the nodes' drivers
    problem: str = ""

    def count(self, samples: list[Sample], loads: float) -> None:
        """What lies between the first sample `loads` seconds after the first frame, and the last one."""
        began = next((each.seconds for each in samples if each.frames), 0.0)
        first = next((each for each in samples if each.seconds >= began + loads), samples[-1])
        last = samples[-1]
        frames, seconds = last.frames - first.frames, last.seconds - first.seconds
        if seconds > 0:
            self.frames_per_second = frames / seconds
        if frames > 0:
            waited = last.round_trips - first.round_trips
            self.bytes_per_frame = (last.bytes - first.bytes) / frames
            self.round_trips, self.round_trips_per_frame = dict(waited), waited.total() / frames


class Window:
    """The X display of a running program (which xvfb-run may have chosen)."""

    def __init__(self, pid: int):
        entries = Path(f"/proc/{pid}/environ").read_bytes().decode(errors="replace").split("\0")
        self._environment = dict(os.environ, **dict(entry.split("=", 1) for entry in entries if
                                                    entry.startswith(("DISPLAY=", "XAUTHORITY="))))

    def press(self, key: str) -> None:
        subprocess.run(["xdotool", "key", key], env=self._environment, check=False, capture_output=True)

    def save(self, path: Path) -> None:
        subprocess.run(["ffmpeg", "-y", "-loglevel", "error", "-f", "x11grab", "-video_size",
                        f"{SCREEN[0]}x{SCREEN[1]}", "-i", self._environment["DISPLAY"], "-frames:v", "1", path],
                       env=self._environment, check=False, stdin=subprocess.DEVNULL)


def children(pid: int) -> list[int]:
    """A process, and its youngest descendants last: xvfb-run starts a program beside its X server."""
    found = [pid]
    with contextlib.suppress(OSError):
        for child in sorted(map(int, Path(f"/proc/{pid}/task/{pid}/children").read_text().split())):
            found += children(child)
    return found


class Watch:
    """Watches a program that was started: until it has drawn for `seconds`, or ended."""

    def __init__(self, program: Program, app: subprocess.Popen, counts: MesaCounts | WallCounts):
        self._program, self._app, self._counts = program, app, counts
        self.samples: list[Sample] = []

    def window(self) -> Window:
        return Window(children(self._app.pid)[-1])

    def until(self, seconds: float) -> str:
        """Gives what went wrong."""
        start = time.monotonic()
        began = 0.0
        keys = list(self._program.keys)
        while not began or time.monotonic() < began + seconds:
            time.sleep(0.1)
            sample = self._counts.sample()
            if not self.samples or sample != self.samples[-1]:
                self.samples.append(sample)
            began = began or (time.monotonic() if sample.frames else 0.0)
            if self._app.poll() is not None:
                return f"ended with {self._app.returncode}"
            if not began and time.monotonic() > start + FIRST_FRAME_LIMIT:
                return f"drew no frame in {FIRST_FRAME_LIMIT:.0f} seconds"
            if began and keys and time.monotonic() > began + 1 + len(self._program.keys) - len(keys):
                self.window().press(keys.pop(0))
        return "" if self.samples[-1].frames > 1 else "drew one frame only"

    def end(self) -> str:
        """Asks the program to end; gives what went wrong, unless it ends of the signal."""
        with contextlib.suppress(ProcessLookupError):
            os.kill(children(self._app.pid)[-1], signal.SIGTERM)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._app.wait(END_LIMIT)
        end_group(self._app)
        crashes = {-signal.SIGSEGV, -signal.SIGABRT, -signal.SIGBUS, 128 + signal.SIGSEGV, 128 + signal.SIGABRT}
        return f"ended with {self._app.returncode}" if self._app.returncode in crashes else ""


def end_group(app: subprocess.Popen) -> None:
    for sign in (signal.SIGTERM, signal.SIGKILL):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(app.pid, sign)
        with contextlib.suppress(subprocess.TimeoutExpired):
            app.wait(2)
            return


class Bench:
    def __init__(self, x: XServer, wall: Wall, options: argparse.Namespace):
        self._x, self._wall, self._options = x, wall, options

    def measure(self, program: Program) -> dict[str, object]:
        with tempfile.TemporaryDirectory(prefix="live-") as folder:
            mesa = self._run(program, Path(folder), MesaCounts(Path(folder)), [])
        with tempfile.TemporaryDirectory(prefix="live-") as folder:
            before = self._node_errors()
            wall = self._run(program, Path(folder), WallCounts(Path(folder)), self._wall.wallrun()[:-1] + ["--"])
            wall.node_errors = self._node_errors() - before
        return {"does": program.does, "package": program.package, "mesa": dataclasses.asdict(mesa),
                "wall": dataclasses.asdict(wall)}

    def _node_errors(self) -> int:
        return sum(node["gl_errors"] for node in self._wall.nodes())

    @contextlib.contextmanager
    def _started(self, program: Program, folder: Path, environment: dict[str, str],
                 prefix: list[str]) -> Iterator[subprocess.Popen]:
        home = folder / "home"
        home.mkdir()
        for name, text in program.files.items():
            (home / name).parent.mkdir(parents=True, exist_ok=True)
            (home / name).write_text(text)
        whole = self._x.environment(HOME=str(home), XDG_RUNTIME_DIR=str(home), LIBGL_ALWAYS_SOFTWARE="1",
                                    vblank_mode="0", USER="root",
                                    PATH="/usr/bin:/bin:/usr/games", SDL_AUDIODRIVER="dummy", ALSOFT_DRIVERS="null",
                                    **program.environment, **environment)
        line = [*(XVFB_RUN if self._options.xvfb_run else []), *prefix, *program.line(home)]
        with open(folder / "said", "wb") as said:
            app = subprocess.Popen(line, env=whole, cwd=home, stdin=subprocess.DEVNULL, stdout=said, stderr=said,
                                   start_new_session=True)
        try:
            yield app
        finally:
            end_group(app)

    def _run(self, program: Program, folder: Path, counts: MesaCounts | WallCounts, prefix: list[str]) -> Run:
        run = Run()
        with self._started(program, folder, counts.environment(), prefix) as app:
            watch = Watch(program, app, counts)
            run.problem = watch.until(program.loads + self._options.seconds)
            on_wall = isinstance(counts, WallCounts)
            if not run.problem and on_wall:
                run.problem = self._fault()
            if not run.problem and self._options.pictures:
                self._save(watch, program, on_wall)
            run.problem = run.problem or watch.end()
        if watch.samples:
            run.count(watch.samples, program.loads)
        if run.problem:
            run.problem += last_words(folder / "said")
        run.errors = dict(counts.errors())
        if on_wall:
            run.unsupported = counts.stats()["unsupported"]
        return run

    def _fault(self) -> str:
        faults = [session["fault"] for session in self._wall.sessions() if session["fault"]]
        return f"fault: {faults[0]}" if faults else ""

    def _save(self, watch: Watch, program: Program, on_wall: bool) -> None:
        path = self._options.pictures / f"{program.name.replace(' ', '-')}-{'wall' if on_wall else 'mesa'}.png"
        with contextlib.suppress(WallError, OSError):
            if on_wall:
                self._wall.screenshot(path)
            else:
                watch.window().save(path)


def last_words(path: Path) -> str:
    lines = [line.strip() for line in path.read_text(errors="replace").splitlines() if line.strip()]
    return f": {lines[-1][:WORDS_OF_ERRORS]}" if lines else ""


def told(name: str, result: dict) -> str:
    """A line for people."""
    mesa, wall = result["mesa"], result["wall"]
    text = (f"{name:24} {mesa['frames_per_second']:7.1f} {wall['frames_per_second']:7.1f} frames/s, "
            f"{wall['bytes_per_frame']:11,.0f} bytes, {wall['round_trips_per_frame']:.2f} round trips")
    for place, run in (("Mesa", mesa), ("wall", wall)):
        for what in ("problem", "errors", "unsupported", "node_errors", "round_trips"):
            text += f"\n    {place}: {what} {run[what]}" if run[what] else ""
    return text


def table(report: dict) -> Iterator[str]:
    """Lines of Markdown."""
    yield "| program | plain Mesa | wall | ratio | bytes a frame | round trips a frame | OpenGL errors, Mesa / wall |"
    yield "|---|---|---|---|---|---|---|"
    order = [program.name for program in load_programs()]
    for name, result in sorted(report["programs"].items(), key=lambda entry: order.index(entry[0])):
        if "missing" in result:
            yield f"| {name} | package missing: {result['missing']} | | | | | |"
            continue
        mesa, wall = result["mesa"], result["wall"]
        errors = f"{sum(mesa['errors'].values())} / {sum(wall['errors'].values())}"
        if wall["problem"]:
            yield f"| {name} | {rate(mesa)} | {wall['problem']} | | | | {errors} |"
            continue
        ratio = wall["frames_per_second"] / mesa["frames_per_second"] if mesa["frames_per_second"] else 0.0
        yield (f"| {name} | {rate(mesa)} | {rate(wall)} | {ratio:.2f} | {wall['bytes_per_frame']:,.0f} | "
               f"{wall['round_trips_per_frame']:.2f} | {errors} |")


def rate(run: dict) -> str:
    return run["problem"] or f"{run['frames_per_second']:.1f}"


def failed(result: dict) -> bool:
    if "missing" in result:
        return False
    wall, mesa = result["wall"], result["mesa"]
    return bool(wall["problem"] and not mesa["problem"] or wall["node_errors"] or wall["unsupported"]
                or codes(wall["errors"]) - codes(mesa["errors"]))


class Report:
    """The results, which a file has after each program. What a file of the same kind has of others stays."""

    def __init__(self, path: Path | None, options: argparse.Namespace):
        self._path, self.results = path, {}
        self._about = {"measured": datetime.date.today().isoformat(), "seconds": options.seconds,
                       "tiles": options.tiles, "processors": os.cpu_count(), "xvfb_run": options.xvfb_run}
        self._old = {}
        if path and path.exists():
            told_before = json.loads(path.read_text())
            self._old = told_before.pop("programs")
            if told_before != self._about:
                raise SystemExit(f"{path} is of another run: {told_before}, not {self._about}")

    def add(self, name: str, result: dict) -> None:
        self.results[name] = result
        if self._path:
            self._path.write_text(json.dumps({**self._about, "programs": self._old | self.results}, indent=1) + "\n")


def codes(errors: dict[str, int]) -> set[str]:
    """Without the functions, which Mesa does not name in full."""
    return {error.split()[0] for error in errors}


def run_all(programs: list[Program], options: argparse.Namespace, report: Report) -> None:
    columns, rows = map(int, options.tiles.split("x"))
    size = (SCREEN[0] // columns, SCREEN[1] // rows)
    with XServer(SCREEN) as x:
        for program in programs:
            missing = program.missing()
            if missing:
                report.add(program.name, {"missing": missing})
                print(f"{program.name:24} not installed: {missing}", flush=True)
                continue
            with Wall(tiles=(columns, rows), tile_size=size, name="live", swap_timeout_ms=10000) as wall:
                result = Bench(x, wall, options).measure(program)
            report.add(program.name, result)
            print(told(program.name, result), flush=True)


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("--only", action="append", default=[], help="a program, or the first words of some")
    arguments.add_argument("--tiles", default="2x2")
    arguments.add_argument("--seconds", type=float, default=20)
    arguments.add_argument("--xvfb-run", action="store_true")
    arguments.add_argument("--pictures", type=Path)
    arguments.add_argument("--json", type=Path)
    arguments.add_argument("--table", type=Path)
    options = arguments.parse_args()
    if options.table:
        print("\n".join(table(json.loads(options.table.read_text()))))
        return 0
    if options.xvfb_run and not shutil.which("xvfb-run"):
        arguments.error("xvfb-run is not installed (package xvfb)")
    if options.pictures:
        options.pictures.mkdir(parents=True, exist_ok=True)
    programs = [each for each in load_programs() if not options.only or each.name.startswith(tuple(options.only))]
    report = Report(options.json, options)
    run_all(programs, options, report)
    bad = [name for name, result in report.results.items() if failed(result)]
    print(f"{len(report.results)} programs, worse than on Mesa: {', '.join(bad) or 'none'}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
