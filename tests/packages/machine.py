# SPDX-License-Identifier: MIT
"""Machines that run Debian 12 with systemd as on real hardware: containers of systemd-nspawn, each on a network of its
own (tests/support/hosts.py) and over a root that it does not change. What it writes lies in a folder beside, so that
one can look at what has become of the machine.

    with Hosts("walld", "left") as hosts, Machine("walld", root, folder, hosts) as walld:
        walld.run("systemctl enable --now walld")
        print(walld.changed())

Needs root, systemd-container, and an overlay file system in the kernel.
"""
from __future__ import annotations

import os
import shlex
import signal
import subprocess
import time
from pathlib import Path
from typing import Iterator

from hosts import Hosts

BOOT_LIMIT, STOP_LIMIT = 60.0, 30.0  # seconds
CGROUPS = Path("/sys/fs/cgroup")
ENVIRONMENT = {"PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root",
               "LANG": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive"}


class MachineError(RuntimeError):
    pass


class Machine:
    """`name`: of a host of `hosts`. `root`: a Debian system with systemd; `folder`: for what the machine writes, made
    and left. `shared` is a folder that the machine sees as /srv/shared."""

    def __init__(self, name: str, root: Path, folder: Path, hosts: Hosts, shared: Path):
        self.name, self.root, self.folder, self.hosts, self.shared = name, root, folder, hosts, shared
        self.upper, self._merged = folder / "written", folder / "root"
        self._init = 0

    # ---- life ----

    def __enter__(self) -> "Machine":
        for path in (self.upper, self.folder / "work", self._merged):
            path.mkdir(parents=True)
        layers = f"lowerdir={self.root},upperdir={self.upper},workdir={self.folder / 'work'}"
        _run("mount", "-t", "overlay", "overlay", "-o", layers, self._merged)
        try:
            self._boot()
        except BaseException:
            self.__exit__()
            raise
        return self

    def _boot(self) -> None:
        command = ["systemd-nspawn", "--quiet", "--boot", f"--directory={self._merged}", f"--machine={self.name}",
                   "--register=no", "--keep-unit", "--console=pipe", f"--bind={self.shared}:/srv/shared",
                   f"--network-namespace-path=/run/netns/{self.hosts.namespace(self.name)}"]
        with open(self.folder / "console.log", "wb") as log:
            self._process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                             preexec_fn=self._move_to_cgroups, start_new_session=True)
        end = time.monotonic() + BOOT_LIMIT
        while not self._is_up():
            if self._process.poll() is not None or time.monotonic() > end:
                raise MachineError(f"{self.name} does not boot:\n" + (self.folder / "console.log").read_text()[-4000:])
            time.sleep(0.1)

    def _is_up(self) -> bool:
        children = Path(f"/proc/{self._process.pid}/task/{self._process.pid}/children").read_text().split()
        if not children:
            return False
        self._init = int(children[0])
        return self.ask("systemctl is-system-running").stdout.strip() in ("running", "degraded")

    def _move_to_cgroups(self) -> None:
        """Its systemd shall find a cgroup that is its own alone."""
        for path in self._cgroups():
            path.mkdir(exist_ok=True)
            (path / "cgroup.procs").write_text(str(os.getpid()))

    def _cgroups(self) -> Iterator[Path]:
        parents = [CGROUPS] if (CGROUPS / "cgroup.procs").exists() else [CGROUPS / "systemd", CGROUPS / "unified"]
        return (parent / f"wallgl-test-{self.name}" for parent in parents if parent.exists())

    def __exit__(self, *_) -> None:
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGTERM)  # systemd-nspawn shuts the machine down
            try:
                self._process.wait(STOP_LIMIT)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        _run("umount", "--lazy", self._merged)
        for path in self._cgroups():
            for each in sorted((p for p in path.rglob("*") if p.is_dir()), reverse=True):
                each.rmdir()
            if path.exists():
                path.rmdir()

    # ---- commands ----

    def line(self, command: str, user: str = "root") -> list[str]:
        """The command line that has its shell run a command."""
        environment = [f"{name}={value}" for name, value in ENVIRONMENT.items()]
        return ["nsenter", f"--target={self._init}", "--all", "env", "--ignore-environment", *environment, "setpriv",
                f"--reuid={user}", f"--regid={user}", "--init-groups", "bash", "-c", command]

    def ask(self, command: str, user: str = "root", timeout: float = 120.0) -> subprocess.CompletedProcess:
        return subprocess.run(self.line(command, user), stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=timeout)

    def run(self, command: str, user: str = "root", timeout: float = 120.0) -> str:
        """What it prints; an exit code other than 0 is an error."""
        done = self.ask(command, user, timeout)
        if done.returncode != 0:
            raise MachineError(f"{self.name}: {command}: exit code {done.returncode}\n{done.stdout}{done.stderr}"
                               f"{self.journal() if 'systemctl' in command else ''}")
        return done.stdout

    def popen(self, command: str, user: str = "root", **popen) -> subprocess.Popen:
        return subprocess.Popen(self.line(command, user), stdin=subprocess.DEVNULL, start_new_session=True, **popen)

    def write(self, path: str, text: str) -> None:
        self.run(f"printf %s {shlex.quote(text)} > {shlex.quote(path)}")

    def journal(self) -> str:
        return self.ask("journalctl --no-pager --boot --lines 60").stdout

    def changed(self) -> set[str]:
        """The files that are not as in the root: written, made or (a device of the number 0) removed."""
        return {"/" + str(path.relative_to(self.upper)) for path in self.upper.rglob("*")
                if path.is_symlink() or not path.is_dir()}


def _run(*command: object) -> None:
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if done.returncode != 0:
        raise MachineError(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
