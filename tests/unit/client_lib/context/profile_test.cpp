// SPDX-License-Identifier: MIT
// A core profile: what OpenGL removed is an error there, and what it always has is told to the nodes.
#include "client_lib/context/profile.h"

#include <algorithm>
#include <string>
#include <vector>

#include "client_lib/context/es_version.h"
#include "client_lib/context/version.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class CoreProfile : public testing::Test {
protected:
    void SetUp() override { tls_context = &c; }
    void TearDown() override { tls_context = nullptr; }
    const GlTable& gl() const { return *c.table; }
    GLenum error() { return c.take_error(); }

    Context c{std::make_shared<ShareGroup>(), {.core = true, .forward_compatible = true, .debug = true}};
};

TEST_F(CoreProfile, HasNoRemovedCommands) {
    gl().Begin(c, GL_TRIANGLES);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().NewList(c, 1, GL_COMPILE);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().PushAttrib(c, GL_ALL_ATTRIB_BITS);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().Color3f(c, 1, 0, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().DepthFunc(c, GL_LESS);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(CoreProfile, HasNoRemovedWords) {
    for (const GLenum word : {GL_LIGHTING, GL_POINT_SPRITE, GL_ALPHA_TEST, GL_TEXTURE_2D}) {
        gl().Enable(c, word);
        EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM}) << std::hex << word;
    }
    GLint value = 0;
    gl().GetIntegerv(c, GL_MATRIX_MODE, &value);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().Enable(c, GL_BLEND);
    gl().Enable(c, GL_PROGRAM_POINT_SIZE);
    gl().GetIntegerv(c, GL_BLEND_SRC_RGB, &value);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(CoreProfile, DrawsFromArrayObjectsOnly) {
    gl().DrawArrays(c, GL_TRIANGLES, 0, 3);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().DrawArrays(c, GL_QUADS, 0, 4);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().VertexAttribPointer(c, 0, 4, GL_FLOAT, 0, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    GLuint arrays = 0;
    gl().GenVertexArrays(c, 1, &arrays);
    gl().BindVertexArray(c, arrays);
    const float memory[4] = {};
    gl().VertexAttribPointer(c, 0, 4, GL_FLOAT, 0, 0, memory);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "no array is in the program's memory";
}

TEST_F(CoreProfile, TakesGeneratedNamesOnly) {
    gl().BindTexture(c, GL_TEXTURE_2D, 7);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindBuffer(c, GL_ARRAY_BUFFER, 7);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BeginQueryIndexed(c, GL_SAMPLES_PASSED, 0, 7);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindFramebuffer(c, GL_FRAMEBUFFER, 7);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(CoreProfile, IsWhatItSays) {
    GLint value = 0;
    gl().GetIntegerv(c, GL_CONTEXT_PROFILE_MASK, &value);
    EXPECT_EQ(value, GL_CONTEXT_CORE_PROFILE_BIT);
    gl().GetIntegerv(c, GL_CONTEXT_FLAGS, &value);
    EXPECT_EQ(value, GL_CONTEXT_FLAG_FORWARD_COMPATIBLE_BIT | GL_CONTEXT_FLAG_DEBUG_BIT);
    EXPECT_TRUE(gl().IsEnabled(c, GL_DEBUG_OUTPUT));
    gl().LineWidth(c, 2);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    EXPECT_TRUE(c.state.line_point.point_sprite);
}

TEST(Versions, HaveShadingLanguages) {
    Caps caps;
    caps.version = "3.3 (Compatibility Profile) Mesa";
    ContextProfile profile;
    const std::vector<std::string> all{"330", "150", "140", "130", "120", ""};
    EXPECT_EQ(shading_languages_in(profile, caps), all);
    caps.extensions = "GL_ARB_ES2_compatibility GL_ARB_ES3_compatibility";
    EXPECT_EQ(shading_languages_in(profile, caps).back(), "300 es");
    profile.core = true;
    EXPECT_EQ(shading_languages_in(profile, caps), (std::vector<std::string>{"330", "150", "140", "100", "300 es"}));
    profile.es = 20;
    EXPECT_EQ(shading_languages_in(profile, caps), std::vector<std::string>{"100"});
}

TEST(Versions, AreOfferedWithAllTheirCommands) {
    const GlVersion version = implemented_version();
    EXPECT_TRUE(is_implemented(2, 1));
    for (const VersionCommands& each : kVersions) {
        const bool offered = each.major < version.major || (each.major == version.major && each.minor <= version.minor);
        EXPECT_EQ(is_implemented(each.major, each.minor), offered);
        EXPECT_FALSE(offered && each.missing) << each.missing;
    }
    EXPECT_TRUE(std::ranges::is_sorted(kRemovedWords));
}

}  // namespace
}  // namespace wall::client
