// SPDX-License-Identifier: MIT
// What a node would be told before drawing with a context: of each kind of object those in use, once they differ from
// what every node has.
#include "client_lib/context/used_objects.h"

#include <algorithm>
#include <array>
#include <vector>

#include "client_lib/context/memory_use.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/objects/maps.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class UsedObjectsTest : public ContextTest {
protected:
    /// Ids of what a node at time zero would be sent.
    std::vector<ClientName> used() {
        std::vector<ClientName> ids;
        for_each_used(c, [&](const Object& object) {
            if (object.latest() != 0) ids.push_back(object.id);
        });
        return ids;
    }
    bool uses(ClientName id) { return std::ranges::count(used(), id) != 0; }
    /// A texture with content, bound to a target of the active unit.
    ClientName bind_texture(GLenum target, GLuint name) {
        gl().BindTexture(c, target, name);
        const auto texture = texture_to_change(c, target);
        std::lock_guard lock(share->mutex);
        touch(*share, *texture);
        return texture->id;
    }
};

TEST_F(UsedObjectsTest, NothingAtTheStart) { EXPECT_TRUE(used().empty()); }

TEST_F(UsedObjectsTest, TexturesOfEnabledTargetsOnly) {
    const ClientName plain = bind_texture(GL_TEXTURE_2D, 1), rectangle = bind_texture(GL_TEXTURE_RECTANGLE, 2);
    gl().ActiveTexture(c, GL_TEXTURE1);
    const ClientName second = bind_texture(GL_TEXTURE_2D, 3);
    EXPECT_TRUE(used().empty());
    gl().Enable(c, GL_TEXTURE_2D);
    EXPECT_EQ(used(), std::vector{second});
    gl().ActiveTexture(c, GL_TEXTURE0);
    gl().Enable(c, GL_TEXTURE_RECTANGLE);
    EXPECT_TRUE(uses(rectangle) && uses(second) && !uses(plain));
}

TEST_F(UsedObjectsTest, ADefaultTextureOnceItHasContent) {
    gl().Enable(c, GL_TEXTURE_2D);
    EXPECT_TRUE(used().empty());
    const ClientName texture = bind_texture(GL_TEXTURE_2D, 0);
    EXPECT_EQ(used(), std::vector{texture});
}

TEST_F(UsedObjectsTest, MapsOnceTheyAreTheProgramsOwn) {
    const std::array<GLfloat, 2> table{0.25f, 0.5f};
    gl().PixelMapfv(c, GL_PIXEL_MAP_R_TO_R, 2, table.data());
    const std::array<GLfloat, 6> points{};
    gl().Map1f(c, GL_MAP1_VERTEX_3, 0, 1, 3, 2, points.data());
    EXPECT_EQ(used().size(), 2u);
    EXPECT_TRUE(uses(c.maps->map1[GL_MAP1_VERTEX_3 - GL_MAP1_COLOR_4].id));
    EXPECT_TRUE(uses(c.maps->pixel_maps[GL_PIXEL_MAP_R_TO_R - GL_PIXEL_MAP_I_TO_I].id));
}

TEST_F(UsedObjectsTest, TheStampTellsOfEachChange) {
    std::vector<UseStamp> stamps{use_stamp(c)};
    const auto differs = [&] {
        stamps.push_back(use_stamp(c));
        return std::ranges::count(stamps, stamps.back()) == 1;
    };
    bind_texture(GL_TEXTURE_2D, 1);
    EXPECT_TRUE(differs()) << "a binding";
    gl().Enable(c, GL_TEXTURE_2D);
    EXPECT_TRUE(differs()) << "a switch";
    const GLfloat nearest = GL_NEAREST;
    gl().TexParameterfv(c, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, &nearest);
    EXPECT_TRUE(differs()) << "an object";
    const std::array<GLfloat, 2> table{0.25f, 0.5f};
    gl().PixelMapfv(c, GL_PIXEL_MAP_R_TO_R, 2, table.data());
    EXPECT_TRUE(differs()) << "a map";
    EXPECT_EQ(use_stamp(c), stamps.back());
    gl().Color4f(c, 1, 0, 0, 1);
    EXPECT_EQ(use_stamp(c), stamps.back()) << "nothing that names an object";
    DispatchTarget target;
    c.memory->now = &target;
    EXPECT_TRUE(differs()) << "where compute shaders run";
    c.memory->now = nullptr;
}

}  // namespace
}  // namespace wall::client
