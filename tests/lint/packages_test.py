# SPDX-License-Identifier: MIT
"""A fresh machine has everything that the build and the tests use: the headers that the build really read, and the
programs that scripts and tests start, are of packages that scripts/install-deps.sh names or pulls in."""
import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

from packages import ROOT, Installed, listed, missing
from programs import started_by_python, started_by_shell

BUILD = Path(os.environ.get("WALLGL_BUILD", ROOT / "build" / "release"))
NODE = {"node", "nodejs", "npm", "npx"}  # may come from elsewhere (scripts/install-deps.sh)
OPTIONAL = {"mpirun", "xdotool"}  # where they are missing, what needs them is left out
NOT_STARTED = {"clang", "man", "time", "view"}  # words of our scripts that happen to be names of programs, too


def headers(build: Path) -> set[Path]:
    printed = subprocess.run(["ninja", "-C", build, "-t", "deps"], check=True, capture_output=True, text=True).stdout
    return {Path(line.strip()) for line in printed.splitlines() if line.startswith("    /usr/")}


def tracked(*patterns: str) -> list[Path]:
    command = ["git", "-C", ROOT, "ls-files", "-z", *patterns]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return [ROOT / name for name in printed.split("\0") if name]


def programs(files: list[Path]) -> set[Path]:
    names = set()
    for file in files:
        names |= (started_by_python if file.suffix == ".py" else started_by_shell)(file.read_text())
    found = (shutil.which(name, path="/usr/sbin:/usr/bin:/sbin:/bin") for name in names - NODE - OPTIONAL - NOT_STARTED)
    return {Path(path) for path in found if path}


class AFreshMachine(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.installed = Installed()

    def test_has_the_headers_that_the_build_used(self) -> None:
        used = headers(BUILD)
        self.assertGreater(len(used), 500, "the build's own list of what it read")
        self.assertEqual(missing(used, "build", self.installed), [])

    def test_has_the_programs_that_the_demo_starts(self) -> None:
        files = tracked("scripts/demo.*", "scripts/build.py", "tests/support/wall.py", "tests/support/xserver.py")
        used = programs(files)
        self.assertIn(Path("/usr/bin/glxgears"), used)
        self.assertEqual(missing(used, "demo", self.installed), [])

    def test_has_the_programs_that_scripts_and_tests_start(self) -> None:
        used = programs(tracked("*.py", "*.sh"))
        for name in ("Xvfb", "glretrace", "ffmpeg", "chromium", "piglit"):
            self.assertIn(name, {path.name for path in used}, "what is known to be started is found")
        self.assertEqual(missing(used, "test", self.installed), [])


class DebianPackages(unittest.TestCase):
    """debian/control says once more what is built with, because Debian wants that."""
    # Names of debhelper's own.
    OURS = {"debhelper-compat", "dh-sequence-installsysusers"}
    TOOLS = {"cmake", "help2man", "khronos-api", "ninja-build", "pkg-config", "protobuf-compiler"}

    def test_need_what_the_build_needs(self) -> None:
        control = (ROOT / "debian" / "control").read_text()
        field = re.search(r"(?ms)^Build-Depends:\n(.*?)^\S", control)[1]
        named = {re.match(r"[a-z0-9.+-]+", line.strip())[0] for line in field.splitlines()} - self.OURS
        wanted = listed("packages")
        self.assertEqual({package for package in wanted if package.endswith("-dev") or package in self.TOOLS} - named,
                         set(), "of scripts/install-deps.sh, in debian/control")
        self.assertEqual(named - Installed().closure(wanted), set(), "of debian/control, in scripts/install-deps.sh")


class TheCheckItself(unittest.TestCase):
    STATUS = "\n".join(["app\t\t\tlibapp (>= 1), mail-server | postfix\t", "libapp\t\t\t\tbase-files",
                        "base-files\tbase\t\t\t", "exim\t\tmail-server\t\t", "postfix\t\tmail-server\t\t",
                        "other\t\t\tlibapp\t"])

    def test_follows_what_a_package_pulls_in(self) -> None:
        self.assertEqual(Installed(self.STATUS).closure(["app"]), {"app", "libapp", "base-files", "exim", "postfix"})

    def test_does_not_reach_what_nothing_names(self) -> None:
        self.assertNotIn("other", Installed(self.STATUS).closure(["app"]))

    def test_fails_when_a_package_is_left_out(self) -> None:
        header = Path("/usr/include/GL/osmesa.h")
        installed = Installed()
        self.assertEqual(missing([header], "build", installed), [])
        without = installed.closure(listed("build") - {"libosmesa6-dev"})
        self.assertNotIn("libosmesa6-dev", without, "nothing else brings GL/osmesa.h")

    def test_finds_programs_in_python(self) -> None:
        self.assertEqual(started_by_python('run(["ls", "-l"]); TOOLS = {"play": "glretrace"}; say("not this one")'),
                         {"ls", "-l", "play", "glretrace"})

    def test_finds_programs_in_shell(self) -> None:
        text = ('A=1 ls -l | sort -n\n# awk\nif grep x; then exec tar x; fi\n'
                '"${root[@]}" env B=2 apt-get update && cat x\n')
        found = started_by_shell(text)
        self.assertLessEqual({"ls", "sort", "grep", "tar", "cat", "apt-get"}, found)
        self.assertNotIn("awk", found)


if __name__ == "__main__":
    unittest.main()
