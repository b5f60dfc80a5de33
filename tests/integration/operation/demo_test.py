# SPDX-License-Identifier: MIT
"""scripts/demo.sh as the README uses it: pictures, exit codes, nothing left behind."""
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from compare import load_png  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

DEMO = ["/usr/bin/python3", str(ROOT / "scripts" / "demo.py")]  # what demo.sh runs when all is installed and built


def processes_of(folder_mark: str) -> list[str]:
    listed = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True).stdout.splitlines()
    return [line for line in listed if folder_mark in line]


class Demo(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory(prefix="wallgl-demo-test-")
        self.addCleanup(self.folder.cleanup)
        # The wall's own folder goes below this one, so that its processes can be told from others'.
        self.environment = {**{k: v for k, v in os.environ.items() if k != "DISPLAY"}, "TMPDIR": self.folder.name,
                            "WALLGL_BUILD": str(build_folder())}

    def demo(self, *arguments: object, limit: float = 90) -> subprocess.CompletedProcess:
        done = subprocess.run([*DEMO, "--http", "0", *map(str, arguments)], env=self.environment, capture_output=True,
                              text=True, timeout=limit)
        self.assertEqual(processes_of(self.folder.name), [], "nothing is left behind")
        self.assertEqual([p.name for p in Path(self.folder.name).iterdir() if p.name.startswith("wallgl-")], [])
        return done

    def gears(self, tiles: str, size: str, *more: str) -> None:
        shot = Path(self.folder.name) / "out.png"
        columns, rows, width, height = (int(n) for text in (tiles, size) for n in text.split("x"))
        done = self.demo("--seconds", 2, "--tiles", tiles, "--tile-size", size, "--screenshot", shot, *more,
                         "--", "glxgears", "-geometry", f"{columns * width}x{rows * height}")
        self.assertEqual(done.returncode, 0, done.stderr)
        picture = load_png(shot)
        self.assertEqual(picture.shape, (rows * height, columns * width, 3))
        reds = (picture[..., 0] > 100) & (picture[..., 1] < 60)
        for row in range(rows):
            for column in range(columns):
                tile = picture[row * height:(row + 1) * height, column * width:(column + 1) * width]
                self.assertGreater(int(tile.max()), 50, f"tile {column}-{row} shows nothing")
        self.assertGreater(reds.mean(), 0.05, "the red gear")

    def test_2x2(self) -> None:
        self.gears("2x2", "256x192")

    def test_1x1(self) -> None:
        self.gears("1x1", "512x384")

    def test_3x1(self) -> None:
        self.gears("3x1", "160x384")

    def test_2x2_osmesa(self) -> None:
        self.gears("2x2", "256x192", "--backend", "osmesa")

    def test_tiles_as_windows_of_a_desktop(self) -> None:
        with XServer((640, 480)) as desktop:
            self.environment["DISPLAY"] = desktop.display
            running = subprocess.Popen([*DEMO, "--http", "0", "--windows", "--tiles", "2x1", "--tile-size", "160x240",
                                        "--seconds", "6", "--", "glxgears", "-geometry", "320x240"],
                                       env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                       text=True)
            seen = []
            while running.poll() is None:
                seen.append(subprocess.run(["xwininfo", "-root", "-tree"], env=desktop.environment(),
                                           capture_output=True, text=True).stdout)
                time.sleep(0.2)
            self.assertEqual(running.returncode, 0, running.stdout.read())
            running.stdout.close()
        self.assertTrue(any("160x240+0+0" in tree and "160x240+160+0" in tree and "glxgears" not in tree
                            for tree in seen), seen[-3:])

    def test_without_seconds_it_ends_with_the_worst_exit_code(self) -> None:
        done = self.demo("--tiles", "1x1", "--", "sh", "-c", "exit 3", "--and", "true")
        self.assertEqual(done.returncode, 3, done.stderr)

    def test_ctrl_c_ends_it(self) -> None:
        running = subprocess.Popen([*DEMO, "--http", "0", "--tiles", "2x1", "--tile-size", "320x240"],
                                   env=self.environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        page = ""
        for line in running.stdout:
            page = line.split()[-1] if "status page" in line else page
            if "Ctrl-C" in line:
                break
        with urllib.request.urlopen(page, timeout=10) as answer:
            self.assertIn(b"<title>WallGL</title>", answer.read())
        time.sleep(2)
        running.send_signal(signal.SIGINT)
        output, _ = running.communicate(timeout=30)
        self.assertEqual(running.returncode, 0, output)
        self.assertEqual(processes_of(self.folder.name), [])

    def test_wrong_use_is_told(self) -> None:
        for arguments in (["--tiles", "2"], ["--backend", "vulkan"], ["--"], ["--nonsense"], ["--windows"]):
            done = self.demo(*arguments)
            self.assertEqual(done.returncode, 2)
            self.assertIn("demo.sh: error:", done.stderr)


if __name__ == "__main__":
    unittest.main()
