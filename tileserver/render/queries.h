// SPDX-License-Identifier: MIT
// Occlusion queries of one session. A query is a part of the soft context: while it is current, each tile of each block
// is counted by a driver query of its own, so that nothing of other sessions is; the answer is their sum. Render
// thread.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/base/ids.h"
#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

inline constexpr std::size_t kMaxQueries = 1 << 16;  ///< of a session

class Queries {
public:
    explicit Queries(const Gl& gl) : gl_(gl) {}
    ~Queries();
    Queries(const Queries&) = delete;

    /// Counts what is drawn from here to end(). `scale`: pixels of the layer for each one of the window. False: too
    /// many.
    bool begin(ClientName name, double scale);
    void end();
    /// Waits for the driver.
    std::uint64_t result(ClientName name);
    void erase(ClientName name);

private:
    struct Part {
        GLuint driver = 0;
        double scale = 1;
    };
    struct Query {
        std::vector<Part> parts;
        double sum = 0;
    };
    void collect(Query& query);

    const Gl& gl_;
    std::unordered_map<ClientName, Query> queries_;
    bool active_ = false;
};

}  // namespace wall::tileserver
