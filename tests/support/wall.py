# SPDX-License-Identifier: MIT
"""A whole wall on this machine for tests and the demo: walld and one tileserver per tile, on Unix sockets in a folder
of its own, so that any number of walls may run side by side.

    with XServer() as x, Wall(tiles=(2, 2), tile_size=(512, 384)) as wall:
        app = wall.run("glxgears", env=x.environment())
        session = wall.wait_session(app)
        wall.wait(session, frame=10)
        png = wall.screenshot()
"""
from __future__ import annotations

import ctypes
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

os.environ.setdefault("WALLGL_CACHE", "off")  # what a program asks nodes is the same in each run

REPOSITORY = Path(__file__).resolve().parents[2]
START_LIMIT = 30.0  # seconds until everything answers; a software renderer compiles its shaders first
STOP_LIMIT = 5.0  # seconds for an orderly end, then SIGKILL
PR_SET_PDEATHSIG = 1
CRASHES = {signal.SIGSEGV, signal.SIGBUS, signal.SIGILL, signal.SIGFPE, signal.SIGABRT}


class WallError(RuntimeError):
    pass


def build_folder() -> Path:
    return Path(os.environ.get("WALLGL_BUILD", REPOSITORY / "build" / "release"))


def _die_with_parent() -> None:
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


def _quoted(text: object) -> str:
    return json.dumps(str(text))  # a TOML basic string, for what we put into it


class Wall:
    """`tiles` are columns and rows, `tile_size` is in pixels. `environment` goes to the daemons, `die_with_parent` ends
    them with the *thread* that starts the wall. `options` and `people` are lines for wall.toml. `windows` is an X
    display on which the tiles are windows, beside each other as on the wall. `tile_keys` are further lines of each tile
    in wall.toml, `triangle_order` is that of each node. `one_node` puts all tiles on one tileserver, which draws with
    `gpus` GPUs if that is not 0.
    `client_build` is where wallrun and the vendor library come from, if not from `build` (a sanitizer's library does
    not load into a foreign program)."""

    def __init__(self, tiles: tuple[int, int] = (2, 2), tile_size: tuple[int, int] = (512, 384), backend: str = "egl",
                 *, http: str = "127.0.0.1:0", swap_timeout_ms: int = 250, one_node: bool = False, gpus: int = 0,
                 name: str = "test", options: str = "", people: str = "", windows: str = "", tile_keys: str = "",
                 triangle_order: str = "", build: Path | None = None, client_build: Path | None = None,
                 environment: dict[str, str] | None = None,
                 die_with_parent: bool = False):
        self.tiles, self.tile_size, self.backend = tiles, tile_size, backend
        self.http, self.swap_timeout_ms, self.name = http, swap_timeout_ms, name
        self.one_node, self.gpus, self.triangle_order = one_node, gpus, triangle_order
        self.options, self.people, self.windows, self.tile_keys = options, people, windows, tile_keys
        self.bin = (build or build_folder()) / "bin"
        self.client_bin = (client_build or build or build_folder()) / "bin"
        self._environment = dict(os.environ, **(environment or {}))
        self._before_exec = _die_with_parent if die_with_parent else None
        self.daemons: dict[str, subprocess.Popen] = {}  # "walld" and the nodes' names
        self.apps: list[subprocess.Popen] = []
        self.folder = Path()
        self.crashed = ""  # what daemons said last that had ended with one of CRASHES; known when the wall has stopped
        self.url = ""  # of the status page
        self.address = ""  # of walld, as --walld and WALLGL_WALLD take it

    # ---- life ----

    def __enter__(self) -> "Wall":
        self.folder = Path(tempfile.mkdtemp(prefix="wallgl-"))
        try:
            self._start()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, kind: object, *_) -> None:
        """A wall on which a daemon crashed has not passed, whatever it showed."""
        self.stop()
        if self.crashed and kind is None:
            raise WallError(self.crashed)
        print(self.crashed, end="", file=sys.stderr)

    @property
    def size(self) -> tuple[int, int]:
        return self.tiles[0] * self.tile_size[0], self.tiles[1] * self.tile_size[1]

    @property
    def node_names(self) -> list[str]:
        if self.one_node:
            return ["node"]
        return [f"node-{column}-{row}" for row in range(self.tiles[1]) for column in range(self.tiles[0])]

    @property
    def tile_names(self) -> list[str]:
        return [f"{column}-{row}" for row in range(self.tiles[1]) for column in range(self.tiles[0])]

    def _tile(self, name: str) -> str:
        column, row = map(int, name.split("-"))
        width, height = self.tile_size
        x, y = column * width, row * height
        return f"[[node.tile]]\nname = {_quoted(name)}\nrect = [{x}, {y}, {width}, {height}]\n" + (
            self._output(x, y) + f"{self.tile_keys}\n")

    def _output(self, x: int, y: int) -> str:
        return f'output = "window"\ndisplay = {_quoted(self.windows)}\nposition = [{x}, {y}]\n' if self.windows else ""

    def _node(self, name: str, tiles: list[str]) -> str:
        return (f"[[node]]\nname = {_quoted(name)}\nbackend = {_quoted(self.backend)}\n"
                f"listen = {_quoted(f'unix:{self.folder}/{name}.sock')}\n"
                + (f"triangle_order = {_quoted(self.triangle_order)}\n" if self.triangle_order else "")
                + (f"gpus = {self.gpus}\n" if self.gpus else "") + "".join(map(self._tile, tiles)))

    def _description(self) -> str:
        nodes = [(self.node_names[0], self.tile_names)] if self.one_node else [(n, [n[len("node-"):]])
                                                                               for n in self.node_names]
        return self._but_nodes() + "".join(self._node(*node) for node in nodes)

    def _but_nodes(self) -> str:
        return (f"[wall]\nname = {_quoted(self.name)}\nswap_timeout_ms = {self.swap_timeout_ms}\n"
                f"state_directory = {_quoted(self.folder / 'state')}\n{self.options}\n"
                f"[people]\n{self.people}\n"
                f"[control]\nlisten = [{_quoted(f'unix:{self.folder}/walld.sock')}]\n"
                f"[http]\nlisten = {_quoted(self.http)}\n")

    def _start(self) -> None:
        (self.folder / "wall.toml").write_text(self._description())
        self.address = f"unix:{self.folder}/walld.sock"
        self.start_walld()
        for name in self.node_names:
            self.start_node(name)
        self.wait_nodes()

    def start_walld(self) -> None:
        """Until it answers. Its HTTP port may be another one than before."""
        (self.folder / "ready").unlink(missing_ok=True)
        self._start_daemon("walld", "walld", "--config", self.folder / "wall.toml", "--ready-file",
                           self.folder / "ready")
        self._until(lambda: (self.folder / "ready").exists(), "walld does not get ready", "walld")
        self.url = json.loads((self.folder / "ready").read_text())["http"]

    def start_node(self, name: str) -> subprocess.Popen:
        return self._start_daemon(name, "tileserver", "--config", self.folder / "wall.toml", "--node", name)

    def restart_walld(self, pause: float = 0) -> None:
        """Killed, and after `pause` seconds another one on the same addresses (but for HTTP)."""
        self.restart_walld_only(pause)
        self.wait_nodes()

    def restart_walld_only(self, pause: float = 0) -> None:
        """The same without waiting for nodes."""
        self.daemons["walld"].kill()
        self.daemons["walld"].wait()
        time.sleep(pause)
        (self.folder / "ready").unlink()
        self.start_walld()

    def wait_nodes(self) -> None:
        """Until all nodes are up."""
        self._until(lambda: all(node["up"] for node in self.nodes()), "not all nodes came up", *self.node_names)

    def _start_daemon(self, name: str, program: str, *arguments: object) -> subprocess.Popen:
        if not (self.bin / program).exists():
            raise WallError(f"{self.bin / program} is missing: build it first (cmake --preset release && cmake --build "
                            f"--preset release)")
        with open(self.folder / f"{name}.log", "ab") as log:
            self.daemons[name] = subprocess.Popen(
                [self.bin / program, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                env=self._environment, start_new_session=True, preexec_fn=self._before_exec)
        return self.daemons[name]

    def _until(self, done, what: str, *needed: str, limit: float = START_LIMIT) -> None:
        end = time.monotonic() + limit
        while not done():
            ended = [name for name in needed if self.daemons[name].poll() is not None]
            if ended or time.monotonic() > end:
                logs = "\n".join(f"--- {name}:\n{self.log(name)}" for name in ended or needed)
                raise WallError(f"{what}: {', '.join(ended) + ' ended' if ended else f'{limit:.0f} seconds are over'}\n"
                                f"{logs}")
            time.sleep(0.02)

    def log(self, name: str) -> str:
        """What a daemon has said so far."""
        path = self.folder / f"{name}.log"
        return path.read_text(errors="replace") if path.exists() else ""

    def stop(self) -> dict[str, int]:
        """Ends the programs, then the nodes, then walld; gives the daemons' exit codes. May be called again."""
        end_all(self.apps)
        nodes = {name: daemon for name, daemon in self.daemons.items() if name != "walld"}
        end_all(nodes.values())
        if "walld" in self.daemons:
            end_all([self.daemons["walld"]])
        codes = {name: daemon.returncode for name, daemon in self.daemons.items()}
        self.crashed += "".join(f"--- {name} crashed ({signal.Signals(-code).name}):\n{self.log(name)[-4000:]}"
                                for name, code in codes.items() if -code in CRASHES)
        if self.folder != Path():
            shutil.rmtree(self.folder, ignore_errors=True)
        self.daemons, self.apps = {}, []
        return codes

    # ---- programs ----

    def wallrun(self, *command: object, rect: tuple[int, int, int, int] | None = None, fullscreen: bool = False,
                name: str = "", hold: bool = False, parallel: int = 0, stereo: str = "",
                camera: str = "", sort_last: bool = False) -> list[str]:
        """The command line that starts a program on this wall."""
        line = [self.client_bin / "wallrun", "--walld", self.address]
        line += ["--rect", ",".join(map(str, rect))] if rect else []
        line += ["--fullscreen"] if fullscreen else []
        line += ["--name", name] if name else []
        line += ["--hold"] if hold else []
        line += ["--stereo", stereo] if stereo else []
        line += ["--camera", camera] if camera else []
        line += ["--parallel", parallel] if parallel else []
        line += ["--sort-last"] if sort_last else []
        return [str(word) for word in (*line, "--", *command)]

    def run(self, *command: object, rect: tuple[int, int, int, int] | None = None, fullscreen: bool = False,
            name: str = "", hold: bool = False, parallel: int = 0, env: dict[str, str] | None = None,
            **popen) -> subprocess.Popen:
        """Starts a program on the wall. Its process id is that of the session (wallrun becomes the program), but for
        one of several processes."""
        return self.run_line(self.wallrun(*command, rect=rect, fullscreen=fullscreen, name=name, hold=hold,
                                          parallel=parallel), env=env, **popen)

    def run_line(self, line: list[str], *, env: dict[str, str] | None = None, **popen) -> subprocess.Popen:
        """The same with a command line of wallrun()."""
        app = subprocess.Popen(line, env=env or self._environment, start_new_session=True, preexec_fn=self._before_exec,
                               **{"stdin": subprocess.DEVNULL, **popen})
        self.apps.append(app)
        return app

    # ---- operating ----

    def ctl(self, *arguments: object, timeout: float = 60.0):
        """wallctl; gives its JSON (None if there is none)."""
        done = subprocess.run([self.bin / "wallctl", "--walld", self.address, "--json", *map(str, arguments)],
                              capture_output=True, text=True, timeout=timeout)
        if done.returncode != 0:
            raise WallError(f"wallctl {' '.join(map(str, arguments))}: {done.stderr.strip()}")
        return json.loads(done.stdout) if done.stdout.strip() else None

    def rest(self, method: str, path: str, body: object = None, *,
             headers: dict[str, str] | None = None) -> tuple[int, object]:
        """A request to the HTTP API; gives the status and the JSON (or text) of the answer."""
        data = None if method == "GET" else json.dumps({} if body is None else body).encode()
        request = urllib.request.Request(self.url.rstrip("/") + path, data=data, method=method,
                                         headers={"Content-Type": "application/json", **(headers or {})})
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                status, text = answer.status, answer.read().decode(errors="replace")
        except urllib.error.HTTPError as error:
            status, text = error.code, error.read().decode()
        try:
            return status, json.loads(text)
        except ValueError:
            return status, text

    def status(self) -> dict:
        return self.ctl("status")

    def nodes(self) -> list[dict]:
        return self.ctl("nodes")

    def sessions(self) -> list[dict]:
        return self.ctl("sessions")

    def wait_session(self, app: subprocess.Popen | None = None, limit: float = 20.0) -> int:
        """The number of a program's session (of any, without one) once it has a window."""
        end = time.monotonic() + limit
        while time.monotonic() < end:
            for session in self.sessions():
                if session["surfaces"] and (app is None or session["pid"] == app.pid):
                    return session["id"]
            if app is not None and app.poll() is not None:
                raise WallError(f"{app.args}: ended with {app.returncode} before it had a window on the wall")
            time.sleep(0.02)
        raise WallError(f"no window appeared within {limit:.0f} seconds")

    def step(self, session: object, frames: int = 1) -> None:
        self.ctl("step", session, frames)

    def hold(self, session: object, on: bool = True) -> None:
        self.ctl("hold", session, *([] if on else ["--off"]))

    def wait(self, session: object, frame: int, limit: float = 20.0) -> int:
        """Until the frame is shown on all tiles; gives the number of the last one shown."""
        return self.ctl("wait", session, "--frame", frame, "--timeout", limit, timeout=limit + 10)["frame"]

    def screenshot(self, path: Path | str | None = None, tile: str = "", session: object = None,
                   output: bool = False) -> bytes:
        """PNG of the wall, of one tile (or what its output shows), or of one program's window alone; also written to
        `path`."""
        target = Path(path) if path else self.folder / f"screenshot-{time.monotonic_ns()}.png"
        options = (["--tile", tile] if tile else []) + (["--session", session] if session is not None else [])
        options += ["--output"] if output else []
        self.ctl("screenshot", target, *options)
        return target.read_bytes()


def end_all(processes) -> None:
    """SIGTERM to all, then SIGKILL to what has not ended in time. Each was started in a session of its own."""
    running = [process for process in processes if process.poll() is None]
    for process in running:
        _signal_group(process, signal.SIGTERM)
    end = time.monotonic() + STOP_LIMIT
    for process in running:
        try:
            process.wait(max(0.0, end - time.monotonic()))
        except subprocess.TimeoutExpired:
            _signal_group(process, signal.SIGKILL)
            process.wait()


def _signal_group(process: subprocess.Popen, number: int) -> None:
    try:
        os.killpg(process.pid, number)
    except ProcessLookupError:
        pass
