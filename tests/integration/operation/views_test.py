# SPDX-License-Identifier: MIT
"""Tiles that look elsewhere (docs/walls.md, "Views"): what unmodified programs show there, views that change while
they run, nodes that come back, and windows that are not seen through them."""
from __future__ import annotations

import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import numpy as np  # noqa: E402
from compare import load_png  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from wall import WallError, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

ROOT_BUILD = build_folder()
QUIET = {"LP_NUM_THREADS": "0"}
SIZE = 240, 180  # of a tile
PLAN = {"a": {"ahead": (0, 0, *SIZE), "aside": (SIZE[0], 0, *SIZE)}, "b": {"flat": (2 * SIZE[0], 0, *SIZE)}}
SCREEN = "screen = { lower_left = [1, -0.3, 0.4], lower_right = [1, -0.3, 1.2], upper_left = [1, 0.3, 0.4] }"


def looking(ahead: int, aside: int) -> dict[str, str]:
    return {"ahead": f"yaw = {ahead}\nfov = 50", "aside": f"yaw = {aside}\nfov = 50"}


class TilesThatLookElsewhere(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())

    def setUp(self) -> None:
        self.wall = self.enterContext(PlannedWall(PLAN, looking(0, 120), environment=QUIET, die_with_parent=True))

    def start(self, *command: object, **options) -> int:
        app = self.wall.run(*command, env=self.x.environment(), stdout=subprocess.DEVNULL, **options)
        session = self.wall.wait_session(app)
        self.wall.wait(session, 3)
        return session

    def picture(self, tile: str) -> np.ndarray:
        path = self.wall.folder / f"{tile}.png"
        self.wall.screenshot(path, tile=tile)
        return load_png(path)[:, :, :3]

    def table(self, *arguments: str) -> str:
        """As people see it."""
        return subprocess.run([self.wall.bin / "wallctl", "--walld", self.wall.address, *arguments], check=True,
                              capture_output=True, text=True).stdout

    def lit(self, tile: str) -> float:
        return float((self.picture(tile).max(axis=2) > 0).mean())

    def views_of(self, session: int) -> str | None:
        return next(s for s in self.wall.sessions() if s["id"] == session)["surfaces"][0]["views"]

    def until_views(self, session: int, views: str | None) -> None:
        self.wall._until(lambda: self.views_of(session) == views, f"the window's views are {views}", "walld")

    def test_a_program_is_seen_through_them(self) -> None:
        session = self.start("glxgears", fullscreen=True)
        self.until_views(session, "seen")
        self.assertGreater(self.lit("ahead"), 0.03, "the gears are before the camera")
        self.assertEqual(self.lit("aside"), 0, "and nothing is behind the user")
        self.assertGreater(self.lit("flat"), 0, "a tile without a view shows its part of the picture")
        tiles = {tile["name"]: tile["view"] for tile in self.wall.ctl("tiles")}
        self.assertIsNone(tiles["flat"])
        self.assertEqual(len(tiles["aside"]), 13)
        self.assertIn("looks 120 right", self.table("tiles"))

        with self.subTest("they change while it runs"):
            before = {node["name"]: (node["pid"], node["incarnation"]) for node in self.wall.nodes()}
            self.wall.keys = looking(-120, 0)
            self.wall.reload(PLAN)
            self.wall._until(lambda: self.lit("ahead") == 0 and self.lit("aside") > 0.03, "the other one looks ahead",
                             "walld")
            self.assertEqual({node["name"]: (node["pid"], node["incarnation"]) for node in self.wall.nodes()}, before,
                             "no node has begun anew")
        with self.subTest("the same of the room"):
            self.wall.keys = looking(0, 0) | {"aside": SCREEN}
            self.wall.reload(PLAN)
            self.wall._until(lambda: self.lit("ahead") > 0.03 and self.lit("aside") == 0, "one stands aside", "walld")
        with self.subTest("what makes no sense changes nothing"):
            self.wall.keys = {"ahead": "yaw = 10", "aside": SCREEN}
            self.wall.write(PLAN)
            with self.assertRaisesRegex(WallError, r"wall\.toml:\d+: 'yaw': expected 'fov' beside it"):
                self.wall.ctl("reload")
            checked = subprocess.run([self.wall.bin / "walld", "--check", "--config", self.wall.folder / "wall.toml"],
                                     capture_output=True, text=True)
            self.assertEqual(checked.returncode, 2)
            self.assertIn("'yaw': expected 'fov' beside it", checked.stderr)
            self.assertGreater(self.lit("ahead"), 0.03)
        with self.subTest("without them it is a part of the picture again"):
            self.wall.keys = {}
            self.wall.reload(PLAN)
            self.until_views(session, None)
            self.wall._until(lambda: self.lit("aside") > 0.03, "the middle of the picture", "walld")

    def test_a_node_that_comes_back_looks_there_again(self) -> None:
        session = self.start("glxgears", fullscreen=True)
        self.until_views(session, "seen")
        self.wall.daemons["a"].kill()
        self.wall.daemons["a"].wait()
        self.wall.start_node("a")
        self.wall.wait_nodes()
        self.wall._until(lambda: self.lit("ahead") > 0.03, "the gears are there again", "a")
        self.assertEqual(self.lit("aside"), 0)

    def test_a_window_that_covers_a_part_lies_on_the_tile(self) -> None:
        session = self.start("glxgears", rect=(20, 10, 200, 150))
        self.until_views(session, None)
        picture = self.picture("ahead")
        self.assertGreater((picture[10:160, 20:220].max(axis=2) > 0).mean(), 0.03)
        self.assertEqual(picture[170:].max(), 0)

    def test_a_program_that_asks_draws_what_the_tiles_see(self) -> None:
        def panorama(*options: str) -> tuple[int, float]:
            """Views that it was told, and what part of the tile beside its camera shows houses."""
            program = ROOT_BUILD / "examples" / "panorama"
            app = self.wall.run(program, "--still", "--size", "240x180", *options, fullscreen=True,
                                env=self.x.environment(), stdout=subprocess.PIPE, text=True)
            session = self.wall.wait_session(app)
            self.wall.wait(session, 5)
            self.until_views(session, "seen")
            sky = (140, 179, 230)  # in the tile's upper left corner
            picture = self.picture("aside").astype(int)
            houses = float((np.abs(picture - picture[0, 0]).max(axis=2) > 4).mean())
            self.assertLess(np.abs(picture[0, 0] - sky).max(), 3)
            self.wall.ctl("close", session)
            return int(app.communicate(timeout=20)[0].split(" views")[0].split()[-1]), houses

        self.assertEqual(panorama("--alone"), (0, 0.0), "as any program it leaves out what its camera does not see")
        views, houses = panorama()
        self.assertEqual(views, 2)
        self.assertGreater(houses, 0.2)

    def test_a_program_without_a_camera_is_flat(self) -> None:
        session = self.start("glmark2", "-b", "effect2d:duration=60", "--size", "300x100", fullscreen=True)
        self.until_views(session, "flat")
        self.assertIn("shown flat: its camera is not known", self.table("sessions"))
        left, right = self.picture("ahead"), self.picture("aside")
        self.assertFalse((left == right).all(), "parts of one picture")

    def test_a_wrong_name_of_its_camera_leaves_it_flat_and_is_said_once(self) -> None:
        scene = ROOT_BUILD / "tests" / "golden_scenes"
        for camera, views, said in (("projection,matrices[7]", "flat", 1), ("camera,matrices[1]", "seen", 0)):
            with self.subTest(camera):
                app = self.wall.run_line(
                    self.wall.wallrun(scene, "named_camera", "--frames=1000000", "--read-from=1000000", fullscreen=True,
                                      camera=camera),
                    env=self.x.environment(), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                session = self.wall.wait_session(app)
                self.wall.wait(session, 30)
                self.until_views(session, views)
                app.kill()
                self.assertEqual(app.communicate(timeout=20)[1].count("no uniform that WALLGL_CAMERA names"), said)


if __name__ == "__main__":
    unittest.main()
