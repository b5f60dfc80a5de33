// SPDX-License-Identifier: MIT
#include "common/glapi/named_camera.h"

#include <gtest/gtest.h>

#include "common/base/camera_names.h"

namespace wall::glapi {
namespace {

using Names = std::vector<std::string>;

TEST(CameraNames, AreNamesWithCommasBetweenThem) {
    EXPECT_EQ(camera_names_of_text("viewProjection"), Names{"viewProjection"});
    EXPECT_EQ(camera_names_of_text("eye.proj,matrices[1],P"), (Names{"eye.proj", "matrices[1]", "P"}));
    for (const char* bad : {"", ",", "a,", "a,,b", "a b", "a;b", "a\nb", "\xc3\xa4"})
        EXPECT_FALSE(camera_names_of_text(bad)) << bad;
    EXPECT_TRUE(camera_names_of_text(std::string(kMostCameraName, 'a')));
    EXPECT_FALSE(camera_names_of_text(std::string(kMostCameraName + 1, 'a')));
    std::string many = "a";
    for (std::size_t i = 1; i < kMostCameraNames; ++i) many += ",a";
    EXPECT_TRUE(camera_names_of_text(many));
    EXPECT_FALSE(camera_names_of_text(many + ",a"));
}

ActiveUniform uniform(GLenum type, const char* name, std::uint32_t size = 1) {
    ActiveUniform out;
    out.type = type;
    out.size = size;
    out.array = size > 1;
    out.name = name;
    return out;
}

/// The camera that is noted; nothing: none.
std::optional<PositionUniform> noted(const Names& names, const std::vector<ActiveUniform>& uniforms) {
    PositionProgram position;
    name_camera(position, names, uniforms);
    return position.camera ? std::optional(position.uniforms.at(*position.camera)) : std::nullopt;
}

TEST(NamedCamera, IsAMatrixOfFloatsOfThatName) {
    const std::vector<ActiveUniform> uniforms{uniform(GL_FLOAT_MAT3, "normals"), uniform(GL_FLOAT_MAT4, "camera"),
                                              uniform(GL_FLOAT_MAT4, "eyes[1].view"),
                                              uniform(GL_FLOAT_MAT4, "matrices", 3)};
    EXPECT_EQ(noted({"camera"}, uniforms), (PositionUniform{"camera", 0}));
    EXPECT_EQ(noted({"nowhere", "eyes[1].view"}, uniforms), (PositionUniform{"eyes[1].view", 0}));
    EXPECT_EQ(noted({"matrices"}, uniforms), (PositionUniform{"matrices", 0}));
    EXPECT_EQ(noted({"matrices[2]", "camera"}, uniforms), (PositionUniform{"matrices", 2}))
        << "the first that is there";
    for (const char* wrong : {"normals", "matrices[3]", "camera[0]", "cam", "Camera"})
        EXPECT_FALSE(noted({wrong}, uniforms)) << wrong;
    EXPECT_FALSE(noted({}, uniforms));
}

TEST(NamedCamera, IsInNoBlockAndNotOfFixedFunction) {
    std::vector<ActiveUniform> uniforms{uniform(GL_FLOAT_MAT4, "camera"),
                                        uniform(GL_FLOAT_MAT4, "gl_ProjectionMatrix")};
    uniforms[0].place.block = 0;
    uniforms[1].built_in = true;
    EXPECT_FALSE(noted({"camera", "gl_ProjectionMatrix"}, uniforms));
}

TEST(NamedCamera, IsNotedOnceAndBesideThoseThatThePositionTakes) {
    const std::vector<ActiveUniform> uniforms{uniform(GL_FLOAT_MAT4, "camera"), uniform(GL_FLOAT_MAT4, "model")};
    PositionProgram position;
    position.uniforms = {{"offset", 0}, {"model", 0}};
    name_camera(position, {"camera"}, uniforms);
    EXPECT_EQ(position.camera, 2u);
    EXPECT_EQ(position.uniforms.size(), 3u);
    name_camera(position, {"model"}, uniforms);
    EXPECT_EQ(position.camera, 2u) << "it stays";
    position.camera.reset();
    name_camera(position, {"model"}, uniforms);
    EXPECT_EQ(position.camera, 1u) << "one that is there is not there twice";
    EXPECT_EQ(position.uniforms.size(), 3u);
}

}  // namespace
}  // namespace wall::glapi
