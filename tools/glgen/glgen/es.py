# SPDX-License-Identifier: MIT
"""OpenGL ES: what each version of gl.xml has, and the extensions of proto/gl/es.toml."""

from dataclasses import dataclass

from . import data


@dataclass
class Extension:
    name: str
    node_word: str      # that a node's driver must have; "": none
    commands: list      # full names, sorted
    missing: str | None     # one of them that is not implemented


@dataclass(frozen=True)
class Image:
    """A texture's image, as a program describes it."""
    internal: str
    format: str
    type: str
    told: str           # the internal format that OpenGL has for it


@dataclass
class EsModel:
    versions: list      # (major, minor), in order
    extensions: list    # of Extension, by name
    registry: object
    commands: object
    more_words: list    # in every version
    numbers: dict       # short name of a command -> its parameter of type GLenum that is none
    images: list        # of Image
    drawn: dict         # internal format that may be drawn to -> the version that brought it

    def missing(self, version):
        """A command of exactly this version that is not implemented; None: there is none."""
        return next((name for name in sorted(self.registry.es_features[version].commands)
                     if self.commands.all[name].later), None)

    def slots(self, version):
        """Names of the implemented commands that a context of this version may call, extensions' included."""
        names = {name for v in self.versions if v <= version for name in self.registry.es_features[v].commands}
        names |= {name for e in self.extensions if not e.missing for name in e.commands}
        return {slot for name in names if (slot := self._slot(self.commands.all[name]))}

    def _slot(self, i):
        if i.later:
            return None
        if self.commands.has_slot(i):
            return i.name
        if i.way in ("convert", "as"):
            return i.target
        family, _ = self.commands.family_of(i.name)
        return family + self.commands.families[family]["form"]

    def words(self):
        """Value of each word -> the first version that has it; that of an extension is there from the first on."""
        out = {}
        named = [(v, name) for v in self.versions for name in self.registry.es_features[v].enums]
        named += [(self.versions[0], name) for e in self.extensions if not e.missing
                  for name in self.registry.es_extensions[e.name].enums]
        named += [(self.versions[0], name) for name in self.more_words]
        for version, name in named:
            if name in self.registry.bitmasks:
                continue
            value = self.registry.enums[name]
            out[value] = min(out.get(value, version), version)
        return out

    def checked(self, i):
        """Places of the parameters that are words."""
        number = self.numbers.get(i.name)
        return [n for n, p in enumerate(i.command.params) if p.type == "GLenum" and p.name != number]


def load(path, registry, commands):
    file = data.load(path)
    extensions = []
    for name, node_word in file.sections["extensions"].items():
        with file.line("extensions", name):
            assert name in registry.es_extensions, f"no extension {name} of OpenGL ES in gl.xml"
            assert node_word == "" or node_word.startswith("GL_"), f"{node_word!r} is no word of OpenGL"
            names = sorted(registry.es_extensions[name].commands)
            missing = next((n for n in names if commands.all[n].later), None)
            extensions.append(Extension(name, node_word, names, missing))
    for name, parameter in file.sections["numbers"].items():
        with file.line("numbers", name):
            params = registry.commands["gl" + name].params
            assert any(p.name == parameter and p.type == "GLenum" for p in params), f"no GLenum {parameter}"
    for name in file.sections["words"]:
        with file.line("words", name):
            assert name in registry.enums, f"no word {name}"
    versions = sorted(v for v in registry.es_features if v[0] >= 2)
    return EsModel(versions, sorted(extensions, key=lambda e: e.name), registry, commands,
                   list(file.sections["words"]), file.sections["numbers"], _images(file, registry),
                   _drawn(file, registry, versions))


def _known(registry, words):
    for word in words:
        assert word in registry.enums, f"no word {word}"


def _images(file, registry):
    images = []
    for internal, text in file.sections["images"].items():
        with file.line("images", internal):
            for part in text.split(","):
                form, *types = part.split()
                assert types, f"{form} has no type"
                for word in types:
                    kind, _, told = word.partition(":")
                    images.append(Image(internal, form, kind, told or internal))
                    _known(registry, (internal, form, kind, told or internal))
            assert len(set(images)) == len(images), "the same image twice"
    return images


def _drawn(file, registry, versions):
    drawn = {}
    for version, text in file.sections["drawn"].items():
        with file.line("drawn", version):
            since = tuple(int(x) for x in version.split("."))
            assert since in versions, f"no version {version} of OpenGL ES"
            _known(registry, text.split())
            for word in text.split():
                assert word not in drawn, f"{word} is there already"
                drawn[word] = since
    return drawn
