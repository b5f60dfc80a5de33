# SPDX-License-Identifier: MIT
"""A clean Debian 12 with systemd, with all that the packages under test need and nothing of the packages themselves, so
that machines over it install them without a network."""
from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import Sequence

# systemd as the first process; a display, programs and a user for the tests; drivers that draw without a GPU; what
# Ansible needs.
INCLUDED = ("systemd", "systemd-sysv", "dbus", "bash-completion", "adduser", "procps", "xvfb", "xauth", "mesa-utils",
            "libgl1-mesa-dri", "libosmesa6", "openssh-server", "python3-apt")
USER = "alice"
FOLDER = "debs"  # of the packages, in the root's /srv
# What apt would install beside them, by its own word.
DEPENDENCIES = (f"cd /srv/{FOLDER} && apt-get --yes --no-install-recommends install $(apt-get --simulate "
                f"--no-install-recommends install ./*.deb | sed -n 's/^Inst \\([^ ]*\\) .*/\\1/p' | grep -v ^wallgl-)")


def make(root: Path, packages: Sequence[Path]) -> None:
    """Takes about a minute and a half, with downloads."""
    shutil.rmtree(root, ignore_errors=True)
    root.parent.mkdir(parents=True, exist_ok=True)
    quoted = DEPENDENCIES.replace("$", "\\$")
    copied = " ".join(f"'{package}'" for package in packages)
    hooks = (f'mkdir "$1/srv/{FOLDER}" && cp {copied} "$1/srv/{FOLDER}"',
             'cp /etc/resolv.conf "$1/etc/resolv.conf"', f'chroot "$1" sh -c "{quoted}"',
             f'chroot "$1" useradd --create-home {USER}', f'rm -r "$1/srv/{FOLDER}"')
    done = subprocess.run(["mmdebstrap", "--quiet", "--variant=apt", f"--include={','.join(INCLUDED)}",
                           *(f"--customize-hook={hook}" for hook in hooks), "bookworm", str(root)],
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"mmdebstrap: {done.stdout[-2000:]}{done.stderr[-4000:]}")
