// SPDX-License-Identifier: MIT
// Which arrays of which buffers a draw reads: a vertex array object of the driver, made once (common/glstate/
// vertex_input.h). The driver keeps the memory of its buffers for as long as it lives. Render thread.
#pragma once

#include <span>

#include "common/glstate/vertex_input.h"
#include "tileserver/driver/driver.h"
#include "tileserver/objects/object.h"

namespace wall::tileserver {

class VertexInput final : public ObjectOf<ObjectKind::vertex_input> {
public:
    VertexInput(ObjectAccount& account, Driver& driver);
    ~VertexInput() override;

    /// Once. `buffers`: the driver's names, of each array, then that of the indices, if there is one.
    void define(const glstate::VertexInputDefinition& definition, std::span<const GLuint> buffers);

    bool defined() const { return name_ != 0; }
    GLuint name() const { return name_; }  ///< the driver's
    /// 0: it has none.
    ClientName indices() const { return indices_; }

private:
    Driver& driver_;
    GLuint name_ = 0;
    ClientName indices_;
};

}  // namespace wall::tileserver
