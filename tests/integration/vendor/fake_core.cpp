// SPDX-License-Identifier: MIT
// A core without a wall: GL calls do nothing, frames are counted. What the vendors ask of it goes to the log as
// `fake_...` events, which the vendor tests read. WALLGL_FAKE_REFUSE=1: no wall can be reached;
// WALLGL_FAKE_NO_MEMORY=1: what makes something throws.
#include <GL/gl.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

#include "client_lib/context/core.h"
#include "client_lib/process/log.h"

namespace wall::client {

class Context {
public:
    ContextOptions options;
    std::atomic<bool> in_use{false};
};

class ClientSurface {
public:
    explicit ClientSurface(SurfaceOptions o) : options(std::move(o)), id(++last) {
        log(LogLevel::info,
            "fake_surface_made id=%d visible=%d size=%ux%u double=%d alpha=%d depth=%d stencil=%d samples=%d "
            "srgb=%d stereo=%d title=%s",
            id, options.visible, options.size.width, options.size.height, options.format.double_buffered,
            options.format.alpha_bits, options.format.depth_bits, options.format.stencil_bits, options.format.samples,
            options.format.srgb, options.format.stereo, options.title.c_str());
    }
    ~ClientSurface() { log(LogLevel::info, "fake_surface_gone id=%d", id); }
    Extent now() const { return options.query_size ? options.query_size().value_or(options.size) : options.size; }

    const SurfaceOptions options;
    const int id;
    int frame = 0;
    static inline std::atomic<int> last{0};
};

namespace {

thread_local std::shared_ptr<Context> current;

const GLubyte* get_string(GLenum name) {
    const char* text = "";
    if (name == GL_VENDOR) text = "WallGL";
    if (name == GL_RENDERER) text = "fake core";
    if (name == GL_VERSION) text = "2.1 WallGL fake";
    if (name == 0x8B8C) text = "1.20";  // GL_SHADING_LANGUAGE_VERSION
    return reinterpret_cast<const GLubyte*>(text);
}

void get_integer(GLenum, GLint* value) { *value = 4; }  // a plausible alignment, limit, size, ...
void get_float(GLenum, GLfloat* value) { *value = 1; }
void new_list(GLuint list, GLenum) { log(LogLevel::info, "fake_call name=glNewList list=%u", list); }

void bitmap(GLsizei width, GLsizei height, GLfloat x, GLfloat y, GLfloat dx, GLfloat dy, const GLubyte* bits) {
    int ink = 0;
    for (GLsizei i = 0; bits && i < (width + 7) / 8 * height; ++i) ink += __builtin_popcount(bits[i]);
    log(LogLevel::info, "fake_bitmap size=%dx%d origin=%g,%g move=%g,%g ink=%d", width, height, x, y, dx, dy, ink);
}

GLuint gen_lists(GLsizei) { return 1; }
GLboolean true_function() { return GL_TRUE; }
long no_function() { return 0; }

void ask_for_memory() {
    if (std::getenv("WALLGL_FAKE_NO_MEMORY")) throw std::bad_alloc();
}

void gen_names(GLsizei n, GLuint* names) {
    for (GLsizei i = 0; i < n; ++i) names[i] = static_cast<GLuint>(i + 1);
}

}  // namespace

std::shared_ptr<ClientSurface> create_surface(SurfaceOptions options) {
    ask_for_memory();
    return std::make_shared<ClientSurface>(std::move(options));
}

bool offers_es(int major) { return major == 1 || major == 2; }

std::shared_ptr<Context> create_context(const ContextOptions& options) {
    ask_for_memory();
    log(LogLevel::info, "fake_context version=%d.%d core=%d shared=%d es=%d robust=%d resets=%d", options.major,
        options.minor, options.core_profile, options.share != nullptr, options.es, options.robust,
        options.notifies_of_resets);
    if (options.core_profile || options.major > 2 || (options.es && !offers_es(options.major))) return nullptr;
    auto context = std::make_shared<Context>();
    context->options = options;
    return context;
}

bool make_current(std::shared_ptr<Context> context, std::shared_ptr<ClientSurface> draw,
                  std::shared_ptr<ClientSurface>) {
    if (context) ask_for_memory();
    if (std::getenv("WALLGL_FAKE_REFUSE")) {
        complain_once("no wall at unix:/nowhere");
        return !context;
    }
    if (context && context != current && context->in_use.exchange(true)) return false;
    if (current && current != context) current->in_use = false;
    if (context)
        log(LogLevel::info, "fake_current surface=%d size=%ux%u", draw->id, draw->now().width, draw->now().height);
    current = std::move(context);
    return true;
}

void copy_context(Context&, Context&, std::uint32_t mask) { log(LogLevel::info, "fake_copy mask=0x%x", mask); }

Context* current_context() { return current.get(); }

void swap_buffers(ClientSurface& surface) {
    const auto size = surface.now();
    log(LogLevel::info, "fake_swap surface=%d frame=%d size=%ux%u", surface.id, ++surface.frame, size.width,
        size.height);
}

Extent surface_size(const ClientSurface& surface) { return surface.now(); }
void flush_current(bool) {}

ProcAddress gl_proc_address(const char* name) {
    const auto is = [name](const char* other) { return std::strcmp(name, other) == 0; };
    if (is("glGetString")) return reinterpret_cast<ProcAddress>(get_string);
    if (is("glGetIntegerv")) return reinterpret_cast<ProcAddress>(get_integer);
    if (is("glGetFloatv")) return reinterpret_cast<ProcAddress>(get_float);
    if (is("glGenLists")) return reinterpret_cast<ProcAddress>(gen_lists);
    if (is("glGenTextures") || is("glGenBuffers")) return reinterpret_cast<ProcAddress>(gen_names);
    if (is("glNewList")) return reinterpret_cast<ProcAddress>(new_list);
    if (is("glBitmap")) return reinterpret_cast<ProcAddress>(bitmap);
    if (is("glIsEnabled")) return reinterpret_cast<ProcAddress>(true_function);
    return reinterpret_cast<ProcAddress>(no_function);
}

}  // namespace wall::client
