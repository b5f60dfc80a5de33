// SPDX-License-Identifier: MIT
#include "client_lib/link/parallel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client_lib/follow/sync_objects.h"
#include "client_lib/link/control_messages.h"
#include "proto/control.pb.h"

namespace wall::client {
namespace {

TEST(Parallel, IsReadFromOneWord) {
    const auto member = parse_parallel("march-1f:2:4");
    ASSERT_TRUE(member);
    EXPECT_EQ(member->group, "march-1f");
    EXPECT_EQ(member->rank, 2u);
    EXPECT_EQ(member->members, 4u);
    EXPECT_EQ(parse_parallel("a:b:0:1")->group, "a:b");
    for (const char* wrong :
         {"", "x", "x:0", ":0:1", "x:1:1", "x:0:0", "x:0:65", "x:-1:2", "x:0:2:", "x:0:2y", "x: 0:2"})
        EXPECT_FALSE(parse_parallel(wrong)) << wrong;
}

TEST(Parallel, IsSaidToWalld) {
    Hello hello;
    hello.group = Parallel{"g", 3, 4};
    proto::Envelope envelope;
    ASSERT_TRUE(envelope.ParseFromString(encode(hello)));
    EXPECT_EQ(envelope.client_hello().group().name(), "g");
    EXPECT_EQ(envelope.client_hello().group().rank(), 3u);
    EXPECT_EQ(envelope.client_hello().group().members(), 4u);
    ASSERT_TRUE(envelope.ParseFromString(encode_placement_noted(SurfaceId(7), 9, 12)));
    EXPECT_EQ(envelope.placement_noted().surface(), 7u);
    EXPECT_EQ(envelope.placement_noted().layout_version(), 9u);
    EXPECT_EQ(envelope.placement_noted().begun(), 12u);
    ASSERT_TRUE(envelope.ParseFromString(encode_member_leaves(0)));
    EXPECT_TRUE(envelope.has_member_leaves());
}

TEST(Parallel, APlacementComesWithItsFrameSizeAndNodes) {
    proto::Envelope envelope;
    auto& sent = *envelope.mutable_placement();
    sent.set_surface(1);
    sent.set_from_frame(12);
    sent.set_width(640);
    sent.set_height(480);
    sent.add_nodes()->set_address("unix:/a");
    sent.add_nodes()->set_node(3);
    const auto message = decode_from_walld(envelope.SerializeAsString());
    ASSERT_TRUE(message);
    const auto& placement = std::get<Placement>(*message);
    EXPECT_EQ(placement.from_frame, 12u);
    EXPECT_EQ(placement.width, 640u);
    EXPECT_EQ(placement.height, 480u);
    ASSERT_EQ(placement.nodes.size(), 2u);
    EXPECT_EQ(placement.nodes[0].address, "unix:/a");
    EXPECT_EQ(placement.nodes[1].node, NodeIndex(3));
}

TEST(SyncObjects, TellMisuse) {
    SyncObjects own(4);
    EXPECT_EQ(own.barrier_create(0, 2), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(own.barrier_create(1, 0), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(own.barrier_create(1, 5), GLenum{GL_INVALID_VALUE}) << "so many will never come";
    EXPECT_EQ(own.barrier_create(1, 4), GLenum{GL_NO_ERROR});
    EXPECT_EQ(own.barrier_create(1, 4), GLenum{GL_NO_ERROR}) << "again the same";
    EXPECT_EQ(own.barrier_create(1, 3), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(own.barrier_exec(2), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(own.barrier_exec(1), GLenum{GL_NO_ERROR});
    EXPECT_EQ(own.barrier_destroy(1), GLenum{GL_NO_ERROR});
    EXPECT_EQ(own.barrier_destroy(1), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(own.semaphore_create(0, 0), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(own.semaphore_create(1, 0), GLenum{GL_NO_ERROR});
    EXPECT_EQ(own.semaphore_create(1, 1), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(own.semaphore_p(2), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(own.semaphore_v(2), GLenum{GL_INVALID_OPERATION});
}

TEST(SyncObjects, RememberWhatANodeMustBeToldThatComesLater) {
    SyncObjects own(2);
    own.semaphore_create(1, 3);
    EXPECT_EQ(own.semaphore_p(1), GLenum{GL_NO_ERROR});
    EXPECT_EQ(own.semaphore_p(1), GLenum{GL_NO_ERROR});
    EXPECT_EQ(own.semaphore_v(1), GLenum{GL_NO_ERROR});
    EXPECT_EQ(own.semaphores().at(1).count, 3u);
    EXPECT_EQ(own.semaphores().at(1).moved, -1);
}

TEST(SyncObjects, AProcessAloneCannotWaitForItself) {
    SyncObjects own(1);
    EXPECT_EQ(own.barrier_create(1, 2), GLenum{GL_INVALID_VALUE});
    own.semaphore_create(1, 1);
    EXPECT_EQ(own.semaphore_p(1), GLenum{GL_NO_ERROR});
    EXPECT_EQ(own.semaphore_p(1), GLenum{GL_INVALID_OPERATION});
    own.semaphore_v(1);
    EXPECT_EQ(own.semaphore_p(1), GLenum{GL_NO_ERROR});
}

}  // namespace
}  // namespace wall::client
