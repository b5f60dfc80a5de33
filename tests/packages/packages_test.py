#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The Debian packages on machines that boot with systemd: packages_test.py [-v] [TEST...], after scripts/packages.sh.
As root."""
from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "support"), str(Path(__file__).parent)]

import clean_root  # noqa: E402
from hosts import Hosts  # noqa: E402
from machine import Machine  # noqa: E402
from readme import Steps  # noqa: E402

PACKAGES = ROOT / "build" / "packages"
CLEAN_ROOT = PACKAGES / "clean-root"
PROGRAMS = {"walld": 8, "tileserver": 8, "wallagent": 8, "wallrun": 1, "wallctl": 1, "wallview": 1,
            "wallplay": 1}  # manual sections
# As systemd-analyze counts, times ten. A node needs the graphics devices, and drivers make code while they run.
EXPOSURE = {"walld.service": 20, "wallagent.service": 20, "tileserver@left.service": 23,
            "tileserver-joined@left.service": 23}
NEXT = "9.0"  # the version of the packages that the upgrade brings
# What any Debian system writes that installs, runs and purges something.
KEPT_BY_SYSTEM = re.compile(r"/(etc/(\.pwd\.lock|machine-id|resolv\.conf|localtime|ld\.so\.cache"
                            r"|(passwd|group|shadow|gshadow|subuid|subgid)-?)"
                            r"|var/(log|cache|lib/(dpkg|apt|dbus|systemd|ucf))/.*"
                            r"|tmp/.*|var/tmp/.*|root/.*|home/.*|run/.*)")
WALL = """
[wall]
name = "installed"
[control]
listen = ["unix:/run/wallgl/walld.sock"]
[people]
users = ["alice"]
[[node]]
name = "left"
listen = "unix:/run/wallgl/left.sock"
[[node.tile]]
name = "A"
rect = [0, 0, 320, 240]
[[node]]
name = "right"
backend = "osmesa"
listen = "unix:/run/wallgl/right.sock"
[[node.tile]]
name = "B"
rect = [320, 0, 320, 240]
"""
GEARS = "exec xvfb-run -a wallrun --fullscreen -- glxgears"
RIGHT_AGAIN = 10.0  # seconds, with several nodes started anew, one after the other


def packages() -> list[Path]:
    found = sorted(path for path in PACKAGES.glob("wallgl-*.deb") if "-dbgsym_" not in path.name)
    if not found:
        sys.exit(f"no packages in {PACKAGES}: scripts/packages.sh makes them")
    return found


def run(*command: object, **options) -> subprocess.CompletedProcess:
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, **options)


def sessions(machine: Machine) -> list[dict]:
    return json.loads(machine.run("wallctl --json sessions"))


def frame_of(session: dict) -> int:
    return session["surfaces"][0]["frame"] if session["surfaces"] else 0


def until(done, what: str, limit: float = RIGHT_AGAIN):
    end = time.monotonic() + limit
    while not (result := done()):
        if time.monotonic() > end:
            raise AssertionError(f"{limit} s have passed, and it is not so: {what}")
        time.sleep(0.1)
    return result


def frames_go_on(machine: Machine) -> dict:
    """The one session, which has ended at least five frames more than when this was called."""
    def count() -> int:
        there = sessions(machine)
        return frame_of(there[0]) if there else 0
    until(count, "the program has a frame")
    before = count()
    until(lambda: count() > before + 5, f"frames go on behind {before}")
    return sessions(machine)[0]


def later_versions(folder: Path) -> None:
    """The same packages, as a later version."""
    for package in packages():
        tree = folder / f"{package.name}.tree"
        run("dpkg-deb", "--raw-extract", package, tree, check=True)
        control = tree / "DEBIAN" / "control"
        old = re.search(r"(?m)^Version: (.*)$", control.read_text())[1]
        control.write_text(control.read_text().replace(f"Version: {old}", f"Version: {NEXT}")
                           .replace(f"(= {old})", f"(= {NEXT})"))
        run("dpkg-deb", "--build", "--root-owner-group", tree, folder / f"{package.name.split('_')[0]}_{NEXT}.deb",
            check=True)
        shutil.rmtree(tree)


def setUpModule() -> None:
    clean_root.make(CLEAN_ROOT, packages())


class Lintian(unittest.TestCase):
    def test_finds_no_error(self) -> None:
        done = run("lintian", "--fail-on", "error", "--allow-root", *PACKAGES.glob("*.deb"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class OnMachines(unittest.TestCase):
    """A folder for what the machines write, and one that they share, with the packages."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(tempfile.mkdtemp(prefix="machines-", dir=PACKAGES))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.shared = cls.folder / "shared"
        cls.shared.mkdir()
        for package in packages():
            shutil.copy(package, cls.shared)

    @classmethod
    def boot(cls, *names: str) -> list[Machine]:
        hosts = cls.enterClassContext(Hosts(*names))
        return [cls.enterClassContext(Machine(name, CLEAN_ROOT, cls.folder / name, hosts, cls.shared))
                for name in names]


class OneMachine(OnMachines):
    """The tests go on from one another, in the order of their names."""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        [cls.machine] = cls.boot("one")
        cls.machine.run("apt-get install --yes --no-install-recommends /srv/shared/*.deb")

    def test_1_all_is_in_its_place(self) -> None:
        for program, section in PROGRAMS.items():
            with self.subTest(program):
                self.assertRegex(self.machine.run(f"{program} --version"), r"^\d+\.\d+\.\d+\n$")
                self.machine.run(f"zgrep -q {program} /usr/share/man/man{section}/{program}.{section}.gz")
        self.assertEqual(self.machine.run("stat --format=%U /run/wallgl"), "wallgl\n")
        self.assertEqual(self.machine.ask("systemctl is-enabled walld wallagent").stdout.split(), ["disabled"] * 2,
                         "nothing starts before the machine was told what it is")

    def test_1_bash_completes_commands(self) -> None:
        for line, expected in (("wallctl node dr", "drain"), ("walld --che", "--check"), ("wallctl lay", "layout"),
                               ("wallrun --hold -- glxge", "glxgears"), ("wallctl layout lo", "load")):
            script = ('source /usr/share/bash-completion/bash_completion; read -ra COMP_WORDS <<<"$1"; '
                      'COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); COMP_LINE=$1; COMP_POINT=${#1}; '
                      '_completion_loader "${COMP_WORDS[0]}"; _wallgl "${COMP_WORDS[0]}"; '
                      'printf "%s\\n" "${COMPREPLY[@]}"')
            said = self.machine.run(f"bash -c '{script}' - '{line}' 2>/dev/null")
            self.assertIn(expected, said.split(), line)

    def test_1_units_are_understood_and_closed(self) -> None:
        for unit, exposure in EXPOSURE.items():
            with self.subTest(unit):
                self.machine.run(f"systemd-analyze verify --man=no {unit}")
                self.machine.run(f"systemd-analyze security --no-pager --threshold={exposure} {unit}")

    def test_2_a_wall_runs(self) -> None:
        self.machine.write("/etc/wallgl/wall.toml", WALL)
        self.machine.run("systemctl enable --now walld tileserver@left tileserver@right")
        program = self.machine.popen(GEARS, user=clean_root.USER, cwd="/")
        self.addCleanup(program.wait)
        self.addCleanup(self.machine.ask, "pkill glxgears")
        session = frames_go_on(self.machine)
        self.assertEqual(session["owner"]["name"], clean_root.USER)
        self.machine.run("wallctl screenshot /srv/shared/wall.png")
        self.assert_shows_gears()
        with self.subTest("an upgrade while it runs"):
            before = self.pids()
            later_versions(self.shared)
            self.machine.run(f"apt-get install --yes --no-install-recommends /srv/shared/*_{NEXT}.deb", timeout=300)
            self.assertEqual(self.machine.run("dpkg-query -W -f '${Version}\\n' 'wallgl-*' | sort -u"), f"{NEXT}\n")
            now = self.pids()
            self.assertTrue(before.isdisjoint(now), "every daemon is another process")
            self.assertNotIn("0", now, "and runs")
            until(lambda: all(node["up"] for node in json.loads(self.machine.run("wallctl --json nodes"))), "nodes up")
            after = frames_go_on(self.machine)
            self.assertEqual((after["pid"], after["owner"]), (session["pid"], session["owner"]))
            self.assertIsNone(program.poll(), "the program goes on")
            self.machine.run("wallctl screenshot /srv/shared/wall.png")
            self.assert_shows_gears()

    def pids(self) -> set[str]:
        units = "walld tileserver@left tileserver@right"
        return set(self.machine.run(f"systemctl show --property=MainPID --value {units}").split())

    def assert_shows_gears(self) -> None:
        """Their three colours on both tiles' halves of the picture."""
        import cv2  # takes a second, and only this needs it
        picture = cv2.imread(str(self.shared / "wall.png"))
        self.assertEqual(picture.shape, (240, 640, 3))
        for half in (picture[:, :320], picture[:, 320:]):
            self.assertGreater((half.max(axis=2) > 60).mean(), 0.05, "a part of the gears is on each tile")

    def test_3_purge_leaves_nothing(self) -> None:
        self.machine.run("apt-get purge --yes 'wallgl-*'")
        left = {path for path in self.machine.changed() if not KEPT_BY_SYSTEM.fullmatch(path)}
        self.assertEqual(left, set())
        self.assertEqual(self.machine.run("ls /run | grep wallgl || true"), "")
        self.assertNotIn("wallgl", self.machine.run("cat /etc/passwd /etc/group"))
        units = "walld.service wallagent.service 'tileserver*'"
        self.assertEqual(self.machine.run(f"systemctl list-units --state=active --plain --no-legend {units}"), "")


class SeveralMachines(OnMachines):
    """A host for walld, for each of three nodes of two tiles, and for people."""
    NODES = ("left", "middle", "right")

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        cls.machines = {machine.name: machine for machine in cls.boot("walld", *cls.NODES, "desk")}

    def wall(self) -> str:
        address = self.machines["walld"].hosts.address
        nodes = "".join(f'[[node]]\nname = "{name}"\nlisten = "{address(name)}:7790"\n'
                        + "".join(f'[[node.tile]]\nname = "{name}-{row}"\nrect = [{160 * i}, {120 * row}, 160, 120]\n'
                                  for row in range(2)) for i, name in enumerate(self.NODES))
        listen = f'"unix:/run/wallgl/walld.sock", "{address("walld")}:7770"'
        return f'[wall]\nname = "lab"\n[control]\nlisten = [{listen}]\n{nodes}'

    def assert_programs_run(self) -> None:
        walld, desk = self.machines["walld"], self.machines["desk"]
        until(lambda: all(node["up"] for node in json.loads(walld.run("wallctl --json nodes"))), "nodes up")
        program = desk.popen(GEARS, user=clean_root.USER, cwd="/")
        self.addCleanup(program.wait)
        self.addCleanup(desk.ask, "pkill glxgears")
        for machine in (walld, desk):
            self.assertEqual(frames_go_on(machine)["owner"]["name"], f"{clean_root.USER}@desk")


class RealMachines(SeveralMachines):
    """What README.md says under "On real machines", word for word."""

    def test_readme(self) -> None:
        steps = Steps(ROOT / "README.md", "On real machines")
        machines, walld = self.machines, self.machines["walld"]
        for machine in machines.values():
            machine.run("cp /srv/shared/*.deb /root")
        # wall.toml is what a person writes.
        lines = steps.of("walld")
        self.assertIn("editor /etc/wallgl/wall.toml", lines)
        invitations = {}
        for line in lines:
            if line.startswith("editor "):
                walld.write(line.split()[1], self.wall())
            elif line.startswith("wallctl join-token node "):
                for node in self.NODES:
                    invitations[node] = walld.run(line.replace("left", node))
            elif line.startswith("wallctl join-token client "):
                invitations["desk"] = walld.run(line)
            else:
                walld.run(f"cd /root && {line}", timeout=300)
        begin = time.monotonic()
        for name in (*self.NODES, "desk"):
            for line in steps.of("desks" if name == "desk" else "nodes"):
                machines[name].run(f"cd /root && {line}", timeout=300)
            command = next(line.strip() for line in invitations[name].splitlines() if line.startswith("  "))
            machines[name].run(command)
        print(f"four machines installed and joined in {time.monotonic() - begin:.0f} s", file=sys.stderr)
        self.assert_programs_run()


class WithAnsible(SeveralMachines):
    """deploy/ansible, over SSH."""

    def test_the_role_makes_a_wall_and_leaves_it_alone_then(self) -> None:
        key = self.folder / "key"
        run("ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", key, check=True)
        for machine in self.machines.values():
            machine.run("install -d -m 700 /root/.ssh")
            machine.write("/root/.ssh/authorized_keys", key.with_suffix(".pub").read_text())
        (self.folder / "wall.toml").write_text(self.wall())
        address = self.machines["walld"].hosts.address
        host = lambda name: f"{name} ansible_host={address(name)}\n"
        (self.folder / "hosts.ini").write_text(
            f"[walld]\n{host('walld')}[nodes]\n{''.join(map(host, self.NODES))}[desks]\n{host('desk')}"
            f"[all:vars]\nansible_user=root\nansible_ssh_private_key_file={key}\n"
            f"ansible_python_interpreter=/usr/bin/python3\n")
        first = self.play()
        self.assertTrue(all(changed > 0 for changed in first.values()), first)
        self.assert_programs_run()
        self.assertEqual(set(self.play().values()), {0}, "nothing is left to be done")

    def play(self) -> dict[str, int]:
        """What was changed on each machine."""
        command = ["ansible-playbook", "-i", self.folder / "hosts.ini", "-e", f"wallgl_packages={PACKAGES}", "-e",
                   f"wallgl_wall={self.folder / 'wall.toml'}", ROOT / "deploy" / "ansible" / "site.yml"]
        environment = dict(os.environ, ANSIBLE_HOST_KEY_CHECKING="False", ANSIBLE_NOCOLOR="1", LANG="C.UTF-8",
                           ANSIBLE_LOCAL_TEMP=str(self.folder / "ansible"))
        done = self.machines["walld"].hosts.run("walld", command, env=environment, timeout=600)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return {name: int(count) for name, count in re.findall(r"(?m)^(\w+) +: ok=.*changed=(\d+)", done.stdout)}


if __name__ == "__main__":
    if os.geteuid() != 0:
        sys.exit("packages_test: machines are booted by root: run this with sudo")
    unittest.main()
