// SPDX-License-Identifier: MIT
// A buffer object of a session: vertices and indices that draws of vertex inputs read. Render thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tileserver/driver/driver.h"
#include "tileserver/objects/index_orders.h"
#include "tileserver/objects/object.h"

namespace wall::tileserver {

class Buffer final : public ObjectOf<ObjectKind::buffer> {
public:
    Buffer(ObjectAccount& account, Driver& driver);
    ~Buffer() override;

    GLuint name() const { return name_; }  ///< the driver's; the same for life
    std::uint64_t size() const { return size_; }
    bool affords_size(std::uint64_t size) const { return affords(size, size_); }
    /// New memory, all 0. False: more than a session may have, or than the driver has.
    [[nodiscard]] bool define(std::uint32_t size, GLenum usage);
    /// False: it reaches over the end.
    [[nodiscard]] bool write(std::uint32_t offset, std::span<const std::byte> content);
    /// A texture is made of it from now on.
    void give_texels() {
        gives_texels_ = true;
        may_be_written();
    }
    /// The driver may write to it from now on, without write().
    void may_be_written() {
        stays_ = false;
        forget_orders();
    }
    /// Indices of triangles in it are drawn, which lie within it. The driver's buffer that has the same triangles from
    /// its beginning on, in an order that is drawn faster; 0: none.
    GLuint in_order(const IndexRange& range);
    /// Nothing: it reaches over the end.
    std::vector<std::byte> read(std::uint32_t offset, std::uint32_t size) const;

private:
    /// Before it changes: what is drawn and not yet sent on by the driver has read it (Mesa 22 gathers glBegin ..
    /// glEnd).
    void release();
    void forget_orders();

    const Gl& gl_;
    Driver& driver_;
    GLuint name_ = 0;
    std::uint64_t size_ = 0;
    bool gives_texels_ = false;
    bool stays_ = true;  // but for write()
    IndexOrders orders_;
};

}  // namespace wall::tileserver
