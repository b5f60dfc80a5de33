# SPDX-License-Identifier: MIT
"""What is drawn in the golden tests: recorded programs (recordings.toml) and the scenes of our own (programs/). Both
can be run anywhere OpenGL is, and give their frames as glReadPixels returned them."""
from __future__ import annotations

import contextlib
import dataclasses
import os
import re
import signal
import subprocess
import tempfile
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import IO

import numpy as np

HERE = Path(__file__).resolve().parent
WINDOW = (400, 300)  # of a subject that does not say otherwise
WARM_UP = 1  # frames of a recording that are not compared
FRAME_LIMIT_BYTES = 64 << 20
MOST_FRAMES = 1000  # of any subject

_PNM = re.compile(rb"P6\n(?:#[^\n]*\n)*(\d+) (\d+)\n255\n")


@dataclasses.dataclass(frozen=True)
class Recording:
    """A program's first frames, as apitrace recorded them. `api` is "gl" (GLX) or "egl". What record.py needs besides:
    `needs` (of its environment), `files` (path in the home folder: text), `keys` (pressed one a second), `screen`
    (pixels of the X server), `seconds` that the program runs, and `cut`, the first frame of those that are kept with
    what they need."""

    name: str
    api: str
    command: list[str]
    frames: int
    covers: str
    window: tuple[int, int] = WINDOW
    core: bool = False  # it asks for a core profile, which Mesa refuses while told to offer the other, and may use sRGB
    first: int = WARM_UP  # frames before it are not compared
    needs: dict[str, str] = dataclasses.field(default_factory=dict)
    files: dict[str, str] = dataclasses.field(default_factory=dict)
    keys: list[str] = dataclasses.field(default_factory=list)
    screen: tuple[int, int] = (800, 600)  # programs that choose their own size take half of it
    seconds: float = 3
    cut: int = 0
    most_image_bytes: int = 0  # larger images of textures are left out, so that the recording stays small; 0: none is
    loops: bool = False  # see looping()

    kind = "recording"

    @property
    def path(self) -> Path:
        return HERE / "recordings" / f"{self.name}.trace"

    @property
    def compared(self) -> range:
        return range(self.first, self.frames)

    @property
    def shown(self) -> range:
        """Frames that can be looked at on the wall: after the last one the replay ends at once."""
        return range(self.first, self.frames - 1)

    swaps = True
    whole = False

    def argv(self) -> list[str]:
        """Replays it, with each frame written to standard output just before its swap. -b leaves out the glGetError
        that would follow each call."""
        what = ["--loop=-1"] if self.loops else ["-s", "-"]
        return ["eglretrace" if self.api == "egl" else "glretrace", "-b", *what, str(self.path)]

    def silent_argv(self) -> list[str]:
        """Replays it once, and writes nothing."""
        return [word for word in self.argv() if word not in ("-s", "-")]

    def looping(self) -> Recording:
        """Never ends: goes on with its last frame. It gives no frames."""
        return dataclasses.replace(self, loops=True)

    def environment(self) -> dict[str, str]:
        platform = {"WAFFLE_PLATFORM": "x11_egl"} if self.api == "egl" else {}
        core = {"MESA_GL_VERSION_OVERRIDE": "4.5", "MESA_EXTENSION_OVERRIDE": ""}
        return platform | (core if self.core else {})


@dataclasses.dataclass(frozen=True)
class Scene:
    """One scene of the program golden_scenes (programs/). Its text is what queries, feedback and selection returned."""

    name: str
    frames: int
    swaps: bool
    whole: bool  # every node draws all of its window
    program: Path

    kind = "scene"
    window = WINDOW

    @property
    def compared(self) -> range:
        return range(self.frames)

    shown = compared

    def argv(self) -> list[str]:
        return [str(self.program), self.name, f"--frames={self.frames}", "--pause"]

    def environment(self) -> dict[str, str]:
        return {}


Subject = Recording | Scene


def load_recordings(path: Path = HERE / "recordings.toml") -> list[Recording]:
    table = tomllib.loads(path.read_text())
    for fields in table.values():
        fields |= {name: tuple(fields[name]) for name in ("window", "screen") if name in fields}
    return [Recording(name, **fields) for name, fields in table.items()]


def load_scenes(program: Path) -> list[Scene]:
    """The program lists its scenes itself: a line `NAME FRAMES swaps|flushes tiles|whole` each."""
    lines = subprocess.run([program, "--list"], check=True, capture_output=True, text=True).stdout.split("\n")
    words = [line.split() for line in lines if line]
    return [Scene(name, int(frames), shows == "swaps", drawn == "whole", program)
            for name, frames, shows, drawn in words]


def read_frame(stream: IO[bytes]) -> np.ndarray | None:
    """The next PNM picture of a stream as (height, width, 3), top row first; None at its end. Lines that belong to no
    picture (the replayer's own messages) are skipped."""
    while True:
        line = stream.readline()
        if not line:
            return None
        if line == b"P6\n":
            break
    header = line
    while not (found := _PNM.fullmatch(header)):
        line = stream.readline()
        if not line or len(header) > 4096:
            return None
        header += line
    width, height = int(found[1]), int(found[2])
    if width * height * 3 > FRAME_LIMIT_BYTES:
        raise ValueError(f"a frame of {width}x{height} pixels")
    data = stream.read(width * height * 3)
    if len(data) != width * height * 3:
        return None
    return np.frombuffer(data, np.uint8).reshape(height, width, 3)


@contextlib.contextmanager
def _lines_of_nothing() -> Iterator[IO[bytes]]:
    """What to read for a scene that pauses after each frame, and that nobody lets go on."""
    with tempfile.TemporaryFile() as file:
        file.write(b"\n" * MOST_FRAMES)
        file.seek(0)
        yield file


class Play:
    """A running subject. `frames()` yields its pictures; while the caller looks at frame n, frame n has not been
    swapped yet, and frames before it have. `text()` after the end: what a scene printed besides."""

    def __init__(self, subject: Subject, environment: dict[str, str], prefix: list[str] = (), *, unseen: bool = False):
        """Nobody looks at the frames of one that is `unseen`: it never stops for them."""
        self.subject = subject
        self._errors = tempfile.TemporaryFile()
        with _lines_of_nothing() if unseen else contextlib.nullcontext(subprocess.PIPE) as stdin:
            self._process = subprocess.Popen([*prefix, *subject.argv()], stdin=stdin,
                                             stdout=subprocess.DEVNULL if unseen else subprocess.PIPE,
                                             stderr=self._errors, env=dict(environment, **subject.environment()),
                                             start_new_session=True)

    def frames(self) -> Iterator[np.ndarray]:
        while (frame := read_frame(self._process.stdout)) is not None:
            yield frame

    def go_on(self) -> None:
        """Lets a scene that pauses after a frame go on."""
        try:
            self._process.stdin.write(b"\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            pass

    @property
    def pid(self) -> int:
        return self._process.pid

    def alive(self) -> bool:
        return self._process.poll() is None

    def end(self) -> None:
        """Of one that would not end by itself."""
        signal_group(self._process, signal.SIGKILL)
        self._process.communicate()

    def finish(self, seconds: float = 30) -> tuple[int, str]:
        """Exit code and standard error; kills what does not end in time."""
        try:
            self._process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            signal_group(self._process, signal.SIGKILL)
            self._process.communicate()
        self._errors.seek(0)
        return self._process.returncode, self._errors.read().decode(errors="replace")


def signal_group(process: subprocess.Popen, number: int) -> None:
    """To a process that leads its own group, and to its children."""
    try:
        os.killpg(process.pid, number)
    except ProcessLookupError:
        pass


def play_through(subject: Subject, environment: dict[str, str]) -> list[np.ndarray]:
    """All frames of a subject, without a stop."""
    play = Play(subject, environment)
    frames = []
    for frame in play.frames():
        frames.append(frame)
        play.go_on()
    play.finish()
    return frames
