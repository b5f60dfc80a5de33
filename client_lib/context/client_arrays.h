// SPDX-License-Identifier: MIT
// Vertex arrays as immediate-mode geometry: only the vertices that a draw references are looked at (an application's
// arrays may be wrong elsewhere), and what travels is Begin, attributes, vertices, End. The application's thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/objects/buffer.h"
#include "common/glstate/vertex_input.h"

namespace wall::client {

/// The place of an array of positions among those of attributes.
inline constexpr auto kVertexArray = static_cast<Attribute>(kAttributes);

/// One enabled array, resolved to memory.
struct ArraySource {
    Attribute attribute;  ///< that it has the values of; kVertexArray: positions
    bool by_command;      ///< converted as glColor and the like do
    const std::byte* base;
    std::size_t stride;
    std::size_t count;  ///< elements that lie in the buffer object; kNoLimit for client memory
    GLint size;         ///< components
    GLenum type;
    bool integer;  ///< the values are bits of integers
    bool bgra;     ///< the first and the third component change places
    void (*load)(const std::byte* from, GLint size, float* out);
    static constexpr std::size_t kNoLimit = ~std::size_t{0};
};
inline constexpr std::size_t kMaxArrays = kAttributes + 1;

/// The array of an attribute in `content`, which are the bytes of its buffer from its first element on, and stay.
ArraySource array_source(const glstate::InputArray& array, std::span<const std::byte> content);

/// The enabled arrays in the order in which an element's attributes are sent: the vertex last.
class ArraySet {
public:
    /// `by_command`: values are converted as by glColor and the like, not as by a draw. Of arrays that go on from
    /// instance to instance, all elements are those of `instance`.
    ArraySet(Context& c, bool by_command, GLsizei instance = 0);
    std::span<const ArraySource> sources() const { return {sources_.data(), count_}; }
    ArraySet(const ArraySet&) = delete;  // sources may point to constant_vertex_

    /// A program may draw without an array of positions: all vertices have the current attribute 0 then.
    void add_constant_vertex(Context& c);
    bool has_vertex() const { return count_ != 0 && sources_[count_ - 1].attribute == kVertexArray; }

private:
    void add(Context& c, Attribute attribute, const glstate::ClientArray& array);
    std::array<ArraySource, kMaxArrays> sources_;  // not initialized: draws may be small
    std::size_t count_ = 0;
    bool by_command_;
    GLsizei instance_;
    glstate::Vec4 constant_vertex_{};
    std::vector<BufferReading> readings_;  ///< of the buffers that the sources lie in
};

/// Which elements a draw uses: `count` in a row from `first`, or the indices.
struct ElementRange {
    GLint first = 0;
    GLsizei count = 0;
    GLenum type = 0;  ///< of the indices; 0: none
    const void* indices = nullptr;
    GLint base_vertex = 0;          ///< is added to indices
    std::optional<GLuint> restart;  ///< an index that is none: the primitive begins anew there
    GLsizei instance = 0;           ///< which one it is

    bool restarts_at(GLsizei i) const { return type != 0 && restart && index_at(i) == *restart; }
    /// The element; not where it restarts.
    GLuint at(GLsizei i) const { return index_at(i) + (type != 0 ? static_cast<GLuint>(base_vertex) : 0); }
    GLuint index_at(GLsizei i) const {
        switch (type) {
            case GL_UNSIGNED_BYTE: return static_cast<const GLubyte*>(indices)[i];
            case GL_UNSIGNED_SHORT: return static_cast<const GLushort*>(indices)[i];
            case GL_UNSIGNED_INT: return static_cast<const GLuint*>(indices)[i];
            default: return static_cast<GLuint>(first + i);
        }
    }
};

/// Sends one element through the context's table (glArrayElement).
void send_element(Context& c, const ArraySet& arrays, GLuint element);

/// Draws one primitive. While the context draws at once: straight into the packer where the layout is a usual one, and
/// the current attributes are what they were before. While a list is compiled: through the table.
void draw_elements(Context& c, GLenum mode, const ElementRange& elements);

}  // namespace wall::client
