# SPDX-License-Identifier: MIT
"""The golden tests' own tests: whatever a wall gets wrong, they must say so."""
import io
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from expectations import Check, Expected, Outcome, judge, load  # noqa: E402
from golden import Comparison, either, sample  # noqa: E402
from other_driver import distance, farthest, problem  # noqa: E402
from stages import Performance, parts_of  # noqa: E402
from subjects import Recording, Scene, load_recordings, read_frame  # noqa: E402


def performance(frames=3):
    rng = np.random.default_rng(5)
    pictures = [rng.integers(0, 255, (300, 400, 3), np.uint8) for _ in range(frames)]
    return Performance(read=pictures, shown=dict(enumerate(pictures)), text=["= answer 5"],
                       stats={"round_trips": 1, "round_trips_by_function": {"glReadPixels": 1}})


class Compared(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.reference, self.moved, self.given = performance(), performance(), performance()

    def wrong(self, tiles="1x1", subject=Scene("it", 3, True, False, Path())):
        report, moved = Path(self.folder.name), None if tiles == "1x1" else self.moved
        outcomes = Comparison(subject, tiles, self.reference, moved, self.given, report).outcomes()
        return sorted((o.check.view, o.check.frame) for o in outcomes if not o.good)

    @staticmethod
    def rounded(pictures, number):
        """One pixel of one picture differs by one level."""
        pictures[number] = pictures[number].copy()
        pictures[number][0, 0, 0] ^= 1

    def test_right(self):
        self.assertEqual(self.wrong(), [])
        self.assertEqual(self.wrong("2x2"), [])

    def test_one_pixel_by_one_level(self):
        self.rounded(self.given.read, 1)
        self.assertEqual(self.wrong(), [("read", 1)])
        self.assertEqual(self.wrong("2x2"), [("read", 1)])
        self.assertTrue((Path(self.folder.name) / "it-1x1-read-1.png").exists())

    def test_several_tiles_round_as_the_moved_reference_does(self):
        self.rounded(self.moved.read, 1)
        self.assertEqual(self.wrong("2x2"), [("read", 1), ("shown", 1)])
        self.rounded(self.given.read, 1)
        self.rounded(self.given.shown, 1)
        self.assertEqual(self.wrong("2x2"), [])

    def test_a_moved_reference_of_the_whole_window_is_the_plain_one(self):
        self.rounded(self.moved.read, 2)
        self.rounded(self.given.read, 2)
        self.assertEqual(self.wrong("mesa"), [("reference", 2)])

    def test_a_moved_reference_that_shows_something_else(self):
        self.moved.read[2] = self.given.read[2] = self.given.shown[2] = np.roll(self.moved.read[2], 1, axis=1)
        self.assertEqual(self.wrong("2x2"), [("reference", 2)])

    def test_a_moved_reference_that_failed(self):
        self.moved.problems = ["a tile's process ended with 3"]
        self.assertEqual(self.wrong("2x2"), [("reference", -1)])
        self.moved = Performance(exit_code=3)
        self.assertIn(("read", 0), self.wrong("2x2"))

    def test_composed_wall(self):
        self.given.shown[2] = np.roll(self.given.shown[2], 1, axis=1)
        self.assertEqual(self.wrong(), [("shown", 2)])
        self.assertEqual(self.wrong("3x2"), [("shown", 2)])

    def test_missing_frames(self):
        del self.given.shown[0]
        self.given.read.pop()
        self.assertEqual(self.wrong(), [("exit", -1), ("read", 2), ("shown", 0)])

    def test_too_many_frames(self):
        self.given.read.append(self.given.read[0])
        self.assertEqual(self.wrong(), [("exit", -1)])

    def test_answers(self):
        self.given.text = ["= answer 6"]
        self.assertEqual(self.wrong(), [("text", -1)])
        self.given.text = []
        self.assertEqual(self.wrong(), [("text", -1)])

    def test_exit_code_and_problems(self):
        self.given.exit_code = -11
        self.assertEqual(self.wrong(), [("exit", -1)])
        self.given.exit_code = 0
        self.given.problems = ["the window covers 5x5"]
        self.assertEqual(self.wrong(), [("exit", -1)])

    def test_round_trips(self):
        waited = self.given.stats["round_trips_by_function"]
        for name in ("glGetError", "glGetIntegerv", "glIsEnabled", "glGetTexParameteriv"):
            waited[name] = 1
            self.assertEqual(self.wrong(), [("round_trips", -1)])
            del waited[name]
        waited.update(glFinish=2, glGetTexImage=1)
        self.assertEqual(self.wrong(), [])
        self.given.stats = {}
        self.assertEqual(self.wrong(), [("round_trips", -1)])

    def test_a_recordings_warm_up_is_not_compared(self):
        recording = Recording("it", "gl", [], 3, "")
        self.given.read[0] = 255 - self.given.read[0]
        self.assertEqual(self.wrong(subject=recording), [])
        self.given.read[1] = self.given.read[2]
        self.assertEqual(self.wrong(subject=recording), [("read", 1)])


class PlayedTwice(unittest.TestCase):
    @staticmethod
    def told(*good):
        return [Outcome(Check("it", "2x2", "read", i), each, f"play {good}") for i, each in enumerate(good)]

    def test_what_either_play_of_mesa_shows_is_right(self):
        first, second = self.told(True, False, False), self.told(False, True, False)
        self.assertEqual(either(first, second, []), [first[0], second[1], first[2]])
        with self.assertRaises(ValueError):
            either(first, second[:2], [])

    def test_not_what_is_expected_to_fail(self):
        first, second = self.told(False, False), self.told(True, True)
        self.assertEqual(either(first, second, [first[0].check]), [first[0], second[1]])


class Parts(unittest.TestCase):
    def test_of_a_window_over_all_tiles(self):
        self.assertEqual(parts_of((4, 5, 400, 300), (2, 2), (206, 155)),
                         [(0, 0, 202, 150), (202, 0, 198, 150), (0, 150, 202, 150), (202, 150, 198, 150)])

    def test_only_what_lies_on_the_wall(self):
        self.assertEqual(parts_of((-60, 250, 400, 300), (3, 2), (310, 290)),
                         [(60, 0, 310, 40), (370, 0, 30, 40), (60, 40, 310, 260), (370, 40, 30, 260)])
        self.assertEqual(parts_of((600, 0, 400, 300), (3, 1), (310, 290)), [(0, 0, 20, 290), (20, 0, 310, 290)])


class Judged(unittest.TestCase):
    known = Check("a", "1x1", "read", 2)

    def outcome(self, good, check=known):
        return Outcome(check, good, "")

    def test_failures(self):
        self.assertFalse(judge([self.outcome(False)], {}).good)
        self.assertTrue(judge([self.outcome(True)], {}).good)

    def test_expected_failure(self):
        self.assertTrue(judge([self.outcome(False)], {self.known: Expected("why")}).good)
        other = Check("a", "1x1", "shown", 2)
        self.assertFalse(judge([self.outcome(False, other)], {self.known: Expected("why")}).good)

    def test_unexpected_pass(self):
        self.assertEqual(judge([self.outcome(True)], {self.known: Expected("why")}).unexpected_passes, [self.known])
        self.assertFalse(judge([self.outcome(True)], {self.known: Expected("why")}).good)

    def test_what_chance_decides(self):
        known = {self.known: Expected("why", sometimes=True)}
        self.assertTrue(judge([self.outcome(True)], known).good)
        self.assertTrue(judge([self.outcome(False)], known).good)

    def test_wrong_only_so_far(self):
        known = {self.known: Expected("why", sometimes=True, near=True)}
        self.assertTrue(judge([Outcome(self.known, False, "", near=True)], known).good)
        self.assertFalse(judge([Outcome(self.known, False, "", near=False)], known).good)

    def test_list(self):
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write('[[expected]]\nsubject = "a"\ntiles = ["1x1", "2x2"]\nview = "read"\nframes = [2]\n'
                       'reason = "why"\n')
            file.flush()
            other = Check("a", "2x2", "read", 2)
            self.assertEqual(load(Path(file.name)), {self.known: Expected("why"), other: Expected("why")})
            file.write('[[expected]]\nsubject = "b"\ntiles = ["1x1"]\nview = "read"\nframes = [2]\nreason = " "\n')
            file.flush()
            with self.assertRaises(ValueError):
                load(Path(file.name))


class Subjects(unittest.TestCase):
    def test_recordings_are_there(self):
        recordings = load_recordings()
        self.assertGreaterEqual(len(recordings), 12)
        for recording in recordings:
            self.assertTrue(recording.path.exists(), recording.path)
            self.assertGreaterEqual(recording.frames, 3)

    def test_frames_of_a_stream(self):
        picture = np.arange(24, dtype=np.uint8).reshape(2, 4, 3)
        stream = io.BytesIO(b"a message\nP6\n# comment\n4 2\n255\n" + picture.tobytes() + b"P6\n4 2\n255\n"
                            + picture.tobytes()[:-1])
        self.assertTrue((read_frame(stream) == picture).all())
        self.assertIsNone(read_frame(stream))  # cut off


class Sampled(unittest.TestCase):
    SUBJECTS = [*load_recordings()[:7], Scene("it", 3, True, False, Path())]

    def test_each_recording_is_in_one_sample_and_scenes_in_all(self):
        samples = [sample(self.SUBJECTS, f"{number}/3") for number in (1, 2, 3)]
        self.assertEqual([len(subjects) for subjects in samples], [4, 3, 3])
        self.assertEqual(sum(samples, []).count(self.SUBJECTS[-1]), 3)
        self.assertEqual({subject.name for subject in sum(samples, [])}, {subject.name for subject in self.SUBJECTS})
        self.assertEqual(sample(self.SUBJECTS, "1/1"), self.SUBJECTS)

    def test_a_sample_that_there_is_not_is_refused(self):
        for which in ("0/3", "4/3", "3"):
            self.assertRaises(ValueError, sample, self.SUBJECTS, which)


class OtherDriver(unittest.TestCase):
    SCENE = Scene("it", 3, True, False, Path())

    def setUp(self):
        self.plain, self.given = performance(), performance()

    def test_the_farthest_picture_counts(self):
        self.assertEqual(farthest(self.SCENE, self.plain, self.given).key(), (0, 0, 0))
        self.given.read[0] = self.plain.read[0] ^ 1
        self.assertEqual(farthest(self.SCENE, self.plain, self.given).key(), (0, 0, 1))
        self.given.shown[2] = 255 - self.plain.read[2]
        far = farthest(self.SCENE, self.plain, self.given)
        self.assertGreater(far.differing, 0.9)
        self.assertIs(far.picture, self.given.shown[2])

    def test_a_picture_of_another_size_is_wrong_throughout(self):
        self.assertEqual(distance(self.plain.read[0], self.plain.read[0][1:]).key(), (1, 1, 255))

    def test_what_ended_too_early_is_a_failure(self):
        self.assertEqual(problem(self.SCENE, self.given), "")
        self.given.read.pop()
        self.assertIn("2 of 3 frames", problem(self.SCENE, self.given))
        self.given = performance()
        self.given.exit_code = 1
        self.assertIn("exit code 1", problem(self.SCENE, self.given))


if __name__ == "__main__":
    unittest.main()
