// SPDX-License-Identifier: MIT
// Finds in the source of vertex shaders how they make gl_Position of one attribute (DESIGN, section 4, "Shaders and
// boxes"). The source is parsed by glslang and its tree is gone through as the shader would run: functions where they
// are called, both sides of a branch, and of a loop what it may write. Nothing is guessed: what is not followed is not
// known, and a position that depends on it is not recognised. The same is found of where textures are looked up. Pure
// but for glslang. Any thread; several at once.
#pragma once

#include <string>
#include <vector>

#include "common/glapi/position_program.h"
#include "common/glapi/program_format.h"

namespace wall::tileserver {

struct RecognisedPosition {
    glapi::PositionProgram program;                  ///< not known: it was not recognised
    std::string reason;                              ///< why not, for people
    std::vector<glapi::TextureLookup> lookups = {};  ///< if it was: of the samplers that lookup_finder.h finds
};

/// Of a program that the driver has linked. Parsing takes as long as the driver's own, and up to 0.1 s more for the
/// first shader of a version.
RecognisedPosition recognise_position(const glapi::ProgramDefinition& definition);

}  // namespace wall::tileserver
