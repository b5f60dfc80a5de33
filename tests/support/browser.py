# SPDX-License-Identifier: MIT
"""A real headless Chromium for tests of the status page.

    with Browser() as browser:
        browser.open(wall.url)
        browser.until("document.title == 'test: WallGL'")
        browser.call("mouse.click", 10, 20)
"""
from __future__ import annotations

import json
import shutil
import subprocess
import time
from pathlib import Path
from typing import Sequence

from wall import REPOSITORY, build_folder

START_LIMIT = 60.0  # seconds; a loaded machine starts a browser slowly
STOP_LIMIT = 10.0


class BrowserError(RuntimeError):
    pass


class Browser:
    def __init__(self, via: Sequence[str] = ()):
        """`via`: what runs it, for one on another host (hosts.py)."""
        self._via = via

    def __enter__(self) -> "Browser":
        program = shutil.which("chromium")
        if not program:
            raise BrowserError("chromium is missing: scripts/install-deps.sh installs it")
        driver = build_folder() / "tests" / "playwright"
        if not (driver / "node_modules").exists():
            raise BrowserError(f"playwright-core is missing: tests/web/install_playwright.sh {driver} installs it")
        driven = ["node", REPOSITORY / "tests" / "web" / "browser.mjs", driver, program]
        self._process = subprocess.Popen([*self._via, *driven],
                                         stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        return self

    def __exit__(self, *_) -> None:
        self._process.stdin.close()
        try:
            self._process.wait(STOP_LIMIT)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._process.stdout.close()

    def _order(self, **order):
        self._process.stdin.write(json.dumps(order) + "\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        if not line:
            raise BrowserError("the browser ended")
        answer = json.loads(line)
        if "error" in answer:
            raise BrowserError(f"{order}: {answer['error']}")
        return answer["result"]

    def open(self, url: str, **options) -> None:
        """A new page; `options` are those of Playwright's browser.newContext."""
        self._order(open={"viewport": {"width": 1280, "height": 900}, **options})
        self.call("goto", url)

    def call(self, method: str, *arguments):
        """A method of Playwright's page, or of what it has: "mouse.move"."""
        return self._order(call=method, arguments=arguments)

    def get(self, expression: str):
        """The value of an expression in the page."""
        return self.call("evaluate", expression)

    def until(self, expression: str, limit: float = 20.0) -> None:
        """Also over a page that loads itself again: between two documents nothing has a value."""
        end = time.monotonic() + limit
        while True:
            problem = ""
            try:
                if self.get(expression):
                    return
            except BrowserError as error:
                problem = f" ({error})"
            if time.monotonic() > end:
                raise BrowserError(f"{limit:.0f} seconds are over: {expression}{problem}; the page's errors are "
                                   f"{self.errors()}; it says: {self.get('document.body?.innerText')}")
            time.sleep(0.05)

    def screenshot(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self.call("screenshot", {"path": str(path), "fullPage": True})

    def errors(self) -> list[str]:
        """What the page has written to the console as errors."""
        return self.call("messages")
