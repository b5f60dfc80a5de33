# SPDX-License-Identifier: MIT
"""Addresses end to end: IPv6 loopback for everything, and none that other machines reach for any daemon."""
import re
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402


def free_port() -> int:
    with socket.socket(socket.AF_INET6) as probe:
        probe.bind(("::1", 0))
        return probe.getsockname()[1]


class IPv6Wall(Wall):
    """walld, its nodes and HTTP on [::1]."""

    def __init__(self, **options):
        super().__init__(http="[::1]:0", **options)

    def _description(self) -> str:
        text = re.sub(r"unix:[^\"]*", lambda _: f"[::1]:{free_port()}", super()._description())
        self.on_ipv6 = re.search(r"\[control\]\nlisten = \[\"([^\"]*)", text)[1]
        return text

    def start_walld(self) -> None:
        self.address = self.on_ipv6
        super().start_walld()


class IPv6(unittest.TestCase):
    def test_a_program_draws_on_a_wall_that_is_only_there(self) -> None:
        with XServer() as x, IPv6Wall(tiles=(2, 1), tile_size=(320, 240)) as wall:
            self.assertRegex(wall.address, r"^\[::1\]:\d+$")
            self.assertRegex(wall.url, r"^http://\[::1\]:\d+/$")
            app = wall.run("glxgears", env=x.environment())
            wall.wait(wall.wait_session(app), 10)
            self.assertEqual(wall.rest("GET", "/api/v1/sessions")[1][0]["pid"], app.pid)


class OtherMachines(unittest.TestCase):
    REACHED = ("0.0.0.0", "[::]", "192.0.2.1")

    def refused(self, program: str, description: str, address: str) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "wall.toml"
            description = description.replace("LOCAL", f"unix:{folder}/walld.sock")
            path.write_text(description.replace("ELSEWHERE", f"{address}:0"))
            node = ["--node", "n"] if program == "tileserver" else []
            command = [build_folder() / "bin" / program, "--config", path, *node]
            done = subprocess.run(command, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"{program}: listen address {address}:0 can be reached from other machines", done.stderr)

    def test_reach_no_daemon(self) -> None:
        control, http = '[control]\nlisten = ["{}"]\n', '[http]\nlisten = "{}"\n'
        node, tile = '[[node]]\nname = "n"\n', '[[node.tile]]\nname = "t"\nrect = [0, 0, 64, 48]\n'
        for address in self.REACHED:
            with self.subTest(address):
                self.refused("tileserver", control.format("LOCAL") + node + 'listen = "ELSEWHERE"\n' + tile, address)
                self.refused("walld", control.format("ELSEWHERE") + node + tile, address)
                self.refused("walld", control.format("LOCAL") + http.format("ELSEWHERE") + node + tile, address)


if __name__ == "__main__":
    unittest.main()
