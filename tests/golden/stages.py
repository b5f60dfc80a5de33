# SPDX-License-Identifier: MIT
"""Where a subject is played: on plain Mesa, which is the reference, or on a wall."""
from __future__ import annotations

import contextlib
import dataclasses
import json
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import cv2
import numpy as np

from subjects import WINDOW, Play, Recording, Subject
from wall import Wall, WallError
from xserver import XServer

Rect = tuple[int, int, int, int]  # x, y, width, height in pixels, y down
SHOWN_LIMIT = 10.0  # seconds until a frame that was read must be on the wall


@dataclasses.dataclass
class Performance:
    """All that a subject gave. `shown` lacks the frames that could not be looked at: a recording's last one, since its
    program ends at once."""

    read: list[np.ndarray] = dataclasses.field(default_factory=list)
    shown: dict[int, np.ndarray] = dataclasses.field(default_factory=dict)
    text: list[str] = dataclasses.field(default_factory=list)
    exit_code: int = 0
    errors: str = ""
    problems: list[str] = dataclasses.field(default_factory=list)
    stats: dict = dataclasses.field(default_factory=dict)

    def end(self, play: Play) -> None:
        self.exit_code, said = play.finish()
        self.text = [line for line in said.splitlines() if line.startswith("= ")]
        self.errors = "\n".join(line for line in said.splitlines() if not line.startswith("= "))


def mesa_environment(x: XServer) -> dict[str, str]:
    """For programs that use the X server's own OpenGL, Mesa's llvmpipe."""
    # With its sRGB extension Mesa 22 lets glAccum convert a window's colours to and from sRGB, even while sRGB is off.
    # (Without it OpenGL 2.1 is all that it offers, unless it is told.)
    environment = x.environment(LIBGL_ALWAYS_SOFTWARE="1", vblank_mode="0", MESA_GL_VERSION_OVERRIDE="4.5COMPAT",
                                MESA_EXTENSION_OVERRIDE="-GL_EXT_framebuffer_sRGB")
    for name in ("__GLX_VENDOR_LIBRARY_NAME", "__EGL_VENDOR_LIBRARY_FILENAMES"):
        environment.pop(name, None)
    return environment


class MesaStage:
    """The whole window on plain Mesa."""

    def __init__(self, x: XServer):
        self._environment = mesa_environment(x)

    def play(self, subject: Subject) -> Performance:
        given = Performance()
        play = Play(subject, self._environment)
        for frame in play.frames():
            given.read.append(frame)
            play.go_on()
        given.end(play)
        return given


class MovedStage:
    """Plain Mesa, drawing a window in parts: for each of the tiles that `tiles_of` gives for a window's size one
    process with everything moved so that the tile's left top pixel is that of its window (moved/). That is what a tile
    of a wall does, so a wall's picture is the same. Each process has an X server of its own, since Mesa reads a front
    buffer back from the screen: there are as many `servers` as tiles, or more."""

    def __init__(self, tiles_of: Callable[[tuple[int, int]], list[Rect]], build: Path, servers: list[XServer]):
        self._tiles_of, self._servers = tiles_of, servers
        library = build / "tests" / "moved"
        self._vendor = {"__GLX_VENDOR_LIBRARY_NAME": "moved",
                        "__EGL_VENDOR_LIBRARY_FILENAMES": str(library / "moved.json"),
                        "LD_LIBRARY_PATH": str(library),
                        # Shaders get the declaration of a uniform before their #extension.
                        "allow_glsl_extension_directive_midshader": "true"}

    def _environments(self, window: tuple[int, int], share: str) -> list[dict[str, str]]:
        tiles = self._tiles_of(window)
        words = ";".join(",".join(map(str, numbers)) for numbers in (window, *tiles))
        return [mesa_environment(server) | self._vendor | {"GOLDEN_TILES": words, "GOLDEN_TILE": str(i),
                                                           "GOLDEN_SHARE": share}
                for i, server in zip(range(len(tiles)), self._servers, strict=False)]

    def play(self, subject: Subject) -> Performance:
        """The frames are those of all tiles put together; text and exit code are the first tile's. Another tile's
        process that fails is a problem."""
        given = Performance()
        with tempfile.NamedTemporaryFile(prefix="golden-share-") as share:
            plays = [Play(subject, environment, unseen=i > 0)
                     for i, environment in enumerate(self._environments(subject.window, share.name))]
            for frame in plays[0].frames():
                given.read.append(frame)
                plays[0].go_on()
            given.end(plays[0])
            for play in plays[1:]:
                code, said = play.finish()
                if code != 0:
                    given.problems.append(f"a tile's process ended with {code}: {said[-200:]}")
        return given


class References:
    """Performances kept in a folder, so that the walls need not play them again. What was recorded is not checked:
    the test that writes them (golden_mesa) runs first."""

    def __init__(self, folder: Path | None):
        self._folder = folder
        if folder:
            folder.mkdir(parents=True, exist_ok=True)

    def keep(self, subject: Subject, given: Performance) -> None:
        if self._folder:
            told = json.dumps({"text": given.text, "exit_code": given.exit_code, "frames": len(given.read)})
            np.savez(self._folder / f"{subject.name}.npz", told=np.array(told),
                     **{f"f{i}": each for i, each in enumerate(given.read)})

    def find(self, subject: Subject) -> Performance | None:
        path = self._folder / f"{subject.name}.npz" if self._folder else None
        if not path or not path.exists():
            return None
        with np.load(path) as kept:
            told = json.loads(str(kept["told"]))
            return Performance(read=[kept[f"f{i}"] for i in range(told["frames"])], text=told["text"],
                               exit_code=told["exit_code"])


def parts_of(window: Rect, tiles: tuple[int, int], tile_size: tuple[int, int]) -> list[Rect]:
    """What each tile shows of a window at `window` on the wall, in the window's pixels. Tiles that show nothing are
    left out."""
    def cuts(axis: int) -> list[tuple[int, int]]:
        start, whole, size = window[axis], window[axis + 2], tile_size[axis]
        ends = [(max(i * size - start, 0), min((i + 1) * size - start, whole)) for i in range(tiles[axis])]
        return [(first, end - first) for first, end in ends if end > first]

    return [(x, y, width, height) for y, height in cuts(1) for x, width in cuts(0)]


class WallStage:
    """A wall of `tiles`, just large enough for a subject's window: another one for windows of another size. On one tile
    the window fills it; on several it lies where tile borders cut it at odd places. Each tile has a node, or all have
    one that draws with `gpus` GPUs. `triangle_order` is the nodes' in wall.toml.
    `sort_last`: programs run so (docs/sort-last.md)."""

    SLACK = {(1, 1): (0, 0), (2, 2): (12, 10), (3, 2): (20, 14)}  # pixels of the wall beside the window

    def __init__(self, x: XServer, tiles: tuple[int, int], backend: str = "egl", swap_timeout_ms: int = 10000,
                 gpus: int = 0, triangle_order: str = "", sort_last: bool = False):
        slack = self.SLACK.get(tiles, (16, 16))
        self._x, self._tiles, self._backend, self._slack = x, tiles, backend, slack
        self._swap_timeout_ms, self._gpus, self._triangle_order = swap_timeout_ms, gpus, triangle_order
        self._sort_last = sort_last
        self._origin = (slack[0] // 3, slack[1] // 2)
        self._window = WINDOW
        self._wall = self._wall_for(WINDOW)

    def __enter__(self) -> "WallStage":
        self._wall.__enter__()
        return self

    def __exit__(self, *_) -> None:
        self._wall.__exit__(*_)

    def _tile_size(self, window: tuple[int, int]) -> tuple[int, int]:
        return -(-(window[0] + self._slack[0]) // self._tiles[0]), -(-(window[1] + self._slack[1]) // self._tiles[1])

    def _wall_for(self, window: tuple[int, int]) -> Wall:
        return Wall(tiles=self._tiles, tile_size=self._tile_size(window), backend=self._backend,
                    swap_timeout_ms=self._swap_timeout_ms, name="golden", one_node=self._gpus > 0, gpus=self._gpus,
                    triangle_order=self._triangle_order)

    def _fit(self, window: tuple[int, int]) -> None:
        if window == self._window:
            return
        self._wall.stop()
        self._window, self._wall = window, self._wall_for(window)
        self._wall.__enter__()

    @property
    def tiles(self) -> tuple[int, int]:
        return self._tiles

    def parts(self, window: tuple[int, int]) -> list[Rect]:
        return parts_of((*self._origin, *window), self._tiles, self._tile_size(window))

    @contextlib.contextmanager
    def looping(self, recording: Recording) -> Iterator[tuple[Wall, Play, Rect]]:
        """Draws the recording's last frame over and over, at (x, y, width, height) of the wall."""
        self._fit(recording.window)
        rect = (*self._origin, *recording.window)
        prefix = self._wall.wallrun(rect=rect, name=recording.name, sort_last=self._sort_last)
        play = Play(recording.looping(), self._x.environment(vblank_mode="0"), prefix, unseen=True)
        try:
            yield self._wall, play, rect
        finally:
            play.end()

    def play(self, subject: Subject) -> Performance:
        given = Performance()
        self._fit(subject.window)
        with tempfile.TemporaryDirectory() as folder:
            stats = Path(folder) / "stats.json"
            rect = None if self._tiles == (1, 1) else (*self._origin, *subject.window)
            prefix = self._wall.wallrun(rect=rect, name=subject.name, sort_last=self._sort_last)
            play = Play(subject, self._x.environment(WALLGL_STATS=str(stats), vblank_mode="0"), prefix)
            session = Session(self._wall, play.pid)
            for number, frame in enumerate(play.frames()):
                given.read.append(frame)
                if number in subject.shown:
                    self._look(session, subject, number, given)
                play.go_on()
            given.end(play)
            with contextlib.suppress(OSError, ValueError):
                given.stats = json.loads(stats.read_text())
        return given

    def _look(self, session: "Session", subject: Subject, number: int, given: Performance) -> None:
        """The composed wall, cut to the window, once it shows the frame."""
        try:
            session.wait_shown(number + 1 if subject.swaps else 0, wait_a_moment=not subject.swaps)
            x, y, width, height = session.rect()
            if (width, height) != subject.window:
                given.problems.append(f"frame {number}: the window covers {width}x{height} of the wall")
            picture = decode_png(self._wall.screenshot())
            given.shown[number] = picture[y:y + height, x:x + width]
        except (WallError, ValueError, KeyError) as problem:
            given.problems.append(f"frame {number}: {problem}")


class Session:
    """A program's session on the wall, found by its process."""

    def __init__(self, wall: Wall, pid: int):
        self._wall, self._pid = wall, pid

    def surface(self) -> dict:
        for session in self._wall.sessions():
            if session["pid"] == self._pid and session["surfaces"]:
                if session["fault"]:
                    raise WallError("session fault: " + session["fault"])
                return session["surfaces"][-1]
        raise WallError("the program has no window on the wall")

    def rect(self) -> list[int]:
        return self.surface()["rect"]

    def wait_shown(self, frame: int, wait_a_moment: bool) -> None:
        """Until the wall says that it shows `frame`. What is drawn to the front has no number: given a moment."""
        end = time.monotonic() + SHOWN_LIMIT
        if wait_a_moment:
            time.sleep(0.25)
        while self.surface()["frame"] < frame:
            if time.monotonic() > end:
                raise WallError(f"not shown within {SHOWN_LIMIT:.0f} seconds (last is {self.surface()['frame']} of "
                                f"{frame})")
            time.sleep(0.01)


def decode_png(data: bytes) -> np.ndarray:
    picture = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    if picture is None:
        raise ValueError("the screenshot is no PNG picture")
    return picture[..., ::-1]
