// SPDX-License-Identifier: MIT
// Finds in the text of a vertex program how it makes result.position of one attribute, as position_recogniser.h does
// for shaders. A program has neither branches nor loops: its instructions are gone through once, in order. Nothing is
// guessed: what is not followed is not known, and a position that depends on it is not recognised. Pure.
#pragma once

#include <string>
#include <string_view>

#include "common/glapi/position_program.h"

namespace wall::tileserver {

struct AssemblyPosition {
    bool invariant = false;          ///< the program leaves it to fixed function (ARB_position_invariant)
    glapi::PositionProgram program;  ///< not known: it was not recognised
    std::string reason;              ///< why not, for people
};

/// Of a vertex program that the driver has compiled.
AssemblyPosition recognise_assembly_position(std::string_view source);

}  // namespace wall::tileserver
