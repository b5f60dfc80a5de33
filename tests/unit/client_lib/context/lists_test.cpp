// SPDX-License-Identifier: MIT
// Display lists: how a recording is taken apart, and what calling one does to the context.
#include "client_lib/context/lists.h"

#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class ListTest : public ContextTest {
protected:
    void triangle(float x) {
        gl().Begin(c, GL_TRIANGLES);
        for (int i = 0; i < 6; ++i) gl().Vertex3f(c, x, static_cast<float>(i), 0);
        gl().End(c);
    }
    void begin_list(GLuint name, GLenum mode = GL_COMPILE) { gl().NewList(c, name, mode); }
    void end_list() { gl().EndList(c); }
    const DisplayList& list(GLuint name) { return *share->lists.find(name); }
};

TEST_F(ListTest, ConsecutiveGeometryIsOneRun) {
    begin_list(1);
    gl().Color3f(c, 1, 0, 0);
    triangle(1);
    gl().Normal3f(c, 0, 1, 0);
    triangle(2);
    end_list();
    ASSERT_EQ(list(1).items.size(), 1u);
    const ListRun& run = *list(1).items[0].run;
    EXPECT_EQ(run.content.commands(), 2u + 2 * 8);
    EXPECT_EQ(run.in_context.attributes.size(), 2u);
    EXPECT_TRUE(c.packer.empty());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(ListTest, StateEndsARunAndIsReplayed) {
    begin_list(1);
    triangle(1);
    gl().Enable(c, GL_FOG);
    triangle(2);
    end_list();
    ASSERT_EQ(list(1).items.size(), 3u);
    EXPECT_FALSE(c.state.fog.fog_enabled);
    gl().CallList(c, 1);
    EXPECT_TRUE(c.state.fog.fog_enabled);
}

TEST_F(ListTest, ARunLeavesItsAttributesAndMaterials) {
    const GLfloat red[4] = {1, 0, 0, 1}, unit[1] = {32};
    begin_list(1);
    gl().Materialfv(c, GL_FRONT, GL_DIFFUSE, red);
    triangle(1);
    gl().Color3f(c, 0.25f, 0.5f, 1);
    gl().MultiTexCoord4f(c, GL_TEXTURE2, 1, 2, 3, 4);
    gl().Materialfv(c, GL_FRONT_AND_BACK, GL_SHININESS, unit);
    triangle(2);
    end_list();
    EXPECT_EQ(list(1).items.size(), 1u);
    EXPECT_EQ(c.state.material.material_shininess[0], 0);
    gl().CallList(c, 1);
    EXPECT_EQ(c.state.current.color, (glstate::Vec4{0.25f, 0.5f, 1, 1}));
    EXPECT_EQ(c.state.current.texcoord[2], (glstate::Vec4{1, 2, 3, 4}));
    EXPECT_EQ(c.state.material.material_diffuse[0], (glstate::Vec4{1, 0, 0, 1}));
    EXPECT_EQ(c.state.material.material_diffuse[1], (glstate::Vec4{0.8f, 0.8f, 0.8f, 1}));
    EXPECT_EQ(c.state.material.material_shininess[1], 32);
}

TEST_F(ListTest, HalvesOfBeginEndComeTogether) {
    begin_list(1);
    gl().Begin(c, GL_TRIANGLES);
    gl().Vertex3f(c, 0, 0, 0);
    end_list();
    begin_list(2);
    gl().Vertex3f(c, 1, 0, 0);
    gl().Vertex3f(c, 0, 1, 0);
    gl().End(c);
    end_list();
    gl().CallList(c, 1);
    EXPECT_TRUE(c.packer.inside());
    gl().CallList(c, 2);
    EXPECT_FALSE(c.packer.inside());
    ASSERT_EQ(c.packer.primitives().size(), 1u);
    EXPECT_EQ(c.packer.commands(), 5u);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(ListTest, ARunInsideBeginIsUnpacked) {
    begin_list(1);
    triangle(0);
    end_list();
    ASSERT_TRUE(list(1).items[0].run);
    gl().Begin(c, GL_POINTS);
    gl().CallList(c, 1);  // glBegin within glBegin is an error, its vertices and glEnd count
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_FALSE(c.packer.inside());
    EXPECT_EQ(c.packer.commands(), 8u);
}

TEST_F(ListTest, StateInsideBeginIsAnError) {
    begin_list(1);
    gl().Enable(c, GL_FOG);
    end_list();
    gl().Begin(c, GL_POINTS);
    gl().CallList(c, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_FALSE(c.state.fog.fog_enabled);
}

TEST_F(ListTest, ArraysAreOneCommandInAList) {
    const GLfloat points[6] = {0, 0, 1, 0, 1, 1};
    gl().VertexPointer(c, 2, GL_FLOAT, 0, points);
    gl().EnableClientState(c, GL_VERTEX_ARRAY);
    begin_list(1);
    gl().Vertex2f(c, 5, 5);  // of a glBegin outside
    end_list();
    begin_list(2);
    triangle(1);
    gl().DrawArrays(c, GL_TRIANGLES, 0, 3);
    triangle(2);
    end_list();
    ASSERT_EQ(list(2).items.size(), 1u);
    const ListRun& run = *list(2).items[0].run;
    EXPECT_EQ(run.content.commands(), 8u + 5 + 8);
    EXPECT_EQ(run.array_draws, std::vector<std::size_t>{8});

    gl().Begin(c, GL_POINTS);
    gl().CallList(c, 1);
    begin_list(3);
    gl().End(c);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});  // no list is made between glBegin and glEnd
}

TEST_F(ListTest, ArraysOfAListInsideBeginDrawNothing) {
    const GLfloat points[6] = {0, 0, 1, 0, 1, 1};
    gl().VertexPointer(c, 2, GL_FLOAT, 0, points);
    begin_list(1);
    gl().Vertex2f(c, 5, 5);
    gl().DrawArrays(c, GL_TRIANGLES, 0, 3);  // nothing to draw yet, an error all the same
    gl().EnableClientState(c, GL_VERTEX_ARRAY);
    gl().DrawArrays(c, GL_TRIANGLES, 0, 3);
    end_list();
    gl().Begin(c, GL_POINTS);
    gl().CallList(c, 1);
    EXPECT_EQ(c.packer.commands(), 2u);  // Begin and one vertex
    gl().End(c);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});

    begin_list(2, GL_COMPILE_AND_EXECUTE);
    gl().Begin(c, GL_POINTS);
    gl().DrawArrays(c, GL_TRIANGLES, 0, 3);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().EndList(c);  // so is this
    gl().End(c);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    end_list();
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().CallList(c, 2);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(ListTest, ImagesInsideBeginAreErrorsToo) {
    const GLubyte byte = 0;
    begin_list(1, GL_COMPILE_AND_EXECUTE);
    gl().Begin(c, GL_POINTS);
    gl().Bitmap(c, 1, 1, 0, 0, 0, 0, &byte);
    gl().End(c);
    end_list();
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().CallList(c, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(ListTest, NestedListsAreLookedUpWhenCalled) {
    begin_list(1);
    gl().CallList(c, 2);
    end_list();
    gl().CallList(c, 1);  // 2 does not exist: nothing
    begin_list(2);
    gl().Enable(c, GL_FOG);
    end_list();
    gl().CallList(c, 1);
    EXPECT_TRUE(c.state.fog.fog_enabled);
}

TEST_F(ListTest, ACycleStopsAtTheNestingLimit) {
    begin_list(1);
    gl().Translatef(c, 1, 0, 0);
    gl().CallList(c, 1);
    end_list();
    gl().CallList(c, 1);
    EXPECT_EQ(c.state.matrix.modelview[12], static_cast<float>(kListNestingLimit));
}

TEST_F(ListTest, CompileAndExecuteDoesBoth) {
    begin_list(1, GL_COMPILE_AND_EXECUTE);
    gl().Translatef(c, 1, 0, 0);
    EXPECT_EQ(c.state.matrix.modelview[12], 1);
    for (int i = 0; i < 2000; ++i) triangle(0);
    const std::size_t packed = c.packer.commands();
    end_list();
    EXPECT_EQ(packed, 2000u * 8);
    EXPECT_EQ(c.packer.commands(), packed);
    EXPECT_EQ(c.table, &tables::immediate);
    c.packer.reset();
    gl().CallList(c, 1);
    EXPECT_EQ(c.state.matrix.modelview[12], 2);
}

TEST_F(ListTest, CallListsReadsEveryTypeAndAddsTheBase) {
    begin_list(0x102);
    gl().Translatef(c, 1, 0, 0);
    end_list();
    const GLbyte bytes[] = {2};
    const GLushort shorts[] = {2};
    const GLfloat floats[] = {2.5f};
    const GLubyte pairs[] = {1, 2};
    gl().ListBase(c, 0x100);
    gl().CallLists(c, 1, GL_BYTE, bytes);
    gl().CallLists(c, 1, GL_UNSIGNED_SHORT, shorts);
    gl().CallLists(c, 1, GL_FLOAT, floats);
    gl().ListBase(c, 0);
    gl().CallLists(c, 1, GL_2_BYTES, pairs);
    EXPECT_EQ(c.state.matrix.modelview[12], 4);
    gl().CallLists(c, 1, GL_DOUBLE, bytes);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().CallLists(c, -1, GL_BYTE, bytes);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(ListTest, CompiledCallListsUsesTheBaseOfTheCall) {
    begin_list(12);
    gl().Translatef(c, 1, 0, 0);
    end_list();
    const GLubyte text[] = {2};
    begin_list(1);
    gl().CallLists(c, 1, GL_UNSIGNED_BYTE, text);
    end_list();
    gl().ListBase(c, 10);
    gl().CallList(c, 1);
    EXPECT_EQ(c.state.matrix.modelview[12], 1);
}

TEST_F(ListTest, NamesAndErrors) {
    gl().EndList(c);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().NewList(c, 0, GL_COMPILE);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().NewList(c, 1, GL_RENDER);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    const GLuint first = gl().GenLists(c, 3);
    EXPECT_TRUE(gl().IsList(c, first + 2));
    EXPECT_FALSE(gl().IsList(c, first + 3));
    begin_list(first);
    gl().NewList(c, 9, GL_COMPILE);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().DeleteLists(c, first, 0x7fffffff);  // its own name while it is compiled
    end_list();
    EXPECT_TRUE(gl().IsList(c, first));
    EXPECT_FALSE(gl().IsList(c, first + 1));
}

}  // namespace
}  // namespace wall::client
