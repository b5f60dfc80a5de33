# SPDX-License-Identifier: MIT
"""Runs piglit's tests, several at a time: on a wall, or on plain Mesa."""
from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from results import Result, read_result
from suite import HOME, Test
from wall import Wall
from xserver import XServer

FORGET_LIMIT = 10.0  # seconds until a wall must have forgotten programs that have ended
MOST_MEMORY = 6 << 10  # MiB that a daemon may use; a leak must not take the machine along
MOST_OUTPUT = 20_000  # characters kept of one test


class Player:
    """One way to run tests. Any thread."""

    def __init__(self, environment: dict[str, str], timeout: float):
        self._environment = dict(environment, PIGLIT_PLATFORM="glx", PIGLIT_SOURCE_DIR=str(HOME), vblank_mode="0")
        self._timeout = timeout

    def command(self, test: Test) -> list[str]:
        return list(test.command)

    def play(self, test: Test) -> Result:
        """A test in a session of its own; one that hangs ends with all that it has started."""
        start = time.monotonic()
        process = subprocess.Popen(self.command(test), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT,
                                   env=self._environment, cwd=HOME, start_new_session=True, text=True, errors="replace")
        try:
            output, _ = process.communicate(timeout=self._timeout)
            exit_code = process.returncode
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)  # not waited for yet: the number is still its own
            output, _ = process.communicate()
            exit_code = None
        result = read_result(output, exit_code, round(time.monotonic() - start, 2))
        return Result(result.status, result.subtests, result.output[-MOST_OUTPUT:], result.seconds)


class MesaPlayer(Player):
    """The X server's own OpenGL, Mesa's llvmpipe: the golden tests' reference, with as many threads as a node here.
    Told so it offers the version of OpenGL ES that the wall does."""

    def __init__(self, x: XServer, timeout: float, es: tuple[int, int]):
        environment = x.environment(LIBGL_ALWAYS_SOFTWARE="1", LP_NUM_THREADS="0",
                                    MESA_GLES_VERSION_OVERRIDE=f"{es[0]}.{es[1]}")
        for name in ("__GLX_VENDOR_LIBRARY_NAME", "__EGL_VENDOR_LIBRARY_FILENAMES"):
            environment.pop(name, None)
        super().__init__(environment, timeout)


class WallPlayer(Player):
    def __init__(self, x: XServer, wall: Wall, timeout: float):
        super().__init__(x.environment(WALLGL_LOG="warn"), timeout)
        self._wall = wall

    def command(self, test: Test) -> list[str]:
        return self._wall.wallrun(*test.command)

    def trouble(self) -> list[str]:
        """Why it makes no sense to go on: a daemon has ended, or uses far too much memory."""
        return [told for name, daemon in self._wall.daemons.items() if (told := self._trouble_of(name, daemon))]

    def _trouble_of(self, name: str, daemon: subprocess.Popen) -> str:
        if daemon.poll() is not None:
            return f"{name} ended with {daemon.returncode}:\n" + "\n".join(self._wall.log(name).splitlines()[-12:])
        used = memory_of(daemon.pid)
        return f"{name} uses {used} MiB" if used > MOST_MEMORY else ""

    def aftermath(self) -> list[str]:
        """What is wrong with the wall after the tests: a daemon in trouble, a session that nobody has any more."""
        if trouble := self.trouble():
            return trouble
        end = time.monotonic() + FORGET_LIMIT
        while (left := self._wall.sessions()) and time.monotonic() < end:
            time.sleep(0.1)
        return [f"session {session['id']} of process {session['pid']} is left" for session in left] + \
               [f"node {node['name']} is not up" for node in self._wall.nodes() if not node["up"]]


def memory_of(pid: int) -> int:
    """MiB in use; 0 if it has just ended."""
    try:
        status = Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return 0
    found = re.search(r"^VmRSS:\s+(\d+) kB", status, re.MULTILINE)
    return int(found[1]) >> 10 if found else 0


def play_all(player: Player, tests: Iterable[Test], jobs: int) -> Iterator[tuple[Test, Result]]:
    """In the tests' order."""
    listed = list(tests)
    with ThreadPoolExecutor(jobs) as pool:
        futures = [(test, pool.submit(player.play, test)) for test in listed]
        try:
            for test, future in futures:
                yield test, future.result()
        finally:
            for _, future in futures:
                future.cancel()
