// SPDX-License-Identifier: MIT
// A program that draws a window only when X asks it to (Expose): still_windows [--close] [--single] COLOUR... opens a
// window for each colour (red, green, blue), 120x90, and says on stdout what happens. --close: takes WM_DELETE_WINDOW,
// closes that window, and ends with the last one. --single: without a back buffer.
#include <GL/gl.h>
#include <GL/glx.h>
#include <X11/Xlib.h>
#include <stdio.h>
#include <string.h>

#include <map>
#include <string>
#include <vector>

namespace {

constexpr unsigned kWidth = 120, kHeight = 90;

struct Options {
    bool close = false, single = false;
    std::vector<std::string> colours;
};

Options read_options(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--close") options.close = true;
        else if (word == "--single") options.single = true;
        else options.colours.push_back(word);
    }
    return options;
}

class Program {
public:
    explicit Program(const Options& options) : options_(options), display_(XOpenDisplay(nullptr)) {
        int attributes[] = {GLX_RGBA, GLX_RED_SIZE, 8, options.single ? int{None} : GLX_DOUBLEBUFFER, None};
        visual_ = glXChooseVisual(display_, DefaultScreen(display_), attributes);
        context_ = glXCreateContext(display_, visual_, nullptr, True);
        protocols_ = XInternAtom(display_, "WM_PROTOCOLS", False);
        delete_ = XInternAtom(display_, "WM_DELETE_WINDOW", False);
        for (const auto& colour : options.colours) open(colour);
    }

    void run() {
        while (!windows_.empty()) {
            XEvent event;
            XNextEvent(display_, &event);
            if (event.type == Expose && event.xexpose.count == 0) draw(event.xexpose.window);
            if (event.type == ClientMessage && event.xclient.message_type == protocols_ &&
                Atom(event.xclient.data.l[0]) == delete_)
                close(event.xclient.window);
        }
    }

private:
    void open(const std::string& colour) {
        XSetWindowAttributes attributes{};
        attributes.event_mask = ExposureMask;
        attributes.colormap = XCreateColormap(display_, DefaultRootWindow(display_), visual_->visual, AllocNone);
        const Window window =
            XCreateWindow(display_, DefaultRootWindow(display_), 0, 0, kWidth, kHeight, 0, visual_->depth, InputOutput,
                          visual_->visual, CWEventMask | CWColormap, &attributes);
        XStoreName(display_, window, colour.c_str());
        if (options_.close) XSetWMProtocols(display_, window, &delete_, 1);
        XMapWindow(display_, window);
        windows_[window] = colour;
    }
    void draw(Window window) {
        const auto found = windows_.find(window);
        if (found == windows_.end()) return;
        glXMakeCurrent(display_, window, context_);
        const auto& colour = found->second;
        glClearColor(colour == "red", colour == "green", colour == "blue", 1);
        glClear(GL_COLOR_BUFFER_BIT);
        if (options_.single) glFlush();
        else glXSwapBuffers(display_, window);
        say("drawn", colour);
    }
    void close(Window window) {
        glXMakeCurrent(display_, None, nullptr);
        say("closed", windows_[window]);
        XDestroyWindow(display_, window);
        XSync(display_, False);
        windows_.erase(window);
    }
    static void say(const char* what, const std::string& colour) {
        printf("%s %s\n", what, colour.c_str());
        fflush(stdout);
    }

    const Options& options_;
    Display* display_;
    XVisualInfo* visual_;
    GLXContext context_;
    Atom protocols_, delete_;
    std::map<Window, std::string> windows_;
};

}  // namespace

int main(int argc, char** argv) {
    const auto options = read_options(argc, argv);
    Program(options).run();
    return 0;
}
