# SPDX-License-Identifier: MIT
"""Runs a program with a vendor library on an X server of its own: run_vendor_test.py LIBRARY_FOLDER PROGRAM ARGS..."""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from xserver import XServer  # noqa: E402


def vendor_environment(x: XServer, folder: str, log: str = "") -> dict[str, str]:
    environment = x.environment(
        LD_LIBRARY_PATH=folder,
        __GLX_VENDOR_LIBRARY_NAME="wallgl",
        __EGL_VENDOR_LIBRARY_FILENAMES=folder + "/50_wallgl.json")
    if log:
        environment["WALLGL_LOG"] = "info:" + log
    return environment


def main() -> int:
    folder, *command = sys.argv[1:]
    with XServer() as x, tempfile.TemporaryDirectory() as scratch:
        return subprocess.run(command, env=vendor_environment(x, folder, scratch + "/log"), timeout=100).returncode


if __name__ == "__main__":
    sys.exit(main())
