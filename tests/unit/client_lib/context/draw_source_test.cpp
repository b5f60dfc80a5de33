// SPDX-License-Identifier: MIT
// A context as those see it who follow its state.
#include "client_lib/follow/draw_source.h"

#include <vector>

#include "client_lib/context/select.h"
#include "client_lib/context/texture_binding.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class ADrawSource : public ContextTest {
protected:
    std::vector<ClientName> used() {
        std::vector<ClientName> ids;
        c.draw_source().objects.for_each_used([&](const Object& object) {
            if (object.latest() != 0) ids.push_back(object.id);
        });
        return ids;
    }
    std::shared_ptr<ClientSurface> surface = std::make_shared<ClientSurface>(SurfaceId(1), SurfaceOptions{});
    std::shared_ptr<ClientSurface> other = std::make_shared<ClientSurface>(SurfaceId(2), SurfaceOptions{});
};

TEST_F(ADrawSource, HasNoTargetsWithoutSurfaces) {
    const DrawSource source = c.draw_source();
    EXPECT_FALSE(source.draw || source.read);
}

TEST_F(ADrawSource, DrawsToOneSurfaceAndReadsFromAnother) {
    surface->layout.width = 30;
    other->layout.width = 40;
    c.bind_surfaces(surface, other);
    EXPECT_EQ(c.draw_source().draw.size().width, 30u);
    EXPECT_EQ(c.draw_source().read.size().width, 40u);
}

TEST_F(ADrawSource, DrawsToOneLayerWhileSelecting) {
    surface->layout.layers = {whole_window(30, 20, NodeIndex(0)), whole_window(30, 20, NodeIndex(1))};
    c.bind_surfaces(surface, surface);
    EXPECT_EQ(c.draw_source().draw.layers().size(), 2u);
    c.select->layer = whole_window(30, 20, NodeIndex(1));
    ASSERT_EQ(c.draw_source().draw.layers().size(), 1u);
    EXPECT_EQ(c.draw_source().draw.layers().front().node, NodeIndex(1));
    EXPECT_EQ(c.draw_source().read.layers().size(), 2u);
    c.select->layer.reset();
    EXPECT_EQ(c.draw_source().draw.layers().size(), 2u);
}

TEST_F(ADrawSource, TellsByItsStampThatOtherObjectsAreUsed) {
    const UseStamp before = c.draw_source().used;
    EXPECT_EQ(c.draw_source().used, before);
    EXPECT_TRUE(used().empty());
    gl().Enable(c, GL_TEXTURE_2D);
    gl().BindTexture(c, GL_TEXTURE_2D, 1);
    const auto texture = texture_to_change(c, GL_TEXTURE_2D);
    touch(*share, *texture);
    EXPECT_NE(c.draw_source().used, before);
    EXPECT_EQ(used(), std::vector{texture->id});
}

}  // namespace
}  // namespace wall::client
