# SPDX-License-Identifier: MIT
"""The status page in a real browser of another machine: over TLS, for somebody with a token."""
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from browser import Browser  # noqa: E402
from token_wall import SECRETS, TokenWall  # noqa: E402
from wall import build_folder  # noqa: E402

OUTPUT = build_folder() / "test-output" / "page"
ASKED = "document.getElementById('sign-in').open"
UNKNOWN = "401"  # of the resource that the console names


class FromAnotherMachine(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.wall = cls.enterClassContext(TokenWall((2, 1), clients=["desk"]))
        cls.browser = cls.enterClassContext(Browser(via=cls.wall.hosts.line("desk", [])))

    def sign_in(self, secret: str) -> None:
        self.browser.call("fill", "#token", secret)
        self.browser.call("press", "#token", "Enter")

    def test_somebody_signs_in_and_out(self) -> None:
        # Whether the certificate is walld's is for the person: tests/integration/machines/https_test.py compares it.
        self.browser.open(self.wall.page_url, ignoreHTTPSErrors=True)
        self.browser.until(ASKED)
        self.sign_in("a guess of some length")
        self.browser.until("!document.getElementById('sign-in-problem').hidden")
        self.assertIn("does not know that token", self.browser.get("document.getElementById('sign-in').innerText"))
        self.browser.screenshot(OUTPUT / "sign-in.png")
        self.sign_in(SECRETS["leads"])
        self.browser.until(f"!{ASKED} && document.querySelectorAll('.tile').length === 2")
        self.browser.until("document.getElementById('connection').dataset.state === 'live'")
        self.assertEqual(self.browser.get("document.getElementById('who').innerText"), "leads, operator")
        self.assertEqual(self.browser.get("document.cookie"), "", "no script sees it")
        self.browser.call("reload")
        self.browser.until("document.querySelectorAll('.tile').length === 2")
        self.browser.call("click", "#sign-out")
        self.browser.until(ASKED)
        self.assertEqual([text for text in self.browser.errors() if UNKNOWN not in text], [])


if __name__ == "__main__":
    unittest.main()
