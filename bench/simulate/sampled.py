# SPDX-License-Identifier: MIT
"""What a running program, and the daemons that serve it, need of the processor in a frame."""
from __future__ import annotations

import dataclasses
import subprocess
import sys
import time
from pathlib import Path
from typing import Callable

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "support"))
from wall import Wall, WallError  # noqa: E402

INTERVAL = 0.02  # seconds between two looks at least,
REST = 5  # and so many times as long as one takes
NANO = 1e-9

# Seconds that each thread has run, by its number; the process's first one is the first.
Threads = dict[int, float]


def threads_of(pid: int) -> Threads:
    out = {}
    for task in sorted(Path(f"/proc/{pid}/task").iterdir(), key=lambda path: int(path.name)):
        try:
            out[int(task.name)] = int((task / "schedstat").read_text().split()[0]) * NANO
        except OSError:
            pass  # it has just ended
    return out


def members_of(pid: int) -> list[int]:
    """The processes of a parallel program, which wallrun has started; of any other, itself."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [int(child) for child in children] or [pid]


@dataclasses.dataclass
class Look:
    time: float
    frame: int  # the last one shown
    daemons: dict[str, Threads]
    members: list[Threads]


@dataclasses.dataclass(frozen=True)
class Rates:
    """Over the frames between two looks. Seconds are of processor time, in a frame."""

    frames: int
    frames_per_second: float
    daemons: dict[str, float]  # by name
    packing: float  # of a member's own thread, on average
    sending: float  # of its other ones


def last_shown(sessions: list[dict]) -> int:
    """The last frame that a wall has shown of its only program, by walld's list."""
    return max((surface["frame"] for session in sessions for surface in session["surfaces"]), default=0)


def watch(wall: Wall, app: subprocess.Popen, first: int, enough: Callable[[Look, Look], bool], limit: float,
          sessions: Callable[[], list[dict]]) -> Rates:
    """From frame `first` of the only program on the wall on, until what was seen then and now is enough, or the program
    ends; within `limit` seconds. `sessions` gives walld's list of them."""
    looks: list[Look] = []
    end = time.monotonic() + limit
    while app.poll() is None and not (len(looks) > 1 and enough(looks[0], looks[-1])):
        if time.monotonic() > end:
            raise WallError(f"{app.args}: too few frames in {limit:.0f} seconds: from {first} on, "
                            f"{looks[-1].frame if looks else 'none'} was reached")
        begin = time.monotonic()
        try:
            frame = last_shown(sessions())
            now = Look(time.monotonic(), frame, {name: threads_of(d.pid) for name, d in wall.daemons.items()},
                       [threads_of(member) for member in members_of(app.pid)])
        except OSError:
            break  # it has just ended
        if now.frame >= first:
            looks.append(now)
        time.sleep(max(INTERVAL, REST * (time.monotonic() - begin)))
    if len(looks) < 2 or looks[-1].frame == looks[0].frame:
        raise WallError(f"{app.args}: has ended with code {app.poll()} before frame {first}")
    return between(looks[0], looks[-1])


def between(begin: Look, end: Look) -> Rates:
    frames = end.frame - begin.frame

    def ran(before: Threads, after: Threads) -> list[float]:
        return [(time - before.get(thread, 0.0)) / frames for thread, time in after.items()]

    members = [ran(before, after) for before, after in zip(begin.members, end.members, strict=True)]
    return Rates(frames, frames / (end.time - begin.time),
                 {name: sum(ran(begin.daemons[name], threads)) for name, threads in end.daemons.items()},
                 sum(threads[0] for threads in members) / len(members),
                 sum(sum(threads[1:]) for threads in members) / len(members))
