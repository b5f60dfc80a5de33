# SPDX-License-Identifier: MIT
"""Context state (proto/gl/state.toml) as values: categories of elements. The file's head explains the keys."""

from dataclasses import dataclass, field

from . import data

UNITS = 8

# type -> (C++ type, component type, components, bytes)
TYPES = {
    "flag": ("Flag", "flag", 1, 4),
    "enum": ("GLenum", "enum", 1, 4),
    "i32": ("std::int32_t", "i32", 1, 4),
    "u32": ("std::uint32_t", "u32", 1, 4),
    "u64": ("std::uint64_t", "u64", 1, 8),
    "float": ("float", "float", 1, 4),
    "double": ("double", "double", 1, 8),
    "vec2": ("Vec2", "float", 2, 8),
    "vec3": ("Vec3", "float", 3, 12),
    "vec4": ("Vec4", "float", 4, 16),
    "mat4": ("Mat4", "float", 16, 64),
    "words32": ("Words32", "u32", 32, 128),
}

GROUP_BITS = {
    "current": "GL_CURRENT_BIT", "point": "GL_POINT_BIT", "line": "GL_LINE_BIT", "polygon": "GL_POLYGON_BIT",
    "polygon_stipple": "GL_POLYGON_STIPPLE_BIT", "pixel": "GL_PIXEL_MODE_BIT", "lighting": "GL_LIGHTING_BIT",
    "fog": "GL_FOG_BIT", "depth_buffer": "GL_DEPTH_BUFFER_BIT", "accum_buffer": "GL_ACCUM_BUFFER_BIT",
    "stencil_buffer": "GL_STENCIL_BUFFER_BIT", "viewport": "GL_VIEWPORT_BIT", "transform": "GL_TRANSFORM_BIT",
    "enable": "GL_ENABLE_BIT", "color_buffer": "GL_COLOR_BUFFER_BIT", "hint": "GL_HINT_BIT", "eval": "GL_EVAL_BIT",
    "list": "GL_LIST_BIT", "texture": "GL_TEXTURE_BIT", "scissor": "GL_SCISSOR_BIT",
    "multisample": "GL_MULTISAMPLE_BIT",
}
CLIENT_GROUP_BITS = {"pixel_store": "GL_CLIENT_PIXEL_STORE_BIT", "vertex_array": "GL_CLIENT_VERTEX_ARRAY_BIT"}


@dataclass(frozen=True)
class Field:
    type: str       # key of TYPES
    name: str       # "" for the only component(s) of a plain element
    offset: int     # bytes from the value's start

    @property
    def components(self):
        return TYPES[self.type][2]


@dataclass
class Element:
    name: str
    category: str
    id: int
    cpp: str            # C++ type of the value
    fields: tuple       # of Field
    count: int
    index: str          # "" if count is 1
    defaults: list      # one C++ initializer per index
    groups: tuple
    client_groups: tuple
    keys: dict = field(repr=False, default_factory=dict)    # the line itself
    place: str = field(repr=False, default="state.toml")    # of that line

    @property
    def plain(self):
        return len(self.fields) == 1 and not self.fields[0].name

    @property
    def bytes(self):
        last = self.fields[-1]
        return last.offset + TYPES[last.type][3]

    # cap, get, set, param, emit, hand, norm, bits, valid, min, max, above, below, clamp, name...
    def __getattr__(self, key):
        if key in _OPTIONAL:
            return self.keys.get(key)
        raise AttributeError(key)

    def of_field(self, key, field_name):
        """The value of a key that is given for the whole element or by field."""
        value = self.keys.get(key)
        return value.get(field_name) if isinstance(value, dict) else value

    @property
    def getters(self):
        """(pname, first index, field, components) of each word that glGet answers."""
        out = []
        if self.cap:
            out += [(word, i, self.fields[0], 1) for word, i in self.caps]
        get = self.get or {}
        for field_name, words in (get.items() if isinstance(get, dict) else [(self.fields[0].name, get)]):
            f = next(f for f in self.fields if f.name == field_name)
            words = words.split()
            whole = not isinstance(get, dict)
            for n, word in enumerate(words):
                word, _, given = word.partition(":")
                components = int(given) if given else sum(x.components for x in self.fields) if whole else f.components
                first = n if self.index == "face" and len(words) == self.count else 0
                if self.index == "face" and len(words) == 1:
                    components = self.count
                out.append((word, first, f, components))
        return out

    @property
    def caps(self):
        """(word, first index) of each glEnable word."""
        if not self.cap:
            return []
        if self.index in ("light", "clip_plane"):
            stem = self.cap[:-1]
            return [(f"{stem}{i}", i) for i in range(self.count)]
        if self.index == "coord":
            return [(self.cap[:-1] + c, i) for i, c in enumerate("STRQ")]
        return [(self.cap, 0)]

    @property
    def unit_stride(self):
        return {"unit": 1, "client_unit": 1, "coord": 4}.get(self.index, 0)

    @property
    def units(self):
        """How many units have a value; 0: it is not by units."""
        return self.count // self.unit_stride if self.unit_stride else 0

    @property
    def family(self):
        return self.param.split()[0] if self.param else None

    @property
    def param_target(self):
        parts = self.param.split()
        return parts[1] if len(parts) == 3 else None

    @property
    def pname(self):
        return self.param.split()[-1]

    @property
    def name_of(self):
        """Kind of object that the value names, or None."""
        return self.keys.get("name")

    @property
    def emit_custom(self):
        return self.emit == "custom"


_OPTIONAL = {"cap", "get", "set", "param", "emit", "hand", "norm", "valid", "min", "max", "above", "below", "clamp",
             "args", "or", "invalid", "bits", "forward_max", "rest", "when"}
_KEYS = _OPTIONAL | {"name", "type", "fields", "value", "default", "defaults", "count", "index", "groups",
                     "client_groups"}


@dataclass
class Category:
    name: str
    note: str
    sent: bool
    elements: list

    @property
    def struct(self):
        return "".join(part.capitalize() for part in self.name.split("_")) + "State"


@dataclass
class StateModel:
    categories: list
    valid: dict         # name -> list of enums (or numbers, as text)
    families: dict      # name -> keys
    structs: dict       # struct name -> tuple of Field, in order of appearance
    conditions: dict    # name of [when] -> words

    def switches(self, element):
        """The elements of which any must be on for this one to matter; none: it always does."""
        by_name = {e.name: e for e in self.elements}

        def resolve(word):
            if word in self.conditions:
                return [e for part in self.conditions[word].split() for e in resolve(part)]
            return [by_name[word]]
        return resolve(element.when) if element.when else []

    @property
    def elements(self):
        return [e for c in self.categories for e in c.elements]

    @property
    def last_id(self):
        last = self.elements[-1]
        return last.id + last.count - 1


def _fields(text):
    fields, offset = [], 0
    for part in text.split(","):
        type_, name = part.split()
        size = TYPES[type_][3]
        assert offset % (8 if type_ in ("u64", "double") else 4) == 0, f"{text}: padding"
        fields.append(Field(type_, name, offset))
        offset += size
    return tuple(fields)


def _literal(type_, value):
    if isinstance(value, bool):
        return "1" if value else "0"
    if isinstance(value, str):
        return value
    if type_ == "float":
        return f"{float(value)}f"
    if type_ == "double":
        return repr(float(value))
    if type_ in ("u32", "u64") and value > 0x7FFFFFFF:
        return f"0x{value:x}u"
    return str(value)


def _initializer(fields, plain, value, index):
    if value == "identity":
        return "kIdentity"
    if value == "plane":
        value = {0: [1, 0, 0, 0], 1: [0, 1, 0, 0]}.get(index % 4, [0, 0, 0, 0])
    if plain:
        component = TYPES[fields[0].type][1]
        if fields[0].components == 1:
            return _literal(component, value)
        if not isinstance(value, list):
            return f"filled<{TYPES[fields[0].type][0]}>({_literal(component, value)})"
        return "{" + ", ".join(_literal(component, v) for v in value) + "}"
    assert len(value) == len(fields), f"{value}: one default per field"
    return "{" + ", ".join(_literal(f.type, v) for f, v in zip(fields, value)) + "}"


def _camel(name):
    return "".join(part.capitalize() for part in name.split("_"))


def _element(name, category, keys, next_id, structs, shared):
    unknown = set(keys) - _KEYS
    assert not unknown, f"unknown key {unknown}"
    if "type" in keys:
        fields = (Field(keys["type"], "", 0),)
        cpp = TYPES[keys["type"]][0]
    else:
        fields = _fields(shared[keys["value"]] if "value" in keys else keys["fields"])
        cpp = keys.get("value") or _camel(name)
        assert structs.setdefault(cpp, fields) == fields, f"another {cpp} than before"
    count = keys.get("count", 1)
    special = {int(k): v for k, v in keys.get("defaults", {}).items()}
    defaults = [_initializer(fields, "type" in keys, special.get(i, keys["default"]), i) for i in range(count)]
    groups = set(keys.get("groups", category.get("_groups", "")).split())
    if "cap" in keys and "client_groups" not in keys:
        groups.add("enable")
    return Element(name, "", next_id, cpp, fields, count, keys.get("index", ""), defaults, tuple(sorted(groups)),
                   tuple(keys.get("client_groups", "").split()), keys)


def _named_lists(elements):
    """The lists of [valid] that elements name, for all their fields or for single ones."""
    return {name for e in elements for f in e.fields for name in [e.of_field("valid", f.name)] if isinstance(name, str)}


def load(path):
    file = data.load(path)
    sections = dict(file.sections)
    valid, families, shared = sections.pop("valid"), sections.pop("family"), sections.pop("value")
    conditions = sections.pop("when")
    categories, structs, names, next_id = [], {}, set(), 1
    for name, lines in sections.items():
        attributes = {k: v for k, v in lines.items() if k.startswith("_")}
        elements = []
        for element_name, keys in lines.items():
            if element_name.startswith("_"):
                continue
            with file.line(name, element_name):
                e = _element(element_name, attributes, keys, next_id, structs, shared)
                e.category, e.place = name, file.place(name, element_name)
                assert not e.param or e.family in families, f"no family {e.family}"
                assert element_name not in names, "an element's name twice"
            names.add(element_name)
            elements.append(e)
            next_id += e.count
        categories.append(Category(name, attributes.get("_note", ""), not attributes.get("_unsent", False), elements))
    model = StateModel(categories, valid, families, structs, conditions)
    for e in model.elements:
        words = [e.when] if e.when else []
        while words:
            word = words.pop()
            if word not in names and word not in conditions:
                file.refuse(f"neither an element nor a name of [when]: {word}", e.category, e.name)
            words += conditions.get(word, "").split() if word not in names else []
    for before, category in zip(categories, categories[1:]):
        if category.sent and not before.sent:
            file.refuse("unsent categories must be the last ones (their elements do not travel)", before.name)
    unused = set(valid) - _named_lists(model.elements)
    for name in sorted(unused):
        file.refuse(f"no element names the list {name}", "valid", name)
    return model
