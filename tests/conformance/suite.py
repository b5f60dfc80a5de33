# SPDX-License-Identifier: MIT
"""Which of piglit's tests there are, and which of them ask for what a wall offers."""
from __future__ import annotations

import dataclasses
import itertools
import re
import shlex
import subprocess
import tomllib
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HOME = Path("/usr/lib/x86_64-linux-gnu/piglit")  # of Debian's package
PROFILES = ("opengl", "shader", "glslparser")
OPENGL = re.compile(r"spec@!opengl (\d)\.(\d)(@|$)")
GLSL = re.compile(r"spec@glsl-(\d)\.(\d)0(@|$)")
OPENGL_ES = re.compile(r"spec@(?:!opengl es |glsl-es-)(\d)\.(\d)")
OFFSCREEN = "-fbo"
GLSL_ES_1 = (2, 0)  # the version of OpenGL ES that brought GLSL ES 1.00
OTHER_NAMES = {"khr_texture_compression_astc": "khr_texture_compression_astc_ldr"}  # piglit's of extensions


class SuiteError(RuntimeError):
    pass


@dataclasses.dataclass(frozen=True)
class Test:
    name: str
    command: tuple[str, ...]
    profile: str
    offscreen: bool = False  # piglit itself would run it with -fbo


@dataclasses.dataclass(frozen=True)
class LeftOut:
    pattern: re.Pattern[str]
    reason: str


@dataclasses.dataclass(frozen=True)
class Offer:
    """What a wall offers, as piglit's glinfo and es2_info of mesa-utils tell."""

    opengl: tuple[int, int]
    glsl: tuple[int, int]
    extensions: frozenset[str]
    es: tuple[int, int] = (0, 0)
    es_extensions: frozenset[str] = frozenset()


def read_offer(text: str) -> Offer:
    def version(name: str) -> tuple[int, int]:
        found = re.search(rf"^{name} = (\d+)\.(\d)", text, re.MULTILINE)
        if not found:
            raise SuiteError(f"glinfo does not tell {name}:\n{text}")
        return int(found[1]), int(found[2])

    extensions = re.findall(r"^GL_([A-Za-z0-9_]+?)(?=PIGLIT|\s|$)", text.partition("Extensions:")[2], re.MULTILINE)
    return Offer(version("GL_VERSION"), version("GL_SHADING_LANGUAGE_VERSION"), frozenset(map(str.lower, extensions)))


def with_es(offer: Offer, text: str) -> Offer:
    """`text`: es2_info's."""
    version = re.search(r"^GL_VERSION: OpenGL ES (\d+)\.(\d)", text, re.MULTILINE)
    if not version:
        raise SuiteError(f"es2_info tells no version of OpenGL ES:\n{text}")
    words = re.findall(r"\bGL_([A-Za-z0-9_]+)", text.partition("GL_EXTENSIONS:")[2])
    return dataclasses.replace(offer, es=(int(version[1]), int(version[2])),
                               es_extensions=frozenset(map(str.lower, words)))


def group_of_es(major: int, minor: int, offer: Offer) -> str:
    """`major` may be that of GLSL ES, which counts as OpenGL ES does, but for 1.00."""
    version = GLSL_ES_1 if (major, minor) == (1, 0) else (major, minor)
    return f"OpenGL ES {version[0]}.{version[1]}" if version <= offer.es else ""


def group_of(name: str, offer: Offer) -> str:
    """The group of a test, or nothing if it is about something that is not offered."""
    if found := OPENGL_ES.match(name):
        if name.startswith("spec@!opengl es 1"):
            return ""  # of fixed function
        return group_of_es(int(found[1]), int(found[2]), offer)
    if found := OPENGL.match(name):
        version = int(found[1]), int(found[2])
        return f"OpenGL {found[1]}.{found[2]}" if version <= offer.opengl else ""
    if found := GLSL.match(name):
        version = int(found[1]), int(found[2])
        return f"GLSL {found[1]}.{found[2]}0" if version <= offer.glsl else ""
    if name.startswith("glx@"):
        return "GLX"
    if name.startswith("spec@egl"):
        return "EGL"
    if name.startswith("shaders@"):
        return "shaders"
    if not name.startswith("spec@"):
        return ""
    extension = name.split("@")[1]
    offered = offer.extensions | offer.es_extensions
    return "extensions" if OTHER_NAMES.get(extension, extension) in offered else ""


def read_test(name: str, words: list[str], profile: str, home: Path = HOME) -> Test:
    """A test's command line without -fbo: a window is what a wall is about first."""
    program, *arguments = (word for word in words if word != OFFSCREEN)
    return Test(name, (str(home / "bin" / Path(program).name), *arguments), profile, OFFSCREEN in words)


def in_framebuffer(test: Test) -> Test:
    """The test that draws into a framebuffer object instead of its window."""
    return dataclasses.replace(test, command=(*test.command, OFFSCREEN))


def read_list(text: str, profile: str, home: Path = HOME) -> list[Test]:
    """`text`: lines of `piglit print-cmd`."""
    pairs = (line.split(" ::: ", 1) for line in text.splitlines() if " ::: " in line)
    return [read_test(name, shlex.split(command), profile, home) for name, command in pairs]


def load_left_out(path: Path) -> list[LeftOut]:
    entries = tomllib.loads(path.read_text()).get("left_out", [])
    if any(not entry["reason"].strip() for entry in entries):
        raise SuiteError(f"{path}: an entry gives no reason")
    return [LeftOut(re.compile(entry["tests"]), entry["reason"]) for entry in entries]


def list_profile(profile: str) -> list[Test]:
    try:
        listed = subprocess.run(["piglit", "print-cmd", profile], capture_output=True, text=True, check=True, cwd=HOME)
    except (OSError, subprocess.CalledProcessError) as error:
        raise SuiteError(f"piglit does not list its tests ({error}): run scripts/install-deps.sh") from error
    return read_list(listed.stdout, profile)


def all_tests() -> list[Test]:
    """All that piglit has, by name only once, less those whose program is not in Debian's package."""
    tests: dict[str, Test] = {}
    with ThreadPoolExecutor() as pool:  # seconds each
        for test in itertools.chain.from_iterable(pool.map(list_profile, PROFILES)):
            if Path(test.command[0]).exists():
                tests.setdefault(test.name, test)
    return list(tests.values())
