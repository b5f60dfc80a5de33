// SPDX-License-Identifier: MIT
// The GLX vendor through GLVND, as a program sees it; the core behind it is the fake one.
#include <gmock/gmock.h>

#include <memory>
#include <set>
#include <thread>

#include "tests/integration/vendor/vendor_log.h"

// After GoogleTest: X defines None, Bool, ... as macros.
#include <X11/Xmd.h>
#include <X11/Xutil.h>

#include <GL/gl.h>
#include <GL/glx.h>
#include <GL/glxproto.h>

namespace {

using testing::HasSubstr;

std::vector<int> x_errors;

int remember_error(Display*, XErrorEvent* event) {
    x_errors.push_back(event->error_code);
    return 0;
}

class Glx : public testing::Test {
protected:
    void SetUp() override {
        XSetErrorHandler(remember_error);
        x_errors.clear();
        display = XOpenDisplay(nullptr);
        ASSERT_TRUE(display);
        int event = 0;
        ASSERT_TRUE(glXQueryExtension(display, &glx_error, &event));
    }
    void TearDown() override {
        glXMakeCurrent(display, None, nullptr);
        XCloseDisplay(display);
    }
    Window make_window(const XVisualInfo& visual, unsigned width = 300, unsigned height = 200) {
        XSetWindowAttributes attributes{};
        attributes.colormap = XCreateColormap(display, DefaultRootWindow(display), visual.visual, AllocNone);
        return XCreateWindow(display, DefaultRootWindow(display), 0, 0, width, height, 0, visual.depth, InputOutput,
                             visual.visual, CWColormap | CWBorderPixel, &attributes);
    }
    std::unique_ptr<XVisualInfo, int (*)(void*)> choose(std::vector<int> attributes) {
        attributes.push_back(None);
        return {glXChooseVisual(display, DefaultScreen(display), attributes.data()), XFree};
    }
    std::vector<GLXFBConfig> configs(std::vector<int> attributes = {}) {
        attributes.push_back(None);
        int count = 0;
        GLXFBConfig* found = glXChooseFBConfig(display, DefaultScreen(display), attributes.data(), &count);
        std::vector<GLXFBConfig> all(found, found + count);
        if (found) XFree(found);
        return all;
    }
    int attrib(GLXFBConfig config, int name) {
        int value = -1;
        EXPECT_EQ(glXGetFBConfigAttrib(display, config, name, &value), 0);
        return value;
    }
    template <class F>
    F* proc(const char* name) {
        return reinterpret_cast<F*>(glXGetProcAddress(reinterpret_cast<const GLubyte*>(name)));
    }
    Display* display = nullptr;
    int glx_error = 0;
};

TEST_F(Glx, TheVendorIsOurs) { EXPECT_STREQ(glXGetClientString(display, GLX_VENDOR), "WallGL"); }

TEST_F(Glx, ConfigurationsAreAMatrix) {
    int count = 0;
    GLXFBConfig* all = glXGetFBConfigs(display, DefaultScreen(display), &count);
    std::set<std::vector<int>> kinds;
    std::set<int> ids;
    for (int i = 0; i < count; ++i) {
        kinds.insert({attrib(all[i], GLX_ALPHA_SIZE), attrib(all[i], GLX_DEPTH_SIZE), attrib(all[i], GLX_STENCIL_SIZE),
                      attrib(all[i], GLX_DOUBLEBUFFER), attrib(all[i], GLX_SAMPLES)});
        ids.insert(attrib(all[i], GLX_FBCONFIG_ID));
        EXPECT_EQ(attrib(all[i], GLX_X_VISUAL_TYPE), GLX_TRUE_COLOR);
    }
    EXPECT_EQ(kinds.size(), 32u);
    EXPECT_EQ(ids.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(attrib(all[0], GLX_VISUAL_ID), static_cast<int>(XVisualIDFromVisual(DefaultVisual(display, 0))));
    XFree(all);
}

TEST_F(Glx, WithoutMemoryAFunctionFailsAndTheProgramGoesOn) {
    const GLXFBConfig config = configs().at(0);
    const int size[] = {GLX_PBUFFER_WIDTH, 16, GLX_PBUFFER_HEIGHT, 16, None};
    const auto make_context = [&] { return glXCreateNewContext(display, config, GLX_RGBA_TYPE, nullptr, True); };
    const GLXPbuffer surface = glXCreatePbuffer(display, config, size);
    const GLXContext context = make_context();
    setenv("WALLGL_FAKE_NO_MEMORY", "1", 1);
    EXPECT_EQ(glXCreatePbuffer(display, config, size), GLXPbuffer{0});
    EXPECT_EQ(make_context(), nullptr);
    EXPECT_FALSE(glXMakeContextCurrent(display, surface, surface, context));
    unsetenv("WALLGL_FAKE_NO_MEMORY");
    EXPECT_THAT(last_logged("event=out_of_memory"), HasSubstr("function=glXMakeContextCurrent"));
    EXPECT_TRUE(glXMakeContextCurrent(display, surface, surface, context)) << "it is nobody's";
    glXMakeContextCurrent(display, None, None, nullptr);
    glXDestroyContext(display, context);
    glXDestroyPbuffer(display, surface);
}

TEST_F(Glx, ChoosesNoMoreThanAskedFor) {
    const auto found = configs({GLX_DOUBLEBUFFER, True, GLX_RED_SIZE, 1, GLX_DEPTH_SIZE, 1});
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(attrib(found[0], GLX_STENCIL_SIZE), 0);
    EXPECT_EQ(attrib(found[0], GLX_ALPHA_SIZE), 0);
    EXPECT_EQ(attrib(found[0], GLX_ACCUM_RED_SIZE), 0);
    EXPECT_EQ(attrib(found[0], GLX_SAMPLES), 0);
    EXPECT_EQ(attrib(found[0], GLX_SAMPLE_BUFFERS), 0);
    const auto alpha = configs({GLX_ALPHA_SIZE, 8, GLX_STENCIL_SIZE, 8});
    EXPECT_EQ(attrib(alpha[0], GLX_ALPHA_SIZE), 8);
    EXPECT_EQ(attrib(alpha[0], GLX_STENCIL_SIZE), 8);
    EXPECT_EQ(attrib(found[0], GLX_STEREO), 0);
    EXPECT_TRUE(configs({GLX_STEREO, True, GLX_DOUBLEBUFFER, False}).empty());
    EXPECT_TRUE(configs({GLX_SAMPLES, 8}).empty());
    EXPECT_TRUE(configs({GLX_SAMPLES, 4, GLX_ACCUM_RED_SIZE, 1}).empty());
    EXPECT_TRUE(configs({GLX_RENDER_TYPE, GLX_COLOR_INDEX_BIT}).empty());
    EXPECT_TRUE(configs({0x12345, 1}).empty());
}

TEST_F(Glx, AVisualStandsForWhatWasChosen) {
    for (const bool double_buffered : {true, false})
        for (const int depth : {0, 1}) {
            std::vector<int> wish{GLX_RGBA, GLX_DEPTH_SIZE, depth};
            if (double_buffered) wish.push_back(GLX_DOUBLEBUFFER);
            const auto visual = choose(wish);
            ASSERT_TRUE(visual);
            int value = -1;
            EXPECT_EQ(glXGetConfig(display, visual.get(), GLX_DOUBLEBUFFER, &value), 0);
            EXPECT_EQ(value, double_buffered);
            EXPECT_EQ(glXGetConfig(display, visual.get(), GLX_DEPTH_SIZE, &value), 0);
            EXPECT_EQ(value, depth ? 24 : 0);
            GLXContext context = glXCreateContext(display, visual.get(), nullptr, True);
            const Window window = make_window(*visual);
            EXPECT_TRUE(glXMakeCurrent(display, window, context));
            EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr(double_buffered ? "double=1" : "double=0"));
            EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr(depth ? "depth=24" : "depth=0"));
            glXMakeCurrent(display, None, nullptr);
            glXDestroyContext(display, context);
            XDestroyWindow(display, window);
        }
    EXPECT_FALSE(choose({GLX_DOUBLEBUFFER}));  // colour index
}

TEST_F(Glx, HasBuffersForTwoEyesWhereThatIsAskedFor) {
    const auto found = configs({GLX_STEREO, True, GLX_DEPTH_SIZE, 1});
    ASSERT_FALSE(found.empty());
    for (GLXFBConfig config : found) EXPECT_EQ(attrib(config, GLX_STEREO), 1);
    EXPECT_FALSE(configs({GLX_STEREO, True, GLX_SAMPLES, 4, GLX_ALPHA_SIZE, 8}).empty());
    for (const bool stereo : {true, false}) {  // as glxgears -stereo asks, and then one that shares the visual
        std::vector<int> wish{GLX_RGBA, GLX_RED_SIZE, 1, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 1};
        if (stereo) wish.push_back(GLX_STEREO);
        const auto visual = choose(wish);
        ASSERT_TRUE(visual);
        int value = -1;
        EXPECT_EQ(glXGetConfig(display, visual.get(), GLX_STEREO, &value), 0);
        EXPECT_EQ(value, stereo);
        GLXContext context = glXCreateContext(display, visual.get(), nullptr, True);
        const Window window = make_window(*visual);
        EXPECT_TRUE(glXMakeCurrent(display, window, context));
        EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr(stereo ? "stereo=1" : "stereo=0"));
        glXMakeCurrent(display, None, nullptr);
        glXDestroyContext(display, context);
        XDestroyWindow(display, window);
    }
}

TEST_F(Glx, PixelsHaveSeveralSamplesWhereThatIsAskedFor) {
    for (const auto& wish : {std::vector{GLX_SAMPLE_BUFFERS, 1}, std::vector{GLX_SAMPLES, 2, GLX_DOUBLEBUFFER, False},
                             std::vector{GLX_SAMPLES, 4, GLX_DRAWABLE_TYPE, GLX_PBUFFER_BIT}}) {
        const auto found = configs(wish);
        ASSERT_FALSE(found.empty());
        for (GLXFBConfig config : found) {
            EXPECT_EQ(attrib(config, GLX_SAMPLES), 4);
            EXPECT_EQ(attrib(config, GLX_SAMPLE_BUFFERS), 1);
        }
    }
    const auto visual = choose({GLX_RGBA, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 1, GLX_SAMPLE_BUFFERS, 1, GLX_SAMPLES, 4});
    ASSERT_TRUE(visual);
    int value = -1;
    EXPECT_EQ(glXGetConfig(display, visual.get(), GLX_SAMPLES, &value), 0);
    EXPECT_EQ(value, 4);
    GLXContext context = glXCreateContext(display, visual.get(), nullptr, True);
    const Window window = make_window(*visual);
    EXPECT_TRUE(glXMakeCurrent(display, window, context));
    EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr("samples=4"));
    glXMakeCurrent(display, None, nullptr);
    glXDestroyContext(display, context);
    XDestroyWindow(display, window);
}

TEST_F(Glx, EveryWindowCanBeDrawnToBySrgb) {
    EXPECT_THAT(glXQueryExtensionsString(display, DefaultScreen(display)), HasSubstr("GLX_ARB_framebuffer_sRGB"));
    for (const int wanted : {False, True}) {
        const auto found = configs({GLX_FRAMEBUFFER_SRGB_CAPABLE_ARB, wanted});
        ASSERT_FALSE(found.empty());
        EXPECT_EQ(attrib(found[0], GLX_FRAMEBUFFER_SRGB_CAPABLE_ARB), 1);
    }
}

TEST_F(Glx, UnknownVisualsAreNotForGl) {
    XVisualInfo wanted{};
    wanted.c_class = DirectColor;
    int count = 0;
    XVisualInfo* direct = XGetVisualInfo(display, VisualClassMask, &wanted, &count);
    if (!direct) GTEST_SKIP() << "the server has no DirectColor visual";
    int value = -1;
    EXPECT_EQ(glXGetConfig(display, direct, GLX_USE_GL, &value), 0);
    EXPECT_EQ(value, 0);
    EXPECT_EQ(glXGetConfig(display, direct, GLX_RGBA, &value), GLX_BAD_VISUAL);
    XFree(direct);
}

TEST_F(Glx, FramesFollowTheWindowsSize) {
    const auto visual = choose({GLX_RGBA, GLX_DOUBLEBUFFER});
    const Window window = make_window(*visual);
    XStoreName(display, window, "my window");
    GLXContext context = glXCreateContext(display, visual.get(), nullptr, True);
    ASSERT_TRUE(glXMakeCurrent(display, window, context));
    EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr("visible=1 size=300x200"));
    EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr("title=my window"));
    glXSwapBuffers(display, window);
    EXPECT_THAT(last_logged("fake_swap"), HasSubstr("size=300x200"));
    XResizeWindow(display, window, 400, 250);
    glXSwapBuffers(display, window);
    EXPECT_THAT(last_logged("fake_swap"), HasSubstr("size=400x250"));
    XDestroyWindow(display, window);
    glXSwapBuffers(display, window);  // gone: the last size stays
    EXPECT_TRUE(x_errors.empty());
    glXMakeCurrent(display, None, nullptr);
    glXDestroyContext(display, context);
}

TEST_F(Glx, AProbeWindowIsForgotten) {
    const auto visual = choose({GLX_RGBA, GLX_DOUBLEBUFFER});
    for (int i = 0; i < 2; ++i) {
        const Window window = make_window(*visual);
        GLXContext context = glXCreateContext(display, visual.get(), nullptr, True);
        ASSERT_TRUE(glXMakeCurrent(display, window, context));
        glXMakeCurrent(display, None, nullptr);
        glXDestroyContext(display, context);
        XDestroyWindow(display, window);
    }
    const auto gone = logged("fake_surface_gone").size();
    const Window window = make_window(*visual);
    GLXContext context = glXCreateContext(display, visual.get(), nullptr, True);
    ASSERT_TRUE(glXMakeCurrent(display, window, context));
    EXPECT_GT(logged("fake_surface_gone").size(), gone);
    EXPECT_EQ(logged("fake_surface_gone").size() + 1, logged("fake_surface_made").size());
}

TEST_F(Glx, GlxWindowsPbuffersAndPixmaps) {
    const auto config = configs({GLX_DOUBLEBUFFER, True})[0];
    std::unique_ptr<XVisualInfo, int (*)(void*)> visual(glXGetVisualFromFBConfig(display, config), XFree);
    GLXContext context = glXCreateNewContext(display, config, GLX_RGBA_TYPE, nullptr, True);
    ASSERT_TRUE(context);
    const GLXWindow window = glXCreateWindow(display, config, make_window(*visual), nullptr);
    ASSERT_TRUE(glXMakeContextCurrent(display, window, window, context));
    glXSwapBuffers(display, window);
    unsigned value = 0;
    glXQueryDrawable(display, window, GLX_WIDTH, &value);
    EXPECT_EQ(value, 300u);

    const int size[] = {GLX_PBUFFER_WIDTH, 128, GLX_PBUFFER_HEIGHT, 64, None};
    const GLXPbuffer pbuffer = glXCreatePbuffer(display, config, size);
    ASSERT_TRUE(glXMakeContextCurrent(display, pbuffer, window, context));
    EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr("visible=0 size=128x64"));
    glXQueryDrawable(display, pbuffer, GLX_HEIGHT, &value);
    EXPECT_EQ(value, 64u);
    const auto gone = logged("fake_surface_gone").size();
    glXDestroyPbuffer(display, pbuffer);  // still current: it lives on
    EXPECT_EQ(logged("fake_surface_gone").size(), gone);
    ASSERT_TRUE(glXMakeContextCurrent(display, window, window, context));
    EXPECT_EQ(logged("fake_surface_gone").size(), gone + 1);

    const Pixmap pixmap = XCreatePixmap(display, DefaultRootWindow(display), 33, 44, 24);
    const GLXPixmap glx_pixmap = glXCreatePixmap(display, config, pixmap, nullptr);
    ASSERT_TRUE(glXMakeContextCurrent(display, glx_pixmap, glx_pixmap, context));
    EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr("visible=0 size=33x44"));
    glXMakeCurrent(display, None, nullptr);
    glXDestroyPixmap(display, glx_pixmap);
    glXDestroyWindow(display, window);
    EXPECT_TRUE(x_errors.empty());
    glXDestroyPixmap(display, glx_pixmap);
    EXPECT_THAT(x_errors, testing::ElementsAre(glx_error + GLXBadPixmap));
}

TEST_F(Glx, AContextBelongsToOneThread) {
    const auto visual = choose({GLX_RGBA, GLX_DOUBLEBUFFER});
    const Window window = make_window(*visual);
    GLXContext context = glXCreateContext(display, visual.get(), nullptr, True);
    ASSERT_TRUE(glXMakeCurrent(display, window, context));
    bool other = true;
    std::thread([&] { other = glXMakeCurrent(display, window, context); }).join();
    EXPECT_FALSE(other);
    EXPECT_THAT(x_errors, testing::ElementsAre(BadAccess));
    glXMakeCurrent(display, None, nullptr);
    std::thread([&] {
        other = glXMakeCurrent(display, window, context);
        glXMakeCurrent(display, None, nullptr);
    }).join();
    EXPECT_TRUE(other);
}

TEST_F(Glx, CopiesAContextThatIsNotCurrent) {
    const auto visual = choose({GLX_RGBA, GLX_DOUBLEBUFFER});
    const Window window = make_window(*visual);
    GLXContext from = glXCreateContext(display, visual.get(), nullptr, True);
    GLXContext to = glXCreateContext(display, visual.get(), nullptr, True);
    ASSERT_TRUE(glXMakeCurrent(display, window, from));
    glXCopyContext(display, from, to, GL_FOG_BIT);
    EXPECT_THAT(last_logged("fake_copy"), HasSubstr("mask=0x80"));
    EXPECT_TRUE(x_errors.empty());
    glXCopyContext(display, to, from, GL_FOG_BIT);
    EXPECT_THAT(x_errors, testing::ElementsAre(BadAccess));
}

TEST_F(Glx, DestroyingTheCurrentContextIsDeferred) {
    const auto visual = choose({GLX_RGBA, GLX_DOUBLEBUFFER});
    const Window window = make_window(*visual);
    GLXContext context = glXCreateContext(display, visual.get(), nullptr, True);
    ASSERT_TRUE(glXMakeCurrent(display, window, context));
    glXDestroyContext(display, context);
    const auto frames = logged("fake_swap").size();
    glXSwapBuffers(display, window);
    EXPECT_EQ(logged("fake_swap").size(), frames + 1);
    glXMakeCurrent(display, None, nullptr);
    EXPECT_TRUE(x_errors.empty());
}

TEST_F(Glx, WrongUseIsAnXError) {
    const auto visual = choose({GLX_RGBA, GLX_DOUBLEBUFFER});
    GLXContext context = glXCreateContext(display, visual.get(), nullptr, True);
    EXPECT_FALSE(glXMakeCurrent(display, 0x123456, context));
    EXPECT_THAT(x_errors, testing::ElementsAre(glx_error + GLXBadDrawable));
    x_errors.clear();
    auto* create = proc<GLXContext(Display*, GLXFBConfig, GLXContext, Bool, const int*)>("glXCreateContextAttribsARB");
    const auto config = configs()[0];
    const int too_new[] = {GLX_CONTEXT_MAJOR_VERSION_ARB, 4, GLX_CONTEXT_MINOR_VERSION_ARB, 6, None};
    EXPECT_FALSE(create(display, config, nullptr, True, too_new));
    const int es[] = {
        GLX_CONTEXT_MAJOR_VERSION_ARB, 2, GLX_CONTEXT_MINOR_VERSION_ARB, 1, GLX_CONTEXT_PROFILE_MASK_ARB, 4, None};
    EXPECT_FALSE(create(display, config, nullptr, True, es)) << "there is no OpenGL ES 2.1";
    const int nonsense[] = {0x7777, 1, None};
    EXPECT_FALSE(create(display, config, nullptr, True, nonsense));
    EXPECT_THAT(x_errors, testing::ElementsAre(glx_error + GLXBadFBConfig, glx_error + 13, BadValue));
    const int es2[] = {GLX_CONTEXT_MAJOR_VERSION_ARB, 2, GLX_CONTEXT_PROFILE_MASK_ARB, 4, None};
    EXPECT_TRUE(create(display, config, nullptr, True, es2));
    EXPECT_THAT(last_logged("fake_context"), HasSubstr("version=2.0 core=0 shared=0 es=1"));
    const int plain[] = {GLX_CONTEXT_MAJOR_VERSION_ARB, 2, GLX_CONTEXT_MINOR_VERSION_ARB, 1, None};
    EXPECT_TRUE(create(display, config, context, True, plain));
    EXPECT_THAT(last_logged("fake_context"), HasSubstr("version=2.1 core=0 shared=1"));
}

TEST_F(Glx, ExtensionFunctionsReachTheVendor) {
    const auto visual = choose({GLX_RGBA, GLX_DOUBLEBUFFER});
    const Window window = make_window(*visual);
    GLXContext context = glXCreateContext(display, visual.get(), nullptr, True);
    ASSERT_TRUE(glXMakeCurrent(display, window, context));
    auto* set = proc<void(Display*, GLXDrawable, int)>("glXSwapIntervalEXT");
    auto* get = proc<int()>("glXGetSwapIntervalMESA");
    unsigned value = 7;
    set(display, window, 0);
    EXPECT_EQ(get(), 0);
    glXQueryDrawable(display, window, GLX_SWAP_INTERVAL_EXT, &value);
    EXPECT_EQ(value, 0u);
    EXPECT_EQ(proc<int(unsigned)>("glXSwapIntervalMESA")(1), 0);
    EXPECT_EQ(get(), 1);
    EXPECT_EQ(proc<int(int)>("glXSwapIntervalSGI")(0), GLX_BAD_VALUE);
    auto* of_visual = proc<GLXFBConfig(Display*, XVisualInfo*)>("glXGetFBConfigFromVisualSGIX");
    const GLXFBConfig config = of_visual(display, visual.get());
    EXPECT_EQ(attrib(config, GLX_VISUAL_ID), static_cast<int>(visual->visualid));
}

TEST_F(Glx, FontsBecomeDisplayLists) {
    const auto visual = choose({GLX_RGBA, GLX_DOUBLEBUFFER});
    const Window window = make_window(*visual);
    GLXContext context = glXCreateContext(display, visual.get(), nullptr, True);
    ASSERT_TRUE(glXMakeCurrent(display, window, context));
    const Font font = XLoadFont(display, "fixed");
    glXUseXFont(font, 32, 96, 1000);
    ASSERT_TRUE(x_errors.empty());
    EXPECT_EQ(logged("fake_call name=glNewList").size(), 96u);
    EXPECT_THAT(last_logged("fake_bitmap"), HasSubstr("ink="));
    const auto bitmaps = logged("fake_bitmap");
    ASSERT_EQ(bitmaps.size(), 96u);
    // "fixed" is 6x13: every glyph advances by 6, and '#' has ink where ' ' has none.
    for (const auto& line : bitmaps) EXPECT_THAT(line, HasSubstr("move=6,0"));
    EXPECT_THAT(bitmaps[0], HasSubstr("ink=0"));
    EXPECT_THAT(bitmaps['#' - 32], testing::Not(HasSubstr("ink=0")));
}

}  // namespace
