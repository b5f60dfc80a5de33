# SPDX-License-Identifier: MIT
"""200 random moves, changes of size and order, starts and ends of programs in a row. After each, the wall shows exactly
what it should: every window in its one colour at its place, those above over those below, background elsewhere."""
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import numpy  # noqa: E402
from compare import load_png  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

STILL = build_folder() / "tests" / "still_windows"  # draws a window, of one colour, only when X asks
COLOURS = {"red": (255, 0, 0), "green": (0, 255, 0), "blue": (0, 0, 255)}
ACTIONS = 200
MOST = 5  # programs at once
SEED = int(os.environ.get("WALLGL_SEED", "20"))
SOON = 10.0  # seconds until an action has its effect


class Window:
    def __init__(self, app: subprocess.Popen, session: int, colour: str, rect: list[int]):
        self.app, self.session, self.colour, self.rect = app, session, colour, rect


class Storm(unittest.TestCase):
    def setUp(self) -> None:
        self.x = self.enterContext(XServer())
        self.wall = self.enterContext(Wall(tiles=(2, 2), tile_size=(160, 120), options="close_timeout_ms = 300"))
        self.dice = random.Random(SEED)
        self.windows: list[Window] = []  # bottom first
        self.said: list[str] = []

    def rect(self) -> list[int]:
        """A part of it is on the wall, most often all."""
        width, height = self.dice.randint(1, 250), self.dice.randint(1, 200)
        return [self.dice.randint(1 - width // 4, 319), self.dice.randint(1 - height // 4, 239), width, height]

    # ---- actions ----

    def start(self) -> None:
        colour, rect = self.dice.choice(list(COLOURS)), self.rect()
        rect[:2] = [max(0, rect[0]), max(0, rect[1])]
        single = self.dice.random() < 0.3
        app = self.wall.run(STILL, *(["--single"] if single else []), colour, rect=tuple(rect),
                            env=self.x.environment(), stdout=subprocess.DEVNULL)
        self.windows.append(Window(app, self.wall.wait_session(app), colour, rect))

    def place(self) -> None:
        window = self.dice.choice(self.windows)
        rect = self.rect() if self.dice.random() < 0.5 else [*self.rect()[:2], *window.rect[2:]]
        if rect[0] + rect[2] < 1 or rect[1] + rect[3] < 1:
            rect[:2] = [0, 0]
        self.wall.ctl("place", window.session, "--", *rect)
        window.rect = rect

    def raise_one(self) -> None:
        window = self.dice.choice(self.windows)
        self.wall.ctl("raise", window.session)
        self.windows.remove(window)
        self.windows.append(window)

    def lower_one(self) -> None:
        window = self.dice.choice(self.windows)
        self.wall.ctl("lower", window.session)
        self.windows.remove(window)
        self.windows.insert(0, window)

    def end(self) -> None:
        window = self.windows.pop(self.dice.randrange(len(self.windows)))
        how = self.dice.choice([signal.SIGKILL, signal.SIGTERM, None])
        if how is None:
            self.wall.ctl("close", window.session)
            window.app.kill()  # it cannot be asked: it was cut off, and goes on without the wall
        else:
            window.app.send_signal(how)
        window.app.wait()
        self.wall.apps.remove(window.app)

    # ---- what must hold ----

    def expected(self) -> numpy.ndarray:
        picture = numpy.zeros((240, 320, 3), numpy.uint8)
        for window in self.windows:
            x, y, width, height = window.rect
            picture[max(0, y):max(0, y + height), max(0, x):max(0, x + width)] = COLOURS[window.colour]
        return picture

    def picture(self) -> numpy.ndarray:
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            self.wall.screenshot(file.name)
            return load_png(file.name)[:, :, :3]

    def check(self) -> None:
        expected, end = self.expected(), time.monotonic() + SOON
        while not (picture := self.picture()).shape == expected.shape or (picture != expected).any():
            if time.monotonic() > end:
                wrong = numpy.argwhere((picture != expected).any(axis=2))
                self.fail(f"seed {SEED}: {len(wrong)} pixels are wrong, from {wrong.min(axis=0)} to "
                          f"{wrong.max(axis=0)} (y, x) after\n"
                          + "\n".join(self.said[-6:]) + f"\n{self.wall.sessions()}\n{self.wall.log('walld')[-1500:]}")
            time.sleep(0.02)
        self.assertEqual(sorted(s["id"] for s in self.wall.sessions()), sorted(w.session for w in self.windows))

    def test_the_wall_shows_what_it_should_after_each(self) -> None:
        for number in range(ACTIONS):
            actions = [self.start]
            if self.windows:
                actions = [self.place] * 8 + [self.raise_one] * 2 + [self.lower_one] * 2 + [self.end]
            if len(self.windows) < MOST:
                actions += [self.start]
            action = self.start if len(self.windows) < 2 else self.dice.choice(actions)
            action()
            self.said.append(f"{number}: {action.__name__}: "
                             + ", ".join(f"{w.session} {w.colour} {w.rect}" for w in self.windows))
            self.check()


if __name__ == "__main__":
    unittest.main()
