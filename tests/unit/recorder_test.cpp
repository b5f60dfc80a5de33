// SPDX-License-Identifier: MIT
// The recording of a display list.
#include <gtest/gtest.h>

#include <array>

#include "common/glapi/gl_types.h"
#include "common/glapi/recorder.h"

namespace wall::glapi {
namespace {

TEST(Recorder, GivesBackWhatWasRecorded) {
    ListRecorder list;
    const std::array<GLdouble, 4> plane = {1, 2, 3, 4};
    const std::array<GLushort, 3> map = {7, 8, 9};
    list.record(1, GLenum{GL_FOG_MODE}, GLfloat{2.5f}, GLboolean{1});
    list.record(2, GLenum{GL_CLIP_PLANE0}, recorded_array(plane.data(), 4), GLdouble{9});
    list.record(3);
    list.record(4, recorded_array(map.data(), 3), GLubyte{5});
    unsigned seen = 0;
    for_each_record(list.stream(), [&](const Recorded& r) {
        RecordReader in(r.payload);
        EXPECT_EQ(r.command, ++seen);
        if (r.command == 1) {
            EXPECT_EQ(in.get<GLenum>(), GLenum{GL_FOG_MODE});
            EXPECT_EQ(in.get<GLfloat>(), 2.5f);
            EXPECT_EQ(in.get<GLboolean>(), 1);
        } else if (r.command == 2) {
            EXPECT_EQ(in.get<GLenum>(), GLenum{GL_CLIP_PLANE0});
            const GLdouble* values = in.array<GLdouble>();
            EXPECT_TRUE(std::equal(plane.begin(), plane.end(), values));
            EXPECT_EQ(in.get<GLdouble>(), 9);
        } else if (r.command == 4) {
            const GLushort* values = in.array<GLushort>();
            EXPECT_TRUE(std::equal(map.begin(), map.end(), values));
            EXPECT_EQ(in.get<GLubyte>(), 5);
        }
        return true;
    });
    EXPECT_EQ(seen, 4u);
}

TEST(Recorder, TakesLargePayloads) {
    ListRecorder list;
    const std::size_t bytes = 4u * ListRecorder::kMany + 2;
    std::byte* at = list.append(9, bytes);
    at[bytes - 1] = std::byte{3};
    list.record(10);
    std::vector<std::uint16_t> commands;
    for_each_record(list.stream(), [&](const Recorded& r) {
        commands.push_back(r.command);
        if (r.command == 9) {
            EXPECT_EQ(r.payload.size(), bytes + 2);
            EXPECT_EQ(r.payload[bytes - 1], std::byte{3});
        }
        return true;
    });
    EXPECT_EQ(commands, (std::vector<std::uint16_t>{9, 10}));
}

TEST(Recorder, NoArrayIsAnEmptyArray) {
    ListRecorder list;
    list.record(1, recorded_array<GLfloat>(nullptr, 4), GLint{2});
    list.record(1, recorded_array<GLfloat>(nullptr, -4), GLint{2});
    for_each_record(list.stream(), [&](const Recorded& r) {
        RecordReader in(r.payload);
        in.array<GLfloat>();
        EXPECT_EQ(in.get<GLint>(), 2);
        return true;
    });
}

}  // namespace
}  // namespace wall::glapi
