// SPDX-License-Identifier: MIT
#include "walld/http/rest.h"

#include <gtest/gtest.h>

#include "walld/control/arguments.h"

namespace wall::walld {
namespace {

RestRequest ask(std::string_view method, std::string_view path, std::string_view body = {}) {
    return {method, path, body, "application/json", "localhost:7780", {}, {}};
}

int status(const RestRequest& request) {
    const auto command = rest_command(request);
    return command ? 200 : command.error().status;
}

TEST(Rest, APathIsAVerbWithItsTarget) {
    const auto place = rest_command(ask("PUT", "/api/v1/sessions/3.1/placement", R"({"rect": [1, 2, 3, 4]})"));
    ASSERT_TRUE(place);
    EXPECT_EQ(place->verb, "place");
    EXPECT_EQ(place->arguments, (nlohmann::json{{"id", "3.1"}, {"rect", {1, 2, 3, 4}}}));
    EXPECT_EQ(rest_command(ask("DELETE", "/api/v1/sessions/3"))->verb, "close");
    EXPECT_EQ(rest_command(ask("GET", "/api/v1/sessions"))->verb, "sessions");
    EXPECT_EQ(rest_command(ask("HEAD", "/api/v1/sessions"))->verb, "sessions");
    EXPECT_EQ(rest_command(ask("POST", "/api/v1/layouts/day/load"))->arguments["name"], "day");
    EXPECT_EQ(rest_command(ask("PUT", "/api/v1/sessions/3/placement", R"({"id": "9", "rect": []})"))->arguments["id"],
              "3")
        << "the path says what is meant";
}

TEST(Rest, OtherPathsAndMethodsAreRefused) {
    for (const char* path : {"/api/v1/", "/api/v1/sessions/", "/api/v1/sessions//raise", "/api/v1/sessions/1/2/raise",
                             "/api/v2/status", "", "/api/v1/layouts/../load/x"})
        EXPECT_EQ(status(ask("GET", path)), 404) << path;
    EXPECT_EQ(status(ask("POST", "/api/v1/status")), 405);
    EXPECT_EQ(rest_command(ask("PATCH", "/api/v1/sessions/1")).error().why.message, "expected GET, DELETE");
    EXPECT_EQ(status(ask("OPTIONS", "/api/v1/sessions/1/raise")), 405) << "no page elsewhere gets a leave to ask";
}

TEST(Rest, AChangeIsJsonAndFromHere) {
    auto request = ask("POST", "/api/v1/sessions/1/raise");
    EXPECT_EQ(status(request), 200);
    for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data",
                             "application/jsonx", "text/plain;application/json"}) {
        request.content_type = type;
        EXPECT_EQ(status(request), 415) << type;
    }
    request.content_type = "application/json; charset=utf-8";
    EXPECT_EQ(status(request), 200);
    request.origin = "http://localhost:7780";
    request.fetch_site = "same-origin";
    EXPECT_EQ(status(request), 200);
    for (const char* origin : {"http://evil.example", "https://localhost:7780", "http://localhost:1", "null"}) {
        request.origin = origin;
        EXPECT_EQ(status(request), 403) << origin;
    }
    request.origin = {};
    for (const char* site : {"cross-site", "same-site"}) {
        request.fetch_site = site;
        EXPECT_EQ(status(request), 403) << site;
    }
    auto remove = ask("DELETE", "/api/v1/sessions/1");
    remove.content_type = {};
    EXPECT_EQ(status(remove), 200);
    remove.origin = "http://evil.example";
    EXPECT_EQ(status(remove), 403);
}

TEST(Rest, ABodyIsAnObject) {
    for (const char* body : {"{", "[]", "1", "null", "\xff"})
        EXPECT_EQ(status(ask("PUT", "/api/v1/sessions/1/placement", body)), 400) << body;
}

TEST(Rest, ABodyThatIsTooDeepIsRefusedBeforeItIsParsed) {
    const auto deep = "{\"id\": " + std::string(30'000, '[') + std::string(30'000, ']') + "}";
    const auto refused = rest_command(ask("PUT", "/api/v1/sessions/1/placement", deep));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().status, 400);
    EXPECT_EQ(refused.error().why.message, "JSON: expected at most 16 arrays and objects in each other");
}

TEST(Rest, WhatIsTooMuchAtOnceHasAStatusOfItsOwn) {
    EXPECT_EQ(http_status(RefusalKind::busy), 429);
    EXPECT_STREQ(name_of(RefusalKind::busy), "busy");
}

TEST(Arguments, OfAnotherKindAreNamed) {
    const auto good = nlohmann::json::parse(R"({"rect": [-1, 0, 5, 6], "id": 3, "on": false})");
    EXPECT_EQ(*rect_of(good, "rect"), (geom::Rect{-1, 0, 5, 6}));
    EXPECT_EQ(*text_of(good, "id"), "3");
    EXPECT_FALSE(*flag_of(good, "on", true));
    EXPECT_EQ(*number_of(good, "frames", 1, 1, 5), 1);
    for (const char* wrong : {"{}", R"({"rect": 1})", R"({"rect": [1, 2, 3]})", R"({"rect": [1, 2, 3, 4.5]})",
                              R"({"rect": [1, 2, 3, "4"]})", R"({"rect": [1, 2, 3, 99999999999]})",
                              R"({"rect": [1, 2, 3, 18446744073709551615]})"}) {
        const auto rect = rect_of(nlohmann::json::parse(wrong), "rect");
        ASSERT_FALSE(rect) << wrong;
        EXPECT_EQ(rect.error().message, "'rect': expected [x, y, width, height] in canvas pixels");
    }
    EXPECT_FALSE(text_of(nlohmann::json::parse(R"({"id": {}})"), "id"));
    EXPECT_FALSE(flag_of(nlohmann::json::parse(R"({"on": 1})"), "on", true));
    EXPECT_FALSE(number_of(nlohmann::json::parse(R"({"frames": 18446744073709551615})"), "frames", 1, 1, 5));
    EXPECT_FALSE(number_of(nlohmann::json::parse(R"({"frames": 0})"), "frames", 1, 1, 5));
}

}  // namespace
}  // namespace wall::walld
