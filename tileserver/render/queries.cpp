// SPDX-License-Identifier: MIT
#include "tileserver/render/queries.h"

#include <cmath>
#include <utility>

namespace wall::tileserver {
namespace {

constexpr std::size_t kMaxParts = 256;  // then the driver is asked, so that its queries do not pile up

}  // namespace

Queries::~Queries() {
    end();
    for (auto& [name, query] : queries_)
        for (const Part& part : query.parts) gl_.DeleteQueries(1, &part.driver);
}

bool Queries::begin(ClientName name, double scale) {
    if (!name) return true;
    if (queries_.size() >= kMaxQueries && !queries_.contains(name)) return false;
    Query& query = queries_[name];
    if (query.parts.size() >= kMaxParts) collect(query);
    Part part{0, scale};
    gl_.GenQueries(1, &part.driver);
    gl_.BeginQuery(GL_SAMPLES_PASSED, part.driver);
    query.parts.push_back(part);
    active_ = true;
    return true;
}

void Queries::end() {
    if (std::exchange(active_, false)) gl_.EndQuery(GL_SAMPLES_PASSED);
}

void Queries::collect(Query& query) {
    for (const Part& part : query.parts) {
        GLuint64 samples = 0;
        gl_.GetQueryObjectui64v(part.driver, GL_QUERY_RESULT, &samples);
        gl_.DeleteQueries(1, &part.driver);
        query.sum += static_cast<double>(samples) / part.scale;
    }
    query.parts.clear();
}

std::uint64_t Queries::result(ClientName name) {
    const auto at = queries_.find(name);
    if (at == queries_.end()) return 0;
    collect(at->second);
    return static_cast<std::uint64_t>(std::llround(at->second.sum));
}

void Queries::erase(ClientName name) {
    const auto at = queries_.find(name);
    if (at == queries_.end()) return;
    for (const Part& part : at->second.parts) gl_.DeleteQueries(1, &part.driver);
    queries_.erase(at);
}

}  // namespace wall::tileserver
