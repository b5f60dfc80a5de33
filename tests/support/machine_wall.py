# SPDX-License-Identifier: MIT
"""A wall of several machines for tests: walld, a node for each column of tiles and client hosts, each on a host of its
own (hosts.py), joined with the lines that wallctl prints. walld's Unix socket is a file, so that the tests operate the
wall from here, as on walld's machine.

    with XServer() as x, MachineWall(tiles=(3, 2), clients=["desk"]) as wall:
        app = wall.run_at("desk", "glxgears", env=x.environment())
        wall.wait(wall.wait_session(app), frame=10)
"""
from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Sequence

from hosts import Hosts
from wall import Wall, WallError, end_all

WALLD = "walld"  # its host, and what Wall.daemons calls it
CONTROL_PORT, DATA_PORT = 7770, 7790


class MachineWall(Wall):
    """`clients` have joined; `guests` are hosts that have not, for join_client(). `gpus` are how many a node draws
    with, if several; `node_keys` stand in each [[node]]. `workers` are further nodes, without tiles, and what stands in
    each of theirs. Options that are not here are those of Wall. All ends with the thread that starts it."""

    def __init__(self, tiles: tuple[int, int] = (3, 2), tile_size: tuple[int, int] = (200, 150), *,
                 clients: Sequence[str] = ("desk",), guests: Sequence[str] = (),
                 gpus: dict[str, int] | None = None, node_keys: str = "", workers: dict[str, str] | None = None,
                 **options):
        super().__init__(tiles, tile_size, die_with_parent=True, **options)
        self.clients, self.gpus, self.node_keys, self.workers = clients, gpus or {}, node_keys, workers or {}
        self.hosts = Hosts(WALLD, *self.node_names, *clients, *guests)

    # ---- life ----

    @property
    def node_names(self) -> list[str]:
        """Each is also the name of its host."""
        return [f"node-{column}" for column in range(self.tiles[0])] + list(self.workers)

    def tiles_of(self, node: str) -> list[str]:
        """Those of a column, from the top."""
        return [] if node in self.workers else [f"{node.removeprefix('node-')}-{row}" for row in range(self.tiles[1])]

    def listen_address(self, node: str) -> str:
        """One says where exactly it listens; walld sees where the others are."""
        return f"{self.hosts.address(node) if node == self.node_names[0] else '0.0.0.0'}:{DATA_PORT}"

    def data_port(self, node: str) -> tuple[str, int]:
        return self.hosts.address(node), DATA_PORT

    @property
    def control_port(self) -> tuple[str, int]:
        return self.hosts.address(WALLD), CONTROL_PORT

    def _description(self) -> str:
        quoted = json.dumps
        control = [f"unix:{self.folder}/walld.sock", f"{self.hosts.address(WALLD)}:{CONTROL_PORT}"]
        nodes = "".join(f"[[node]]\nname = {quoted(name)}\nbackend = {quoted(self.backend)}\n"
                        f"listen = {quoted(self.listen_address(name))}\n"
                        + (f"gpus = {self.gpus[name]}\n" if name in self.gpus else "")
                        + self.workers.get(name, self.node_keys) + "\n"
                        + "".join(map(self._tile, self.tiles_of(name))) for name in self.node_names)
        return (f"[wall]\nname = {quoted(self.name)}\nswap_timeout_ms = {self.swap_timeout_ms}\n"
                f"state_directory = {quoted(str(self.state_of(WALLD)))}\n{self.options}\n"
                f"[people]\n{self.people}\n[control]\nlisten = {quoted(control)}\n"
                f"[http]\nlisten = {quoted(self.http)}\n{nodes}")

    def _start(self) -> None:
        self.hosts.__enter__()
        self.state_of(WALLD).mkdir(mode=0o700)
        (self.folder / "wall.toml").write_text(self._description())
        self.address = f"unix:{self.folder}/walld.sock"
        self.start_walld()
        for name in self.node_names:
            self.start_node(name, self.invite("node", name))
        for name in self.clients:
            self.join_client(name)
        self.wait_nodes()

    def stop(self) -> dict[str, int]:
        try:
            return super().stop()
        finally:
            self.hosts.close()

    def state_of(self, name: str) -> Path:
        """The folder in which walld, a node or a client host keeps its key."""
        return self.folder / f"{name}-state"

    def _start_daemon(self, name: str, program: str, *arguments: object) -> subprocess.Popen:
        if not (self.bin / program).exists():
            raise WallError(f"{self.bin / program} is missing: build it first (cmake --preset release && cmake --build "
                            f"--preset release)")
        with open(self.folder / f"{name}.log", "ab") as log:
            self.daemons[name] = self.hosts.popen(name, [self.bin / program, *arguments], stdout=log, stderr=log,
                                                  env=self._environment, preexec_fn=self._before_exec)
        return self.daemons[name]

    # ---- machines ----

    def invite(self, kind: str, name: str, *options: object) -> str:
        """The line with which a machine joins."""
        return self.ctl("join-token", kind, name, *options)["line"]

    def revoke(self, kind: str, name: str) -> None:
        self.ctl(kind, "revoke", name)

    def machines(self) -> list[dict]:
        return self.ctl("machines")

    def start_node(self, name: str, line: str = "") -> subprocess.Popen:
        """With a line it joins; without it is the node that it was before."""
        join = ["--join", line] if line else []
        return self._start_daemon(name, "tileserver", "--state", self.state_of(name), *join)

    def kill_node(self, name: str) -> None:
        self.daemons[name].kill()
        self.daemons[name].wait()

    def agent_address(self, client: str) -> str:
        """Where the programs of a client host find the wall."""
        return f"unix:{self.folder}/{client}.sock"

    def start_agent(self, client: str, line: str = "") -> None:
        """Until programs can come; as for a node."""
        (self.folder / f"{client}.sock").unlink(missing_ok=True)  # of one that was killed
        self._start_daemon(client, "wallagent", "--state", self.state_of(client), "--listen",
                           self.agent_address(client), *(["--join", line] if line else []))
        self._until((self.folder / f"{client}.sock").exists, "wallagent does not listen", client)

    def join_node(self, name: str) -> None:
        """It joins without being started, by the command that is printed for it."""
        command = self.ctl("join-token", "node", name)["command"].partition(" && ")
        if not command[2].endswith(f"tileserver-joined@{name}"):
            raise WallError(f"'{command[2]}': expected the unit of {name}")
        done = self.hosts.run(name, [self.bin / "wallctl", *command[0].split()[1:], "--state", self.state_of(name)])
        if done.returncode != 0:
            raise WallError(f"{command[0]}: {done.stderr}")

    def join_client(self, client: str) -> None:
        self.start_agent(client, self.invite("client", client))

    def remove_client(self, client: str) -> None:
        """It is as if it had never joined."""
        if client in self.daemons:
            end_all([self.daemons.pop(client)])
        if client in [machine["name"] for machine in self.machines() if machine["kind"] == "client"]:
            self.revoke("client", client)
        shutil.rmtree(self.state_of(client), ignore_errors=True)

    def join_in_vain(self, host: str, program: str, line: str) -> str:
        """What `program` says about a line with which it cannot join."""
        folder = self.folder / "in-vain"
        listen = ["--listen", f"unix:{folder}.sock"] if program == "wallagent" else []
        done = self.hosts.run(host, [self.bin / program, "--state", folder, "--join", line, *listen], timeout=15,
                              env=self._environment)
        if done.returncode == 0:
            raise WallError(f"{program} --join {line} ended without an error: {done.stderr}")
        return done.stderr

    # ---- at a client host ----

    def run_at(self, client: str, *command: object, rect: tuple[int, int, int, int] | None = None, hold: bool = False,
               parallel: int = 0, sort_last: bool = False, env: dict[str, str] | None = None,
               **popen) -> subprocess.Popen:
        """Starts a program there, as run() does here."""
        line = [self.client_bin / "wallrun", "--walld", self.agent_address(client)]
        line += ["--rect", ",".join(map(str, rect))] if rect else []
        line += ["--hold"] if hold else []
        line += ["--parallel", str(parallel)] if parallel else []
        line += ["--sort-last"] if sort_last else []
        app = self.hosts.popen(client, [*line, "--", *command], env=env or self._environment,
                               preexec_fn=self._before_exec, **popen)
        self.apps.append(app)
        return app

    def ctl_at(self, client: str, *arguments: object, timeout: float = 20.0, any_exit: bool = False):
        """As ctl(), for somebody there. `any_exit`: what it says is wanted, also where it fails."""
        line = [self.bin / "wallctl", "--walld", self.agent_address(client), "--json", *arguments]
        done = self.hosts.run(client, line, timeout=timeout)
        if done.returncode != 0 and not any_exit:
            raise WallError(f"wallctl {' '.join(map(str, arguments))}: {done.stderr.strip()}")
        return json.loads(done.stdout) if done.stdout.strip() else None
