# SPDX-License-Identifier: MIT
"""Programs that tell whether a wall is right. They are held while pictures are compared, so that the frame which they
show is known, and run while something happens: a held program draws no frame from which a node that was away could
take it up."""
from __future__ import annotations

import dataclasses
import json
import subprocess
import time
from pathlib import Path
from typing import Callable

import cv2
import numpy
from wall import Wall, WallError, build_folder, end_all
from xserver import XServer

PROGRAMS = build_folder() / "tests"


@dataclasses.dataclass(frozen=True)
class Part:
    """A program and where it lies. `still`: all of its frames are the same; `ranks`: processes of a parallel one."""

    program: str
    rect: tuple[int, int, int, int]
    still: bool = False
    ranks: int = 0
    arguments: tuple[object, ...] = ()

    def command(self) -> list[object]:
        folder = build_folder() / ("examples" if self.program == "march" else "tests")
        return [folder / self.program, "--size", f"{self.rect[2]}x{self.rect[3]}", *self.arguments]


# One draws once what only the nodes keep (drawn_once.cpp), the other a colour that tells the frame (frame_clock.cpp).
SHOWN = (Part("drawn_once", (0, 0, 600, 180), still=True), Part("frame_clock", (0, 180, 600, 120)))
FIRST = 2  # frames that a show begins with
SETTLED = 0.3  # seconds after which what was told to be shown is shown
GONE = 5.0  # seconds until a program that has ended is off the wall
TOLD = 10.0  # seconds; a program writes its counters once a second


def until(done: Callable[[], bool], what: str, limit: float) -> None:
    end = time.monotonic() + limit
    while not done():
        if time.monotonic() > end:
            raise AssertionError(f"not within {limit:.0f} s: {what}")
        time.sleep(0.05)


def counters(stats: Path, frames: int) -> dict:
    """What a program that runs with WALLGL_STATS has counted, `frames` frames included: it writes before it draws,
    too."""
    told: dict = {}

    def are_there() -> bool:
        told.update(json.loads(stats.read_text()) if stats.exists() else {})
        return told.get("frames", 0) >= frames

    until(are_there, f"the counters of {frames} frames in {stats}", TOLD)
    return told


class Playing:
    """One program of a show, held at a frame that is known."""

    def __init__(self, wall: Wall, part: Part, run: Callable, x: XServer, fps: int):
        self.wall, self.part, self.frame = wall, part, 0
        known = {s["id"] for s in wall.sessions()}
        limit = ["--fps", fps] if fps else []
        self.app: subprocess.Popen = run(*part.command(), *limit, rect=part.rect, hold=True, parallel=part.ranks,
                                         env=x.environment())
        try:
            if part.ranks:  # the session's process is another one than the one that was started
                until(lambda: self._new_groups(known), "the parallel program comes", 20.0)
                self.session = self._new_groups(known)[0]
            else:
                self.session = wall.wait_session(self.app)
            self.step(FIRST)
        except BaseException:
            end_all([self.app])
            raise

    def _new_groups(self, known: set[int]) -> list[int]:
        return [s["id"] for s in self.wall.sessions() if s["id"] not in known and "group" in s and s["surfaces"]]

    def step(self, frames: int = 1) -> None:
        self.frame += frames
        self.wall.step(self.session, frames)
        self.wall.wait(self.session, self.frame)

    def frame_now(self) -> int:
        """While it is not held, too. WallError: it is coming back just now, on another link."""
        for session in self.wall.sessions():
            if session["id"] == self.session and session["surfaces"]:
                return session["surfaces"][0]["frame"]
        raise WallError(f"session {self.session} has no window on the wall now")


class Show:
    """Programs on a wall, started by `run` and held. `fps`: of those that come after they were let go; 0: as many as
    possible."""

    def __init__(self, wall: Wall, run: Callable, x: XServer, fps: int = 0, parts: tuple[Part, ...] = SHOWN):
        self.wall = wall
        self.playing: list[Playing] = []
        try:
            for part in parts:
                self.playing.append(Playing(wall, part, run, x, fps))
        except BaseException:
            end_all(self.apps)
            raise

    @property
    def apps(self) -> list[subprocess.Popen]:
        return [playing.app for playing in self.playing]

    @property
    def sessions(self) -> set[int]:
        return {playing.session for playing in self.playing}

    @property
    def frames(self) -> list[int]:
        """Of each program, as the wall shows it; 0 for one whose frames are all the same."""
        return [0 if playing.part.still else playing.frame for playing in self.playing]

    @property
    def clock(self) -> Playing:
        return next(playing for playing in self.playing if playing.part.program == "frame_clock")

    def step(self, frames: int = 1) -> None:
        for playing in self.playing:
            playing.step(frames)

    def go_on(self) -> None:
        for playing in self.playing:
            self.wall.hold(playing.session, on=False)

    def hold(self) -> None:
        for playing in self.playing:
            self.wall.hold(playing.session)
        time.sleep(SETTLED)
        for playing in self.playing:
            playing.frame = playing.frame_now()

    def picture(self) -> numpy.ndarray:
        return cv2.imdecode(numpy.frombuffer(self.wall.screenshot(), numpy.uint8), cv2.IMREAD_COLOR)

    def end(self) -> None:
        end_all(self.apps)
        until(lambda: not self.sessions & {s["id"] for s in self.wall.sessions()}, "programs leave the wall", GONE)


class OneMachine:
    """The same programs on a wall of this machine, where nothing happens."""

    def __init__(self, wall: Wall, x: XServer, parts: tuple[Part, ...] = SHOWN):
        self.wall, self.x = wall, x
        self.parts = parts
        self.show = Show(wall, wall.run, x, parts=parts)

    def picture(self, frames: list[int]) -> numpy.ndarray:
        """Of Show.frames."""
        for i, (playing, frame) in enumerate(zip(self.show.playing, frames)):
            if frame and frame < playing.frame:
                end_all([playing.app])
                playing = self.show.playing[i] = Playing(self.wall, playing.part, self.wall.run, self.x, 0)
            if frame > playing.frame:
                playing.step(frame - playing.frame)
        return self.show.picture()
