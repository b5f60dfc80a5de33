# SPDX-License-Identifier: MIT
"""Real programs on the vendor libraries with the fake core: they start, choose a configuration and swap frames."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

from run_vendor_test import vendor_environment
from xserver import XServer

FAKE = ""
REAL = ""
HACKS = "/usr/libexec/xscreensaver/"


def run_for(command: list[str], environment: dict[str, str], seconds: float) -> tuple[int, str]:
    """Exit status (-15: it was still running, as it should) and what it said."""
    process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        output = process.communicate(timeout=seconds)[0]
    except subprocess.TimeoutExpired:
        process.terminate()
        output = process.communicate()[0]
    return process.returncode, output


class Library(unittest.TestCase):
    """What the shared objects show and need."""

    def libraries(self):
        for folder in filter(None, (FAKE, REAL)):
            path = pathlib.Path(folder) / "libGLX_wallgl.so.0"
            if path.exists():
                yield path

    def test_only_the_entry_points_are_exported(self):
        for library in self.libraries():
            symbols = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True,
                                     check=True)
            self.assertEqual({line.split()[-1] for line in symbols.stdout.splitlines()}, {"__glx_Main", "__egl_Main"})

    def test_needs_nothing_that_a_program_may_lack_or_clash_with(self):
        allowed = {"libX11.so.6", "libX11-xcb.so.1", "libxcb.so.1", "libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2"}
        for library in self.libraries():
            dynamic = subprocess.run(["readelf", "-dW", library], capture_output=True, text=True, check=True).stdout
            self.assertLessEqual(set(re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic)), allowed)
            self.assertIn("[libGLX_wallgl.so.0]", dynamic)
            self.assertIn("NODELETE", dynamic)

    def test_both_names_are_one_file(self):
        for library in self.libraries():
            self.assertTrue((library.parent / "libEGL_wallgl.so.0").samefile(library))


class Programs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.x = XServer().__enter__()
        cls.addClassCleanup(cls.x.__exit__)

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.log = pathlib.Path(scratch.name) / "log"
        self.environment = vendor_environment(self.x, FAKE, str(self.log))

    def frames(self) -> int:
        return self.log.read_text().count("fake_swap") if self.log.exists() else 0

    def assert_swaps(self, command: list[str], seconds: float = 1.5):
        if not shutil.which(command[0]):
            self.skipTest(command[0] + " is not installed")
        status, output = run_for(command, self.environment, seconds)
        self.assertGreater(self.frames(), 5, output)
        self.assertIn(status, (0, -15), output)

    def test_glxinfo(self):
        output = subprocess.run(["glxinfo"], env=self.environment, capture_output=True, text=True, timeout=30).stdout
        self.assertIn("OpenGL vendor string: WallGL", output)
        self.assertIn("OpenGL renderer string: fake core", output)

    def test_eglinfo(self):
        output = subprocess.run(["eglinfo"], env=self.environment, capture_output=True, text=True, timeout=30).stdout
        self.assertIn("EGL vendor string: WallGL", output)

    def test_glxgears(self):
        self.assert_swaps(["glxgears"])
        self.assertIn("size=300x300 double=1 alpha=0 depth=24", self.log.read_text())

    def test_hacks_through_egl(self):
        for hack in ("atlantis", "gears", "pipes"):
            with self.subTest(hack):
                self.assert_swaps([HACKS + hack, "--window"])
                self.assertIn("window_system=egl", self.log.read_text())
                self.log.unlink()

    def test_hacks_through_glx(self):
        self.assert_swaps([HACKS + "helios", "--vsync", "0"])

    def test_es_programs(self):
        self.assert_swaps(["es2gears_x11"])

    def test_without_a_wall_one_line_says_so(self):
        # Hacks call abort() when they get no context; a crash would be another signal.
        for command, ends in ((["glxgears"], (0, 1, -15)), ([HACKS + "gears", "--window"], (1, -6))):
            with self.subTest(command[0]):
                started = time.monotonic()
                environment = dict(self.environment, WALLGL_FAKE_REFUSE="1", WALLGL_LOG="")
                status, output = run_for(command, environment, 2)
                self.assertEqual(output.count("wallgl: no wall at unix:/nowhere"), 1, output)
                self.assertIn(status, ends, output)
                self.assertLess(time.monotonic() - started, 5)

    def test_silent_unless_asked(self):
        status, output = run_for(["glxgears"], dict(self.environment, WALLGL_LOG=""), 1)
        self.assertNotIn("wallgl", output)

    def test_a_forked_child_ends_quietly(self):
        code = ("import ctypes, os, sys\n"
                "x = ctypes.CDLL('libX11.so.6'); gl = ctypes.CDLL('libGL.so.1')\n"
                "x.XOpenDisplay.restype = gl.glXGetClientString.restype = ctypes.c_void_p\n"
                "d = ctypes.c_void_p(x.XOpenDisplay(None)); gl.glXGetClientString(d, 1)\n"
                "pid = os.fork()\n"
                "if pid == 0: sys.exit(7)\n"
                "print(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]))\n")
        output = subprocess.run([sys.executable, "-c", code], env=self.environment, capture_output=True, text=True,
                                timeout=20)
        self.assertEqual(output.stdout.strip(), "7", output.stderr)


if __name__ == "__main__":
    FAKE, REAL = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
