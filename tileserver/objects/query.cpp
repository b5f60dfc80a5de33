// SPDX-License-Identifier: MIT
#include "tileserver/objects/query.h"

#include <cmath>

namespace wall::tileserver {
namespace {

constexpr std::size_t kMaxParts = 256;      // then the driver is asked, so that its queries do not pile up
constexpr std::uint64_t kPartBytes = 1024;  // of the driver's memory, by estimate

}  // namespace

Query::~Query() {
    for (const Part& part : parts_) driver_.delete_query(part.driver);
}

bool Query::begin(double scale) {
    if (parts_.size() >= kMaxParts) collect();
    Part part{0, scale};
    driver_.gl().GenQueries(1, &part.driver);
    driver_.begin_query(target_, part.driver);
    parts_.push_back(part);
    return has_content(parts_.size() * kPartBytes);
}

void Query::collect() {
    for (const Part& part : parts_) {
        GLuint64 samples = 0;
        driver_.gl().GetQueryObjectui64v(part.driver, GL_QUERY_RESULT, &samples);
        driver_.delete_query(part.driver);
        sum_ += static_cast<double>(samples) / part.scale;
    }
    parts_.clear();
}

std::uint64_t Query::result() {
    collect();
    return static_cast<std::uint64_t>(std::llround(sum_));
}

}  // namespace wall::tileserver
