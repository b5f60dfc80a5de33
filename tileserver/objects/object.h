// SPDX-License-Identifier: MIT
// What a session has named and a draw may use: a texture, a program, a run of a display list, a query. On a node every
// object is a replica of what the client keeps of it (client_lib/objects/object.h), and can be sent again. What all
// kinds have is here: an id, the driver's memory that it counts for, and an end that gives the driver's names back.
// What is special about a kind is in one file of this folder. Render thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace wall::tileserver {

/// The kinds, a word each; kObjectKindNames has what a person calls them.
enum class ObjectKind : std::uint8_t {
    texture,
    program,
    run,
    query,
    buffer,
    vertex_input,
    draw_pieces,
    renderbuffer,
    framebuffer,
    sampler,
    capture,
    pipeline,
    assembly_program,
};
inline constexpr std::array kObjectKindNames = {"texture",
                                                "program",
                                                "run",
                                                "query",
                                                "buffer",
                                                "vertex input",
                                                "piece table",
                                                "renderbuffer",
                                                "framebuffer",
                                                "sampler",
                                                "transform feedback",
                                                "pipeline",
                                                "assembly program"};
inline constexpr std::size_t kObjectKinds = kObjectKindNames.size();

// What one session may have on a node, of all kinds together: they fill the same memory, and no kind knows what is
// left of it. A session that wants more is ended with a reason. walld may say less (SessionQuota).
inline constexpr std::size_t kMaxObjects = std::size_t{1} << 20;
inline constexpr std::uint64_t kMaxObjectBytes = std::uint64_t{6} << 30;  ///< by estimate
/// Why a session is ended that wants more `what`.
inline std::string too_much(std::string_view what) {
    return "more " + std::string(what) + " than a session may have ('program_memory', 'program_objects' in [quota])";
}
/// What the driver takes for an object with nothing in it.
inline constexpr std::uint64_t kLeastObjectBytes = 4096;

/// What a session's objects come to. Outlives them.
struct ObjectAccount {
    std::uint64_t bytes = 0;  ///< of the driver's memory, by estimate
    std::uint64_t most_bytes = kMaxObjectBytes;
    /// By kind: grows whenever the driver's name of an object, or the size of its images, may have become another, so
    /// that it must be looked up again.
    std::array<std::uint64_t, kObjectKinds> versions{};

    bool affords(std::uint64_t more) const { return more <= most_bytes && bytes <= most_bytes - more; }
};

class ObjectReplica {
public:
    virtual ~ObjectReplica() {
        account_.bytes -= bytes_;
        renamed();
    }
    ObjectReplica(const ObjectReplica&) = delete;

    ObjectKind kind() const { return kind_; }
    std::uint64_t bytes() const { return bytes_; }  ///< that it counts for

protected:
    /// `account`: of its session.
    ObjectReplica(ObjectKind kind, ObjectAccount& account) : account_(account), kind_(kind) {
        count_content(0);
        renamed();
    }
    /// It counts for a content of so many bytes from now on. False: the session has more than it may have.
    [[nodiscard]] bool has_content(std::uint64_t bytes) {
        count_content(bytes);
        return account_.affords(0);
    }
    /// Whether the session may have `bytes` for what now takes `instead_of`.
    bool affords(std::uint64_t bytes, std::uint64_t instead_of) const {
        return bytes <= instead_of || account_.affords(bytes - instead_of);
    }
    /// The driver's name of it, or what its images are, may be another from now on.
    void renamed() { ++account_.versions[static_cast<std::size_t>(kind_)]; }

private:
    void count_content(std::uint64_t bytes) {
        account_.bytes += kLeastObjectBytes + bytes - bytes_;
        bytes_ = kLeastObjectBytes + bytes;
    }

    ObjectAccount& account_;
    std::uint64_t bytes_ = 0;
    const ObjectKind kind_;
};

/// The base of the one class of a kind.
template <ObjectKind K>
class ObjectOf : public ObjectReplica {
public:
    static constexpr ObjectKind kKind = K;

protected:
    explicit ObjectOf(ObjectAccount& account) : ObjectReplica(K, account) {}
};

}  // namespace wall::tileserver
