# SPDX-License-Identifier: MIT
"""gen/client_lib/es.gen.h, es_tables.gen.cpp: the modes of an OpenGL ES context, its words, versions and extensions.
gen/client_lib/es_images.gen.h: what its images may be."""

from .text import header

_SOURCE = "gl.xml, proto/gl/commands.toml, proto/gl/es.toml"
_NOTES = "What contexts of OpenGL ES have. Versions are times ten: 11, 20, 30, 31, 32."


def es_header(es):
    return (header(_SOURCE, _NOTES, ["<span>\n", '"gen/client_lib/api.gen.h"\n']) +
            "namespace wall::client {\n\n"
            "/// A version of OpenGL ES, and its mode: each command at once; what it does not have is an error, and so "
            "is a word\n/// that it does not have.\n"
            "struct EsVersion {\n    int version;\n"
            "    const char* missing;  ///< a command of it that is not implemented; null: there is none\n"
            "    const GlTable* table;\n};\n"
            "extern const std::span<const EsVersion> kEsVersions;  ///< all that there are, in order\n\n"
            "struct EsExtension {\n    const char* name;\n"
            "    const char* node_word;  ///< what a node's driver must have for it; empty: nothing\n"
            "    bool implemented;\n"
            "    bool first, later;  ///< whether contexts of OpenGL ES 1.1 have it; those of the others\n};\n"
            "extern const std::span<const EsExtension> kEsExtensions;  ///< by name\n\n"
            "/// A word, and the first version from 2.0 on that has it.\n"
            "struct EsWord {\n    GLenum value;\n    int since;   ///< 0: none\n"
            "    bool first;  ///< whether OpenGL ES 1.1 has it\n};\n"
            "extern const std::span<const EsWord> kEsWords;  ///< by value\n\n"
            "}  // namespace wall::client\n")


def images_header(es):
    images = "".join(f"    {{{i.internal}, {i.format}, {i.type}, {i.told}, {_flag(i.first)}}},\n" for i in es.images)
    drawn = "".join(f"    {{{word}, {_number(since)}}},\n" for word, since in es.drawn.items())
    return (header("gl.xml, proto/gl/es.toml", "What images of OpenGL ES may be made of, and which may be drawn to.",
                   ['"common/glapi/gl_types.h"\n']) +
            "namespace wall::client {\n\n"
            "/// An image of a texture, as a program describes it.\n"
            "struct EsImageRow {\n    GLenum internal_format, format, type;\n"
            "    GLint desktop_format;  ///< the internal format that OpenGL has for it\n"
            "    bool first;            ///< of OpenGL ES 1.1, not of the later versions\n};\n"
            f"inline constexpr EsImageRow kEsImages[] = {{\n{images}}};\n\n"
            "/// An internal format, as OpenGL names it, that images are drawn to from that version on (times ten).\n"
            "struct EsDrawnRow {\n    GLenum internal_format;\n    unsigned since;\n};\n"
            f"inline constexpr EsDrawnRow kEsDrawn[] = {{\n{drawn}}};\n\n"
            "}  // namespace wall::client\n")


def es_source(es):
    canonical = es.commands.canonical
    out = [header(_SOURCE, "The modes of a context of OpenGL ES as tables, and its words.", [], pragma=False),
           '#include "client_lib/context/es_words.h"\n#include "client_lib/context/context.h"\n'
           '#include "gen/client_lib/es.gen.h"\n\nnamespace wall::client {\nnamespace {\n\n'
           "/// A command that OpenGL ES does not have.\n"
           "template <class Function>\nstruct Refused;\n"
           "template <class R, class... A>\nstruct Refused<R (*)(Context&, A...)> {\n"
           "    static R call(Context& c, A...) {\n        c.error(GL_INVALID_OPERATION);\n        return R();\n    }\n"
           "};\n\n"
           "/// A command some of whose parameters are words, a bit each.\n"
           "template <auto kCommand, unsigned kWords, class Function>\nstruct Worded;\n"
           "template <auto kCommand, unsigned kWords, class R, class... A>\n"
           "struct Worded<kCommand, kWords, R (*)(Context&, A...)> {\n"
           "    static R call(Context& c, A... a) {\n"
           "        if (!are_es_words<kWords>(c.profile.es, a...)) {\n            c.error(GL_INVALID_ENUM);\n"
           "            return R();\n        }\n        return kCommand(c, a...);\n    }\n};\n\n"]
    for version in es.versions:
        slots = es.slots(version)
        out.append(f"const GlTable kEs{_number(version)} = {{\n"
                   + "".join(f"    {_entry(es, i) if i.name in slots else _refused(i)},\n" for i in canonical)
                   + "};\n\n")
    out.append("const EsVersion kEsVersionTable[] = {\n"
               + "".join(f"    {{{_number(v)}, {_text(es.missing(v))}, &kEs{_number(v)}}},\n" for v in es.versions)
               + "};\n\nconst EsExtension kExtensionTable[] = {\n"
               + "".join(f'    {{"{e.name}", "{e.node_word}", {_flag(not e.missing)}, {_flag("gles1" in e.apis)}, '
                         f'{_flag("gles2" in e.apis)}}},\n' for e in es.extensions)
               + "};\n\nconst EsWord kWordTable[] = {\n" + _word_rows(es)
               + "};\n\n}  // namespace\n\n"
               "const std::span<const EsVersion> kEsVersions = kEsVersionTable;\n"
               "const std::span<const EsExtension> kEsExtensions = kExtensionTable;\n"
               "const std::span<const EsWord> kEsWords = kWordTable;\n\n}  // namespace wall::client\n")
    return "".join(out)


def _word_rows(es):
    first, later = es.words("gles1"), es.words("gles2")
    rows = [(value, _number(later[value]) if value in later else 0, value in first)
            for value in sorted(first.keys() | later.keys()) if value <= 0xFFFF]
    return "".join(f"    {{0x{value:04x}, {since}, {_flag(in_first)}}},\n" for value, since, in_first in rows)


def _flag(value):
    return "true" if value else "false"


def _number(version):
    return version[0] * 10 + version[1]


def _text(name):
    return f'"{name}"' if name else "nullptr"


def _refused(i):
    return f"&Refused<decltype(GlTable::{i.name})>::call"


def _entry(es, i):
    words = sum(1 << place for place in es.checked(i))
    return f"&Worded<&api::{i.name}, {words}, decltype(GlTable::{i.name})>::call" if words else f"&api::{i.name}"
