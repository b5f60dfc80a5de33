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
    apis: frozenset     # "gles1": contexts of OpenGL ES 1.1 have it; "gles2": those of the others


@dataclass(frozen=True)
class Image:
    """A texture's image, as a program describes it."""
    internal: str
    format: str
    type: str
    told: str           # the internal format that OpenGL has for it
    first: bool = False     # of OpenGL ES 1.1, not of the later versions


@dataclass
class EsModel:
    versions: list      # (major, minor), in order; the first one, 1.1, has nothing in common with the others
    extensions: list    # of Extension, by name
    registry: object
    commands: object
    more_words: dict    # "gles1", "gles2" -> those in every version
    numbers: dict       # short name of a command -> those of its parameters of type GLenum that are none
    images: list        # of Image
    drawn: dict         # internal format that may be drawn to -> the version that brought it

    def missing(self, version):
        """A command of exactly this version that is not implemented; None: there is none."""
        return next((name for name in sorted(self.registry.es_features[version].commands)
                     if self.commands.all[name].later), None)

    @staticmethod
    def api(version):
        return "gles1" if version[0] == 1 else "gles2"

    def features(self, api):
        """The versions of an API, with what each brought, in order."""
        return [(v, self.registry.es_features[v]) for v in self.versions if self.api(v) == api]

    def offered(self, api):
        """Its extensions whose commands are there."""
        return [e for e in self.extensions if api in e.apis and not e.missing]

    def slots(self, version):
        """Names of the implemented commands that a context of this version may call, extensions' included."""
        api = self.api(version)
        names = {name for v, feature in self.features(api) if v <= version for name in feature.commands}
        names |= {name for e in self.offered(api) for name in e.commands}
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

    def words(self, api="gles2"):
        """Value of each word -> the first version that has it; that of an extension is there from the first on."""
        out = {}
        features = self.features(api)
        first = features[0][0]
        named = [(v, name) for v, feature in features for name in feature.enums]
        named += [(first, name) for e in self.offered(api) for name in self.registry.es_extensions[e.name].enums]
        named += [(first, name) for name in self.more_words[api]]
        for version, name in named:
            if name in self.registry.bitmasks:
                continue
            value = self.registry.enums[name]
            out[value] = min(out.get(value, version), version)
        return out

    def checked(self, i):
        """Places of the parameters that are words."""
        numbers = self.numbers.get(i.name, "").split()
        return [n for n, p in enumerate(i.command.params) if p.type == "GLenum" and p.name not in numbers]


def _extensions(file, section, registry, commands):
    out = []
    for name, node_word in file.sections[section].items():
        with file.line(section, name):
            assert name in registry.es_extensions, f"no extension {name} of OpenGL ES in gl.xml"
            assert node_word == "" or node_word.startswith("GL_"), f"{node_word!r} is no word of OpenGL"
            listed = registry.es_extensions[name]
            names = sorted(listed.commands)
            missing = next((n for n in names if commands.all[n].later), None)
            apis = frozenset({"gles1"} if section == "extensions_1" else listed.apis)
            out.append(Extension(name, node_word, names, missing, apis))
    return out


def load(path, registry, commands):
    file = data.load(path)
    extensions = _extensions(file, "extensions", registry, commands)
    extensions += _extensions(file, "extensions_1", registry, commands)
    assert len({e.name for e in extensions}) == len(extensions), f"{path}: an extension twice"
    for name, parameters in file.sections["numbers"].items():
        with file.line("numbers", name):
            words = [p.name for p in registry.commands["gl" + name].params if p.type == "GLenum"]
            assert set(parameters.split()) <= set(words), f"no GLenum {parameters}"
    words = {"gles1": "words_1", "gles2": "words"}
    for section in words.values():
        for name in file.sections[section]:
            with file.line(section, name):
                assert name in registry.enums, f"no word {name}"
    versions = sorted(registry.es_features)
    return EsModel(versions, sorted(extensions, key=lambda e: e.name), registry, commands,
                   {api: list(file.sections[section]) for api, section in words.items()},
                   file.sections["numbers"], _images(file, "images", registry) + _images(file, "images_1", registry),
                   _drawn(file, registry, versions))


def _known(registry, words):
    for word in words:
        assert word in registry.enums, f"no word {word}"


def _images(file, section, registry):
    images = []
    for internal, text in file.sections[section].items():
        with file.line(section, internal):
            for part in text.split(","):
                form, *types = part.split()
                assert types, f"{form} has no type"
                for word in types:
                    kind, _, told = word.partition(":")
                    images.append(Image(internal, form, kind, told or internal, section == "images_1"))
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
