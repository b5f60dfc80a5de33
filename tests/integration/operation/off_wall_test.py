#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What a program reads back is what it drew, wherever its window lies: beyond the wall, across its edge, over pixels
behind bezels, on a node that is gone. The scenes of the golden tests, held against plain Mesa."""
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "support"))
import compare  # noqa: E402
import numpy  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

WINDOW = (400, 300)
TILE = (200, 150)
ACROSS = (-150, -90, *WINDOW)
AROUND = (-100, -75, *WINDOW)  # larger than the wall
# Of every way to draw, and to go on from the frame before. Each with its frames.
SCENES = {"primitive_modes": 3, "draw_pixels": 5, "bitmaps": 4, "copy_pixels": 4, "depth_and_stencil_pixels": 3,
          "clears": 4, "depth": 8, "stencil": 6, "accumulation": 4, "draw_buffers": 4, "front_buffer": 4,
          "single_buffered": 4, "kept_back_buffer": 5, "through_egl": 3, "lighting": 5, "texture_updates": 4,
          "copy_texture": 3, "list_state": 4, "list_images": 3, "vertex_arrays": 5, "evaluators": 5, "glsl_values": 2,
          "glsl_in_lists": 2, "occlusion": 2, "queries": 2, "selection": 2, "feedback": 2, "framebuffer": 4}
# Read for the first time after so many frames that were not.
LATE = {"depth": 8, "lighting": 90, "texture_updates": 7, "glsl_values": 70, "kept_back_buffer": 20, "list_state": 9,
        "single_buffered": 12, "framebuffer": 20}


class WallWithBezels(Wall):
    """Pixels between the tiles that nobody sees."""

    def __init__(self, *arguments, gap: int, **options):
        super().__init__(*arguments, **options)
        self.gap = gap

    def _tile(self, name: str) -> str:
        column, row = map(int, name.split("-"))
        x, y = column * (self.tile_size[0] + self.gap), row * (self.tile_size[1] + self.gap)
        return f'[[node.tile]]\nname = "{name}"\nrect = [{x}, {y}, {self.tile_size[0]}, {self.tile_size[1]}]\n'


def wall_beside() -> Wall:
    """Two tiles so far apart that the window lies between them. (No program may ask for a place off the canvas.)"""
    return WallWithBezels(tiles=(2, 1), tile_size=TILE, gap=WINDOW[0] + 20)


BETWEEN = (TILE[0] + 10, 0, *WINDOW)


class OffTheWall(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.x = cls.enterClassContext(XServer())
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.references: dict[tuple, tuple] = {}

    def play(self, scene: str, frames: int, read_from: int, wall: Wall | None = None, rect=None) -> tuple[list, list]:
        """The frames that were read, and what queries answered."""
        raw = self.folder / "frames.raw"
        raw.unlink(missing_ok=True)
        line = [str(build_folder() / "tests" / "golden_scenes"), scene, f"--frames={frames}",
                f"--read-from={read_from}", f"--raw={raw}"]
        if wall:
            line = wall.wallrun(*line, rect=rect)
            done = subprocess.run(line, env=self.x.environment(), capture_output=True, timeout=60)
        else:
            plain = self.x.environment(LIBGL_ALWAYS_SOFTWARE="1", MESA_EXTENSION_OVERRIDE="-GL_EXT_framebuffer_sRGB")
            plain.pop("__GLX_VENDOR_LIBRARY_NAME", None)
            plain.pop("__EGL_VENDOR_LIBRARY_FILENAMES", None)
            done = subprocess.run(line, env=plain, capture_output=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr[-2000:])
        pixels = numpy.fromfile(raw, numpy.uint8).reshape(-1, WINDOW[1], WINDOW[0], 4)[:, ::-1, :, :3]
        return list(pixels), [text for text in done.stderr.decode().splitlines() if text.startswith("= ")]

    def reference(self, *what) -> tuple[list, list]:
        if what not in self.references:
            self.references[what] = self.play(*what)
        return self.references[what]

    def hold_against_mesa(self, scene: str, frames: int, read_from: int, wall: Wall, rect: tuple, right,
                          text: bool = True) -> None:
        expected, said = self.reference(scene, frames, read_from)
        given, told = self.play(scene, frames, read_from, wall, rect)
        self.assertEqual(len(given), len(expected))
        for number, (mine, mesa) in enumerate(zip(given, expected)):
            verdict = right(mesa, mine)
            self.assertTrue(verdict.good, f"{scene}, frame {read_from + number}: {verdict}")
        if text:
            self.assertEqual(told, said, scene)

    def test_where_no_tile_shows_any_of_it(self) -> None:
        with wall_beside() as wall:
            for scene, frames in SCENES.items():
                with self.subTest(scene=scene):
                    self.hold_against_mesa(scene, frames, 0, wall, BETWEEN, compare.same)

    def test_across_its_edge(self) -> None:
        with Wall(tiles=(1, 1), tile_size=TILE) as wall:
            for scene, frames in SCENES.items():
                with self.subTest(scene=scene):  # samples are counted where they are seen
                    self.hold_against_mesa(scene, frames, 0, wall, ACROSS, compare.match, text=scene != "occlusion")

    def test_looked_at_late(self) -> None:
        for make, rect, right in ((wall_beside, BETWEEN, compare.same),
                                  (lambda: Wall(tiles=(1, 1), tile_size=TILE), AROUND, compare.match)):
            with make() as wall:
                for scene, frames in LATE.items():
                    with self.subTest(scene=scene, rect=rect):
                        self.hold_against_mesa(scene, frames, frames - 1, wall, rect, right)

    def test_behind_bezels_of_several_nodes(self) -> None:
        with WallWithBezels(tiles=(2, 2), tile_size=TILE, gap=24) as wall:
            for scene in ("primitive_modes", "texture_updates", "glsl_values", "kept_back_buffer"):
                with self.subTest(scene=scene):
                    self.hold_against_mesa(scene, SCENES[scene], 0, wall, (10, 10, *WINDOW), compare.match)

    def test_scaled(self) -> None:
        """Where the wall shows it at another size, what nobody sees has the window's own pixels."""
        with wall_beside() as wall:
            self.hold_against_mesa("lighting", 5, 0, wall, (*BETWEEN[:2], 200, 150), compare.same)

    def test_on_a_node_that_is_gone(self) -> None:
        with Wall(tiles=(2, 1), tile_size=TILE) as wall:
            wall.daemons["node-1-0"].kill()
            wall.daemons["node-1-0"].wait()
            end = time.monotonic() + 10
            while [node["up"] for node in wall.nodes()] != [True, False]:
                self.assertLess(time.monotonic(), end, "the killed node is up")
                time.sleep(0.05)
            self.hold_against_mesa("lighting", 5, 0, wall, (0, 0, *WINDOW), compare.match)

    def test_moved_there_while_it_draws(self) -> None:
        program = build_folder() / "tests" / "golden_scenes"
        with WallWithBezels(tiles=(2, 1), tile_size=WINDOW, gap=WINDOW[0] + 20) as wall:
            expected, _ = self.reference("lighting", 5, 0)
            raw = self.folder / "moved.raw"
            app = wall.run(program, "lighting", "--frames=5", "--pause", f"--raw={raw}", rect=(0, 0, *WINDOW),
                           env=self.x.environment(), stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
            session = wall.wait_session(app)
            for frame, (x, y) in enumerate([(-150, -90), (WINDOW[0] + 10, 0), (100, 0), (0, 0), (0, 0)]):
                while not raw.exists() or raw.stat().st_size < (frame + 1) * WINDOW[0] * WINDOW[1] * 4:
                    self.assertIsNone(app.poll())
                    time.sleep(0.02)
                wall.ctl("place", session, x, y, *WINDOW)
                time.sleep(0.2)
                app.stdin.write(b"\n")
                app.stdin.flush()
            pixels = numpy.fromfile(raw, numpy.uint8).reshape(-1, WINDOW[1], WINDOW[0], 4)[:, ::-1, :, :3]
            for frame, (mine, mesa) in enumerate(zip(pixels, expected)):
                verdict = compare.match(mesa, mine)
                self.assertTrue(verdict.good, f"frame {frame}: {verdict}")


if __name__ == "__main__":
    unittest.main()
