// SPDX-License-Identifier: MIT
#include "client_lib/geometry/sight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "client_lib/context/context.h"
#include "client_lib/follow/view_use.h"

namespace wall::client {

void GLAPIENTRY gl_entry_Vertex3f(GLfloat x, GLfloat y, GLfloat z);

namespace {

constexpr std::uint32_t kSide = 100;  // pixels of the window, and of each tile

/// 90 degrees wide, looks down -z.
glstate::Projection camera() {
    glstate::Projection p;
    p.camera = p.clip_from_object = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.2f, 0};
    p.viewport[2] = p.viewport[3] = kSide;
    return p;
}

/// Four tiles around the eye, on a node each, and one that shows the program's own picture.
SurfaceLayout all_around() {
    SurfaceLayout layout;
    layout.width = layout.height = kSide;
    layout.rect = {0, 0, 500, 100};
    for (std::uint32_t i = 0; i < 4; ++i) {
        layout.views.push_back({.view = {.elsewhere = geom::view_of_angles(90.0 * i, 0, 0, 90, 90)}});
        layout.layers.push_back(view_layer(layout, NodeIndex(i), 0, i + 1));
    }
    layout.layers.push_back(whole_window(kSide, kSide, NodeIndex(4)));
    return layout;
}

geom::Box box_at(float x, float y, float z, float size = 0.1f) {
    geom::Box box;
    for (const float s : {-size, size}) box.add(_mm_setr_ps(x + s, y + s, z + s, 1));
    return box;
}

std::vector<std::uint32_t> nodes_of(const SurfaceLayout& layout, const Reach& reach) {
    std::vector<std::uint32_t> out;
    for (const auto& [node, slots] : nodes_touched(layout.layers, reach)) out.push_back(node.value);
    return out;
}

class SightTest : public ::testing::Test {
protected:
    std::vector<std::uint32_t> seen_by(const geom::Box& box) { return nodes_of(layout_, sight_.of(box)); }

    const SurfaceLayout layout_ = all_around();
    const glstate::Projection own_ = camera();
    Sight sight_;
};

using Nodes = std::vector<std::uint32_t>;

TEST_F(SightTest, ABoxIsSeenByWhoeverLooksThere) {
    sight_.aim(own_, layout_.views);
    EXPECT_EQ(seen_by(box_at(0, 0, -5)), (Nodes{0, 4})) << "ahead, where the program's camera looks, too";
    EXPECT_EQ(seen_by(box_at(5, 0, 0)), (Nodes{1})) << "to the right";
    EXPECT_EQ(seen_by(box_at(0, 0, 5)), (Nodes{2})) << "behind";
    EXPECT_EQ(seen_by(box_at(-5, 0, 0)), (Nodes{3})) << "to the left";
    EXPECT_EQ(seen_by(box_at(5, 0, -5)), (Nodes{0, 1, 4})) << "at the edge of two";
    EXPECT_EQ(seen_by(box_at(0, 9, 0, 1)), (Nodes{})) << "above all of them";
    EXPECT_EQ(seen_by(box_at(0, 0, 0, 9)), (Nodes{0, 1, 2, 3, 4})) << "around the eye";
}

TEST_F(SightTest, AnImageIsSeenByWhoeverSeesItsPlace) {
    const auto seen = [&](float x, float y, float z, const std::optional<PixelRect>& window) {
        sight_.aim(own_, layout_.views);
        const glstate::Vec4 clip = glstate::project(own_, x, y, z, 1).clip;
        return nodes_of(layout_, sight_.of_image(Drawn::image(own_, clip, {-2, -2, 10, 10}, window)));
    };
    EXPECT_EQ(seen(0, 0, -5, PixelRect{48, 48, 60, 60}), (Nodes{0, 4})) << "ahead";
    EXPECT_EQ(seen(5, 0, 0, std::nullopt), (Nodes{1})) << "to the right, where the program's picture has nothing";
    EXPECT_EQ(seen(0.5f, 0, 5, std::nullopt), (Nodes{2})) << "behind";
    EXPECT_EQ(seen(-5, 0, 4.9f, std::nullopt), (Nodes{2, 3})) << "over the edge between two";
    EXPECT_EQ(seen(0, 9, 0, std::nullopt), (Nodes{})) << "above all of them";
    glstate::Projection flat = own_;
    flat.camera = flat.clip_from_object = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    sight_.aim(flat, layout_.views);
    EXPECT_EQ(nodes_of(layout_, sight_.of_image(Drawn::image(flat, {0, 0, 0, 1}, {}, PixelRect{48, 48, 60, 60}))),
              (Nodes{0, 1, 2, 3, 4}))
        << "drawn by no camera: on each of them";
}

TEST_F(SightTest, WithoutViewsItIsTheProjectionsOwn) {
    sight_.aim(own_, {});
    const Reach reach = sight_.of(box_at(5, 0, 0));
    EXPECT_TRUE(reach.views.empty());
    EXPECT_FALSE(reach.touches(whole_window(kSide, kSide, NodeIndex(0))));
}

TEST_F(SightTest, WhatHasNoPerspectiveIsTheSameInAllViews) {
    glstate::Projection flat = own_;
    flat.camera = flat.clip_from_object = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    sight_.aim(flat, layout_.views);
    EXPECT_EQ(seen_by(box_at(0.5f, 0.5f, 0)), (Nodes{0, 1, 2, 3, 4}));
    EXPECT_EQ(seen_by(box_at(5, 0, 0)), (Nodes{}));
    sight_.aim(own_, layout_.views);
    EXPECT_EQ(seen_by(box_at(5, 0, 0)), (Nodes{1})) << "and then the camera again";
}

TEST_F(SightTest, ModelsMoveBeforeTheCamera) {
    glstate::Projection turned = own_;  // a quarter to the left: what is ahead of the model is to the right
    const glstate::Mat4 model{0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1};
    turned.clip_from_object = glstate::multiply(own_.camera, model);
    sight_.aim(turned, layout_.views);
    EXPECT_EQ(seen_by(box_at(0, 0, -5)), (Nodes{1}));
}

TEST_F(SightTest, LargePixelsReachFarther) {
    SurfaceLayout layout = all_around();
    const geom::Box just_beyond = box_at(5, 0, -5.5f, 0.01f);  // some pixels past the right tile's left edge
    sight_.aim(own_, layout.views);
    EXPECT_EQ(nodes_of(layout, sight_.of(just_beyond)), (Nodes{0, 4}));
    for (SurfaceView& view : layout.views) view.window_pixels_x = 8;
    sight_.aim(own_, layout.views);
    EXPECT_EQ(nodes_of(layout, sight_.of(just_beyond)), (Nodes{0, 1, 4}));
}

TEST_F(SightTest, TrianglesAreSeenOneByOne) {
    Packer packer;
    tls_packer = &packer;
    packer.begin(GL_TRIANGLES);
    const std::array<std::array<float, 3>, 6> places = {
        {{-1, -1, -5}, {1, -1, -5}, {0, 1, -5}, {5, -1, -1}, {5, -1, 1}, {5, 1, 0}}};
    for (const auto& [x, y, z] : places) gl_entry_Vertex3f(x, y, z);
    packer.end();
    tls_packer = nullptr;
    sight_.aim(own_, layout_.views);
    VertexScan vertices;
    vertices.scan(packer, packer.primitives()[0], {}, own_);
    const Topology topology = *topology_of(GL_TRIANGLES);
    EXPECT_EQ(nodes_of(layout_, sight_.of(topology, vertices, 0)), (Nodes{0, 4}));
    EXPECT_EQ(nodes_of(layout_, sight_.of(topology, vertices, 3)), (Nodes{1}));
}

TEST_F(SightTest, WhatIsNotKnownMayBeInAllViews) {
    const glstate::Projection unknown = glstate::unknown_projection(own_.camera);
    sight_.aim(unknown, layout_.views);
    EXPECT_EQ(seen_by(box_at(0, 0, -5)), (Nodes{0, 1, 2, 3, 4}));
    glstate::Projection named = own_;
    named.unknown_elsewhere = true;
    sight_.aim(named, layout_.views);
    EXPECT_EQ(seen_by(box_at(5, 0, 0)), (Nodes{0, 1, 2, 3})) << "in the program's own picture its place is known";
}

TEST(ViewUseTest, AProgramWithACameraIsSeenAndOthersAreFlat) {
    const glstate::Projection perspective = camera();
    glstate::Projection flat = perspective, shader = perspective;
    flat.camera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    shader.by_shader = true;
    shader.camera = {};
    ViewUse use;
    use.offered.emplace_back();
    EXPECT_FALSE(use.finish_frame()) << "nothing was drawn";
    use.note(flat, nullptr);
    EXPECT_FALSE(use.finish_frame()) << "it stays flat";
    use.note(flat, nullptr);
    use.note(perspective, nullptr);
    EXPECT_TRUE(use.finish_frame());
    EXPECT_TRUE(use.used);
    EXPECT_FALSE(use.finish_frame()) << "a frame without anything tells nothing";
    use.note(flat, nullptr);
    use.note(flat, nullptr);
    EXPECT_FALSE(use.finish_frame()) << "nor does one of titles";
    EXPECT_TRUE(use.used);
    use.note(perspective, nullptr);
    use.note(shader, nullptr);
    use.note(glstate::unknown_projection(), nullptr);
    EXPECT_TRUE(use.finish_frame()) << "most of it has no camera that is known";
    EXPECT_FALSE(use.used);
    use.note(glstate::unknown_projection(perspective.camera), nullptr);
    EXPECT_TRUE(use.finish_frame()) << "a camera counts also where it is not known what lies where";
}

TEST(ViewUseTest, AProgramStaysFlatThatShowsNoCameraInManyFrames) {
    glstate::Projection flat = camera();
    flat.camera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    ViewUse use;
    const auto frames = [&](int count, const glstate::Projection* by) {
        for (int i = 0; i < count; ++i) {
            if (by != nullptr) use.note(*by, nullptr);
            use.finish_frame();
        }
    };
    frames(100, &flat);
    EXPECT_FALSE(use.stays_flat()) << "no tile looks elsewhere";
    use.offered.emplace_back();
    const glstate::Projection perspective = camera(), unknown = glstate::unknown_projection();
    frames(9, &flat);
    frames(5, nullptr);
    EXPECT_FALSE(use.stays_flat());
    frames(1, &perspective);
    frames(9, &unknown);
    EXPECT_FALSE(use.stays_flat()) << "not in a row";
    frames(1, &unknown);
    EXPECT_TRUE(use.stays_flat());
    frames(1, &perspective);
    EXPECT_FALSE(use.stays_flat());
}

}  // namespace
}  // namespace wall::client
