// SPDX-License-Identifier: MIT
// Which arrays of which buffers a draw reads: a vertex array object of the driver, made once (common/glstate/
// vertex_input.h). The driver keeps the memory of its buffers for as long as it lives. Render thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/glstate/vertex_input.h"
#include "tileserver/driver/driver.h"
#include "tileserver/objects/object_table.h"

namespace wall::tileserver {

class VertexInput final : public ObjectOf<ObjectKind::vertex_input> {
public:
    VertexInput(ObjectAccount& account, Driver& driver);
    ~VertexInput() override;

    /// Once. `buffers`: the driver's names, of each array, then that of the indices, if there is one. False: the driver
    /// has no such arrays, and it must not be drawn with.
    [[nodiscard]] bool define(const glstate::VertexInputDefinition& definition, std::span<const GLuint> buffers);

    bool defined() const { return name_ != 0; }
    GLuint name() const { return name_; }  ///< the driver's
    /// 0: it has none.
    ClientName indices() const { return definition_.indices; }
    /// How many elements lie in all buffers of arrays that go on from vertex to vertex, as large as they are now: a
    /// draw must not read behind them.
    std::uint64_t elements(const ObjectTable& objects) { return facts(objects).elements; }
    /// How large the buffer of the indices is, bytes; nothing: the input has none, or it is gone.
    std::optional<std::size_t> index_bytes(const ObjectTable& objects) { return facts(objects).index_bytes; }

private:
    struct Facts {
        std::uint64_t elements = 0;
        std::optional<std::size_t> index_bytes;
    };
    /// Looked up again when a buffer of the session has changed its size.
    const Facts& facts(const ObjectTable& objects);

    Driver& driver_;
    GLuint name_ = 0;
    glstate::VertexInputDefinition definition_;
    Facts facts_;
    std::optional<std::uint64_t> buffers_;  ///< the version of the table's buffers that facts_ is of
};

}  // namespace wall::tileserver
