# SPDX-License-Identifier: MIT
"""gen/glapi/gl_functions.gen.h: the driver's functions as one table of pointers."""

from .text import header

NOTES = """
Every function of the OpenGL 4.6 compatibility profile (and a few extensions') as a pointer, named without the gl
prefix. Usage:

    glapi::GlFunctions gl;
    gl.load([](const char* name) { return reinterpret_cast<void*>(eglGetProcAddress(name)); });
    gl.Clear(GL_COLOR_BUFFER_BIT);          // gl.DispatchCompute == nullptr: the driver lacks it
"""


def functions_header(registry, extra):
    names = sorted(n for n, c in registry.commands.items() if c.gl) + sorted(extra)
    commands = [registry.commands[n] for n in names]
    out = [header("gl.xml", NOTES, ["<array>", "<cstddef>", "<cstring>", "",
                                    '"common/glapi/gl_types.h"']).replace("#include \n", "\n")]
    out.append("\nnamespace wall::glapi {\n\nstruct GlFunctions {\n")
    for c in commands:
        out.append(f"    {c.returns} (GLAPIENTRY* {c.short})({c.types}) = nullptr;\n")
    out.append("""
    /// Fills the table; `get` takes a name and returns a `void*`, null if there is no such function.
    template <class GetProcAddress>
    void load(GetProcAddress&& get);
};

""")
    out.append(f"inline constexpr std::array<const char*, {len(commands)}> kGlFunctionNames = {{\n")
    out += [f'    "{c.name}",\n' for c in commands]
    out.append("""};
static_assert(sizeof(GlFunctions) == kGlFunctionNames.size() * sizeof(void*));

template <class GetProcAddress>
void GlFunctions::load(GetProcAddress&& get) {
    for (std::size_t i = 0; i < kGlFunctionNames.size(); ++i) {
        void* function = get(kGlFunctionNames[i]);
        std::memcpy(reinterpret_cast<std::byte*>(this) + i * sizeof function, &function, sizeof function);
    }
}

}  // namespace wall::glapi
""")
    return "".join(out)
