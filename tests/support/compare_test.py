# SPDX-License-Identifier: MIT
"""A check that cannot fail is a defect: every way in which a picture may be wrong must be noticed."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import compare  # noqa: E402


def flat(level=100, size=(300, 400)):
    return np.full((*size, 3), level, np.uint8)


def spotted(count, level, base=100):
    """`count` far-apart pixels of `level` on a flat picture."""
    picture = flat(base)
    for i in range(count):
        picture[5 + 10 * (i // 30), 5 + 10 * (i % 30)] = level
    return picture


class Same(unittest.TestCase):
    def test_equal_pictures(self):
        self.assertTrue(compare.same(flat(), flat()).good)

    def test_one_level_in_one_channel_of_one_pixel(self):
        picture = flat()
        picture[299, 399, 2] += 1
        verdict = compare.same(flat(), picture)
        self.assertFalse(verdict.good)
        self.assertEqual((verdict.unequal, verdict.largest), (1, 1))

    def test_other_size_type_or_nothing(self):
        self.assertFalse(compare.same(flat(), flat(size=(300, 401))).good)
        self.assertFalse(compare.same(flat(), flat().astype(np.float32)).good)
        self.assertFalse(compare.same(flat(size=(0, 0)), flat(size=(0, 0))).good)


class Match(unittest.TestCase):
    def test_two_levels_everywhere(self):
        self.assertTrue(compare.match(flat(100), flat(102)).good)
        self.assertTrue(compare.match(flat(100), flat(98)).good)

    def test_three_levels_everywhere(self):
        self.assertFalse(compare.match(flat(100), flat(103)).good)

    def test_differing_pixels_up_to_a_ten_thousandth(self):
        self.assertTrue(compare.match(flat(), spotted(12, 108)).good)  # 12 of 120,000
        verdict = compare.match(flat(), spotted(13, 108))
        self.assertFalse(verdict.good)
        self.assertEqual((verdict.differing, verdict.outside), (13, 0))

    def test_pixels_outside_their_neighbourhood(self):
        self.assertTrue(compare.match(flat(), spotted(4, 109)).good)
        verdict = compare.match(flat(), spotted(5, 109))
        self.assertFalse(verdict.good)
        self.assertEqual(verdict.outside, 5)
        self.assertFalse(compare.match(flat(), spotted(5, 91)).good)

    def test_share_outside_grows_with_the_picture(self):
        large = np.full((1000, 1000, 3), 50, np.uint8)
        picture = large.copy()
        picture[::100, 0] = 250  # 10 pixels of a million
        self.assertTrue(compare.match(large, picture).good)
        picture[1, 1] = 250
        self.assertFalse(compare.match(large, picture).good)

    def test_an_edge_that_moved_by_one_pixel_is_inside_but_counts(self):
        reference, picture = flat(0), flat(0)
        reference[:, 200:] = 255
        picture[:, 201:] = 255
        verdict = compare.match(reference, picture)
        self.assertFalse(verdict.good)
        self.assertEqual((verdict.differing, verdict.outside), (300, 0))

    def test_one_channel_is_enough(self):
        picture = flat()
        picture[:1, :13, 1] += 8
        self.assertFalse(compare.match(flat(), picture).good)

    def test_dark_and_bright_do_not_wrap(self):
        self.assertFalse(compare.match(flat(0), flat(255)).good)
        self.assertFalse(compare.match(flat(255), flat(0)).good)


class Program(unittest.TestCase):
    def run_program(self, word, reference, picture):
        with tempfile.TemporaryDirectory() as folder:
            a, b, diff = (Path(folder) / name for name in ("a.png", "b.png", "diff.png"))
            compare.save_png(a, reference)
            compare.save_png(b, picture)
            done = subprocess.run([sys.executable, compare.__file__, word, a, b, "--diff", diff], capture_output=True)
            return done.returncode, diff.exists()

    def test_exit_code_and_difference_picture(self):
        self.assertEqual(self.run_program("same", flat(), flat()), (0, False))
        self.assertEqual(self.run_program("same", flat(), flat(101)), (1, True))
        self.assertEqual(self.run_program("match", flat(), flat(101)), (0, False))
        self.assertEqual(self.run_program("match", flat(), flat(120)), (1, True))
        self.assertEqual(self.run_program("match", flat(), flat(size=(10, 10))), (1, True))

    def test_channels_keep_their_order(self):
        with tempfile.TemporaryDirectory() as folder:
            red = flat(0)
            red[..., 0] = 200
            compare.save_png(Path(folder) / "red.png", red)
            self.assertTrue(compare.same(red, compare.load_png(Path(folder) / "red.png")).good)


if __name__ == "__main__":
    unittest.main()
