# SPDX-License-Identifier: MIT
"""Texture targets (proto/gl/texture_targets.toml) as values. The file's head explains the keys."""

from dataclasses import dataclass

from . import data

_KEYS = {"images", "layers", "faces", "square", "mipmaps", "repeats", "blocks", "proxy", "size", "samplers", "global",
         "samples"}


@dataclass(frozen=True)
class Target:
    name: str
    binding: object         # state.Element: what is bound
    enabled: object         # state.Element: the switch of the fixed functions; None if there is none
    keys: dict              # the line itself
    size_name: str          # glGet's word for the largest image
    size_otherwise: int     # and what it is where nobody has said so

    @property
    def constant(self):
        """Its enumerator in C++."""
        return f"t{self.name}" if self.name[0].isdigit() else self.name

    @property
    def gl(self):
        return f"GL_TEXTURE_{self.name.upper()}"

    @property
    def proxy(self):
        """GL's name; None if there is none."""
        return f"GL_PROXY_TEXTURE_{self.name.upper()}" if self.says("proxy", True) else None

    @property
    def first_face(self):
        return f"{self.gl}_POSITIVE_X" if self.says("faces") else None

    @property
    def samplers(self):
        """Of floats, of integers and unsigned ones; those that compare are of floats alone."""
        words = self.keys.get("samplers", "").split()
        whole = [word for word in words if not word.endswith("_SHADOW")]
        return ([f"GL_SAMPLER_{word}" for word in words] + [f"GL_INT_SAMPLER_{word}" for word in whole]
                + [f"GL_UNSIGNED_INT_SAMPLER_{word}" for word in whole])

    def says(self, key, otherwise=False):
        return self.keys.get(key, otherwise)


def load(path, gl, model):
    """`gl`: registry.Registry, which knows the enumerants; `model`: state.StateModel."""
    file = data.load(path)
    elements = {e.name: e for e in model.elements}
    bindings = [e.name for e in model.elements if e.name.startswith("texture_binding_")]
    targets = []
    for name, keys in file.sections["texture_target"].items():
        with file.line("texture_target", name):
            targets.append(_target(name, keys, elements, gl))
    described = [t.binding.name for t in targets]
    missing = sorted(set(bindings) - set(described))
    if missing:
        file.refuse(f"no line for {', '.join(missing)} of state.toml", "texture_target")
    if described != bindings:
        file.refuse("not in the order of state.toml", "texture_target")
    return targets


def _target(name, keys, elements, gl):
    unknown = set(keys) - _KEYS
    assert not unknown, f"unknown key {', '.join(sorted(unknown))}"
    binding = elements.get(f"texture_binding_{name}")
    assert binding, f"no element texture_binding_{name} in state.toml"
    enabled = elements.get(f"texture_{name}_enabled")
    assert not enabled or enabled.count <= binding.count, f"{enabled.name} has more units than {binding.name}"
    assert keys["images"] in range(4), "images of 0 to 3 dimensions"
    assert keys.get("layers", 0) in (0, 1, 6), "layers by ones or sixes"
    size_name, size = keys["size"].split()
    target = Target(name, binding, enabled, keys, size_name, int(size))
    for word in filter(None, (target.gl, target.proxy, target.first_face, size_name, *target.samplers)):
        assert word in gl.enums, f"no {word} in gl.xml"
    return target
