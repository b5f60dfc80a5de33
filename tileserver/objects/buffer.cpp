// SPDX-License-Identifier: MIT
#include "tileserver/objects/buffer.h"

namespace wall::tileserver {

Buffer::Buffer(ObjectAccount& account, Driver& driver)
    : ObjectOf(account), gl_(driver.gl()), driver_(driver), orders_(driver) {
    gl_.CreateBuffers(1, &name_);
}

Buffer::~Buffer() {
    driver_.forget_buffer(name_);
    // Textures and transform feedback of the driver may keep it: without its memory, which nobody accounts for then.
    gl_.NamedBufferData(name_, 0, nullptr, GL_STATIC_DRAW);
    gl_.DeleteBuffers(1, &name_);
}

void Buffer::release() {
    driver_.release_uniform_buffer(name_);
    if (gives_texels_) gl_.Flush();
    forget_orders();
}

void Buffer::forget_orders() {
    const bool counted = orders_.bytes() != 0;
    orders_.forget();
    if (counted) static_cast<void>(has_content(size_));  // less than before
}

GLuint Buffer::in_order(const IndexRange& range) {
    if (!stays_) return 0;
    const std::uint64_t before = orders_.bytes();
    const GLuint found = orders_.drawn(name_, range);
    if (orders_.bytes() == before || has_content(size_ + orders_.bytes())) return found;
    may_be_written();  // the session has no memory for that: it is left alone
    return 0;
}

bool Buffer::define(std::uint32_t size, GLenum usage) {
    release();
    driver_.drain_errors();
    gl_.NamedBufferData(name_, size, nullptr, usage);
    // The driver's memory may have been another session's.
    if (size != 0) gl_.ClearNamedBufferData(name_, GL_R8, GL_RED, GL_UNSIGNED_BYTE, nullptr);
    size_ = driver_.drain_errors() == 0 ? size : 0;
    renamed();  // vertex inputs have another number of elements
    return has_content(size_) && size_ == size;
}

std::vector<std::byte> Buffer::read(std::uint32_t offset, std::uint32_t size) const {
    if (offset > size_ || size > size_ - offset) return {};
    std::vector<std::byte> content(size);
    if (size != 0) gl_.GetNamedBufferSubData(name_, offset, static_cast<GLsizeiptr>(size), content.data());
    return content;
}

bool Buffer::write(std::uint32_t offset, std::span<const std::byte> content) {
    if (offset > size_ || content.size() > size_ - offset) return false;
    release();
    if (!content.empty()) driver_.write_buffer(name_, offset, content);
    return true;
}

}  // namespace wall::tileserver
