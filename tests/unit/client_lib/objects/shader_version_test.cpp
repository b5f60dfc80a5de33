// SPDX-License-Identifier: MIT
#include "client_lib/objects/shader_version.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

TEST(ShaderVersion, IsFoundBehindCommentsOnly) {
    const ShaderVersion version =
        version_of_shader("\n// one\n/* two\n*/ # /* three */ version 300 es\nvoid main() {}");
    EXPECT_TRUE(version.given);
    EXPECT_EQ(version.number, 300u);
    EXPECT_TRUE(version.es);
    EXPECT_FALSE(version_of_shader("precision highp float;\n#version 100\n").given);
    EXPECT_FALSE(version_of_shader("// #version 100").given);
    EXPECT_TRUE(version_of_shader("#version 100\n").es);
    EXPECT_FALSE(version_of_shader("#version 330 core\n").es);
}

TEST(ShaderVersion, TakesAnyBytes) {
    for (const char* source : {"", "#", "/*", "//", "#version", "#version x", "#version 99999999999", " \t\r\n"})
        EXPECT_FALSE(version_of_shader(source).given) << source;
}

TEST(EsSource, HasAVersion) {
    EXPECT_EQ(es_source("void main() {}", 20).source, "#version 100\n#line 1\nvoid main() {}");
    EXPECT_EQ(es_source("#version 100\n", 20).source, "#version 100\n");
}

TEST(EsSource, IsRefusedWhereItsVersionIsNotOffered) {
    EXPECT_TRUE(es_source("#version 100\n", 20).error.empty());
    EXPECT_TRUE(es_source("#version 300 es\n", 30).error.empty());
    EXPECT_FALSE(es_source("#version 300 es\n", 20).error.empty());
    EXPECT_FALSE(es_source("#version 310 es\n", 30).error.empty());
    EXPECT_EQ(es_source("#version 120\n", 30).error,
              "0:1(10): error: GLSL 1.20 is not supported. Supported versions are: 1.00 ES, 3.00 ES\n");
}

}  // namespace
}  // namespace wall::client
