# SPDX-License-Identifier: MIT
"""An X server without a screen for the programs under test, on a display number of its own choosing."""
from __future__ import annotations

import os
import subprocess


class XServer:
    """`with XServer() as x: subprocess.run([...], env=x.environment())`. It never resets: some programs open and close
    the display while they start."""

    def __init__(self, size: tuple[int, int] = (1280, 1024)):
        self.size = size
        self.display = ""

    def __enter__(self) -> "XServer":
        read_end, write_end = os.pipe()
        screen = f"{self.size[0]}x{self.size[1]}x24"
        self._process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write_end), "-screen", "0", screen, "+extension", "GLX", "-noreset",
             "-nolisten", "tcp"],
            pass_fds=[write_end], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True)
        os.close(write_end)
        with os.fdopen(read_end) as number:
            self.display = ":" + number.readline().strip()
        if self.display == ":":
            raise RuntimeError("Xvfb did not start: " + self._process.communicate()[1].decode(errors="replace"))
        return self

    def __exit__(self, *_) -> None:
        self._process.terminate()
        self._process.communicate()

    def kill(self) -> None:
        """It goes away without a word, as one that crashes."""
        self._process.kill()
        self._process.wait()

    def environment(self, **more: str) -> dict[str, str]:
        return {**os.environ, "DISPLAY": self.display, **more}
