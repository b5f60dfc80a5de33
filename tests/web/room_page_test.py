# SPDX-License-Identifier: MIT
"""The status page's plan of a room whose tiles look elsewhere: there when a wall has such tiles, as they are now."""
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from browser import Browser  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from wall import build_folder  # noqa: E402

OUTPUT = build_folder() / "test-output" / "page"
SIDES, SIZE = 8, (160, 120)
PLAN = {"ring": {f"side{i}": (i * SIZE[0], 0, *SIZE) for i in range(SIDES)}}
RING = {f"side{i}": f"yaw = {i * 360 / SIDES}\nfov = {360 / SIDES}" for i in range(SIDES)}
SCREENS = "document.querySelectorAll('#room .screen').length"


class TheRoomFromAbove(unittest.TestCase):
    def test_it_shows_where_tiles_look(self) -> None:
        with PlannedWall(PLAN, RING, die_with_parent=True) as wall, Browser() as browser:
            browser.open(wall.url)
            browser.until(f"{SCREENS} === {SIDES}")
            self.assertFalse(browser.get("document.getElementById('room-section').hidden"))
            self.assertIn("side1 looks 45° to the right",
                          browser.get("document.getElementById('room').getAttribute('aria-label')"))
            browser.screenshot(OUTPUT / "room.png")

            with self.subTest("a click shows the tile"):
                browser.get("document.querySelectorAll('#room .screen')[2].dispatchEvent(new MouseEvent('click', "
                                 "{bubbles: true}))")
                browser.until("document.getElementById('tile-picture').open")
                self.assertEqual(browser.get("document.getElementById('tile-name').textContent"), "Tile side2")
                browser.get("document.getElementById('tile-close').click()")
            with self.subTest("views that change"):
                wall.keys = RING | {"side1": "yaw = 50\npitch = 20\nfov = 30"}
                wall.reload(PLAN)
                browser.until("document.getElementById('room').getAttribute('aria-label')"
                              ".includes('side1 looks 50° to the right, 20° up')")
            with self.subTest("a wall without them has no plan"):
                wall.keys = {}
                wall.reload(PLAN)
                browser.until("document.getElementById('room-section').hidden")
            self.assertEqual(browser.errors(), [])


if __name__ == "__main__":
    unittest.main()
