# SPDX-License-Identifier: MIT
"""The generator: what its models promise, and that a mistake in the data is refused with its place."""

import functools
import os
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/glgen"))

from glgen import attributes, commands, emit_wire, es, registry, state, texture_targets, wire  # noqa: E402

REGISTRY = pathlib.Path(os.environ.get("WALLGL_GL_XML", "/usr/share/khronos-api/gl.xml"))
PROTO = ROOT / "proto/gl"


class Registry(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.gl = registry.load(REGISTRY, PROTO / "extensions.xml")

    def test_signatures(self):
        c = self.gl.commands["glLoadMatrixd"]
        self.assertEqual((c.returns, c.params[0].type, c.params[0].len, c.gl),
                         ("void", "const GLdouble *", "16", "1.0"))
        self.assertEqual(self.gl.commands["glGetString"].returns, "const GLubyte *")

    def test_commands_of_our_own(self):
        c = self.gl.commands["glBarrierCreateCR"]
        self.assertEqual((c.declaration, c.extensions, c.gl),
                         ("GLuint name, GLuint count", ["GL_CR_synchronization"], None))
        c = self.gl.commands["glGetViewsWALLGL"]
        self.assertEqual((c.returns, c.declaration), ("GLsizei", "GLsizei count, GLfloat *views"))

    def test_aliases(self):
        self.assertEqual(self.gl.canonical("glActiveTextureARB"), "glActiveTexture")
        self.assertEqual(self.gl.canonical("glBegin"), "glBegin")


class OpenGlEs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.gl = registry.load(REGISTRY, PROTO / "extensions.xml")
        cls.commands = commands.load(PROTO / "commands.toml", cls.gl, state.load(PROTO / "state.toml"))
        cls.es = es.load(PROTO / "es.toml", cls.gl, cls.commands)

    def test_version_2_is_complete(self):
        self.assertIsNone(self.es.missing((2, 0)))
        self.assertEqual([e.name for e in self.es.extensions if e.missing], [])

    def test_commands_of_versions_and_extensions(self):
        slots = self.es.slots((2, 0))
        self.assertLessEqual({"DrawArrays", "DepthRange", "TexParameterfv", "GenVertexArrays", "MapBuffer"}, slots)
        self.assertFalse({"Begin", "MatrixMode", "TexImage1D", "UniformBlockBinding"} & slots)
        self.assertIn("UniformBlockBinding", self.es.slots((3, 0)))

    def test_words_and_since_when(self):
        words = self.es.words()
        self.assertEqual(words[self.gl.enums["GL_TEXTURE_CUBE_MAP"]], (2, 0))
        self.assertEqual(words[self.gl.enums["GL_TEXTURE_2D_ARRAY"]], (3, 0))
        self.assertEqual(words[self.gl.enums["GL_TEXTURE_3D"]], (2, 0), "an extension's")
        self.assertNotIn(self.gl.enums["GL_MATRIX_MODE"], words)
        self.assertNotIn(self.gl.enums["GL_COLOR_BUFFER_BIT"], words, "a bit, which is a word of desktop's as well")

    def test_the_first_version_is_of_another_kind(self):
        self.assertEqual(self.es.versions[:2], [(1, 1), (2, 0)])
        self.assertIsNone(self.es.missing((1, 1)))
        first, second = self.es.slots((1, 1)), self.es.slots((2, 0))
        self.assertLessEqual({"MatrixMode", "Lightfv", "Frustum", "DrawTexfOES", "BindFramebuffer"}, first)
        self.assertFalse({"UseProgram", "VertexAttribPointer", "Begin"} & first)
        self.assertFalse({"MatrixMode", "DrawTexfOES"} & second)
        words = self.es.words("gles1")
        self.assertIn(self.gl.enums["GL_MATRIX_MODE"], words)
        self.assertNotIn(self.gl.enums["GL_VERTEX_SHADER"], words)
        self.assertNotIn("GL_OES_standard_derivatives", [e.name for e in self.es.offered("gles1")])
        self.assertNotIn("GL_OES_compressed_paletted_texture", [e.name for e in self.es.offered("gles2")])

    def test_names_of_the_first_version_s_extensions(self):
        names = self.commands.all
        self.assertIs(names["glBindFramebufferOES"], names["glBindFramebuffer"])
        self.assertIs(names["glSampleCoveragexOES"], names["glSampleCoveragex"])
        self.assertEqual(self.commands.family_of("TexGenxvOES"), ("TexGen", "xv"))

    def test_parameters_that_are_words(self):
        self.assertEqual(self.es.checked(self.commands.all["glTexParameterf"]), [0, 1])
        self.assertEqual(self.es.checked(self.commands.all["glActiveTexture"]), [])

    def test_images_and_what_is_drawn_to(self):
        self.assertIn(es.Image("GL_RGBA", "GL_RGBA", "GL_FLOAT", "GL_RGBA32F"), self.es.images)
        self.assertIn(es.Image("GL_RGBA8", "GL_BGRA", "GL_UNSIGNED_BYTE", "GL_RGBA8"), self.es.images)
        self.assertEqual((self.es.drawn["GL_RGBA4"], self.es.drawn["GL_R32F"]), ((2, 0), (3, 0)))
        self.assertNotIn("GL_RGB9_E5", self.es.drawn)

    def test_mistakes_have_their_place(self):
        empty = {name: "" for name in ("extensions", "extensions_1", "words", "words_1", "images", "images_1", "drawn",
                                       "numbers")}
        for section, line, why in (("extensions", 'GL_ARB_shadow = ""', "GL_ARB_shadow: no extension"),
                                   ("images", 'GL_R8 = "GL_RED"', "GL_R8: GL_RED has no type"),
                                   ("images", 'GL_R8 = "GL_RED GL_BYTES"', "GL_R8: no word GL_BYTES"),
                                   ("drawn", '"2.5" = "GL_R8"', "2.5: no version 2.5"),
                                   ("drawn", '"3.0" = "GL_R8 GL_R8"', "3.0: GL_R8 is there already")):
            with tempfile.TemporaryDirectory() as folder, self.subTest(line):
                path = pathlib.Path(folder) / "es.toml"
                texts = empty | {section: line + "\n"}
                text = "".join(f"[{name}]\n{text}" for name, text in texts.items())
                path.write_text(text)
                number = text[:text.index(line)].count("\n") + 1
                with self.assertRaisesRegex(AssertionError, f"es.toml:{number}: {why}"):
                    es.load(path, self.gl, self.commands)


class Commands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.gl = registry.load(REGISTRY, PROTO / "extensions.xml")
        cls.model = state.load(PROTO / "state.toml")
        cls.commands = commands.load(PROTO / "commands.toml", cls.gl, cls.model)

    def test_every_command_has_a_class(self):
        self.assertEqual(set(self.commands.all), set(self.gl.commands))
        self.assertTrue(all(i.cls in commands.CLASSES for i in self.commands.all.values()))

    def test_opengl_1_1_is_complete(self):
        waiting = [i.name for i in self.commands.unique if i.command.gl in ("1.0", "1.1") and i.later]
        self.assertEqual(waiting, [])

    def test_commands_in_use_by_programs_up_to_1_4(self):
        for name in ("glActiveTextureARB", "glClientActiveTexture", "glBlendFuncSeparateEXT", "glPointParameterfARB",
                     "glPointParameterfvARB", "glDrawRangeElements", "glTexImage3D", "glBlendEquation",
                     "glMultiDrawArrays", "glWindowPos2i", "glSecondaryColor3ub", "glFogCoordf"):
            self.assertFalse(self.commands.all[name].later, name)

    def test_state_setters_exist_as_commands(self):
        for e in self.model.elements:
            if e.set:
                self.assertEqual(self.commands.all["gl" + e.set].way, "state", e.name)

    def refused(self, old, new):
        text = (PROTO / "commands.toml").read_text()
        self.assertIn(old, text)
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as f:
            f.write(text.replace(old, new, 1))
            f.flush()
            with self.assertRaises(AssertionError) as caught:
                commands.load(f.name, self.gl, self.model)
        return str(caught.exception)

    def test_mistakes_are_refused(self):
        self.assertIn("Begin of the OpenGL core has no class", self.refused('Begin = "hand"\n', ""))
        self.assertIn("no command glBegins in gl.xml", self.refused("\nBegin = ", "\nBegins = "))
        self.assertIn("Vertex9f is not implemented", self.refused("convert Vertex2f", "convert Vertex9f"))
        self.assertIn("unknown words", self.refused('Begin = "hand"', 'Begin = "hand often"'))


class Places(unittest.TestCase):
    """A mistake is refused with the file and the line where it stands."""

    def refused(self, name, old, new, load):
        text = (PROTO / name).read_text()
        self.assertIn(old, text)
        line = text[:text.index(old)].count("\n") + 1 + (old.startswith("\n"))
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as f:
            f.write(text.replace(old, new, 1))
            f.flush()
            with self.assertRaises(AssertionError) as caught:
                load(f.name)
            self.assertTrue(str(caught.exception).startswith(f"{f.name}:{line}: "), caught.exception)
        return str(caught.exception)

    def test_wire(self):
        self.assertIn("unknown type f16", self.refused("wire.toml", '"f32 u"', '"f16 u"', wire.load))
        self.assertIn("bytes come last", self.refused("wire.toml", '"enum map, bytes values"',
                                                      '"bytes values, enum map"', wire.load))

    def test_state(self):
        refused = functools.partial(self.refused, "state.toml", load=state.load)
        self.assertIn("unknown key", refused("\nfog_coord = {", "\nfog_coord = { colour = 1,"))
        self.assertIn("no `vec5`", refused('\nnormal = { type = "vec3"', '\nnormal = { type = "vec5"'))

    def test_commands(self):
        gl, model = registry.load(REGISTRY, PROTO / "extensions.xml"), state.load(PROTO / "state.toml")
        refused = functools.partial(self.refused, "commands.toml", load=lambda f: commands.load(f, gl, model))
        self.assertIn("unknown words", refused('Begin = "hand"', 'Begin = "hand often"'))
        self.assertIn("Vertex9f is not", refused('Vertex2i = "convert Vertex2f"', 'Vertex2i = "convert Vertex9f"'))

    def test_attributes(self):
        ops, model = wire.load(PROTO / "wire.toml"), state.load(PROTO / "state.toml")
        refused = functools.partial(self.refused, "attributes.toml", load=lambda f: attributes.load(f, ops, model))
        self.assertIn("no element of [current]", refused("\nnormal =", "\nnormals ="))
        self.assertIn("Clear: no command of [geometry]", refused('"Normal3f"', '"Clear"'))
        self.assertIn("a command with an index", refused('"VertexAttrib4f"', '"TexCoord4f"'))

    def test_attribute_arrays(self):
        ops, model = wire.load(PROTO / "wire.toml"), state.load(PROTO / "state.toml")
        refused = functools.partial(self.refused, "attributes.toml", load=lambda f: attributes.load(f, ops, model))
        self.assertIn("blend_color: no vertex array", refused('"normal_array"', '"blend_color"'))
        self.assertIn("normal_array: not as many as values", refused('"texcoord_array"', '"normal_array"'))
        self.assertIn("others: no line in [attribute]", refused('\nnormal = "normal_array"',
                                                                '\nothers = "normal_array"\nnormal = "normal_array"'))

    def texture_targets_refused(self, old, new):
        gl, model = registry.load(REGISTRY, PROTO / "extensions.xml"), state.load(PROTO / "state.toml")
        return self.refused("texture_targets.toml", old, new, lambda f: texture_targets.load(f, gl, model))

    def test_texture_targets(self):
        refused = self.texture_targets_refused
        self.assertIn("no element texture_binding_4d", refused("\n3d =", "\n4d ="))
        self.assertIn("unknown key face", refused("\ncube_map = { images = 2, faces =",
                                                  "\ncube_map = { images = 2, face ="))
        self.assertIn("no `size`", refused('size = "GL_MAX_3D_TEXTURE_SIZE 2048", ', ""))
        self.assertIn("images of 0 to 3", refused("\n2d = { images = 2", "\n2d = { images = 4"))
        self.assertIn("no GL_SAMPLER_5D", refused('"3D"', '"5D"'))
        self.assertIn("no GL_PROXY_TEXTURE_BUFFER", refused("proxy = false, ", ""))
        self.assertIn("no GL_TEXTURE_3D_POSITIVE_X", refused("\n3d = { images = 3,",
                                                             "\n3d = { images = 3, faces = true,"))

    def test_every_texture_binding_has_a_line_in_its_order(self):
        lines = (PROTO / "texture_targets.toml").read_text().splitlines(keepends=True)
        rectangle = next(line for line in lines if line.startswith("rectangle ="))
        others = [line for line in lines if line != rectangle]
        gl, model = registry.load(REGISTRY, PROTO / "extensions.xml"), state.load(PROTO / "state.toml")
        for text, why in (("".join(others), "no line for texture_binding_rectangle"),
                          ("".join(others) + rectangle, "not in the order of state.toml")):
            with tempfile.NamedTemporaryFile("w", suffix=".toml") as f:
                f.write(text)
                f.flush()
                with self.assertRaisesRegex(AssertionError, why):
                    texture_targets.load(f.name, gl, model)

    def test_texture_targets_have_what_their_lines_say(self):
        gl, model = registry.load(REGISTRY, PROTO / "extensions.xml"), state.load(PROTO / "state.toml")
        targets = {t.name: t for t in texture_targets.load(PROTO / "texture_targets.toml", gl, model)}
        cube = targets["cube_map"]
        self.assertEqual((cube.gl, cube.proxy, cube.first_face, cube.enabled.name, cube.constant),
                         ("GL_TEXTURE_CUBE_MAP", "GL_PROXY_TEXTURE_CUBE_MAP", "GL_TEXTURE_CUBE_MAP_POSITIVE_X",
                          "texture_cube_map_enabled", "cube_map"))
        buffer = targets["buffer"]
        self.assertEqual((buffer.proxy, buffer.first_face, buffer.enabled), (None, None, None))
        self.assertEqual(targets["2d"].constant, "t2d")

    def test_every_attribute_has_its_lines(self):
        ops, model = wire.load(PROTO / "wire.toml"), state.load(PROTO / "state.toml")
        text = (PROTO / "attributes.toml").read_text()
        commands, array = 'normal = "Normal3f"\n', 'normal = "normal_array"\n'
        for left, why in ((text.replace(commands, "").replace(array, ""), "no line for normal"),
                          (text.replace(array, ""), r"normal: no line in \[attribute_array\]")):
            with tempfile.NamedTemporaryFile("w", suffix=".toml") as f:
                f.write(left)
                f.flush()
                with self.assertRaisesRegex(AssertionError, why):
                    attributes.load(f.name, ops, model)


class Files(unittest.TestCase):
    def test_wire_opcodes_fit_a_byte_and_are_dense(self):
        ops = wire.load(PROTO / "wire.toml")
        self.assertEqual([op.code for op in ops], list(range(len(ops))))
        vertex = next(op for op in ops if op.name == "Vertex3f")
        self.assertEqual(vertex.fixed_bytes, 12)

    def test_ids_are_numbers_to_the_stream(self):
        text = (PROTO / "wire.toml").read_text()
        plain = re.sub(r"\b(?:surface|context|request|object) (?=[a-z_]+[,\"])", "u32 ", text)
        self.assertNotEqual(plain, text)
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as f:
            f.write(plain)
            f.flush()
            numbers = wire.load(f.name)
        ids, elements = wire.load(PROTO / "wire.toml"), state.load(PROTO / "state.toml").elements
        self.assertEqual([op.fixed_bytes for op in ids], [op.fixed_bytes for op in numbers])
        self.assertEqual(emit_wire.stream_version(ids, elements), emit_wire.stream_version(numbers, elements))
        swap = next(op for op in ids if op.name == "Swap")
        self.assertEqual([o.cpp for o in swap.operands], ["SurfaceId", "std::uint32_t"])

    def test_state_ids_are_dense(self):
        model = state.load(PROTO / "state.toml")
        following = 1
        for e in model.elements:
            self.assertEqual(e.id, following)
            self.assertEqual(e.bytes % 4, 0)
            following += e.count

    def test_a_list_of_values_that_no_element_names_is_refused(self):
        text = (PROTO / "state.toml").read_text()
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as f:
            f.write(text.replace("[valid]\n", '[valid]\nnobody = ["GL_ONE"]\n', 1))
            f.flush()
            with self.assertRaisesRegex(AssertionError, r":\d+: no element names the list nobody"):
                state.load(f.name)


if __name__ == "__main__":
    unittest.main()
