// SPDX-License-Identifier: MIT
// glGet*, glIsEnabled and the like answered from a State: which word names which element, and the conversions between
// the kinds of value that OpenGL prescribes (as Mesa does them). Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "gen/glstate/state.gen.h"
#include "gen/glstate/tables.gen.h"

namespace wall::glstate {

/// Says what an array's index follows.
enum class IndexRule : std::uint8_t {
    none,
    unit /* active texture unit */,
    client_unit /* client active texture unit */
};

/// A word that glGet* answers: `components` values from byte `offset` of element `id` + unit * `unit_stride`.
struct GetEntry {
    GLenum pname;
    ValueKind kind;
    std::uint8_t components;
    std::uint16_t id;
    std::uint16_t offset;
    IndexRule rule;
    std::uint8_t unit_stride;
    std::uint8_t units;  ///< that have a value
};

/// A word of glEnable: element `id` + active unit * `unit_stride`.
struct CapEntry {
    GLenum cap;
    std::uint16_t id;
    IndexRule rule;
    std::uint8_t unit_stride;
    std::uint8_t units;  ///< that have a value
};

/// A parameter of glLight*, glFog*, ...: element `id` + the command's index (light; face; unit; unit * 4 + coordinate).
struct ParamEntry {
    ParamFamily family;
    GLenum target;  ///< of glTexEnv*; else 0
    GLenum pname;
    ValueKind kind;
    std::uint8_t components;
    std::uint16_t id;
};

extern const std::span<const GetEntry> kGetEntries;  ///< by pname
extern const std::span<const CapEntry> kCapEntries;  ///< by cap
extern const std::span<const ParamEntry> kParamEntries;

const GetEntry* find_get(GLenum pname);                                         ///< null: not answered from the state
const CapEntry* find_cap(GLenum cap);                                           ///< null: no such word
const ParamEntry* find_param(ParamFamily family, GLenum target, GLenum pname);  ///< null: no such parameter

/// Reads `count` components of kind `kind` that start at `offset` of value `id`, converted as glGet* does.
/// Instantiated for GLboolean, GLint, GLint64, GLfloat, GLdouble.
template <class Out>
void read_components(const State& state, std::uint32_t id, std::uint32_t offset, ValueKind kind, unsigned count,
                     Out* out);

}  // namespace wall::glstate
