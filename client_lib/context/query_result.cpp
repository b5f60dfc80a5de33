// SPDX-License-Identifier: MIT
#include "client_lib/context/query_result.h"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace wall::client {
namespace {

constexpr const char* kFunction = "glGetQueryObject";

bool is_time(const QueryObject& query) { return query.slot == QuerySlot::time || query.slot == QuerySlot::none; }

void ask(Context& c, QueryObject& query) {
    if (query.asked) return;
    query.asked = true;
    c.flush_block();
    if (is_time(query)) return;
    c.session().hidden_parts([](HiddenParts& parts) { parts.before_counting_samples(); });
    query.counts = c.session().ask_later(
        [&](wire::PackBuffer& buffer, RequestId request) { glapi::pack::QueryResult(buffer, request, query.id); });
}

/// Each node counts the samples of its own tiles. Primitives go to all of them while they are counted; one that was
/// left out for a while has counted fewer.
std::uint64_t counted(QueryObject& query) {
    std::uint64_t sum = 0, most = 0;
    for (const auto& answer : query.counts.take_answers()) {
        std::uint64_t count = 0;
        if (answer.size() == sizeof count) std::memcpy(&count, answer.data(), sizeof count);
        sum += count;
        most = std::max(most, count);
    }
    if (query.target == GL_SAMPLES_PASSED) return sum;
    return query.slot == QuerySlot::samples ? sum != 0 : most;
}

std::uint64_t measured(const QueryObject& query) {
    const auto now = Fence::Clock::now(), end = query.ended.done_at().value_or(now);
    if (query.slot == QuerySlot::none) return timestamp(end);
    const auto begin = query.begun.done_at().value_or(end);
    return begin < end ? timestamp(end) - timestamp(begin) : 0;
}

}  // namespace

bool is_available(Context& c, QueryObject& query) {
    if (query.answered || !query.id || query.place <= c.queries->reached) return true;
    ask(c, query);
    const Fence& awaited = is_time(query) ? query.ended : query.counts;
    if (!awaited.done()) c.session().flush({}, false);
    return awaited.done();
}

std::uint64_t result_of(Context& c, QueryObject& query) {
    if (query.answered || !query.id) return query.result;
    ask(c, query);
    const Fence& awaited = is_time(query) ? query.ended : query.counts;
    c.session().wait_for(awaited, Fence::Clock::now() + Fence::kLongestWait, kFunction);
    query.result = is_time(query) ? measured(query) : counted(query);
    query.answered = true;
    c.queries->reached = std::max(c.queries->reached, query.place);
    query.begun = {};
    query.ended = {};
    return query.result;
}

std::uint64_t timestamp(Fence::Clock::time_point at) {
    return static_cast<std::uint64_t>(std::chrono::nanoseconds(at.time_since_epoch()).count());
}

}  // namespace wall::client
