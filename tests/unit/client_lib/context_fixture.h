// SPDX-License-Identifier: MIT
// A context without a wall: enough for everything that does not reach a node.
#pragma once

#include <gtest/gtest.h>

#include "client_lib/context/context.h"
#include "client_lib/context/current.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

class ContextTest : public testing::Test {
protected:
    void SetUp() override {
        tls_context = &c;
        tls_packer = &c.packer;
    }
    void TearDown() override {
        tls_context = nullptr;
        tls_packer = nullptr;
    }
    const GlTable& gl() const { return *c.table; }
    GLenum error() { return c.take_error(); }

    std::shared_ptr<ShareGroup> share = std::make_shared<ShareGroup>();
    Context c{share};
};

}  // namespace wall::client
