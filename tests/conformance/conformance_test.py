# SPDX-License-Identifier: MIT
"""The conformance tests' own tests: whatever is worse on a wall than on Mesa, they must say so."""
import os
import signal
import sys
import tempfile
import time
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "support")]

import piglit  # noqa: E402
import players  # noqa: E402
import report  # noqa: E402
from expectations import load, on_wall  # noqa: E402
from players import Player, play_all  # noqa: E402
from results import RANKS, Expected, Outcome, Result, judge, read_result, worse  # noqa: E402
from suite import Offer, SuiteError, Test, group_of, in_framebuffer, load_left_out  # noqa: E402
from suite import read_list, read_offer, with_es  # noqa: E402

GLINFO = """GL_RENDERER = WallGL (llvmpipe)
GL_VERSION = 2.1 WallGL 0.1
GL_VENDOR = WallGL
GL_SHADING_LANGUAGE_VERSION = 1.20
Extensions:
GL_ARB_shadow
GL_EXT_texture3D
GL_SGIS_texture_lodPIGLIT: {"result": "pass" }
"""
ES2_INFO = """EGL_CLIENT_APIS: OpenGL OpenGL_ES
GL_VERSION: OpenGL ES 2.0 WallGL 0.1
GL_EXTENSIONS:
    GL_EXT_blend_minmax, GL_OES_element_index_uint

"""
OFFER = Offer((2, 1), (1, 2), frozenset({"arb_shadow", "ext_texture3d", "sgis_texture_lod"}))


class Reading(unittest.TestCase):
    def test_result(self):
        self.assertEqual(read_result('hello\nPIGLIT: {"result": "pass" }\n', 0).status, "pass")
        self.assertEqual(read_result('PIGLIT: {"result": "fail" }\n', 1).status, "fail")
        self.assertEqual(read_result('PIGLIT: {"result": "warn" }\n', 0).status, "warn")

    def test_result_after_text_on_the_same_line(self):
        result = read_result('GL_SGIS_texture_lodPIGLIT: {"result": "pass" }', 0)
        self.assertEqual((result.status, result.output), ("pass", "GL_SGIS_texture_lod"))

    def test_no_result(self):
        self.assertEqual(read_result("", 0).status, "none")
        self.assertEqual(read_result("X Error", 1).status, "crash")
        self.assertEqual(read_result('PIGLIT: {"result": "pa', 1).status, "crash")

    def test_ends_after_its_result(self):
        self.assertEqual(read_result('PIGLIT: {"result": "pass" }', -signal.SIGSEGV).status, "crash")
        self.assertEqual(read_result('PIGLIT: {"result": "pass" }', None).status, "timeout")

    def test_unheard_of_result(self):
        self.assertEqual(read_result('PIGLIT: {"result": "splendid" }', 0).status, "fail")

    def test_subtests(self):
        result = read_result('PIGLIT: {"enumerate subtests": ["a", "b"]}\nPIGLIT: {"subtest": {"a" : "pass"}}\n'
                             'Probe\nPIGLIT: {"subtest": {"b" : "fail"}}\nPIGLIT: {"result": "fail" }\n', 1)
        self.assertEqual((result.status, result.subtests, result.output), ("fail", {"a": "pass", "b": "fail"}, "Probe"))

    def test_reason_of_a_skip(self):
        self.assertEqual(Result("skip", output="x\npiglit: info: Failed to create any GL context\n\n").reason,
                         "Failed to create any GL context")
        self.assertEqual(Result("skip").reason, "it does not say")


class Worse(unittest.TestCase):
    def test_all_pairs(self):
        order = [{"pass", "skip"}, {"warn"}, {"fail"}, {"crash", "timeout", "none"}]
        place = {status: i for i, statuses in enumerate(order) for status in statuses}
        self.assertEqual(set(place), set(RANKS))
        for given in RANKS:
            for reference in RANKS:
                self.assertEqual(bool(worse(Result(given), Result(reference))), place[given] > place[reference],
                                 (given, reference))

    def test_subtests_of_a_test_that_fails_on_both(self):
        reference = Result("fail", {"a": "pass", "b": "fail", "c": "skip"})
        self.assertFalse(worse(Result("fail", {"a": "pass", "b": "fail", "c": "skip"}), reference))
        self.assertFalse(worse(Result("fail", {"a": "skip", "b": "pass", "c": "pass"}), reference))
        self.assertIn("a", worse(Result("fail", {"a": "fail", "b": "pass", "c": "pass"}), reference))
        self.assertIn("b", worse(Result("fail", {"a": "pass", "b": "crash", "c": "pass"}), reference))
        self.assertIn("c", worse(Result("fail", {"a": "pass", "b": "fail", "c": "fail"}), reference))

    def test_subtests_that_were_not_reached(self):
        self.assertTrue(worse(Result("crash", {}), Result("crash", {"a": "pass"})))
        self.assertTrue(worse(Result("fail", {}), Result("fail", {"a": "pass"})))

    def test_subtests_of_a_test_that_passes(self):
        self.assertFalse(worse(Result("pass", {"a": "fail"}), Result("pass", {"a": "pass"})))
        self.assertFalse(worse(Result("skip"), Result("fail", {"a": "pass"})))


def outcome(name, given, reference=None):
    return Outcome(name, "group", Result(given), Result(reference) if reference else None)


def expect(name, status="fail", sometimes=False):
    return {name: Expected(name, status, frozenset(), "so it is", sometimes)}


class Judged(unittest.TestCase):
    def verdicts(self, *outcomes, expected=None, known=("a", "b", "c", "d")):
        judgement = judge(outcomes, expected or {}, known)
        return judgement.verdicts, judgement.good

    def test_good(self):
        self.assertEqual(self.verdicts(outcome("a", "pass"), outcome("b", "skip"), outcome("c", "fail", "fail"),
                                       outcome("d", "fail", "crash")),
                         ({"a": "pass", "b": "skip", "c": "as Mesa", "d": "as Mesa"}, True))

    def test_failed(self):
        self.assertEqual(self.verdicts(outcome("a", "pass"), outcome("b", "fail", "pass")),
                         ({"a": "pass", "b": "FAILED"}, False))

    def test_nothing_ran(self):
        self.assertFalse(judge([], {}, ["a"]).good)

    def test_expected(self):
        self.assertEqual(self.verdicts(outcome("a", "fail", "pass"), expected=expect("a")), ({"a": "expected"}, True))
        self.assertEqual(self.verdicts(outcome("a", "warn", "pass"), expected=expect("a")), ({"a": "expected"}, True))

    def test_worse_than_expected(self):
        self.assertEqual(self.verdicts(outcome("a", "crash", "pass"), expected=expect("a")), ({"a": "FAILED"}, False))

    def test_stale(self):
        self.assertEqual(self.verdicts(outcome("a", "pass"), expected=expect("a")), ({"a": "STALE"}, False))
        self.assertEqual(self.verdicts(outcome("a", "fail", "fail"), expected=expect("a")), ({"a": "STALE"}, False))
        self.assertEqual(self.verdicts(outcome("b", "pass"), expected=expect("a")), ({"b": "pass"}, True))  # not run

    def test_what_chance_decides(self):
        crash = expect("a", "crash", sometimes=True)
        self.assertEqual(self.verdicts(outcome("a", "pass"), expected=crash), ({"a": "pass"}, True))
        self.assertEqual(self.verdicts(outcome("a", "crash", "pass"), expected=crash), ({"a": "expected"}, True))
        self.assertEqual(self.verdicts(outcome("a", "crash", "pass"), expected=expect("a", sometimes=True)),
                         ({"a": "FAILED"}, False))

    def test_stranger(self):
        self.assertFalse(judge([outcome("a", "pass")], expect("z"), ["a"]).good)

    def test_table(self):
        judgement = judge([outcome("a", "pass"), outcome("b", "skip"), Outcome("c", "other", Result("pass"))], {},
                          "abc")
        self.assertEqual([(group, counts.total(), counts["pass"]) for group, counts in judgement.table()],
                         [("group", 2, 1), ("other", 1, 1), ("all", 3, 2)])


class Sampled(unittest.TestCase):
    @staticmethod
    def some(group: str, count: int) -> list[Test]:
        return [Test(f"{group}@{n}", ("true",), "shader") for n in range(count)]

    def test_small_groups_are_whole(self):
        tests = self.some("small", piglit.LARGE_GROUP)
        self.assertEqual(piglit.sample(tests, 4, lambda test: "small"), tests)

    def test_of_large_ones_there_is_a_part(self):
        tests = self.some("small", 10) + self.some("large", 4000)
        chosen = piglit.sample(tests, 4, lambda test: test.name.split("@")[0])
        self.assertEqual(chosen[:10], tests[:10])
        self.assertTrue(800 < len(chosen) < 1200, len(chosen))
        self.assertEqual(chosen, piglit.sample(tests, 4, lambda test: test.name.split("@")[0]), "always the same")


class Suite(unittest.TestCase):
    def test_offer(self):
        self.assertEqual(read_offer(GLINFO), OFFER)
        with self.assertRaises(SuiteError):
            read_offer("wallrun: no wall")

    def test_groups(self):
        for name, group in {
            "spec@!opengl 1.1@draw-pixels": "OpenGL 1.1", "spec@!opengl 2.1@pbo": "OpenGL 2.1",
            "spec@!opengl 3.0@clearbuffer": "", "spec@!opengl es 2.0@minmax": "", "spec@glsl-1.20@x@y": "GLSL 1.20",
            "spec@glsl-1.30@x": "", "spec@arb_shadow@x": "extensions", "spec@ext_texture3d@x": "extensions",
            "spec@ext_texture@x": "", "glx@glx-dlist": "GLX", "glx@glx_arb_create_context@x": "GLX",
            "spec@egl 1.4@x": "EGL", "spec@egl_khr_fence_sync@x": "EGL", "shaders@glsl-fs": "shaders",
            "fast_color_clear@x": "",
        }.items():
            self.assertEqual(group_of(name, OFFER), group, name)

    def test_es_is_told_by_another_program(self):
        offer = with_es(OFFER, ES2_INFO)
        self.assertEqual((offer.es, offer.es_extensions),
                         ((2, 0), frozenset({"ext_blend_minmax", "oes_element_index_uint"})))
        for name, group in {
            "spec@!opengl es 1.1@x": "", "spec@!opengl es 2.0@minmax": "OpenGL ES 2.0", "spec@!opengl es 3.0@x": "",
            "spec@glsl-es-1.00@linker@x": "OpenGL ES 2.0", "spec@glsl-es-3.00@x": "",
            "spec@oes_element_index_uint@x": "extensions", "spec@arb_shadow@x": "extensions", "spec@oes_x@x": "",
        }.items():
            self.assertEqual(group_of(name, offer), group, name)
        with self.assertRaises(SuiteError):
            with_es(OFFER, "eglCreateContext failed")

    def test_groups_by_other_names_than_their_extensions(self):
        for words, group in {"khr_texture_compression_astc_ldr": "extensions", "khr_debug": ""}.items():
            offer = Offer((4, 5), (4, 5), frozenset({words}))
            self.assertEqual(group_of("spec@khr_texture_compression_astc@basic-gl", offer), group)

    def test_list(self):
        text = "spec@!opengl 1.1@a b ::: ../lib/piglit/bin/draw 'GL_A b' -auto -fbo\nnoise\n"
        listed = read_list(text, "opengl", Path("/p"))
        self.assertEqual(listed, [Test("spec@!opengl 1.1@a b", ("/p/bin/draw", "GL_A b", "-auto"), "opengl", True)])
        self.assertEqual(in_framebuffer(listed[0]).command, ("/p/bin/draw", "GL_A b", "-auto", "-fbo"))

    def test_only_what_piglit_draws_into_framebuffers(self):
        text = "glx@a ::: bin/a -auto\nspec@!opengl 1.1@b ::: bin/b -auto -fbo\n"
        chosen = piglit.Selection(read_list(text, "opengl"), OFFER, piglit.read_arguments(["--fbo"]))
        self.assertEqual([(test.name, test.command[1:]) for test in chosen.tests],
                         [("spec@!opengl 1.1@b", ("-auto", "-fbo"))])

    def test_the_parts_together_are_all(self):
        tests = [Test(f"spec@!opengl 1.1@{n}", ("true",), "opengl") for n in range(300)]
        parts = [piglit.Selection(tests, OFFER, piglit.read_arguments(["--part", f"{k}/3"])).tests for k in (1, 2, 3)]
        self.assertEqual(sorted(test.name for part in parts for test in part), sorted(test.name for test in tests))
        self.assertTrue(all(70 < len(part) < 130 for part in parts))

    def test_left_out_needs_a_reason(self):
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write('[[left_out]]\ntests = "a"\nreason = " "\n')
            file.flush()
            with self.assertRaises(SuiteError):
                load_left_out(Path(file.name))


class Lists(unittest.TestCase):
    def load(self, text):
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write(text)
            file.flush()
            return load(Path(file.name))

    def test_walls(self):
        listed = self.load('[[expected]]\ntests = ["a", "b"]\nwalls = ["2x2 of 8x8"]\nreason = "so"\n[[expected]]\n'
                           'tests = ["c"]\nstatus = "crash"\nreason = "it is"\n')
        self.assertEqual({name: each.status for name, each in on_wall(listed, "2x2 of 8x8").items()},
                         {"a": "fail", "b": "fail", "c": "crash"})
        self.assertEqual(list(on_wall(listed, "2x2 of 9x9")), ["c"])

    def test_mistakes(self):
        with self.assertRaises(ValueError):
            self.load('[[expected]]\ntests = ["a"]\n')
        with self.assertRaises(ValueError):
            self.load('[[expected]]\ntests = ["a"]\nstatus = "pass"\nreason = "so"\n')

    def test_those_of_the_repository(self):
        load(HERE / "expectations.toml")
        load_left_out(HERE / "selection.toml")


class Playing(unittest.TestCase):
    """Commands of the shell in place of piglit's."""

    def play(self, script, timeout=20.0):
        return Player(dict(os.environ), timeout).play(Test("it", ("/bin/sh", "-c", script), "opengl"))

    def setUp(self):
        self.addCleanup(setattr, players, "HOME", players.HOME)
        players.HOME = Path("/")

    def test_passes(self):
        self.assertEqual(self.play("echo 'PIGLIT: {\"result\": \"pass\" }'").status, "pass")

    def test_crashes(self):
        self.assertEqual(self.play("kill -SEGV $$").status, "crash")

    def test_hangs(self):
        with tempfile.TemporaryDirectory() as folder:
            survivor = Path(folder) / "survivor"
            result = self.play(f"(sleep 1; touch {survivor}) & echo waiting; sleep 300", timeout=0.3)
            self.assertEqual((result.status, result.output), ("timeout", "waiting"))
            time.sleep(1.2)
            self.assertFalse(survivor.exists())

    def test_order(self):
        class Named(Player):
            def command(self, test):
                return ["/bin/sh", "-c", f"sleep {test.name}; echo {test.name}"]

        tests = [Test(name, (), "opengl") for name in ("0.2", "0", "0.1")]
        self.assertEqual([result.output for _, result in play_all(Named(dict(os.environ), 20.0), tests, 3)],
                         ["0.2", "0", "0.1"])


class Reported(unittest.TestCase):
    def test_text(self):
        outcomes = [outcome("good", "pass"),
                    Outcome("bad", "group", Result("fail", output="Probe at 1,1"), Result("pass")),
                    Outcome("alike", "group", Result("fail"), Result("fail")),
                    Outcome("none", "group", Result("skip", output="requires X"))]
        judgement = judge(outcomes, expect("good") | expect("gone"), ["good", "bad"])
        run = report.Run("1x1 of 8x8", 3.0, {"too slow": 2}, ["walld ended with 1"])
        with tempfile.TemporaryDirectory() as folder:
            told = report.write(Path(folder), run, judgement, {})
            self.assertTrue((Path(folder) / "report.json").exists())
        for line in ("FAILED bad: fail, on Mesa pass", "    Probe at 1,1", "STALE good: no worse",
                     "STALE gone: there is no such test",
                     "as Mesa alike", "skipped 1: requires X", "left out 2: too slow",
                     "FAILED wall: walld ended with 1"):
            self.assertIn(line, told)
        self.assertFalse(run.good(judgement))


if __name__ == "__main__":
    unittest.main()
