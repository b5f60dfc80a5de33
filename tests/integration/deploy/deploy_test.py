#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Installs a build into a folder and looks at it: deploy_test.py BUILD WALLD."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BUILD, WALLD = Path(sys.argv.pop(1)), Path(sys.argv.pop(1))
MOST_CONNECTIONS = 10_000 + 2048 + 1024 + 256  # max_sessions in wall.toml, walld/wall/quota.h, and what is open besides
EXAMPLES = Path(__file__).resolve().parents[3] / "deploy" / "examples"


def output(*command: object, **options) -> subprocess.CompletedProcess:
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, **options)


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory(prefix="wallgl-install-")
        done = output("cmake", "--install", BUILD, env=dict(os.environ, DESTDIR=cls.folder.name))
        assert done.returncode == 0, done.stdout + done.stderr
        cls.files = {path.relative_to(cls.folder.name)
                     for path in Path(cls.folder.name).rglob("*") if not path.is_dir()}

    @classmethod
    def tearDownClass(cls) -> None:
        cls.folder.cleanup()

    def find(self, ending: str) -> Path:
        found = [Path(self.folder.name) / path for path in self.files if str(path).endswith(ending)]
        self.assertEqual(len(found), 1, f"{ending} in {sorted(map(str, self.files))}")
        return found[0]

    def test_everything_is_in_its_place(self) -> None:
        for ending in ("bin/walld", "bin/tileserver", "bin/wallrun", "bin/wallctl", "bin/wallview", "bin/wallagent",
                       "bin/wallplay",
                       "libGLX_wallgl.so.0", "libEGL_wallgl.so.0",
                       "lib/systemd/system/walld.service", "lib/systemd/system/tileserver@.service",
                       "lib/systemd/system/tileserver-joined@.service", "lib/systemd/system/wallagent.service",
                       "lib/sysusers.d/wallgl.conf", "lib/tmpfiles.d/wallgl.conf", "egl_vendor.d/50_wallgl.json",
                       "share/wallgl/grafana/wallgl.json", "share/wallgl/prometheus/wallgl.rules.yml",
                       "share/wallgl/prometheus/prometheus.example.yml"):
            self.find(ending)

    def test_systemd_accepts_the_units(self) -> None:
        # An instance of the template, with the programs where this installation has them.
        with tempfile.TemporaryDirectory() as folder:
            for name, instance in (("walld.service", "walld.service"),
                                   ("tileserver@.service", "tileserver@left.service"),
                                   ("tileserver-joined@.service", "tileserver-joined@left.service"),
                                   ("wallagent.service", "wallagent.service")):
                text = self.find(name).read_text()
                for program in ("walld", "tileserver", "wallagent"):
                    text = re.sub(rf"(?m)^ExecStart=\S*/{program} ", f"ExecStart={self.find(f'bin/{program}')} ", text)
                (Path(folder) / instance).write_text(text)
                verified = output("systemd-analyze", "verify", "--man=no", Path(folder) / instance)
                self.assertEqual((verified.returncode, verified.stderr.strip()), (0, ""))

    def test_no_daemon_takes_the_whole_machine(self) -> None:
        for unit in ("walld.service", "tileserver@.service", "tileserver-joined@.service", "wallagent.service"):
            with self.subTest(unit):
                text = self.find(unit).read_text()
                descriptors = re.findall(r"(?m)^LimitNOFILE=(\d+)$", text)
                memory = re.findall(r"(?m)^MemoryMax=(\d+)%$", text)
                self.assertEqual((len(descriptors), len(memory)), (1, 1))
                self.assertGreaterEqual(int(descriptors[0]), MOST_CONNECTIONS)
                self.assertLess(int(memory[0]), 100)

    def test_systemd_accepts_a_kiosk(self) -> None:
        # The X server's unit and what a node with windows adds to its own. There is no X server with a screen here: any
        # program stands for it.
        with tempfile.TemporaryDirectory() as folder:
            node, addition = Path(folder) / "tileserver@left.service", Path(folder) / "tileserver@left.service.d"
            node.write_text(re.sub(r"(?m)^ExecStart=\S*/tileserver ", f"ExecStart={self.find('bin/tileserver')} ",
                                   self.find("tileserver@.service").read_text()))
            addition.mkdir()
            (addition / "window.conf").write_text(self.find("kiosk/tileserver-window.conf").read_text())
            x = Path(folder) / "wallgl-x.service"
            x.write_text(self.find("kiosk/wallgl-x.service").read_text().replace("/usr/bin/Xorg", "/bin/true"))
            for unit in (node, x):
                verified = output("systemd-analyze", "verify", "--man=no", unit,
                                  env=dict(os.environ, SYSTEMD_UNIT_PATH=f"{folder}:"))
                self.assertEqual((verified.returncode, verified.stderr.strip()), (0, ""))

    def test_sysusers_and_tmpfiles_are_understood(self) -> None:
        users = output("systemd-sysusers", "--dry-run", self.find("lib/sysusers.d/wallgl.conf"))
        if "unrecognized option" not in users.stderr:
            self.assertEqual(users.returncode, 0, users.stderr)
        self.assertRegex(self.find("lib/tmpfiles.d/wallgl.conf").read_text(),
                         r"(?m)^d /run/wallgl 0755 wallgl wallgl -$")


class Examples(unittest.TestCase):
    def test_the_examples_are_good(self) -> None:
        for example in sorted(EXAMPLES.glob("*.toml")):
            with self.subTest(example.name):
                checked = output(WALLD, "--check", "--config", example)
                self.assertEqual((checked.returncode, checked.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main(verbosity=2)
