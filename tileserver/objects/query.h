// SPDX-License-Identifier: MIT
// A query: of samples, or of primitives. It is a part of the soft context: while it is current, each tile of each block
// is counted by a driver query of its own, so that nothing of other sessions is; the answer is their sum. Primitives
// are counted in one tile of a block only. Render thread.
#pragma once

#include <cstdint>
#include <vector>

#include "tileserver/driver/driver.h"
#include "tileserver/objects/object.h"

namespace wall::tileserver {

class Query final : public ObjectOf<ObjectKind::query> {
public:
    Query(ObjectAccount& account, Driver& driver, QueryTarget target)
        : ObjectOf(account), driver_(driver), target_(target) {}
    ~Query() override;

    QueryTarget target() const { return target_; }
    /// Counts what is drawn from here to Driver::end_queries(). `scale`: pixels of the layer for each one of the
    /// window. False: more memory than a session may have.
    [[nodiscard]] bool begin(double scale);
    /// Waits for the driver.
    std::uint64_t result();

private:
    struct Part {
        GLuint driver = 0;
        double scale = 1;
    };
    void collect();

    Driver& driver_;
    const QueryTarget target_;
    std::vector<Part> parts_;
    double sum_ = 0;
};

}  // namespace wall::tileserver
