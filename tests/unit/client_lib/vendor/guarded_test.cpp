// SPDX-License-Identifier: MIT
#include "client_lib/vendor/guarded.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <new>
#include <stdexcept>

namespace wall::client::vendor {
namespace {

TEST(Guarded, AnswersWhatItsBodyAnswers) {
    EXPECT_EQ(guarded("glXNothing", 1, [] { return 2; }), 2);
    bool ran = false;
    guarded("glXNothing", [&] { ran = true; });
    EXPECT_TRUE(ran);
}

TEST(Guarded, AnswersTheOtherThingWhateverIsThrown) {
    EXPECT_EQ(guarded("glXNothing", 1, []() -> int { throw std::bad_alloc(); }), 1);
    EXPECT_EQ(guarded("glXNothing", 1, []() -> int { throw std::runtime_error("no"); }), 1);
    EXPECT_EQ(guarded("glXNothing", 1, []() -> int { throw 13; }), 1);
    EXPECT_NO_THROW(guarded("glXNothing", [] { throw std::bad_alloc(); }));
}

TEST(Guarded, LetsAThreadEndThatIsToEnd) {
    static int end;
    pthread_t thread;
    const auto body = [](void*) -> void* {
        return guarded("glXNothing", static_cast<void*>(nullptr), []() -> void* { pthread_exit(&end); });
    };
    ASSERT_EQ(pthread_create(&thread, nullptr, body, nullptr), 0);
    void* result = nullptr;
    ASSERT_EQ(pthread_join(thread, &result), 0);
    EXPECT_EQ(result, &end);
}

}  // namespace
}  // namespace wall::client::vendor
