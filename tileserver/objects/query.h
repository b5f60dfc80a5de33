// SPDX-License-Identifier: MIT
// A query: of samples, or of primitives. It is a part of the soft context: while it is current, each tile of each block
// is counted by a driver query of its own, so that nothing of other sessions is; the answer is their sum. Primitives
// are counted in one tile of a block only. Render thread.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "tileserver/driver/driver.h"
#include "tileserver/objects/object.h"

namespace wall::tileserver {

/// A query of the driver, which has begun; it counts until Driver::end_queries().
class DriverQuery {
public:
    /// `driver` outlives it.
    DriverQuery(Driver& driver, QueryTarget target, unsigned stream) : driver_(driver) {
        driver_.gl().GenQueries(1, &name_);
        driver_.begin_query(target, stream, name_);
    }
    ~DriverQuery() { driver_.delete_query(name_); }
    DriverQuery(const DriverQuery&) = delete;

    /// It is over. Waits for the driver.
    std::uint64_t result() const {
        GLuint64 counted = 0;
        driver_.gl().GetQueryObjectui64v(name_, GL_QUERY_RESULT, &counted);
        return counted;
    }

private:
    Driver& driver_;
    GLuint name_ = 0;
};

/// The sum of several, which may count for somebody else as well.
class QuerySum {
public:
    /// `scale`: so many are counted for each one. What counted before is over.
    void add(std::shared_ptr<const DriverQuery> query, double scale = 1);
    /// Waits for the driver.
    std::uint64_t result();
    /// Of the driver's memory, by estimate.
    std::uint64_t bytes() const;

private:
    void collect();
    struct Part {
        std::shared_ptr<const DriverQuery> query;
        double scale = 1;
    };
    std::vector<Part> parts_;
    double sum_ = 0;
};

class Query final : public ObjectOf<ObjectKind::query> {
public:
    Query(ObjectAccount& account, Driver& driver, QueryTarget target, unsigned stream)
        : ObjectOf(account), driver_(driver), target_(target), stream_(stream) {}

    QueryTarget target() const { return target_; }
    unsigned stream() const { return stream_; }
    /// Counts what is drawn from here to Driver::end_queries(). `scale`: pixels of the layer for each one of the
    /// window. False: more memory than a session may have.
    [[nodiscard]] bool begin(double scale) {
        return begin(std::make_shared<const DriverQuery>(driver_, target_, stream_), scale);
    }
    /// The same with one that has begun for somebody else.
    [[nodiscard]] bool begin(std::shared_ptr<const DriverQuery> query, double scale) {
        sum_.add(std::move(query), scale);
        return has_content(sum_.bytes());
    }
    /// Waits for the driver.
    std::uint64_t result() { return sum_.result(); }

private:
    Driver& driver_;
    const QueryTarget target_;
    const unsigned stream_;
    QuerySum sum_;
};

}  // namespace wall::tileserver
