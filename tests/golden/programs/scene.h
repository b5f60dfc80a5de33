// SPDX-License-Identifier: MIT
// A scene draws deterministic frames that exercise one part of OpenGL 1.1. It is run on plain Mesa and on walls, and
// what it shows and says must be the same. A scene registers itself: SCENE(name, frames) { ... uses frame, canvas ... }
#pragma once

#define GL_GLEXT_PROTOTYPES 1
#include <GL/gl.h>
#include <GL/glext.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace golden {

struct Size {
    int width = 400, height = 300;
};

/// What a scene needs of its window.
struct Needs {
    bool double_buffered = true;
    bool egl = false;
    int es = 0;       ///< a context of that version of OpenGL ES, by EGL
    int samples = 0;  ///< of a pixel, of which pixels are made before a frame is read; there is no accumulation buffer
    bool stencil = true;
    bool srgb = false;       ///< Mesa keeps what golden.py takes away from it otherwise: sRGB in framebuffers
    bool asks_srgb = false;  ///< asks for a window that has it
    bool stereo = false;     ///< buffers for two eyes; where there are none, it draws what one of them sees
    GLenum read = 0;         ///< buffer to read the frame from; 0: the one that is drawn to by default
    /// Its shaders write memory while they draw to the window: a tile shows a part of what the whole window would.
    bool whole = false;
};

struct Scene {
    std::string name;
    int frames;
    void (*draw)(int frame, Size canvas);
    Needs needs;
};

std::vector<Scene>& scenes();

struct Register {
    Register(const char* name, int frames, void (*draw)(int, Size), Needs needs = {}) {
        scenes().push_back({name, frames, draw, needs});
    }
};

/// A line of results, compared like the pixels. printf-like; floats are best given as %.5g.
void say(const char* format, ...) __attribute__((format(printf, 1, 2)));
/// Says the sticky error, if there is one.
void say_error(const char* where);

// --- drawing helpers ---

/// Clears colour, depth and stencil; identity matrices; everything enabled before by a scene stays.
void clear(float r = 0, float g = 0, float b = 0);
/// Window pixels, origin bottom left.
void pixel_view(Size canvas);
/// A perspective view of the unit scene: 60 degrees, looking at the origin from (0, 0, 3).
void perspective_view(Size canvas);
/// One of a grid of cells: makes [-1, 1]^2 cover cell `index` of `columns` x `rows` by the projection matrix.
void cell_view(int index, int columns, int rows);

/// Radius 1, with normals and texture coordinates; without its poles no quad is degenerate.
void lit_sphere(int slices = 24, int stacks = 12, bool poles = true);
void unit_square();      ///< [-1, 1]^2 at z = 0, texture coordinates 0..1, normal +z
unsigned random_bits();  ///< a fixed sequence, started anew for every frame
float random_unit();     ///< 0..1
std::vector<GLubyte> random_image(std::size_t bytes);
void restart_random();
/// Attributes have the locations 0, 1 ... in that order. Says if it does not link.
GLuint linked_program(const char* vertex, const char* fragment, std::initializer_list<const char*> attributes);
void checker_texture(GLuint name, int size);  ///< RGBA, coloured checks with a varying alpha; nearest, repeat

#define SCENE(NAME, FRAMES, ...)                                                                 \
    static void scene_##NAME(int frame, ::golden::Size canvas);                                  \
    static const ::golden::Register register_##NAME{#NAME, FRAMES, scene_##NAME, ##__VA_ARGS__}; \
    static void scene_##NAME([[maybe_unused]] int frame, [[maybe_unused]] ::golden::Size canvas)

}  // namespace golden
