// SPDX-License-Identifier: MIT
// glXUseXFont: X draws each glyph into a bitmap, which becomes a display list with one glBitmap.
#include <GL/gl.h>
#include <X11/Xutil.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "client_lib/context/core.h"
#include "client_lib/vendor/glx/functions.h"

namespace wall::client::glx {
namespace {

/// The GL functions that glyph lists need, of the current context.
struct GlCalls {
    template <class F>
    static F* get(const char* name) {
        return reinterpret_cast<F*>(gl_proc_address(name));
    }
    void (*NewList)(GLuint, GLenum) = get<void(GLuint, GLenum)>("glNewList");
    void (*EndList)() = get<void()>("glEndList");
    void (*Bitmap)(GLsizei, GLsizei, GLfloat, GLfloat, GLfloat, GLfloat, const GLubyte*) =
        get<void(GLsizei, GLsizei, GLfloat, GLfloat, GLfloat, GLfloat, const GLubyte*)>("glBitmap");
    void (*PushClientAttrib)(GLbitfield) = get<void(GLbitfield)>("glPushClientAttrib");
    void (*PopClientAttrib)() = get<void()>("glPopClientAttrib");
    void (*PixelStorei)(GLenum, GLint) = get<void(GLenum, GLint)>("glPixelStorei");

    bool complete() const { return NewList && EndList && Bitmap && PushClientAttrib && PopClientAttrib && PixelStorei; }
};

struct FreeFontInfo {
    // The font itself is the program's.
    void operator()(XFontStruct* font) const { XFreeFontInfo(nullptr, font, 1); }
};
using FontInfo = std::unique_ptr<XFontStruct, FreeFontInfo>;

struct Glyph {
    XCharStruct metrics{};
    bool exists = false;
};

bool nothing(const XCharStruct& c) {
    return c.lbearing == 0 && c.rbearing == 0 && c.width == 0 && c.ascent == 0 && c.descent == 0;
}

/// Metrics of a character; a missing one is shown as the font's default character.
Glyph glyph_of(const XFontStruct& font, unsigned code) {
    const unsigned columns = font.max_char_or_byte2 - font.min_char_or_byte2 + 1;
    const bool two_bytes = font.min_byte1 != 0 || font.max_byte1 != 0;
    const unsigned row = two_bytes ? code >> 8 & 0xff : 0, column = two_bytes ? code & 0xff : code;
    if (row < font.min_byte1 || row > font.max_byte1 || column < font.min_char_or_byte2 ||
        column > font.max_char_or_byte2)
        return {};
    if (!font.per_char) return {font.min_bounds, true};
    const auto& metrics = font.per_char[(row - font.min_byte1) * columns + column - font.min_char_or_byte2];
    return {metrics, !nothing(metrics)};
}

/// Draws glyphs into bitmaps of the largest glyph's size.
class GlyphPainter {
public:
    GlyphPainter(Display* display, Font font, const XFontStruct& info)
        : display_(display),
          width_(static_cast<unsigned>(std::max(1, info.max_bounds.rbearing - info.min_bounds.lbearing))),
          height_(static_cast<unsigned>(std::max(1, info.max_bounds.ascent + info.max_bounds.descent))),
          pixmap_(XCreatePixmap(display, DefaultRootWindow(display), width_, height_, 1)) {
        XGCValues values{};
        values.font = font;
        values.foreground = 1;
        values.background = 0;
        gc_ = XCreateGC(display, pixmap_, GCFont | GCForeground | GCBackground, &values);
        clear_values_.foreground = 0;
        clear_ = XCreateGC(display, pixmap_, GCForeground, &clear_values_);
    }
    ~GlyphPainter() {
        XFreeGC(display_, gc_);
        XFreeGC(display_, clear_);
        XFreePixmap(display_, pixmap_);
    }
    GlyphPainter(const GlyphPainter&) = delete;

    /// Rows from the bottom up, each padded to a byte, the leftmost pixel in the highest bit.
    std::vector<GLubyte> paint(unsigned code, const XCharStruct& m, unsigned width, unsigned height) {
        XFillRectangle(display_, pixmap_, clear_, 0, 0, width_, height_);
        const XChar2b text{static_cast<unsigned char>(code >> 8 & 0xff), static_cast<unsigned char>(code & 0xff)};
        XDrawString16(display_, pixmap_, gc_, -m.lbearing, m.ascent, &text, 1);
        const unsigned stride = (width + 7) / 8;
        std::vector<GLubyte> bits(stride * height);
        XImage* image =
            XGetImage(display_, pixmap_, 0, 0, std::min(width, width_), std::min(height, height_), 1, XYPixmap);
        if (!image) return bits;
        for (int y = 0; y < image->height; ++y)
            for (int x = 0; x < image->width; ++x)
                if (XGetPixel(image, x, y))
                    bits[stride * (height - 1 - static_cast<unsigned>(y)) + static_cast<unsigned>(x) / 8] |=
                        static_cast<GLubyte>(0x80 >> x % 8);
        XDestroyImage(image);
        return bits;
    }

private:
    Display* display_;
    unsigned width_, height_;
    Pixmap pixmap_;
    GC gc_, clear_;
    XGCValues clear_values_{};
};

void make_list(const GlCalls& gl, GlyphPainter& painter, const XFontStruct& font, unsigned code, GLuint list) {
    Glyph glyph = glyph_of(font, code);
    if (!glyph.exists) {
        code = font.default_char;
        glyph = glyph_of(font, code);
    }
    gl.NewList(list, GL_COMPILE);
    if (glyph.exists) {
        const auto& m = glyph.metrics;
        const auto width = static_cast<unsigned>(std::max(0, m.rbearing - m.lbearing));
        const auto height = static_cast<unsigned>(std::max(0, m.ascent + m.descent));
        const auto bits = width && height ? painter.paint(code, m, width, height) : std::vector<GLubyte>();
        gl.Bitmap(bits.empty() ? 0 : static_cast<GLsizei>(width), bits.empty() ? 0 : static_cast<GLsizei>(height),
                  static_cast<GLfloat>(-m.lbearing), m.descent, m.width, 0, bits.empty() ? nullptr : bits.data());
    }
    gl.EndList();
}

}  // namespace

bool use_x_font(Display* display, Font font, int first, int count, int list_base) {
    const GlCalls gl;
    const FontInfo info(XQueryFont(display, font));
    if (!info || !gl.complete()) return false;
    GlyphPainter painter(display, font, *info);
    gl.PushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
    for (const GLenum name :
         {GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST, GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS})
        gl.PixelStorei(name, 0);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int i = 0; i < count; ++i)
        make_list(gl, painter, *info, static_cast<unsigned>(first + i), static_cast<GLuint>(list_base + i));
    gl.PopClientAttrib();
    return true;
}

}  // namespace wall::client::glx
