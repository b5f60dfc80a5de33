// SPDX-License-Identifier: MIT
// What a node must hold before it can draw with it: a texture, a program, a run of a display list, a map. The client
// keeps all of an object; a node is told what it lacks of it when it is about to draw with it, and never more (T3.5;
// DESIGN, section 4, "Objects are one concept"). What is special about a kind is in one file here. Which objects a
// context draws with: for_each_used() (context/used_objects.h). What a node lacks of one: ObjectSender
// (follow/object_sender.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/base/ids.h"
#include "common/glapi/gl_types.h"
#include "common/wire/pack_buffer.h"

namespace wall::client {

/// A logical time, unique in the process, growing.
std::uint64_t next_stamp();
// Ids of contexts, surfaces and objects on the wire: all from one counter, unique in the process, never 0.
ContextId next_context_id();
SurfaceId next_surface_id();
ClientName next_object_id();

/// Bytes of content from which on a round trip is worth while: on a network of 1 Gbit/s they take 2 ms.
inline constexpr std::size_t kLeastShared = std::size_t{256} << 10;

/// What is asked for of drawn content: tight rows of an image; none of what is no image.
struct ImageRows {
    std::int32_t first = 0, count = 0, width = 0;
};

class Object {
public:
    explicit Object(ClientName own_id, GLuint own_name = 0) : id(own_id), name(own_name) {}
    virtual ~Object() = default;
    Object(const Object&) = delete;

    const ClientName id;  ///< on the wire, in state elements and in Node::object_stamps
    const GLuint name;    ///< the application's; 0: it has none

    /// What a node must have before it can have this one; null: nothing.
    virtual const Object* rests_on() const { return nullptr; }
    /// Stamp of the latest change; 0: there is nothing that a node would lack.
    virtual std::uint64_t latest() const = 0;
    /// Packs everything that changed since `known` (0: the node has nothing). `packed` is called after every command
    /// that may be large, so that the caller can send the buffer before it outgrows a frame.
    virtual void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                              const std::function<void()>& packed) const = 0;

    // ---- what changes from draw to draw, and so goes with kept commands (docs/off-the-wall.md): uniforms ----
    /// As latest(), without these values.
    virtual std::uint64_t defined() const { return latest(); }
    /// Packs these values as they are now, as far as they are newer than `known`.
    virtual void pack_values(std::uint64_t /*known*/, wire::PackBuffer& /*buffer*/) const {}

    // ---- content that only nodes have, because they drew it (DESIGN, section 4: drawn content) ----
    /// Whether there is any.
    virtual bool is_drawn() const { return false; }
    /// Asks a node that has it, `pack(buffer, request)` being the question; nothing: it does not answer.
    using AskHolder = std::function<std::optional<std::vector<std::byte>>(
        const std::function<void(wire::PackBuffer& buffer, RequestId request)>& pack, const ImageRows& rows)>;
    /// Behind pack_changes() for a node that had nothing: packs it as another node has it.
    virtual void pack_drawn(const AskHolder& /*ask*/, wire::PackBuffer& /*buffer*/,
                            const std::function<void()>& /*packed*/) const {}

    // ---- content that a node may hold already, from another program (A6: global share) ----
    /// Whether it is large enough for a round trip.
    virtual bool worth_asking() const { return false; }
    /// The question whether the node holds it; if so, the node has the whole object with the answer.
    virtual void pack_question(wire::PackBuffer& /*buffer*/, RequestId /*request*/) const {}
    /// Behind an object whose question was answered with no: others can have it now. False: its definition says so.
    virtual bool pack_shared(wire::PackBuffer& /*buffer*/) const { return false; }
};

/// Calls `use` with an object, behind what that rests on.
template <class Use>
void use_with_base(const Object& object, Use&& use) {
    if (const Object* base = object.rests_on()) use(*base);
    use(object);
}

/// When nobody wants to hear of the commands that are packed.
inline void no_limit() {}

/// Equal ones: drawing with a context needs the same objects as before, and none of them has changed. Value ids of the
/// state's categories that name objects, and stamps.
struct UseStamp {
    std::uint64_t texture_units = 0, textures = 0, objects = 0;
    std::uint64_t uniform_buffers = 0, read_buffers = 0;  ///< of the places for uniforms, of all that the program reads
    std::uint64_t shader_memory = 0;                      ///< of images and of buffers that shaders may write
    std::uint64_t targets = 0;                            ///< of the context's framebuffer bindings
    std::uint64_t shared = 0;                             ///< of all objects of the share group
    std::uint64_t maps = 0;                               ///< of the context's own
    bool operator==(const UseStamp&) const = default;
};

}  // namespace wall::client
