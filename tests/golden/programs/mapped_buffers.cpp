// SPDX-License-Identifier: MIT
// Buffers that are written through mappings: ranges, flushed parts, storage that stays mapped while it is drawn from,
// copies from one to another. Rows of quads, each row written in its own way.
#include <array>
#include <cmath>
#include <cstddef>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kRows = 6, kQuads = 700;  // a row has some pages
constexpr int kCorners = 4 * kQuads;

struct Corner {
    GLfloat place[2];
    GLubyte colour[4];
};
constexpr GLsizeiptr kRowBytes = kCorners * sizeof(Corner);

/// The quad's corners; `shape` is another one for each frame.
void write_quad(Corner* to, int row, int quad, int shape) {
    const float left = 2 * static_cast<float>(quad) / kQuads - 1, width = 2.0f / kQuads;
    const float middle = (static_cast<float>(row) + 0.5f) / kRows * 2 - 1;
    const float height = 0.12f * (1 + 0.5f * std::sin(0.02f * static_cast<float>(quad * (shape + 1))));
    const GLubyte shade = static_cast<GLubyte>(quad * 255 / kQuads);
    for (int i = 0; i < 4; ++i) {
        const float x = i == 1 || i == 2 ? left + width : left, y = i < 2 ? middle - height : middle + height;
        to[i] = {{x, y}, {shade, static_cast<GLubyte>(40 * row), static_cast<GLubyte>(200 - 40 * shape), 255}};
    }
}

std::vector<Corner> row_of(int row, int shape) {
    std::vector<Corner> out(kCorners);
    for (int quad = 0; quad < kQuads; ++quad) write_quad(&out[static_cast<std::size_t>(4 * quad)], row, quad, shape);
    return out;
}

struct Rows {
    std::array<GLuint, kRows> names{};
    Corner* stays = nullptr;  ///< row 4's
    Corner* tells = nullptr;  ///< row 5's

    Rows() {
        glGenBuffers(kRows, names.data());
        for (int row = 0; row < kRows; ++row) {
            bind(row);
            const auto content = row_of(row, 0);
            if (row < 4) glBufferData(GL_ARRAY_BUFFER, kRowBytes, content.data(), GL_DYNAMIC_DRAW);
            else glBufferStorage(GL_ARRAY_BUFFER, kRowBytes, content.data(), storage(row));
        }
        bind(4);
        stays = static_cast<Corner*>(glMapBufferRange(GL_ARRAY_BUFFER, 0, kRowBytes, storage(4)));
        bind(5);
        tells = static_cast<Corner*>(
            glMapBufferRange(GL_ARRAY_BUFFER, 0, kRowBytes, storage(5) | GL_MAP_FLUSH_EXPLICIT_BIT));
        say_error("storage");
    }
    void bind(int row) const { glBindBuffer(GL_ARRAY_BUFFER, names[static_cast<std::size_t>(row)]); }
    static GLbitfield storage(int row) {
        return GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | (row == 4 ? GLbitfield{GL_MAP_COHERENT_BIT} : 0);
    }
    void draw(int row, int first, int quads) const {
        bind(row);
        glVertexPointer(2, GL_FLOAT, sizeof(Corner), nullptr);
        glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Corner), reinterpret_cast<const void*>(offsetof(Corner, colour)));
        glDrawArrays(GL_QUADS, 4 * first, 4 * quads);
    }
};

void say_mapping(const char* what) {
    GLint mapped = 0, access = 0, offset = 0, length = 0, flags = 0;
    glGetBufferParameteriv(GL_ARRAY_BUFFER, GL_BUFFER_MAPPED, &mapped);
    glGetBufferParameteriv(GL_ARRAY_BUFFER, GL_BUFFER_ACCESS, &access);
    glGetBufferParameteriv(GL_ARRAY_BUFFER, GL_BUFFER_MAP_OFFSET, &offset);
    glGetBufferParameteriv(GL_ARRAY_BUFFER, GL_BUFFER_MAP_LENGTH, &length);
    glGetBufferParameteriv(GL_ARRAY_BUFFER, GL_BUFFER_ACCESS_FLAGS, &flags);
    say("%s: mapped %d access 0x%x at %d, %d bytes, flags 0x%x", what, mapped, static_cast<unsigned>(access), offset,
        length, static_cast<unsigned>(flags));
}

/// The first four rows, each in its own way.
void change(const Rows& rows, int frame) {
    const int quad = 100 * frame;
    const GLintptr at = 4 * quad * static_cast<GLintptr>(sizeof(Corner));
    const GLsizeiptr part = 4 * 80 * sizeof(Corner);
    const auto write = [&](Corner* to, int row) {
        for (int i = 0; i < 80; ++i) write_quad(to + static_cast<std::ptrdiff_t>(4) * i, row, quad + i, frame);
    };
    rows.bind(0);
    write(static_cast<Corner*>(glMapBufferRange(GL_ARRAY_BUFFER, at, part, GL_MAP_WRITE_BIT)), 0);
    say_mapping("a range");
    glUnmapBuffer(GL_ARRAY_BUFFER);
    rows.bind(1);
    auto* mapped = static_cast<Corner*>(glMapBufferRange(
        GL_ARRAY_BUFFER, 0, kRowBytes, GL_MAP_WRITE_BIT | GL_MAP_FLUSH_EXPLICIT_BIT | GL_MAP_UNSYNCHRONIZED_BIT));
    write(mapped + static_cast<std::ptrdiff_t>(4) * quad, 1);
    glFlushMappedBufferRange(GL_ARRAY_BUFFER, at, part);
    say_mapping("flushed");
    glUnmapBuffer(GL_ARRAY_BUFFER);
    rows.bind(2);
    mapped = static_cast<Corner*>(glMapBuffer(GL_ARRAY_BUFFER, GL_READ_WRITE));
    write(mapped + static_cast<std::ptrdiff_t>(4) * quad, 2);
    say_mapping("whole");
    glUnmapBuffer(GL_ARRAY_BUFFER);
    glBindBuffer(GL_COPY_READ_BUFFER, rows.names[2]);
    glBindBuffer(GL_COPY_WRITE_BUFFER, rows.names[3]);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, at, at / 2, part);
    glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
    say_error("change");
}

void wrong_uses(const Rows& rows) {
    rows.bind(0);
    glMapBufferRange(GL_ARRAY_BUFFER, 0, 0, GL_MAP_WRITE_BIT), say_error("empty");
    glMapBufferRange(GL_ARRAY_BUFFER, kRowBytes, 1, GL_MAP_WRITE_BIT), say_error("behind the end");
    glMapBufferRange(GL_ARRAY_BUFFER, 0, 1, GL_MAP_READ_BIT | GL_MAP_INVALIDATE_RANGE_BIT), say_error("invalidated");
    glMapBufferRange(GL_ARRAY_BUFFER, 0, 1, GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT), say_error("persistent");
    glMapBufferRange(GL_ARRAY_BUFFER, 0, 1, 0), say_error("not at all");
    glFlushMappedBufferRange(GL_ARRAY_BUFFER, 0, 1), say_error("not mapped");
    glUnmapBuffer(GL_ARRAY_BUFFER), say_error("unmapped");
    glCopyBufferSubData(GL_ARRAY_BUFFER, GL_ARRAY_BUFFER, 0, 10, 11), say_error("overlap");
    glCopyBufferSubData(GL_ARRAY_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, 1), say_error("to nothing");
    rows.bind(4);
    glBufferData(GL_ARRAY_BUFFER, 4, nullptr, GL_STATIC_DRAW), say_error("data");
    glBufferSubData(GL_ARRAY_BUFFER, 0, 4, rows.names.data()), say_error("not dynamic");
    glBufferStorage(GL_ARRAY_BUFFER, 4, nullptr, 0), say_error("again");
    say_mapping("stays mapped");
}

}  // namespace

SCENE(mapped_buffers, 4) {
    static Rows* rows;
    if (frame == 0) rows = new Rows;
    else change(*rows, frame);
    if (frame == 3) wrong_uses(*rows);
    clear(0.1f, 0.15f, 0.1f);
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_COLOR_ARRAY);
    for (int row = 0; row < 4; ++row) rows->draw(row, 0, kQuads);
    for (int part = 0; part < 4; ++part) {  // what is drawn was written just before, and not all is drawn
        const int first = part * 160 + frame * 7;
        for (int i = 0; i < 100; ++i) write_quad(rows->stays + 4 * (first + i), 4, first + i, frame + part);
        rows->draw(4, first, 90);
        glFinish();  // the next part is written only when this one is drawn
    }
    const int quad = 50 * frame;
    for (int i = 0; i < 60; ++i) write_quad(rows->tells + 4 * (quad + i), 5, quad + i, frame);
    rows->bind(5);
    glFlushMappedBufferRange(GL_ARRAY_BUFFER, 4 * quad * static_cast<GLintptr>(sizeof(Corner)),
                             4 * 60 * sizeof(Corner));
    rows->draw(5, 0, kQuads);
    glDisableClientState(GL_VERTEX_ARRAY);
    glDisableClientState(GL_COLOR_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    say_error("mapped_buffers");
}

}  // namespace golden
