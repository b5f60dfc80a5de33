// SPDX-License-Identifier: MIT
// The EGL vendor through GLVND, as a program sees it; the core behind it is the fake one.
#include <gmock/gmock.h>
#include <xcb/xcb.h>

#include <algorithm>
#include <set>
#include <thread>

#include "tests/integration/vendor/vendor_log.h"

// After GoogleTest: X defines None, Bool, ... as macros.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <X11/Xlib.h>

namespace {

using testing::HasSubstr;

class Egl : public testing::Test {
protected:
    void SetUp() override {
        x = XOpenDisplay(nullptr);
        ASSERT_TRUE(x);
        display = eglGetPlatformDisplay(EGL_PLATFORM_X11_KHR, x, nullptr);
        ASSERT_TRUE(eglInitialize(display, nullptr, nullptr));
        eglBindAPI(EGL_OPENGL_API);
    }
    void TearDown() override {
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglTerminate(display);
        XCloseDisplay(x);
    }
    Window make_window() { return XCreateSimpleWindow(x, DefaultRootWindow(x), 0, 0, 300, 200, 0, 0, 0); }
    EGLConfig config(std::vector<EGLint> attributes = {}) {
        attributes.push_back(EGL_NONE);
        EGLConfig found = nullptr;
        EGLint count = 0;
        EXPECT_TRUE(eglChooseConfig(display, attributes.data(), &found, 1, &count));
        return count ? found : nullptr;
    }
    EGLint attrib(EGLConfig c, EGLint name) {
        EGLint value = -1;
        EXPECT_TRUE(eglGetConfigAttrib(display, c, name, &value));
        return value;
    }
    Display* x = nullptr;
    EGLDisplay display = EGL_NO_DISPLAY;
};

TEST_F(Egl, TheVendorIsOurs) {
    EXPECT_STREQ(eglQueryString(display, EGL_VENDOR), "WallGL");
    EXPECT_EQ(eglGetPlatformDisplay(EGL_PLATFORM_X11_KHR, x, nullptr), display);
    EXPECT_EQ(eglGetDisplay(x), display);
}

TEST_F(Egl, ConfigurationsAreAMatrix) {
    std::vector<EGLConfig> all(100);
    EGLint count = 0;
    ASSERT_TRUE(eglGetConfigs(display, all.data(), 100, &count));
    std::set<std::vector<EGLint>> kinds;
    for (EGLint i = 0; i < count; ++i)
        kinds.insert({attrib(all[i], EGL_ALPHA_SIZE), attrib(all[i], EGL_DEPTH_SIZE), attrib(all[i], EGL_STENCIL_SIZE),
                      attrib(all[i], EGL_SAMPLES)});
    EXPECT_EQ(kinds.size(), 16u);
    EGLConfig plain = config();
    EXPECT_EQ(attrib(plain, EGL_STENCIL_SIZE), 0);
    EXPECT_EQ(attrib(plain, EGL_DEPTH_SIZE), 0);
    EXPECT_EQ(attrib(config({EGL_DEPTH_SIZE, 16, EGL_ALPHA_SIZE, 1}), EGL_ALPHA_SIZE), 8);
    EXPECT_TRUE(config({EGL_RENDERABLE_TYPE, EGL_OPENGL_ES_BIT | EGL_OPENGL_BIT}));
    EXPECT_EQ(attrib(plain, EGL_SAMPLES), 0);
    EXPECT_EQ(attrib(plain, EGL_SAMPLE_BUFFERS), 0);
    EGLConfig several = config({EGL_SAMPLES, 2, EGL_DEPTH_SIZE, 1});
    EXPECT_EQ(attrib(several, EGL_SAMPLES), 4);
    EXPECT_EQ(attrib(several, EGL_SAMPLE_BUFFERS), 1);
    EXPECT_TRUE(config({EGL_SAMPLE_BUFFERS, 1, EGL_ALPHA_SIZE, 8, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT}));
    EXPECT_FALSE(config({EGL_SAMPLES, 8}));
    EGLint value = 0;
    EXPECT_FALSE(eglGetConfigAttrib(display, reinterpret_cast<EGLConfig>(0x1234), EGL_DEPTH_SIZE, &value));
    EXPECT_EQ(eglGetError(), EGL_BAD_CONFIG);
    EXPECT_EQ(eglGetError(), EGL_SUCCESS);
}

TEST_F(Egl, DrawsFramesIntoAWindow) {
    Window window = make_window();
    EGLSurface surface = eglCreatePlatformWindowSurface(display, config(), &window, nullptr);
    ASSERT_NE(surface, EGL_NO_SURFACE);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 1, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
    EGLContext context = eglCreateContext(display, config(), EGL_NO_CONTEXT, version);
    ASSERT_NE(context, EGL_NO_CONTEXT);
    ASSERT_TRUE(eglMakeCurrent(display, surface, surface, context));
    EXPECT_TRUE(eglSwapInterval(display, 0));
    XResizeWindow(x, window, 320, 240);
    EXPECT_TRUE(eglSwapBuffers(display, surface));
    EXPECT_THAT(last_logged("fake_swap"), HasSubstr("size=320x240"));
    EGLint value = 0;
    EXPECT_TRUE(eglQuerySurface(display, surface, EGL_WIDTH, &value));
    EXPECT_EQ(value, 320);
    EXPECT_EQ(eglCreateWindowSurface(display, config(), window, nullptr), EGL_NO_SURFACE);
    EXPECT_EQ(eglGetError(), EGL_BAD_ALLOC);
    EXPECT_TRUE(eglDestroyContext(display, context));  // current: deferred
    EXPECT_TRUE(eglDestroySurface(display, surface));
    EXPECT_FALSE(eglSwapBuffers(display, surface));
    EXPECT_EQ(eglGetError(), EGL_BAD_SURFACE);
}

TEST_F(Egl, WithoutMemoryAFunctionFailsAndTheProgramGoesOn) {
    const EGLint size[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
    const auto make_surface = [&] { return eglCreatePbufferSurface(display, config(), size); };
    const auto make_context = [&] { return eglCreateContext(display, config(), EGL_NO_CONTEXT, nullptr); };
    const EGLSurface surface = make_surface();
    const EGLContext context = make_context();
    setenv("WALLGL_FAKE_NO_MEMORY", "1", 1);
    EXPECT_EQ(make_surface(), EGL_NO_SURFACE);
    EXPECT_EQ(make_context(), EGL_NO_CONTEXT);
    EXPECT_FALSE(eglMakeCurrent(display, surface, surface, context));
    unsetenv("WALLGL_FAKE_NO_MEMORY");
    EXPECT_THAT(last_logged("event=out_of_memory"), HasSubstr("function=eglMakeCurrent"));
    EXPECT_TRUE(eglMakeCurrent(display, surface, surface, context)) << "it is nobody's";
}

TEST_F(Egl, SamplesCountBeforeTheDepthBuffer) {
    std::vector<EGLConfig> all(100);
    EGLint count = 0;
    const EGLint none[] = {EGL_NONE};
    ASSERT_TRUE(eglChooseConfig(display, none, all.data(), 100, &count));
    std::vector<std::vector<EGLint>> order;
    for (EGLint i = 0; i < count; ++i)
        order.push_back({attrib(all[i], EGL_BUFFER_SIZE), attrib(all[i], EGL_SAMPLES), attrib(all[i], EGL_DEPTH_SIZE)});
    EXPECT_TRUE(std::ranges::is_sorted(order));
}

TEST_F(Egl, ASurfaceHasTheSamplesOfItsConfiguration) {
    Window window = make_window();
    EXPECT_NE(eglCreatePlatformWindowSurface(display, config({EGL_SAMPLES, 4}), &window, nullptr), EGL_NO_SURFACE);
    EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr("samples=4"));
    EXPECT_NE(eglCreatePbufferSurface(display, config({EGL_SURFACE_TYPE, EGL_PBUFFER_BIT}), nullptr), EGL_NO_SURFACE);
    EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr("samples=0"));
}

TEST_F(Egl, ASurfaceHasTheColoursThatWereAskedFor) {
    EXPECT_THAT(eglQueryString(display, EGL_EXTENSIONS), HasSubstr("EGL_KHR_gl_colorspace"));
    const EGLint srgb[] = {EGL_GL_COLORSPACE, EGL_GL_COLORSPACE_SRGB, EGL_NONE};
    const EGLint linear[] = {EGL_GL_COLORSPACE, EGL_GL_COLORSPACE_LINEAR, EGL_NONE};
    const EGLint other[] = {EGL_GL_COLORSPACE, EGL_ALPHA_SIZE, EGL_NONE};
    const auto pbuffers = config({EGL_SURFACE_TYPE, EGL_PBUFFER_BIT});
    for (const auto& [asked, space] : {std::pair{srgb, EGL_GL_COLORSPACE_SRGB}, {linear, EGL_GL_COLORSPACE_LINEAR}}) {
        const std::string made = space == EGL_GL_COLORSPACE_SRGB ? "srgb=1" : "srgb=0";
        for (const bool window : {true, false}) {
            EGLSurface surface = window ? eglCreateWindowSurface(display, config(), make_window(), asked)
                                        : eglCreatePbufferSurface(display, pbuffers, asked);
            ASSERT_NE(surface, EGL_NO_SURFACE);
            EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr(made));
            EGLint value = 0;
            EXPECT_TRUE(eglQuerySurface(display, surface, EGL_GL_COLORSPACE, &value));
            EXPECT_EQ(value, space);
        }
    }
    EXPECT_EQ(eglCreatePbufferSurface(display, pbuffers, other), EGL_NO_SURFACE);
    EXPECT_EQ(eglGetError(), EGL_BAD_MATCH);
}

TEST_F(Egl, SingleBufferedWindowsAndPbuffers) {
    const EGLint single[] = {EGL_RENDER_BUFFER, EGL_SINGLE_BUFFER, EGL_NONE};
    EGLSurface surface = eglCreateWindowSurface(display, config(), make_window(), single);
    EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr("double=0"));
    const EGLint size[] = {EGL_WIDTH, 64, EGL_HEIGHT, 32, EGL_NONE};
    EGLSurface pbuffer = eglCreatePbufferSurface(display, config({EGL_SURFACE_TYPE, EGL_PBUFFER_BIT}), size);
    EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr("visible=0 size=64x32"));
    EGLContext context = eglCreateContext(display, config(), EGL_NO_CONTEXT, nullptr);
    EXPECT_TRUE(eglMakeCurrent(display, pbuffer, surface, context));
    EGLSync sync = eglCreateSync(display, EGL_SYNC_FENCE, nullptr);
    EXPECT_EQ(eglClientWaitSync(display, sync, 0, EGL_FOREVER), EGL_CONDITION_SATISFIED);
    EXPECT_TRUE(eglDestroySync(display, sync));
}

TEST_F(Egl, TwoThreadsHaveTheirOwnErrorsAndContexts) {
    EGLSurface surface = eglCreateWindowSurface(display, config(), make_window(), nullptr);
    EGLContext context = eglCreateContext(display, config(), EGL_NO_CONTEXT, nullptr);
    ASSERT_TRUE(eglMakeCurrent(display, surface, surface, context));
    EGLint error = EGL_SUCCESS;
    std::thread([&] {
        EXPECT_FALSE(eglMakeCurrent(display, surface, surface, context));
        error = eglGetError();
    }).join();
    EXPECT_EQ(error, EGL_BAD_ACCESS);
    EXPECT_EQ(eglGetError(), EGL_SUCCESS);
}

class EglEs : public Egl {
protected:
    void SetUp() override {
        Egl::SetUp();
        eglBindAPI(EGL_OPENGL_ES_API);
    }
    EGLContext context(std::vector<EGLint> attributes, EGLContext share = EGL_NO_CONTEXT) {
        attributes.push_back(EGL_NONE);
        return eglCreateContext(display, config(), share, attributes.data());
    }
};

TEST_F(EglEs, ContextsAreMadeOfVersionsThatAreOffered) {
    EXPECT_STREQ(eglQueryString(display, EGL_CLIENT_APIS), "OpenGL OpenGL_ES");
    EXPECT_EQ(attrib(config(), EGL_CONFORMANT), EGL_OPENGL_BIT | EGL_OPENGL_ES_BIT | EGL_OPENGL_ES2_BIT);
    EXPECT_FALSE(config({EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT}));
    EGLContext made = context({EGL_CONTEXT_CLIENT_VERSION, 2});
    ASSERT_NE(made, EGL_NO_CONTEXT);
    EXPECT_THAT(last_logged("fake_context"), HasSubstr("version=2.0 core=0 shared=0 es=1"));
    EGLint value = 0;
    EXPECT_TRUE(eglQueryContext(display, made, EGL_CONTEXT_CLIENT_TYPE, &value));
    EXPECT_EQ(value, EGL_OPENGL_ES_API);
    EXPECT_TRUE(eglQueryContext(display, made, EGL_CONTEXT_CLIENT_VERSION, &value));
    EXPECT_EQ(value, 2);
    for (const EGLint version : {3, 0, 7}) {
        EXPECT_EQ(context({EGL_CONTEXT_CLIENT_VERSION, version}), EGL_NO_CONTEXT);
        EXPECT_EQ(eglGetError(), EGL_BAD_MATCH) << version;
    }
}

TEST_F(EglEs, TheFirstVersionIsWhatNobodyAskedFor) {
    for (const std::vector<EGLint>& attributes : {std::vector<EGLint>{}, {EGL_CONTEXT_CLIENT_VERSION, 1}}) {
        EGLContext made = context(attributes);
        ASSERT_NE(made, EGL_NO_CONTEXT);
        EXPECT_THAT(last_logged("fake_context"), HasSubstr("version=1.0 core=0 shared=0 es=1"));
        EGLint value = 0;
        EXPECT_TRUE(eglQueryContext(display, made, EGL_CONTEXT_CLIENT_VERSION, &value));
        EXPECT_EQ(value, 1);
    }
}

TEST_F(EglEs, ContextsMayBeCurrentWithoutASurface) {
    EGLContext made = context({EGL_CONTEXT_CLIENT_VERSION, 2});
    EXPECT_TRUE(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, made));
    EGLint value = 0;
    EXPECT_TRUE(eglQueryContext(display, made, EGL_RENDER_BUFFER, &value));
    EXPECT_EQ(value, EGL_NONE);
    EGLSurface surface = eglCreateWindowSurface(display, config(), make_window(), nullptr);
    EXPECT_FALSE(eglMakeCurrent(display, surface, EGL_NO_SURFACE, made));
    EXPECT_EQ(eglGetError(), EGL_BAD_MATCH);
}

TEST_F(EglEs, ContextsMayHaveNoConfiguration) {
    EXPECT_THAT(eglQueryString(display, EGL_EXTENSIONS), HasSubstr("EGL_KHR_no_config_context"));
    const EGLint version[] = {EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
    EGLContext made = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    ASSERT_NE(made, EGL_NO_CONTEXT);
    EGLint value = -1;
    EXPECT_TRUE(eglQueryContext(display, made, EGL_CONFIG_ID, &value));
    EXPECT_EQ(value, 0);
    EGLSurface surface = eglCreateWindowSurface(display, config(), make_window(), nullptr);
    EXPECT_TRUE(eglMakeCurrent(display, surface, surface, made));
    EXPECT_EQ(eglCreateWindowSurface(display, EGL_NO_CONFIG_KHR, make_window(), nullptr), EGL_NO_SURFACE);
    EXPECT_EQ(eglGetError(), EGL_BAD_CONFIG);
}

TEST_F(EglEs, DesktopsAttributesAreErrors) {
    constexpr EGLint kVersion = EGL_CONTEXT_CLIENT_VERSION;
    EXPECT_EQ(context({kVersion, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT}),
              EGL_NO_CONTEXT);
    EXPECT_EQ(eglGetError(), EGL_BAD_ATTRIBUTE);
    EXPECT_EQ(context({kVersion, 2, EGL_CONTEXT_FLAGS_KHR, EGL_CONTEXT_OPENGL_FORWARD_COMPATIBLE_BIT_KHR}),
              EGL_NO_CONTEXT);
    EXPECT_EQ(eglGetError(), EGL_BAD_ATTRIBUTE);
    const EGLint endless[] = {0x7777, 1};
    EXPECT_EQ(eglCreateContext(display, config(), EGL_NO_CONTEXT, endless), EGL_NO_CONTEXT);
    EXPECT_NE(context({kVersion, 2, EGL_CONTEXT_FLAGS_KHR, EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR}), EGL_NO_CONTEXT);
}

TEST_F(EglEs, RobustContextsAreAskedForByEitherWord) {
    EXPECT_THAT(eglQueryString(display, EGL_EXTENSIONS), HasSubstr("EGL_EXT_create_context_robustness"));
    EXPECT_NE(context({EGL_CONTEXT_CLIENT_VERSION, 2, EGL_CONTEXT_OPENGL_ROBUST_ACCESS_EXT, EGL_TRUE,
                       EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT, EGL_LOSE_CONTEXT_ON_RESET_EXT}),
              EGL_NO_CONTEXT);
    EXPECT_THAT(last_logged("fake_context"), HasSubstr("robust=1 resets=1"));
    EXPECT_NE(context({EGL_CONTEXT_CLIENT_VERSION, 2, EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE}), EGL_NO_CONTEXT);
    EXPECT_THAT(last_logged("fake_context"), HasSubstr("robust=1 resets=0"));
    EXPECT_EQ(context({EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT, 7}), EGL_NO_CONTEXT);
    EXPECT_EQ(eglGetError(), EGL_BAD_ATTRIBUTE);
}

TEST_F(EglEs, ContextsShareWithTheirKindOnly) {
    EGLContext first = context({EGL_CONTEXT_CLIENT_VERSION, 2});
    EXPECT_NE(context({EGL_CONTEXT_CLIENT_VERSION, 2}, first), EGL_NO_CONTEXT);
    EXPECT_THAT(last_logged("fake_context"), HasSubstr("shared=1"));
    eglBindAPI(EGL_OPENGL_API);
    EXPECT_EQ(eglCreateContext(display, config(), first, nullptr), EGL_NO_CONTEXT);
    EXPECT_EQ(eglGetError(), EGL_BAD_CONTEXT);
}

TEST_F(Egl, WrongHandlesAreErrors) {
    EXPECT_FALSE(eglSwapBuffers(display, reinterpret_cast<EGLSurface>(0x99)));
    EXPECT_EQ(eglGetError(), EGL_BAD_SURFACE);
    EXPECT_EQ(eglCreateWindowSurface(display, config(), 0x123456, nullptr), EGL_NO_SURFACE);
    EXPECT_EQ(eglGetError(), EGL_BAD_NATIVE_WINDOW);
    const EGLint nonsense[] = {0x7777, 1, EGL_NONE};
    EXPECT_EQ(eglCreateContext(display, config(), EGL_NO_CONTEXT, nonsense), EGL_NO_CONTEXT);
    EXPECT_EQ(eglGetError(), EGL_BAD_ATTRIBUTE);
    EGLDisplay other = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    EGLint count = 0;
    EXPECT_FALSE(eglGetConfigs(other, nullptr, 0, &count));
    EXPECT_EQ(eglGetError(), EGL_NOT_INITIALIZED);
}

TEST(EglPlatforms, XcbAndSurfaceless) {
    xcb_connection_t* connection = xcb_connect(nullptr, nullptr);
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_XCB_EXT, connection, nullptr);
    ASSERT_TRUE(eglInitialize(display, nullptr, nullptr));
    xcb_screen_t* screen = xcb_setup_roots_iterator(xcb_get_setup(connection)).data;
    xcb_window_t window = xcb_generate_id(connection);
    xcb_create_window(connection, XCB_COPY_FROM_PARENT, window, screen->root, 0, 0, 50, 60, 0,
                      XCB_WINDOW_CLASS_INPUT_OUTPUT, screen->root_visual, 0, nullptr);
    EGLConfig config = nullptr;
    EGLint count = 0;
    const EGLint any[] = {EGL_NONE};
    ASSERT_TRUE(eglChooseConfig(display, any, &config, 1, &count));
    EXPECT_NE(eglCreatePlatformWindowSurface(display, config, &window, nullptr), EGL_NO_SURFACE);
    EXPECT_THAT(last_logged("fake_surface_made"), HasSubstr("visible=1 size=50x60"));
    eglTerminate(display);
    xcb_disconnect(connection);

    EGLDisplay surfaceless = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    ASSERT_TRUE(eglInitialize(surfaceless, nullptr, nullptr));
    const EGLint pbuffer[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
    ASSERT_TRUE(eglChooseConfig(surfaceless, pbuffer, &config, 1, &count));
    ASSERT_EQ(count, 1);
    EXPECT_NE(eglCreatePbufferSurface(surfaceless, config, nullptr), EGL_NO_SURFACE);
    eglTerminate(surfaceless);
}

TEST(EglPlatforms, TheWallIsADevice) {
    const auto query_devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    const auto query_string =
        reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(eglGetProcAddress("eglQueryDeviceStringEXT"));
    const auto query_attrib =
        reinterpret_cast<PFNEGLQUERYDISPLAYATTRIBEXTPROC>(eglGetProcAddress("eglQueryDisplayAttribEXT"));
    ASSERT_TRUE(query_devices && query_string && query_attrib);
    EGLDeviceEXT devices[4] = {};
    EGLint count = 0;
    ASSERT_TRUE(query_devices(4, devices, &count));
    ASSERT_EQ(count, 1);
    EXPECT_STREQ(query_string(devices[0], EGL_RENDERER_EXT), "WallGL");
    EXPECT_EQ(query_string(devices[0], EGL_WIDTH), nullptr);
    EXPECT_EQ(eglGetError(), EGL_BAD_PARAMETER);
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[0], nullptr);
    ASSERT_NE(display, EGL_NO_DISPLAY);
    ASSERT_TRUE(eglInitialize(display, nullptr, nullptr));
    EGLAttrib of_display = 0;
    ASSERT_TRUE(query_attrib(display, EGL_DEVICE_EXT, &of_display));
    EXPECT_EQ(reinterpret_cast<EGLDeviceEXT>(of_display), devices[0]);
    EXPECT_FALSE(query_attrib(display, EGL_WIDTH, &of_display));
    EXPECT_EQ(eglGetError(), EGL_BAD_ATTRIBUTE);
    const EGLint windows[] = {EGL_SURFACE_TYPE, EGL_WINDOW_BIT, EGL_NONE};
    const EGLint pbuffers[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    ASSERT_TRUE(eglChooseConfig(display, windows, &config, 1, &count));
    EXPECT_EQ(count, 0);
    ASSERT_TRUE(eglChooseConfig(display, pbuffers, &config, 1, &count));
    ASSERT_EQ(count, 1);
    EXPECT_NE(eglCreatePbufferSurface(display, config, nullptr), EGL_NO_SURFACE);
    eglTerminate(display);
}

}  // namespace
