// SPDX-License-Identifier: MIT
#include "tests/golden/programs/window.h"

#include <EGL/egl.h>
#include <GL/glx.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <stdexcept>

namespace golden {
namespace {

template <class T>
T must(T value, const char* what) {
    if (!value) throw std::runtime_error(std::string("cannot ") + what);
    return value;
}

class XWindow : public Window {
public:
    ~XWindow() override {
        XDestroyWindow(display_, window_);
        XCloseDisplay(display_);
    }

protected:
    XWindow() : display_(must(XOpenDisplay(nullptr), "open the display")) {}

    void open(Size size, ::Visual* visual, int depth) {
        const ::Window root = DefaultRootWindow(display_);
        XSetWindowAttributes attributes{};
        attributes.colormap = XCreateColormap(display_, root, visual, AllocNone);
        window_ =
            XCreateWindow(display_, root, 0, 0, static_cast<unsigned>(size.width), static_cast<unsigned>(size.height),
                          0, depth, InputOutput, visual, CWBorderPixel | CWColormap, &attributes);
        XMapWindow(display_, window_);
        XSync(display_, False);
    }

    Display* display_;
    ::Window window_ = 0;
};

class GlxWindow : public XWindow {
public:
    GlxWindow(Size size, const Needs& needs) {
        const int accum = needs.samples ? 0 : 16;
        int wanted[] = {GLX_RENDER_TYPE,
                        GLX_RGBA_BIT,
                        GLX_DRAWABLE_TYPE,
                        GLX_WINDOW_BIT,
                        GLX_X_VISUAL_TYPE,
                        GLX_TRUE_COLOR,
                        GLX_RED_SIZE,
                        8,
                        GLX_GREEN_SIZE,
                        8,
                        GLX_BLUE_SIZE,
                        8,
                        GLX_ALPHA_SIZE,
                        8,
                        GLX_DEPTH_SIZE,
                        24,
                        GLX_STENCIL_SIZE,
                        needs.stencil ? 8 : 0,
                        GLX_ACCUM_RED_SIZE,
                        accum,
                        GLX_ACCUM_GREEN_SIZE,
                        accum,
                        GLX_ACCUM_BLUE_SIZE,
                        accum,
                        GLX_ACCUM_ALPHA_SIZE,
                        accum,
                        GLX_SAMPLES,
                        needs.samples,
                        GLX_DOUBLEBUFFER,
                        needs.double_buffered ? True : False,
                        GLX_FRAMEBUFFER_SRGB_CAPABLE_ARB,
                        static_cast<int>(needs.asks_srgb ? True : GLX_DONT_CARE),
                        GLX_STEREO,
                        needs.stereo ? True : False,
                        None};
        int count = 0;
        GLXFBConfig* configs = glXChooseFBConfig(display_, DefaultScreen(display_), wanted, &count);
        if (!configs && needs.stereo) {
            wanted[std::size(wanted) - 2] = False;
            configs = glXChooseFBConfig(display_, DefaultScreen(display_), wanted, &count);
        }
        must(configs, "find a GLX config");
        XVisualInfo* visual = must(glXGetVisualFromFBConfig(display_, configs[0]), "find its visual");
        open(size, visual->visual, visual->depth);
        context_ = must(glXCreateNewContext(display_, configs[0], GLX_RGBA_TYPE, nullptr, True), "create a context");
        XFree(visual);
        XFree(configs);
        must(glXMakeCurrent(display_, window_, context_), "make the context current");
    }
    ~GlxWindow() override {
        glXMakeCurrent(display_, 0, nullptr);
        glXDestroyContext(display_, context_);
    }
    void swap() override { glXSwapBuffers(display_, window_); }

private:
    GLXContext context_;
};

EGLint renderable(const Needs& needs) {
    if (needs.es == 0) return EGL_OPENGL_BIT;
    return needs.es == 1 ? EGL_OPENGL_ES_BIT : EGL_OPENGL_ES3_BIT;
}

class EglWindow : public XWindow {
public:
    EglWindow(Size size, const Needs& needs) {
        egl_ = must(eglGetDisplay(reinterpret_cast<EGLNativeDisplayType>(display_)), "open an EGL display");
        must(eglInitialize(egl_, nullptr, nullptr), "initialize EGL");
        const EGLint wanted[] = {EGL_RED_SIZE,
                                 8,
                                 EGL_GREEN_SIZE,
                                 8,
                                 EGL_BLUE_SIZE,
                                 8,
                                 EGL_ALPHA_SIZE,
                                 8,
                                 EGL_DEPTH_SIZE,
                                 24,
                                 EGL_STENCIL_SIZE,
                                 needs.stencil ? 8 : 0,
                                 EGL_SAMPLES,
                                 needs.samples,
                                 EGL_RENDERABLE_TYPE,
                                 renderable(needs),
                                 EGL_NONE};
        EGLConfig config{};
        EGLint count = 0, id = 0;
        must(eglChooseConfig(egl_, wanted, &config, 1, &count) && count == 1, "find an EGL config");
        must(eglGetConfigAttrib(egl_, config, EGL_NATIVE_VISUAL_ID, &id), "find its visual");
        XVisualInfo like{};
        like.visualid = static_cast<VisualID>(id);
        int visuals = 0;
        XVisualInfo* visual = must(XGetVisualInfo(display_, VisualIDMask, &like, &visuals), "find its visual");
        open(size, visual->visual, visual->depth);
        XFree(visual);
        must(eglBindAPI(needs.es ? EGL_OPENGL_ES_API : EGL_OPENGL_API), "bind OpenGL");
        const EGLint colors[] = {EGL_GL_COLORSPACE, EGL_GL_COLORSPACE_SRGB, EGL_NONE};
        surface_ =
            must(eglCreateWindowSurface(egl_, config, window_, needs.asks_srgb ? colors : nullptr), "create a surface");
        const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, needs.es, EGL_NONE};
        context_ =
            must(eglCreateContext(egl_, config, EGL_NO_CONTEXT, needs.es ? version : nullptr), "create a context");
        must(eglMakeCurrent(egl_, surface_, surface_, context_), "make the context current");
    }
    ~EglWindow() override {
        eglMakeCurrent(egl_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglTerminate(egl_);
    }
    void swap() override { eglSwapBuffers(egl_, surface_); }

private:
    EGLDisplay egl_;
    EGLSurface surface_;
    EGLContext context_;
};

}  // namespace

std::unique_ptr<Window> Window::by_glx(Size size, const Needs& needs) {
    return std::make_unique<GlxWindow>(size, needs);
}
std::unique_ptr<Window> Window::by_egl(Size size, const Needs& needs) {
    return std::make_unique<EglWindow>(size, needs);
}

}  // namespace golden
