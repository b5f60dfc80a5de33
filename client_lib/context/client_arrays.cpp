// SPDX-License-Identifier: MIT
#include "client_lib/context/client_arrays.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/lists.h"
#include "client_lib/context/program_use.h"
#include "client_lib/geometry/block_walk.h"
#include "client_lib/objects/small_floats.h"
#include "common/glapi/convert.h"
#include "common/glapi/packed_vertex.h"

namespace wall::client {
namespace {

using glapi::Op;

// ---- loading ----

template <class T>
T load_one(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// How a normalized integer becomes a float differs in the last bit between the ways into Mesa.
enum class Conversion : std::uint8_t {
    none,     ///< the number itself
    fetch,    ///< llvmpipe's, of a draw from arrays
    command,  ///< glColor's and glNormal's, which glArrayElement and display lists go through
    integer,  ///< none: a float of the same bits
};

template <class T, Conversion kConversion>
float to_float(T value) {
    constexpr auto kMax = static_cast<double>(std::numeric_limits<T>::max());
    if constexpr (std::is_floating_point_v<T>) return static_cast<float>(value);
    else if constexpr (kConversion == Conversion::none) return static_cast<float>(value);
    else if constexpr (kConversion == Conversion::integer) return glapi::to_bits(value);
    else if constexpr (std::is_same_v<T, GLubyte> && kConversion == Conversion::command)
        return static_cast<float>(value) / 255.0f;
    else if constexpr (std::is_unsigned_v<T> && sizeof(T) < 4)
        return static_cast<float>(value) * static_cast<float>(1.0 / kMax);
    else if constexpr (std::is_unsigned_v<T>) return static_cast<float>(value * (1.0 / kMax));
    else if constexpr (kConversion == Conversion::command)
        return (2.0f * static_cast<float>(value) + 1.0f) *
               (1.0f / static_cast<float>(2.0 * kMax + (sizeof(T) < 4 ? 1.0 : 0.0)));
    else return std::max(static_cast<float>(value) * static_cast<float>(1.0 / kMax), -1.0f);
}

using Load = void (*)(const std::byte*, GLint, float*);

template <class T, Conversion kConversion>
void load_values(const std::byte* from, GLint size, float* out) {
    for (GLint i = 0; i < size; ++i)
        out[i] = to_float<T, kConversion>(load_one<T>(from + static_cast<std::size_t>(i) * sizeof(T)));
}

/// Three of eleven and ten bits (GL_ARB_vertex_type_10f_11f_11f_rev).
void load_short_floats(const std::byte* from, GLint size, float* out) {
    const Rgb values = from_short_floats(load_one<GLuint>(from));
    std::copy_n(values.begin(), size, out);
}

void load_halves(const std::byte* from, GLint size, float* out) {
    for (GLint i = 0; i < size; ++i)
        out[i] = glapi::half_to_float(load_one<std::uint16_t>(from + static_cast<std::size_t>(i) * 2));
}

template <GLenum kType, glapi::Fraction kFraction>
void load_packed(const std::byte* from, GLint size, float* out) {
    glapi::unpack_2_10_10_10(kType, load_one<GLuint>(from), kFraction, static_cast<unsigned>(size), out);
}

/// Fixed point, as llvmpipe fetches it: for it, 1 is 2^16 - 1.
void load_fixed(const std::byte* from, GLint count, GLfloat* out) {
    constexpr auto kLastBit = static_cast<float>(1.0 / 65535);
    for (GLint i = 0; i < count; ++i)
        out[i] = static_cast<float>(load_one<GLfixed>(from + static_cast<std::size_t>(i) * sizeof(GLfixed))) * kLastBit;
}

template <GLenum kType>
Load packed_loader(Conversion conversion) {
    using glapi::Fraction;
    if (conversion == Conversion::none) return &load_packed<kType, Fraction::none>;
    return conversion == Conversion::fetch ? &load_packed<kType, Fraction::fetch>
                                           : &load_packed<kType, Fraction::command>;
}

template <class T>
Load loader(Conversion conversion) {
    switch (conversion) {
        case Conversion::integer: return &load_values<T, Conversion::integer>;
        case Conversion::fetch: return &load_values<T, Conversion::fetch>;
        case Conversion::command: return &load_values<T, Conversion::command>;
        case Conversion::none: break;
    }
    return &load_values<T, Conversion::none>;
}

Load loader_of(GLenum type, Conversion conversion) {
    switch (type) {
        case GL_BYTE: return loader<GLbyte>(conversion);
        case GL_UNSIGNED_BYTE: return loader<GLubyte>(conversion);
        case GL_SHORT: return loader<GLshort>(conversion);
        case GL_UNSIGNED_SHORT: return loader<GLushort>(conversion);
        case GL_INT: return loader<GLint>(conversion);
        case GL_UNSIGNED_INT: return loader<GLuint>(conversion);
        case GL_DOUBLE: return loader<GLdouble>(Conversion::none);
        case GL_HALF_FLOAT: return &load_halves;
        case GL_UNSIGNED_INT_10F_11F_11F_REV: return &load_short_floats;
        case GL_FIXED: return &load_fixed;
        case GL_INT_2_10_10_10_REV: return packed_loader<GL_INT_2_10_10_10_REV>(conversion);
        case GL_UNSIGNED_INT_2_10_10_10_REV: return packed_loader<GL_UNSIGNED_INT_2_10_10_10_REV>(conversion);
        default: return loader<GLfloat>(Conversion::none);
    }
}

/// Whether the two conversions of a byte give the same float; then a colour of bytes may travel as such.
constexpr std::array<bool, 256> kSameByte = [] {
    std::array<bool, 256> same{};
    for (int i = 0; i < 256; ++i)
        same[static_cast<std::size_t>(i)] =
            static_cast<float>(i) * static_cast<float>(1.0 / 255.0) == static_cast<float>(i) / 255.0f;
    return same;
}();

bool same_bytes(const std::byte* at, std::size_t count) {
    bool same = true;
    for (std::size_t i = 0; i < count; ++i) same &= kSameByte[std::to_integer<std::size_t>(at[i])];
    return same;
}

const std::byte* place(const ArraySource& source, GLuint element) {
    static constexpr std::byte kNothing[32]{};
    return element < source.count ? source.base + source.stride * element : kNothing;
}

// ---- straight into the packer ----

/// An array whose elements are an operand as they stand.
struct DirectArray {
    const std::byte* base;
    std::size_t stride;
    Op op;
    std::size_t bytes;
    Attribute attribute;  ///< kVertexArray: the vertex
};

struct DirectLayout {
    std::array<DirectArray, 4> arrays;
    std::size_t count = 0;
};

bool direct(const ArraySource& source, DirectArray& out) {
    if (source.count != ArraySource::kNoLimit) return false;
    if (source.bgra) return false;
    const bool floats = source.type == GL_FLOAT;
    const auto size = static_cast<unsigned>(source.size);
    out = {source.base, source.stride, Op::Vertex3f, size * sizeof(float), source.attribute};
    if (source.attribute == kVertexArray) {
        if (size == 2) out.op = Op::Vertex2f;
        return floats && (size == 2 || size == 3);
    }
    if (source.attribute == Attribute::color && source.type == GL_UNSIGNED_BYTE && size == 4) {
        out.op = Op::Color4ub, out.bytes = 4;
        return true;
    }
    const auto op = glstate::float_command(source.attribute, size);
    if (op) out.op = *op;
    return floats && op;
}

/// False if some array needs conversion or a rarer command.
bool direct_layout(const ArraySet& arrays, DirectLayout& layout) {
    for (const ArraySource& source : arrays.sources()) {
        if (layout.count == layout.arrays.size() || !direct(source, layout.arrays[layout.count])) return false;
        ++layout.count;
    }
    return true;
}

void copy_words(std::byte* to, const std::byte* from, std::size_t bytes) {
    switch (bytes) {  // constant sizes: a move or two each
        case 4: std::memcpy(to, from, 4); break;
        case 8: std::memcpy(to, from, 8); break;
        case 12: std::memcpy(to, from, 12); break;
        default: std::memcpy(to, from, 16); break;
    }
}

__m128 load_vertex(const std::byte* at, std::size_t bytes) {
    const __m128 xy = _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(at)));  // any alignment
    if (bytes == 8) return xy;
    float z;
    std::memcpy(&z, at + 8, sizeof z);
    return _mm_movelh_ps(xy, _mm_set_ss(z));
}

/// Where the latest attributes went and as what.
struct Placed {
    std::array<const std::byte*, 4> at;
    std::array<Op, 4> op;
};

/// A colour of four bytes, as the driver would fetch it.
std::byte* pack_color(std::byte* operand, const std::byte* from, Op& op) {
    if (same_bytes(from, 4)) {
        op = Op::Color4ub;
        std::memcpy(operand, from, 4);
        return operand + 4;
    }
    op = Op::Color4f;
    float v[4];
    load_values<GLubyte, Conversion::fetch>(from, 4, v);
    std::memcpy(operand, v, sizeof v);
    return operand + sizeof v;
}

/// Packs elements as long as there is room in the packer; returns how many.
template <class ElementAt>
GLsizei pack_some(Packer& packer, const DirectLayout& layout, GLsizei first, GLsizei end, ElementAt&& element_at) {
    std::byte *operand = packer.next_operand(), *opcode = packer.next_opcode();
    const std::byte* const limit = packer.limit;
    geom::Box box = packer.box;
    Placed placed;
    GLsizei i = first;
    // A vertex takes at most 16 + 12 + 16 + 12 bytes: it fits into what the packer keeps beyond its limit.
    for (; i < end && operand < limit; ++i) {
        const std::size_t element = element_at(i);
        for (std::size_t k = 0; k < layout.count; ++k) {
            const DirectArray& array = layout.arrays[k];
            const std::byte* from = array.base + array.stride * element;
            placed.at[k] = operand;
            placed.op[k] = array.op;
            if (array.op == Op::Color4ub) {
                operand = pack_color(operand, from, placed.op[k]);
            } else {
                copy_words(operand, from, array.bytes);
                operand += array.bytes;
            }
            *--opcode = static_cast<std::byte>(placed.op[k]);
            if (array.attribute == kVertexArray) box.add(load_vertex(from, array.bytes));
        }
    }
    packer.box = box;
    packer.next_operand() = operand;
    packer.next_opcode() = opcode;
    for (std::size_t k = 0; i > first && k < layout.count; ++k) {  // the last vertex has the current attributes
        if (layout.arrays[k].attribute == kVertexArray) continue;
        packer.last[place_of(layout.arrays[k].attribute)] = placed.at[k];
        packer.last_op[place_of(layout.arrays[k].attribute)] = placed.op[k];
    }
    return i - first;
}

template <class ElementAt>
void pack_direct(Packer& packer, const DirectLayout& layout, GLsizei count, ElementAt&& element_at) {
    for (GLsizei done = 0; done < count;) {
        done += pack_some(packer, layout, done, count, element_at);
        if (done < count) packer.make_room();
    }
}

void pack_direct(Packer& packer, const DirectLayout& layout, const ElementRange& elements) {
    const auto indexed = [&](const auto* indices) {
        pack_direct(packer, layout, elements.count, [indices, base = elements.base_vertex](GLsizei i) {
            return static_cast<std::size_t>(static_cast<GLuint>(indices[i]) + static_cast<GLuint>(base));
        });
    };
    switch (elements.type) {
        case GL_UNSIGNED_BYTE: return indexed(static_cast<const GLubyte*>(elements.indices));
        case GL_UNSIGNED_SHORT: return indexed(static_cast<const GLushort*>(elements.indices));
        case GL_UNSIGNED_INT: return indexed(static_cast<const GLuint*>(elements.indices));
        default:
            pack_direct(packer, layout, elements.count, [first = elements.first](GLsizei i) {
                return static_cast<std::size_t>(first) + static_cast<std::size_t>(i);
            });
    }
}

// ---- current attributes ----

/// OpenGL leaves the current attributes undefined after a draw from arrays; Mesa leaves them alone, and programs rely
/// on it.
class SavedCurrent {
public:
    SavedCurrent(Context& c, const ArraySet& arrays) : c_(c), arrays_(arrays) {
        for (std::size_t i = 0; i < arrays.sources().size(); ++i)
            if (arrays.sources()[i].attribute != kVertexArray) save(arrays.sources()[i].attribute, saved_[i]);
    }
    void restore() {
        for (std::size_t i = 0; i < arrays_.sources().size(); ++i)
            if (arrays_.sources()[i].attribute != kVertexArray) restore(arrays_.sources()[i].attribute, saved_[i]);
    }

private:
    /// The command that sets it again.
    struct Saved {
        Op op;
        std::array<std::byte, glstate::kMostAttributeBytes> operand;
    };
    /// The packed command is newer than the state.
    void save(Attribute attribute, Saved& out) const {
        const std::size_t place = place_of(attribute);
        if (c_.packer.last[place]) {
            out.op = c_.packer.last_op[place];
            std::memcpy(out.operand.data(), c_.packer.last[place], operand_bytes_of(out.op));
        } else {
            out.op = glstate::write_attribute(c_.state, attribute, out.operand.data());
        }
    }
    void restore(Attribute attribute, const Saved& saved) {
        const std::size_t bytes = operand_bytes_of(saved.op);
        std::memcpy(c_.packer.append_attribute(attribute, saved.op, bytes), saved.operand.data(), bytes);
    }

    Context& c_;
    const ArraySet& arrays_;
    std::array<Saved, kMaxArrays> saved_;  // as many as there are sources
};

// ---- through the table ----

void send(Context& c, const ArraySource& source, GLuint element) {
    const std::byte* at = place(source, element);
    if (source.attribute == Attribute::color && source.type == GL_UNSIGNED_BYTE && !source.bgra &&
        (source.by_command || same_bytes(at, static_cast<std::size_t>(source.size)))) {
        const auto byte = [&](GLint i) { return std::to_integer<GLubyte>(at[i]); };
        return c.table->Color4ub(c, byte(0), byte(1), byte(2), source.size == 4 ? byte(3) : GLubyte{255});
    }
    float v[4] = {0, 0, 0, source.integer ? glapi::to_bits(1) : 1.0f};
    source.load(at, source.size, v);
    if (source.bgra) std::swap(v[0], v[2]);
    if (source.integer && source.attribute == kVertexArray)
        return c.table->VertexAttrib4f(c, 0, v[0], v[1], v[2], v[3]);
    if (source.attribute != kVertexArray) return call_attribute(*c.table, c, source.attribute, source.size, v);
    if (source.size == 2) return c.table->Vertex2f(c, v[0], v[1]);
    if (source.size == 3) return c.table->Vertex3f(c, v[0], v[1], v[2]);
    return c.table->Vertex4f(c, v[0], v[1], v[2], v[3]);
}

/// Calls `each(element)` for every element, and `restart()` where the index says so.
template <class Each, class Restart>
void walk(const ElementRange& elements, Each&& each, Restart&& restart) {
    for (GLsizei i = 0; i < elements.count; ++i)
        if (elements.restarts_at(i)) restart();
        else each(elements.at(i));
}

}  // namespace

namespace {

Conversion conversion_of(std::uint32_t reaches_as, std::uint32_t normalized, Conversion of_normalized) {
    if (reaches_as == glstate::kAsIntegers) return Conversion::integer;
    return normalized != 0 ? of_normalized : Conversion::none;
}

}  // namespace

ArraySource array_source(const glstate::InputArray& array, std::span<const std::byte> content) {
    const std::size_t bytes = array.element_bytes();
    return {.attribute = static_cast<Attribute>(array.place),
            .by_command = false,
            .base = content.data(),
            .stride = array.step(),
            .count = content.size() < bytes ? 0 : (content.size() - bytes) / array.step() + 1,
            .size = glstate::components(array.size),
            .type = array.type,
            .integer = array.reaches_as == glstate::kAsIntegers,
            .bgra = array.size == GL_BGRA,
            .load = loader_of(array.type, conversion_of(array.reaches_as, array.normalized, Conversion::fetch))};
}

ArraySet::ArraySet(Context& c, bool by_command, GLsizei instance) : by_command_(by_command), instance_(instance) {
    const auto& l = c.state.vertex_arrays;
    glstate::for_each_attribute_array(c.state, [&](Attribute attribute, const glstate::ClientArray& array) {
        if (attribute != Attribute::vertex_attrib) add(c, attribute, array);  // number 0 is the position
    });
    add(c, kVertexArray, l.attrib_array[0].enabled ? l.attrib_array[0] : l.vertex_array);
}

void ArraySet::add(Context& c, Attribute attribute, const glstate::ClientArray& array) {
    if (!array.enabled) return;
    const std::size_t bytes = glstate::element_bytes(array.type, array.size);
    const std::size_t stride = array.stride ? static_cast<std::size_t>(array.stride) : bytes;
    const auto* base = reinterpret_cast<const std::byte*>(static_cast<std::uintptr_t>(array.pointer));
    std::size_t count = ArraySource::kNoLimit;
    if (array.buffer) {
        readings_.push_back(buffer_content(c, ClientName(array.buffer), static_cast<std::uintptr_t>(array.pointer)));
        const auto content = readings_.back().bytes();
        base = content.data();
        count = content.size() < bytes ? 0 : (content.size() - bytes) / stride + 1;
    } else if (!base) {
        return;
    }
    std::size_t step = stride;
    if (array.divisor != 0) {
        const std::size_t element = static_cast<std::size_t>(instance_) / array.divisor;
        base += stride * element;
        count = element < count ? ArraySource::kNoLimit : 0;
        step = 0;
    }
    const Conversion conversion =
        conversion_of(array.reaches_as, array.normalized, by_command_ ? Conversion::command : Conversion::fetch);
    sources_[count_++] = {.attribute = attribute,
                          .by_command = by_command_,
                          .base = base,
                          .stride = step,
                          .count = count,
                          .size = glstate::components(array.size),
                          .type = array.type,
                          .integer = array.reaches_as == glstate::kAsIntegers,
                          .bgra = array.size == GL_BGRA,
                          .load = loader_of(array.type, conversion)};
}

void ArraySet::add_constant_vertex(Context& c) {
    if (has_vertex()) return;
    c.flush_block();  // the current attributes are in `state` after it
    constant_vertex_ = c.state.current.vertex_attrib[0];
    const auto* base = reinterpret_cast<const std::byte*>(constant_vertex_.data());
    sources_[count_++] = {.attribute = kVertexArray,
                          .by_command = by_command_,
                          .base = base,
                          .stride = 0,
                          .count = ArraySource::kNoLimit,
                          .size = 4,
                          .type = GL_FLOAT,
                          .integer = false,
                          .bgra = false,
                          .load = loader_of(GL_FLOAT, Conversion::none)};
}

void send_element(Context& c, const ArraySet& arrays, GLuint element) {
    for (const ArraySource& source : arrays.sources()) send(c, source, element);
}

void draw_elements(Context& c, GLenum mode, const ElementRange& elements) {
    const bool at_once = c.at_once();
    ArraySet arrays(c, !at_once, elements.instance);
    if (c.shades_vertices()) arrays.add_constant_vertex(c);
    const bool draws = arrays.has_vertex() && elements.count > 0;
    if (!at_once && !record_array_draw(c, draws)) return;
    if (!draws) return;
    if (!at_once) {
        c.table->Begin(c, mode);
        walk(
            elements, [&](GLuint e) { send_element(c, arrays, e); },
            [&] {
                c.table->End(c);
                if (record_array_draw(c, true)) c.table->Begin(c, mode);
            });
        return c.table->End(c);
    }
    if (!may_draw(c)) return;
    SavedCurrent current(c, arrays);
    c.begin_primitive(mode);
    const auto restart = [&] { c.end_primitive(), c.begin_primitive(mode); };
    if (DirectLayout layout; !elements.restart && direct_layout(arrays, layout))
        pack_direct(c.packer, layout, elements);
    else
        walk(
            elements, [&](GLuint e) { send_element(c, arrays, e); }, restart);
    c.end_primitive();
    current.restore();
}

}  // namespace wall::client
