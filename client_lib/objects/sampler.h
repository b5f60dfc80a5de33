// SPDX-License-Identifier: MIT
// A sampler object as the application defined it (OpenGL 3.3, 3.8.2): how textures of a unit are looked up, instead of
// what each of them says. Guarded by the share group's mutex.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "client_lib/objects/object.h"

namespace wall::client {

/// The parameters, in the order of Sampler's values.
inline constexpr std::size_t kSamplerParameters = 13;

class Sampler final : public Object {
public:
    explicit Sampler(GLuint own_name);

    /// A value as a node is told it: one float, or the four components of a border colour in the bits of their type.
    struct Value {
        GLenum type = GL_FLOAT;  ///< GL_FLOAT, GL_INT, GL_UNSIGNED_INT
        std::array<std::uint32_t, 4> bits{};
        bool operator==(const Value&) const = default;
    };
    /// Why a parameter of one value may not be set to `number`; GL_NO_ERROR: it may. GL_INVALID_ENUM also for
    /// parameters that there are not.
    static GLenum refuses(GLenum pname, double number);
    /// How many components a parameter has; 0: there is none.
    static unsigned components(GLenum pname);

    /// Of a parameter that exists.
    const Value& get(GLenum pname) const;
    /// A value that is allowed. False: it was that already.
    bool set(GLenum pname, const Value& value);

    std::uint64_t latest() const override { return stamp_; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;

    std::vector<ContextId> bound_by;  ///< contexts that ever bound it

private:
    std::array<Value, kSamplerParameters> values_;
    std::array<std::uint64_t, kSamplerParameters> stamps_{};  ///< of the latest change of each; 0: none
    std::uint64_t stamp_ = next_stamp();
};

}  // namespace wall::client
