#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Faults, one after the other and chosen by chance, on a wall of several machines (tests/support/hosts.py) on which
four programs run, one of them parallel: daemons are killed and stopped, links cut and slowed, tiles change their nodes,
nodes are drained and revoked. Soon after each fault the wall shows what a wall shows to which nothing has happened
(DESIGN, section 1), and all programs are there.

faults.py [--count N | --for SECONDS] [--seed N] [--limit SECONDS] [--only FAULT]... [--pictures FOLDER]"""
from __future__ import annotations

import argparse
import functools
import itertools
import json
import os
import random
import signal
import sys
import time
from pathlib import Path
from typing import Callable

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import cv2  # noqa: E402
import numpy  # noqa: E402
from compare import same  # noqa: E402
from machine_wall import WALLD, MachineWall  # noqa: E402
from show import SETTLED, OneMachine, Part, Show  # noqa: E402
from wall import Wall, WallError, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

TILES, TILE = (3, 2), (200, 150)
CLIENT = "desk"
PARTS = (Part("drawn_once", (0, 0, 600, 100), still=True), Part("frame_clock", (0, 100, 600, 100)),
         Part("frame_clock", (0, 200, 300, 100), arguments=("--egl", "--vertices", "3000")),
         Part("march", (300, 200, 300, 100), ranks=2, arguments=("--cells", "8")))
QUIET = {"LP_NUM_THREADS": "0"}
FPS = 10
BACK = 30.0  # seconds until what was broken is whole again, and the next fault may come
RATES = ("20mbit", "100mbit")
MORE_DESCRIPTORS = 16  # of a daemon at the end than at the beginning: what is just coming and going


class ChangingWall(MachineWall):
    """Whose columns change their nodes."""

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self.columns = list(range(self.tiles[0]))  # by node

    def _tile(self, name: str) -> str:
        column, row = map(int, name.split("-"))
        return super()._tile(f"{self.columns[column]}-{row}")

    def reload(self, columns: list[int]) -> None:
        self.columns = columns
        (self.folder / "wall.toml").write_text(self._description())
        self.ctl("reload")


class Faults:
    """Each is over when its function returns, and what it needs to be mended is mended."""

    def __init__(self, wall: ChangingWall, chance: random.Random):
        self.wall, self.chance = wall, chance

    def names(self) -> list[str]:
        return [name for name in vars(Faults) if not name.startswith("_") and name != "names"]

    def _some_nodes(self) -> list[str]:
        return self.chance.sample(self.wall.node_names, self.chance.randint(1, len(self.wall.node_names) - 1))

    def _host(self) -> str:
        return self.chance.choice([WALLD, CLIENT, *self.wall.node_names])

    def _pause(self, most: float) -> float:
        return self.chance.uniform(0.0, most)

    def kill_nodes(self) -> str:
        names = self._some_nodes()
        for name in names:
            self.wall.kill_node(name)
        time.sleep(self._pause(1.0))
        for name in names:
            self.wall.start_node(name)
        return " ".join(names)

    def _stop(self, name: str, seconds: float) -> str:
        daemon = self.wall.daemons[name]
        daemon.send_signal(signal.SIGSTOP)
        time.sleep(seconds)
        daemon.send_signal(signal.SIGCONT)
        return f"{name} for {seconds:.1f} s"

    def stop_node(self) -> str:
        return self._stop(self.chance.choice(self.wall.node_names), self._pause(4.0))

    def stop_walld(self) -> str:
        return self._stop(WALLD, self._pause(4.0))

    def stop_agent(self) -> str:
        return self._stop(CLIENT, self._pause(2.0))

    def kill_walld(self) -> str:
        pause = self._pause(1.0)
        self.wall.restart_walld_only(pause)
        return f"for {pause:.1f} s"

    def kill_agent(self) -> str:
        agent = self.wall.daemons[CLIENT]
        agent.kill()
        agent.wait()
        time.sleep(self._pause(1.0))
        self.wall.start_agent(CLIENT)
        return ""

    def cut_link(self) -> str:
        host, seconds = self._host(), self._pause(5.0)
        self.wall.hosts.cut(host)
        time.sleep(seconds)
        self.wall.hosts.mend(host)
        return f"{host} for {seconds:.1f} s"

    def slow_link(self) -> str:
        host, rate, seconds = self._host(), self.chance.choice(RATES), self._pause(3.0)
        self.wall.hosts.limit(host, rate)
        time.sleep(seconds)
        self.wall.hosts.unlimit(host)
        return f"{host} to {rate} for {seconds:.1f} s"

    def reload(self) -> str:
        columns = list(self.wall.columns)  # of two nodes: if all began anew, none would have what programs have drawn
        one, other = self.chance.sample(range(TILES[0]), 2)
        columns[one], columns[other] = columns[other], columns[one]
        self.wall.reload(columns)
        return "columns " + " ".join(map(str, columns))

    def drain_node(self) -> str:
        name = self.chance.choice(self.wall.node_names)
        self.wall.ctl("node", "drain", name)
        time.sleep(self._pause(2.0))
        self.wall.ctl("node", "undrain", name)
        return name

    def revoke_node(self) -> str:
        name = self.chance.choice(self.wall.node_names)
        self.wall.revoke("node", name)
        time.sleep(self._pause(1.0))
        end_all([self.wall.daemons[name]])
        self.wall.start_node(name, self.wall.invite("node", name))
        return name


class Trial:
    def __init__(self, wall: ChangingWall, one: OneMachine, show: Show, chance: random.Random, limit: float,
                 pictures: Path | None):
        self.wall, self.one, self.show = wall, one, show
        self.limit, self.pictures = limit, pictures
        self.faults = Faults(wall, chance)
        self.chance = chance
        self.before = self._descriptors()

    def one_fault(self, name: str) -> tuple[str, float, bool]:
        """What was done, how long it took from its end until the wall was right, and whether that was too long."""
        said = getattr(self.faults, name)()
        try:
            return said, *self._until_right(time.monotonic())
        except (AssertionError, WallError) as error:
            raise AssertionError(f"{name} {said}: {error}") from error

    def _all_back(self) -> bool:
        return self.show.sessions <= {s["id"] for s in self.wall.sessions() if s["surfaces"]}

    def _until_right(self, begin: float) -> tuple[float, bool]:
        """With frames to come: they go on meanwhile. Gives from when on the wall was right, and whether it is late.
        Pictures are taken first, the last at the limit, and compared afterwards, while all programs are held: the
        other wall has to draw up to their frames, which takes longer than what is measured here."""
        late = False
        while True:
            taken = []
            while not taken or taken[-1][0] < self.limit:
                if time.monotonic() > begin + BACK:
                    raise AssertionError(f"not all sessions are there: {sorted(self.show.sessions)} are expected")
                if taken:
                    self.show.go_on()
                time.sleep(SETTLED)
                if (sample := self._sample(begin)) is not None:
                    taken.append(sample)
                    status = self.wall.status()
            verdicts = [same(self.one.picture(frames), picture) for _, frames, picture in taken]
            self.show.go_on()
            if verdicts[-1].good:
                wrong = max((i for i, verdict in enumerate(verdicts) if not verdict.good), default=-1)
                return taken[wrong + 1][0], late
            if not late and self.pictures:
                self._write(taken[-1], status)
            late = True
            if time.monotonic() > begin + BACK:
                raise AssertionError(f"frames {taken[-1][1]}: {verdicts[-1]}")

    def _write(self, taken: tuple[float, list[int], numpy.ndarray], status: dict) -> None:
        """What the wall shows when it is late, and beside it what it should; what walld knew then, and what all daemons
        have said."""
        at = time.strftime("%H%M%S")
        (self.pictures / f"{at}-status.json").write_text(json.dumps(status, indent=1))
        cv2.imwrite(str(self.pictures / f"{at}-shown.png"), taken[2])
        cv2.imwrite(str(self.pictures / f"{at}-expected.png"), self.one.picture(taken[1]))
        for daemon in self.wall.daemons:
            (self.pictures / f"{at}-{daemon}.log").write_text(self.wall.log(daemon))

    def _sample(self, begin: float) -> tuple[float, list[int], numpy.ndarray] | None:
        """When it was held, at which frames, and what the wall shows then; it is held then. None: not all are on the
        wall."""
        for playing in self.show.playing:
            if playing.app.poll() is not None:
                raise AssertionError(f"{playing.part.program} has ended with {playing.app.returncode}")
        if not self._all_back():
            return None
        try:
            self.show.hold()
        except WallError:  # one that was seen on a link that is no more comes on another one now
            self.show.go_on()
            return None
        took = time.monotonic() - begin
        return took, self.show.frames, self.show.picture()

    def _descriptors(self) -> dict[str, int]:
        return {name: len(os.listdir(f"/proc/{daemon.pid}/fd")) for name, daemon in self.wall.daemons.items()}

    def leaks(self) -> list[str]:
        return [f"{name} has {count} descriptors, at the beginning {self.before[name]}"
                for name, count in self._descriptors().items() if count > self.before[name] + MORE_DESCRIPTORS]


def run(count: int | None, seconds: float, seed: int, limit: float, only: list[str], pictures: Path | None,
        say: Callable[[str], None]) -> int:
    chance = random.Random(seed)
    slow, times = 0, []
    with XServer() as x, ChangingWall(TILES, TILE, clients=[CLIENT], environment=QUIET) as wall, \
            Wall(TILES, TILE, one_node=True, environment=QUIET, die_with_parent=True) as still:
        one = OneMachine(still, x, PARTS)
        show = Show(wall, functools.partial(wall.run_at, CLIENT), x, FPS, PARTS)
        show.go_on()
        trial = Trial(wall, one, show, chance, limit, pictures)
        names = only or trial.faults.names()
        end = time.monotonic() + seconds
        for number in itertools.count(1):
            if number > count if count is not None else time.monotonic() > end:
                break
            name = chance.choice(names)
            try:
                said, took, late = trial.one_fault(name)
            except (AssertionError, WallError) as error:
                say(f"{number}: FAILED {error}")
                for daemon in wall.daemons:
                    say(f"--- {daemon}:\n{wall.log(daemon)[-4000:]}")
                return 1
            times.append(took)
            slow += late
            say(f"{number}: {name} {said}: right after {took:.1f} s{'  TOO LATE' if late else ''}")
        leaks = trial.leaks()
        for leak in leaks:
            say(f"FAILED {leak}")
    times.sort()
    say(f"{len(times)} faults, seed {seed}: right after {times[len(times) // 2]:.1f} s (median), "
        f"{times[-1]:.1f} s at most; {slow} later than {limit:.0f} s; no program was lost")
    return 1 if slow or leaks else 0


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    length = arguments.add_mutually_exclusive_group()
    length.add_argument("--count", type=int, help="of faults (300)")
    length.add_argument("--for", dest="seconds", type=float, default=0.0, help="as many as there are in that time")
    arguments.add_argument("--seed", type=int, default=int(time.time()), help="of chance; printed")
    arguments.add_argument("--limit", type=float, default=2.0, help="seconds from a fault's end until all is right")
    arguments.add_argument("--only", action="append", default=[], help="this kind of fault; may be given again")
    arguments.add_argument("--pictures", type=Path, help="a folder for what is shown and should be, and logs")
    options = arguments.parse_args()
    if options.pictures:
        options.pictures.mkdir(parents=True, exist_ok=True)
    count = None if options.seconds else options.count or 300
    return run(count, options.seconds, options.seed, options.limit, options.only, options.pictures,
               functools.partial(print, flush=True))


if __name__ == "__main__":
    sys.exit(main())
