# SPDX-License-Identifier: MIT
"""Programs for two eyes on the status page: there where tiles are for one eye, changed by those who may."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from browser import Browser  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

OUTPUT = build_folder() / "test-output" / "page"
SIZE = (200, 150)
PLAN = {"eyes": {"left": (0, 0, *SIZE), "right": (0, 0, *SIZE)}}
EYES = {"left": 'eye = "left"', "right": 'eye = "right"'}
SECRET = "a secret of the lobby's screen"


class TwoEyesOnThePage(unittest.TestCase):
    def setUp(self) -> None:
        folder = Path(self.enterContext(tempfile.TemporaryDirectory(prefix="wallgl-")))
        secret = folder / "lobby.token"
        secret.touch(mode=0o600)
        secret.write_text(SECRET)
        lobby = f'[[people.token]]\nname = "lobby"\nfile = "{secret}"\nrole = "viewer"'
        x = self.enterContext(XServer())
        self.wall = self.enterContext(PlannedWall(PLAN, EYES, people=lobby, die_with_parent=True))
        self.browser = self.enterContext(Browser())
        app = self.wall.run("glxgears", "-geometry", "200x150", env=x.environment(), stdout=subprocess.DEVNULL,
                            rect=(0, 0, *SIZE))
        self.session = self.wall.wait_session(app)
        self.wall.wait(self.session, 3)

    def tearDown(self) -> None:
        self.browser.screenshot(OUTPUT / f"{self._testMethodName}.png")
        self.assertEqual(self.browser.errors(), [])

    def open_selected(self, **options) -> None:
        self.browser.open(self.wall.url, **options)
        self.browser.until("document.querySelectorAll('.window').length === 1 && "
                           "!document.getElementById('stereo').hidden")
        self.assertTrue(self.browser.get("document.getElementById('stereo-on').disabled"), "no window is selected")
        self.browser.get("document.querySelector('#session-rows button').click()")

    def until_stereo(self, wanted: dict | None) -> None:
        def now() -> dict | None:
            stereo = next(s for s in self.wall.sessions() if s["id"] == self.session)["stereo"]
            return stereo and {key: round(value, 3) for key, value in stereo.items()}
        self.wall._until(lambda: now() == wanted, f"stereo is {wanted}", "walld")

    def until_said(self, state: str) -> None:
        self.browser.until(f"document.querySelector('#session-rows tr').textContent.includes('{state}')")

    def test_a_program_is_shown_to_two_eyes_and_changed_while_it_runs(self) -> None:
        self.open_selected()
        self.browser.call("click", "#stereo-on")
        self.until_stereo({"separation": 1.5, "distance": 0})
        self.until_said("stereo 1.5 %")
        self.browser.until("document.getElementById('stereo-on').getAttribute('aria-pressed') === 'true'")
        for field, text, wanted in (("separation", "3", {"separation": 3, "distance": 0}),
                                    ("distance", "40", {"separation": 3, "distance": 40}),
                                    ("distance", "", {"separation": 3, "distance": 0})):
            self.browser.call("fill", f"#stereo-{field}", text)
            self.browser.call("keyboard.press", "Tab")
            self.until_stereo(wanted)
        with self.subTest("what makes no sense is said, and not sent"):
            self.browser.call("fill", "#stereo-separation", "80")
            self.browser.call("keyboard.press", "Tab")
            self.browser.until("document.getElementById('problem').textContent.includes('expected -25 to 25')")
            self.until_stereo({"separation": 3, "distance": 0})
        with self.subTest("what somebody else changes is shown"):
            self.wall.ctl("stereo", self.session, "--separation", "2", "--distance", "7")
            self.browser.until("document.getElementById('stereo-separation').value === '2' && "
                               "document.getElementById('stereo-distance').value === '7'")
        self.browser.call("click", "#stereo-on")
        self.until_stereo(None)
        self.browser.until("document.getElementById('stereo-on').textContent === 'Show to two eyes'")

    def test_a_viewer_sees_it_and_changes_nothing(self) -> None:
        self.wall.ctl("stereo", self.session, "--separation", "2")
        self.open_selected(extraHTTPHeaders={"Authorization": f"Bearer {SECRET}"})
        self.until_said("stereo 2 %")
        self.browser.until("document.getElementById('stereo-on').getAttribute('aria-pressed') === 'true'")
        for field in ("on", "separation", "distance"):
            self.assertTrue(self.browser.get(f"document.getElementById('stereo-{field}').disabled"), field)

    def test_a_wall_for_both_eyes_has_nothing_to_say_of_it(self) -> None:
        self.open_selected()
        self.wall.keys = {}
        self.wall.reload({"eyes": {"left": (0, 0, *SIZE)}})
        self.browser.until("document.getElementById('stereo').hidden")


if __name__ == "__main__":
    unittest.main()
