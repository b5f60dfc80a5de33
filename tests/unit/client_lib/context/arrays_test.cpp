// SPDX-License-Identifier: MIT
// Vertex arrays: what they pack is what glBegin .. glEnd would, the current attributes stay, and only referenced
// vertices are touched.
#include <sys/mman.h>

#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class ArraysTest : public ContextTest {
protected:
    struct Block {
        std::vector<std::byte> opcodes, operands;
        bool operator==(const Block&) const = default;
    };
    Block take() {
        const auto opcodes = c.packer.opcodes(), operands = c.packer.operands();
        Block block{{opcodes.begin(), opcodes.end()}, {operands.begin(), operands.end()}};
        c.packer.reset();
        return block;
    }
};

TEST_F(ArraysTest, FloatsAndBytesPackAsImmediateMode) {
    const float vertices[] = {1, 2, 3, 4, 5, 6, 7, 8, 9}, texcoords[] = {0, 1, 2, 3, 4, 5};
    const GLubyte colors[] = {0, 1, 2, 4, 5, 8, 9, 10, 255, 11, 16, 17};
    gl().VertexPointer(c, 3, GL_FLOAT, 0, vertices);
    gl().ColorPointer(c, 4, GL_UNSIGNED_BYTE, 0, colors);
    gl().TexCoordPointer(c, 2, GL_FLOAT, 0, texcoords);
    for (const GLenum cap : {GL_VERTEX_ARRAY, GL_COLOR_ARRAY, GL_TEXTURE_COORD_ARRAY}) gl().EnableClientState(c, cap);
    gl().DrawArrays(c, GL_TRIANGLES, 0, 3);
    ASSERT_EQ(c.packer.primitives().size(), 1u);
    const auto arrays = take();

    gl().Begin(c, GL_TRIANGLES);
    for (int i = 0; i < 3; ++i) {
        gl().Color4ub(c, colors[4 * i], colors[4 * i + 1], colors[4 * i + 2], colors[4 * i + 3]);
        gl().TexCoord2f(c, texcoords[2 * i], texcoords[2 * i + 1]);
        gl().Vertex3f(c, vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]);
    }
    gl().End(c);
    gl().Color4f(c, 1, 1, 1, 1);  // the current attributes are what they were
    gl().TexCoord4f(c, 0, 0, 0, 1);
    EXPECT_EQ(arrays, take());
}

TEST_F(ArraysTest, VerticesOfOneComponentAreWhole) {
    const float values[] = {1, 2, 3};
    gl().VertexAttribPointer(c, 0, 1, GL_FLOAT, GL_FALSE, 0, values);
    gl().EnableVertexAttribArray(c, 0);
    gl().DrawArrays(c, GL_TRIANGLES, 0, 3);
    const auto arrays = take();
    gl().Begin(c, GL_TRIANGLES);
    for (const float value : values) gl().Vertex4f(c, value, 0, 0, 1);
    gl().End(c);
    EXPECT_EQ(arrays, take());
}

// llvmpipe multiplies by 1/255 where glColor4ub divides by 255: for half of the bytes not the same float.
TEST_F(ArraysTest, BytesThatADrawConvertsOtherwiseTravelAsFloats) {
    const float vertices[] = {1, 2};
    const GLubyte colors[] = {0, 1, 3, 255};
    gl().VertexPointer(c, 2, GL_FLOAT, 0, vertices);
    gl().ColorPointer(c, 4, GL_UNSIGNED_BYTE, 0, colors);
    gl().EnableClientState(c, GL_VERTEX_ARRAY);
    gl().EnableClientState(c, GL_COLOR_ARRAY);
    gl().DrawArrays(c, GL_POINTS, 0, 1);
    EXPECT_EQ(static_cast<glapi::Op>(c.packer.opcode_at(1)), glapi::Op::Color4f);
    float blue;
    std::memcpy(&blue, c.packer.operand_at(4 + 8), sizeof blue);
    EXPECT_EQ(blue, 3 * (1.0f / 255.0f));
    EXPECT_NE(blue, 3 / 255.0f);
    c.packer.reset();
    gl().Begin(c, GL_POINTS);
    gl().ArrayElement(c, 0);  // Mesa makes a glColor4ub of it
    EXPECT_EQ(static_cast<glapi::Op>(c.packer.opcode_at(1)), glapi::Op::Color4ub);
    gl().End(c);
}

TEST_F(ArraysTest, ConvertedTypes) {
    const GLshort vertices[] = {10, -20, 30, 40};
    const GLushort colors[] = {0, 65535, 0, 65535, 0, 65535};
    gl().VertexPointer(c, 2, GL_SHORT, 0, vertices);
    gl().ColorPointer(c, 3, GL_UNSIGNED_SHORT, 0, colors);
    gl().EnableClientState(c, GL_VERTEX_ARRAY);
    gl().EnableClientState(c, GL_COLOR_ARRAY);
    const GLubyte indices[] = {1, 0};
    gl().DrawElements(c, GL_LINES, 2, GL_UNSIGNED_BYTE, indices);
    const auto arrays = take();
    gl().Begin(c, GL_LINES);
    gl().Color3f(c, 1, 0, 1);
    gl().Vertex2f(c, 30, 40);
    gl().Color3f(c, 0, 1, 0);
    gl().Vertex2f(c, 10, -20);
    gl().End(c);
    gl().Color4f(c, 1, 1, 1, 1);
    EXPECT_EQ(arrays, take());
}

// All arrays at once, one of three vertices' worth of floats for each attribute that the table has.
TEST_F(ArraysTest, EveryAttributeComesFromItsArray) {
    constexpr GLsizei kStride = 4 * sizeof(float);
    std::array<std::array<float, 8>, kAttributes> values{};
    for (std::size_t place = 0; place < kAttributes; ++place)
        for (std::size_t i = 0; i < 8; ++i) values[place][i] = static_cast<float>(10 * place + i + 1) / 512.0f;
    const auto of = [&](Attribute a) { return values[place_of(a)].data(); };
    const float positions[] = {1, 2, 3, 0, 4, 5, 6, 0};
    const GLboolean edges[] = {GL_FALSE, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, GL_TRUE};
    gl().VertexPointer(c, 3, GL_FLOAT, kStride, positions);
    gl().ColorPointer(c, 4, GL_FLOAT, kStride, of(Attribute::color));
    gl().NormalPointer(c, GL_FLOAT, kStride, of(Attribute::normal));
    gl().SecondaryColorPointer(c, 3, GL_FLOAT, kStride, of(Attribute::secondary_color));
    gl().FogCoordPointer(c, GL_FLOAT, kStride, of(Attribute::fog_coord));
    gl().IndexPointer(c, GL_FLOAT, kStride, of(Attribute::color_index));
    gl().EdgeFlagPointer(c, kStride, edges);
    for (unsigned unit = 0; unit < kTextureCoords; ++unit) {
        gl().ClientActiveTexture(c, GL_TEXTURE0 + unit);
        gl().TexCoordPointer(c, unit == 0 ? 3 : 4, GL_FLOAT, kStride, of(Attribute::texcoord + unit));
        gl().EnableClientState(c, GL_TEXTURE_COORD_ARRAY);
    }
    for (GLuint i = 1; i < kVertexAttributes; ++i) {
        gl().VertexAttribPointer(c, i, 4, GL_FLOAT, GL_FALSE, kStride, of(Attribute::vertex_attrib + i));
        gl().EnableVertexAttribArray(c, i);
    }
    for (const GLenum cap : {GL_VERTEX_ARRAY, GL_COLOR_ARRAY, GL_NORMAL_ARRAY, GL_SECONDARY_COLOR_ARRAY,
                             GL_FOG_COORD_ARRAY, GL_INDEX_ARRAY, GL_EDGE_FLAG_ARRAY})
        gl().EnableClientState(c, cap);
    ASSERT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().DrawArrays(c, GL_LINES, 0, 2);
    const auto arrays = take();

    gl().Begin(c, GL_LINES);
    for (std::size_t vertex = 0; vertex < 2; ++vertex) {
        const auto at = [&](Attribute a) { return of(a) + 4 * vertex; };
        const float *color = at(Attribute::color), *normal = at(Attribute::normal), *st = at(Attribute::texcoord),
                    *second = at(Attribute::secondary_color), *position = positions + 4 * vertex;
        gl().Color4f(c, color[0], color[1], color[2], color[3]);
        gl().Normal3f(c, normal[0], normal[1], normal[2]);
        gl().TexCoord3f(c, st[0], st[1], st[2]);
        for (unsigned unit = 1; unit < kTextureCoords; ++unit) {
            const float* v = at(Attribute::texcoord + unit);
            gl().MultiTexCoord4f(c, GL_TEXTURE0 + unit, v[0], v[1], v[2], v[3]);
        }
        gl().SecondaryColor3f(c, second[0], second[1], second[2]);
        gl().FogCoordf(c, *at(Attribute::fog_coord));
        gl().EdgeFlag(c, edges[vertex * kStride]);
        gl().Indexf(c, *at(Attribute::color_index));
        for (GLuint i = 1; i < kVertexAttributes; ++i) {
            const float* v = at(Attribute::vertex_attrib + i);
            gl().VertexAttrib4f(c, i, v[0], v[1], v[2], v[3]);
        }
        gl().Vertex3f(c, position[0], position[1], position[2]);
    }
    gl().End(c);
    const std::size_t drawn = c.packer.commands();
    EXPECT_EQ(arrays.opcodes.size(), drawn + kAttributes - 1);  // and the current values again, but of attribute 0
    const auto commands = take();
    const std::span behind(arrays.operands);
    ASSERT_GE(behind.size(), commands.operands.size());
    EXPECT_TRUE(std::ranges::equal(behind.first(commands.operands.size()), commands.operands));
    // Opcodes are packed backwards: the first command's is the last.
    EXPECT_TRUE(std::ranges::equal(std::span(arrays.opcodes).last(drawn), commands.opcodes));
}

TEST_F(ArraysTest, CurrentColorInTheBlockIsRestored) {
    const float vertices[] = {0, 0, 1, 0, 1, 1}, colors[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    gl().Color4ub(c, 9, 8, 7, 6);
    gl().VertexPointer(c, 2, GL_FLOAT, 0, vertices);
    gl().ColorPointer(c, 3, GL_FLOAT, 0, colors);
    gl().EnableClientState(c, GL_VERTEX_ARRAY);
    gl().EnableClientState(c, GL_COLOR_ARRAY);
    gl().DrawArrays(c, GL_TRIANGLES, 0, 3);
    EXPECT_EQ(c.packer.last_op[0], glapi::Op::Color4ub);
    EXPECT_EQ(std::to_integer<int>(c.packer.last[0][0]), 9);
}

TEST_F(ArraysTest, OnlyReferencedVerticesAreTouched) {
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    auto* memory =
        static_cast<std::byte*>(::mmap(nullptr, 3 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    ASSERT_NE(memory, MAP_FAILED);
    ::mprotect(memory, page, PROT_NONE);
    ::mprotect(memory + 2 * page, page, PROT_NONE);
    const GLuint first = static_cast<GLuint>(page / 8), last = static_cast<GLuint>(2 * page / 8 - 1);
    const GLuint indices[] = {first, last, first};
    gl().VertexPointer(c, 2, GL_FLOAT, 0, memory);
    gl().EnableClientState(c, GL_VERTEX_ARRAY);
    gl().DrawElements(c, GL_TRIANGLES, 3, GL_UNSIGNED_INT, indices);
    EXPECT_EQ(take().operands.size(), 4u + 3 * 8);
    ::munmap(memory, 3 * page);
}

TEST_F(ArraysTest, LargeDrawsGrowThePacker) {
    std::vector<float> vertices(3 * 100000, 1.5f);
    std::vector<float> normals(3 * 100000, 0.5f);
    gl().VertexPointer(c, 3, GL_FLOAT, 0, vertices.data());
    gl().NormalPointer(c, GL_FLOAT, 0, normals.data());
    gl().EnableClientState(c, GL_VERTEX_ARRAY);
    gl().EnableClientState(c, GL_NORMAL_ARRAY);
    gl().NewList(c, 1, GL_COMPILE);  // records, so nothing reaches a node
    gl().DrawArrays(c, GL_POINTS, 0, 100000);
    gl().EndList(c);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(ArraysTest, Errors) {
    gl().VertexPointer(c, 1, GL_FLOAT, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().VertexPointer(c, 3, GL_UNSIGNED_BYTE, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().DrawArrays(c, GL_POINTS, 0, -1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().DrawElements(c, GL_POINTS, 1, GL_SHORT, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().EnableClientState(c, GL_LIGHTING);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().PopClientAttrib(c);
    EXPECT_EQ(error(), GLenum{GL_STACK_UNDERFLOW});
}

TEST_F(ArraysTest, BindingsAreToldByTheApplicationsNames) {
    GLuint names[3];
    gl().GenBuffers(c, 3, names);
    gl().BindBuffer(c, GL_ARRAY_BUFFER, names[2]);
    gl().BindBuffer(c, GL_PIXEL_PACK_BUFFER, names[1]);
    gl().ColorPointer(c, 4, GL_FLOAT, 0, nullptr);
    gl().VertexAttribPointer(c, 3, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
    GLint bound = 0;
    for (const GLenum word : {GL_ARRAY_BUFFER_BINDING, GL_COLOR_ARRAY_BUFFER_BINDING}) {
        gl().GetIntegerv(c, word, &bound);
        EXPECT_EQ(bound, static_cast<GLint>(names[2]));
    }
    gl().GetIntegerv(c, GL_PIXEL_PACK_BUFFER_BINDING, &bound);
    EXPECT_EQ(bound, static_cast<GLint>(names[1]));
    gl().GetVertexAttribiv(c, 3, GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING, &bound);
    EXPECT_EQ(bound, static_cast<GLint>(names[2]));
    gl().GetIntegerv(c, GL_PIXEL_UNPACK_BUFFER_BINDING, &bound);
    EXPECT_EQ(bound, 0);
}

TEST_F(ArraysTest, EnableTakesArraysToo) {
    gl().Enable(c, GL_NORMAL_ARRAY);
    EXPECT_TRUE(gl().IsEnabled(c, GL_NORMAL_ARRAY));
    gl().Disable(c, GL_NORMAL_ARRAY);
    EXPECT_FALSE(gl().IsEnabled(c, GL_NORMAL_ARRAY));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(ArraysTest, PixelMapsComeFromBuffersAndGoThere) {
    GLuint buffer;
    gl().GenBuffers(c, 1, &buffer);
    for (const GLenum target : {GL_PIXEL_UNPACK_BUFFER, GL_PIXEL_PACK_BUFFER}) gl().BindBuffer(c, target, buffer);
    const GLushort values[4] = {65535, 0, 0, 0};
    gl().BufferData(c, GL_PIXEL_PACK_BUFFER, sizeof values, values, GL_STREAM_READ);
    const auto* second = reinterpret_cast<const GLushort*>(std::uintptr_t{2});
    gl().PixelMapusv(c, GL_PIXEL_MAP_R_TO_R, 2, nullptr);
    gl().GetPixelMapusv(c, GL_PIXEL_MAP_R_TO_R, const_cast<GLushort*>(second));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    GLushort now[4];
    gl().GetBufferSubData(c, GL_PIXEL_PACK_BUFFER, 0, sizeof now, now);
    EXPECT_EQ(now[0], 65535);
    EXPECT_EQ(now[1], 65535);
    EXPECT_EQ(now[2], 0);
    gl().PixelMapusv(c, GL_PIXEL_MAP_R_TO_R, 4, second);  // over the end
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(ArraysTest, ClientAttributesAreKept) {
    gl().PushClientAttrib(c, GL_CLIENT_ALL_ATTRIB_BITS);
    gl().PixelStorei(c, GL_PACK_ALIGNMENT, 8);
    gl().EnableClientState(c, GL_NORMAL_ARRAY);
    gl().PopClientAttrib(c);
    EXPECT_EQ(c.state.local.pack_alignment, 4);
    EXPECT_FALSE(gl().IsEnabled(c, GL_NORMAL_ARRAY));
}

}  // namespace
}  // namespace wall::client
