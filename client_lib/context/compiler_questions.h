// SPDX-License-Identifier: MIT
// Questions to the nodes' compilers: what is asked about, and what is kept of the answers. Application threads.
#pragma once

#include <chrono>
#include <optional>

#include "client_lib/context/answer_cache.h"
#include "client_lib/context/ask_one.h"
#include "common/glapi/content_hash.h"

namespace wall::client {

inline constexpr std::chrono::seconds kCompileLimit{130};  ///< a node gives a compiler up after 120 (CompilerLimits)
inline constexpr std::chrono::seconds kWaited{1};          ///< who has no answer sooner has nobody to ask

/// What a compiler says, which may take long where a machine has other things to do: who has not answered in time is
/// asked again, and answers once the compiler has, since each content is tried once.
template <class Pack>
std::optional<NodeAnswer> ask_compiler(Context& c, const char* function, Pack&& pack) {
    using Clock = std::chrono::steady_clock;
    const auto until = Clock::now() + kCompileLimit;
    for (;;) {
        const auto begin = Clock::now();
        auto answer = ask_one_node(c, function, pack);
        const auto now = Clock::now();
        if (answer || now - begin < kWaited || now > until) return answer;
    }
}

/// Those of all contexts of the process.
AnswerCache& kept_answers();

/// What names a question on this wall: who asks nodes of another driver, or speaks to them otherwise, asks another one.
/// What is asked has to be added.
glapi::ContentHash compiler_question(Context& c);

}  // namespace wall::client
