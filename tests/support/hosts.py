# SPDX-License-Identifier: MIT
"""Several machines on this one: network namespaces that reach each other over a bridge, which is in a namespace of its
own, so that nothing of it is seen in this machine's network. They share files, users, process ids and the sockets that
are files (an X server's /tmp/.X11-unix/X1, walld's `unix:PATH`), not those that are not.

    with Hosts("walld", "desk") as hosts:
        server = hosts.popen("walld", ["walld", "--config", path])
        hosts.run("desk", ["wallctl", "--walld", f"{hosts.address('walld')}:7770", "status"])
        hosts.cut("desk")    # its cable is pulled
        hosts.mend("desk")

Needs root and iproute2. All is gone in the end; what a killed test has left is removed by the next one.
"""
from __future__ import annotations

import concurrent.futures
import ctypes
import os
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path
from typing import Sequence

from wall import end_all

NETWORK = "10.77.0"  # addresses are .1, .2 ... in the order of the hosts' names
BRIDGE = "bridge"  # the name of the namespace with the bridge, which no host may have, and of the bridge in it
PREFIX = "wallgl-"  # of namespaces: wallgl-PID-HOST
NAMESPACES = Path("/run/netns")  # where `ip netns` has them
LINK = "eth0"  # in each host
GONE_LIMIT = 5.0  # seconds until what was killed is gone
LIMIT_BURST = "128kb"  # more than a packet of 64 KiB, which a link without a card may have
LIMIT_LATENCY = "50ms"  # what waits longer for a limited link is thrown away, as a switch does
CLONE_NEWNET = 0x40000000


class HostsError(RuntimeError):
    pass


class Hosts:
    """`names` are short words; each becomes a host."""

    def __init__(self, *names: str):
        if BRIDGE in names or len(set(names)) != len(names):
            raise HostsError(f"names of hosts: {names}: expected different ones, and not '{BRIDGE}'")
        self.names = names
        self.processes: list[subprocess.Popen] = []

    # ---- life ----

    def __enter__(self) -> "Hosts":
        if os.geteuid() != 0:
            raise HostsError("hosts are network namespaces, which only root can make: run this test as root")
        for program in ("ip", "tc"):
            if shutil.which(program) is None:
                raise HostsError(f"'{program}' is missing: install iproute2 (scripts/install-deps.sh)")
        _remove_left_over()
        try:
            self._make()
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(self, *_) -> None:
        self.close()

    def _make(self) -> None:
        hub = self.namespace(BRIDGE)
        _run("ip", "netns", "add", hub)
        _run("ip", "-n", hub, "link", "add", BRIDGE, "type", "bridge")
        _run("ip", "-n", hub, "link", "set", BRIDGE, "up")
        for name in self.names:
            own = self.namespace(name)
            _run("ip", "netns", "add", own)
            _run("ip", "link", "add", LINK, "netns", own, "type", "veth", "peer", "name", self._port(name), "netns",
                 hub)
            _run("ip", "-n", own, "address", "add", f"{self.address(name)}/24", "dev", LINK)
            _run("ip", "-n", own, "link", "set", "lo", "up")
            # With an address of IPv6, which a link gets by itself a second later, Chromium drops what it is loading.
            _run("ip", "-n", own, "link", "set", LINK, "addrgenmode", "none")
            _run("ip", "-n", own, "link", "set", LINK, "up")
            _run("ip", "-n", hub, "link", "set", self._port(name), "master", BRIDGE, "up")

    def close(self) -> None:
        """Ends all processes and removes the hosts; may be called again."""
        end_all(self.processes)
        self.processes = []
        for name in (*self.names, BRIDGE):
            if (NAMESPACES / self.namespace(name)).exists():
                _end_what_is_left(self.namespace(name))
                _run("ip", "netns", "delete", self.namespace(name))

    # ---- names ----

    def namespace(self, name: str) -> str:
        return f"{PREFIX}{os.getpid()}-{name}"

    def address(self, name: str) -> str:
        return f"{NETWORK}.{self.names.index(name) + 1}"

    def _port(self, name: str) -> str:
        """Of the bridge; the kernel allows 15 characters."""
        return f"port{self.names.index(name) + 1}"

    # ---- programs ----

    def line(self, host: str, argv: Sequence[object]) -> list[str]:
        """The command line that runs a command there; its process id is that of the command."""
        return ["ip", "netns", "exec", self.namespace(self._known(host)), *map(str, argv)]

    def popen(self, host: str, argv: Sequence[object], env: dict[str, str] | None = None,
              **popen) -> subprocess.Popen:
        """Starts a command on a host; it is ended with the hosts at the latest."""
        process = subprocess.Popen(self.line(host, argv), env=env,
                                   **{"stdin": subprocess.DEVNULL, "start_new_session": True, **popen})
        self.processes.append(process)
        return process

    def run(self, host: str, argv: Sequence[object], env: dict[str, str] | None = None, timeout: float = 60.0,
            **run) -> subprocess.CompletedProcess:
        """Runs a command on a host to its end; what it printed comes as text."""
        return subprocess.run(self.line(host, argv), env=env, timeout=timeout,
                              **{"stdin": subprocess.DEVNULL, "capture_output": True, "text": True, **run})

    def socket(self, host: str) -> socket.socket:
        """A TCP socket of this process in the host's network."""
        path = NAMESPACES / self.namespace(self._known(host))
        with concurrent.futures.ThreadPoolExecutor(1) as another:  # a thread's network is its own, and ends with it
            return another.submit(_socket_in, path).result()

    def connect(self, host: str, address: tuple[str, int], timeout: float = 10.0) -> socket.socket:
        """A connection of this process as if it came from the host."""
        connected = self.socket(host)
        connected.settimeout(timeout)
        try:
            connected.connect(address)
        except BaseException:
            connected.close()
            raise
        return connected

    # ---- links ----

    def cut(self, host: str) -> None:
        """Nothing gets from it or to it, as if its cable were pulled."""
        self._set_port(host, "down")

    def mend(self, host: str) -> None:
        self._set_port(host, "up")

    def _set_port(self, host: str, state: str) -> None:
        _run("ip", "-n", self.namespace(BRIDGE), "link", "set", self._port(self._known(host)), state)

    def limit(self, host: str, rate: str) -> None:
        """No more than `rate` (of tc: "100mbit") gets from it, and no more to it."""
        for namespace, device in self._ends(host):
            _run("tc", "-n", namespace, "qdisc", "replace", "dev", device, "root", "tbf", "rate", rate, "burst",
                 LIMIT_BURST, "latency", LIMIT_LATENCY)

    def unlimit(self, host: str) -> None:
        for namespace, device in self._ends(host):
            _run("tc", "-n", namespace, "qdisc", "delete", "dev", device, "root")

    def _ends(self, host: str) -> list[tuple[str, str]]:
        return [(self.namespace(self._known(host)), LINK), (self.namespace(BRIDGE), self._port(host))]

    def _known(self, host: str) -> str:
        if host not in self.names:
            raise HostsError(f"no host '{host}': there are {', '.join(self.names)}")
        return host


def _run(*command: str) -> str:
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    if done.returncode != 0:
        raise HostsError(f"{' '.join(command)}: {done.stderr.strip() or f'exit code {done.returncode}'}")
    return done.stdout


def _socket_in(namespace: Path) -> socket.socket:
    libc = ctypes.CDLL(None, use_errno=True)
    with open(namespace, "rb") as network:
        if libc.setns(network.fileno(), CLONE_NEWNET) != 0:
            raise HostsError(f"{namespace}: cannot be entered: {os.strerror(ctypes.get_errno())}")
    return socket.socket(socket.AF_INET, socket.SOCK_STREAM)


def _pids(namespace: str) -> list[int]:
    return [int(pid) for pid in _run("ip", "netns", "pids", namespace).split()]


def _end_what_is_left(namespace: str) -> None:
    """Whatever the programs of the namespace, which is ours, have started and not ended."""
    end = time.monotonic() + GONE_LIMIT
    while (pids := _pids(namespace)) and time.monotonic() < end:
        for pid in pids:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        time.sleep(0.02)


def _remove_left_over() -> None:
    """The namespaces of tests that were killed: their process is no more, and nobody is in them."""
    for path in NAMESPACES.glob(f"{PREFIX}*-*"):
        pid = path.name.removeprefix(PREFIX).split("-")[0]
        try:
            if pid.isdigit() and not Path("/proc", pid).exists() and not _pids(path.name):
                _run("ip", "netns", "delete", path.name)
        except HostsError:
            pass  # another test has removed it meanwhile
