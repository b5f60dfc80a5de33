// SPDX-License-Identifier: MIT
#include "client_lib/context/answer_cache.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace wall::client {
namespace {

namespace fs = std::filesystem;

glapi::ContentKey question(unsigned number) {
    glapi::ContentHash hash;
    hash.OwnName(number);
    return hash.finish();
}

std::vector<std::byte> answer(std::size_t bytes, int value) {
    return std::vector<std::byte>(bytes, static_cast<std::byte>(value));
}

class AnswerCacheTest : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = "/tmp/wallgl-answers-XXXXXX";
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        base_ = name;
    }
    void TearDown() override { fs::remove_all(base_); }
    std::string folder() const { return (base_ / "a" / "b").string(); }
    fs::path only_file() const { return fs::directory_iterator(folder())->path(); }

    fs::path base_;
};

TEST_F(AnswerCacheTest, KnowsWhatWasKeptAlsoInAnotherProcess) {
    AnswerCache cache(folder());
    EXPECT_FALSE(cache.find(question(1)));
    cache.keep(question(1), answer(100, 7));
    EXPECT_EQ(AnswerCache(folder()).find(question(1)), answer(100, 7));
    EXPECT_FALSE(cache.find(question(2)));
    cache.keep(question(1), {});
    EXPECT_EQ(cache.find(question(1)), answer(0, 0)) << "what was kept last";
    EXPECT_EQ(std::distance(fs::directory_iterator(folder()), {}), 1) << "nothing is left of writing";
    EXPECT_EQ(fs::status(folder()).permissions(), fs::perms::owner_all);
}

TEST_F(AnswerCacheTest, WithoutAFolderThereIsNothing) {
    AnswerCache cache("");
    cache.keep(question(1), answer(1, 1));
    EXPECT_FALSE(cache.find(question(1)));
    AnswerCache nowhere("/proc/nowhere");
    nowhere.keep(question(1), answer(1, 1));
    EXPECT_FALSE(nowhere.find(question(1)));
}

TEST_F(AnswerCacheTest, WhatIsNotWholeIsNotKnown) {
    AnswerCache cache(folder());
    cache.keep(question(1), answer(50, 3));
    std::ifstream file(only_file(), std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(file), {}};
    for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
        std::ofstream(only_file(), std::ios::binary) << whole.substr(0, bytes);
        EXPECT_FALSE(cache.find(question(1))) << bytes;
        std::string other = whole;
        other[bytes] ^= 1;
        std::ofstream(only_file(), std::ios::binary) << other;
        EXPECT_FALSE(cache.find(question(1))) << bytes;
    }
    std::ofstream(only_file(), std::ios::binary) << whole;
    EXPECT_TRUE(cache.find(question(1)));
}

TEST_F(AnswerCacheTest, LinksAndFoldersAreNoAnswers) {
    AnswerCache cache(folder());
    cache.keep(question(1), answer(5, 5));
    const auto file = only_file();
    fs::rename(file, base_ / "elsewhere");
    fs::create_symlink(base_ / "elsewhere", file);
    EXPECT_FALSE(cache.find(question(1)));
    fs::remove(file);
    fs::create_directory(file);
    EXPECT_FALSE(cache.find(question(1)));
}

TEST_F(AnswerCacheTest, WhatIsTooLargeIsNotKept) {
    AnswerCache cache(folder());
    cache.keep(question(1), answer(AnswerCache::kMostAnswer, 1));
    cache.keep(question(2), answer(AnswerCache::kMostAnswer + 1, 1));
    EXPECT_TRUE(cache.find(question(1)));
    EXPECT_FALSE(cache.find(question(2)));
}

TEST_F(AnswerCacheTest, WhatWasNotUsedForLongestGoesFirst) {
    constexpr std::size_t kMost = 10'000;
    AnswerCache cache(folder(), kMost);
    for (unsigned i = 0; i < 12; ++i) {
        cache.keep(question(i), answer(1000, 1));
        for (const auto& file : fs::directory_iterator(folder()))  // an hour passes
            fs::last_write_time(file, fs::last_write_time(file) - std::chrono::hours(1));
    }
    ASSERT_TRUE(cache.find(question(0)));  // is used now
    AnswerCache(folder(), kMost).keep(question(100), answer(1000, 1));
    EXPECT_TRUE(cache.find(question(0)));
    EXPECT_FALSE(cache.find(question(1)));
    EXPECT_TRUE(cache.find(question(11)));
    EXPECT_TRUE(cache.find(question(100)));
}

TEST(AnswerCacheFolder, IsWhereAUsersCachesAre) {
    const auto with = [](const char* own, const char* caches, const char* home) {
        for (const auto& [name, value] : {std::pair{"WALLGL_CACHE", own}, {"XDG_CACHE_HOME", caches}, {"HOME", home}})
            value != nullptr ? ::setenv(name, value, 1) : ::unsetenv(name);
        return AnswerCache::usual_folder();
    };
    EXPECT_EQ(with(nullptr, nullptr, "/home/a"), "/home/a/.cache/wallgl");
    EXPECT_EQ(with("", "/caches", "/home/a"), "/caches/wallgl");
    EXPECT_EQ(with("/mine", "/caches", "/home/a"), "/mine");
    EXPECT_EQ(with("off", "/caches", "/home/a"), "");
    EXPECT_EQ(with(nullptr, "relative", nullptr), "");
}

}  // namespace
}  // namespace wall::client
