// SPDX-License-Identifier: MIT
#include "tileserver/objects/pipeline.h"

#include <utility>

namespace wall::tileserver {
namespace {

constexpr std::array<GLbitfield, Pipeline::kStages> kBits = {GL_VERTEX_SHADER_BIT,          GL_FRAGMENT_SHADER_BIT,
                                                             GL_GEOMETRY_SHADER_BIT,        GL_TESS_CONTROL_SHADER_BIT,
                                                             GL_TESS_EVALUATION_SHADER_BIT, GL_COMPUTE_SHADER_BIT};

}  // namespace

Pipeline::Pipeline(ObjectAccount& account, Driver& driver) : ObjectOf(account), driver_(driver) {
    driver_.gl().CreateProgramPipelines(1, &name_);
}

Pipeline::~Pipeline() {
    driver_.forget_pipeline(name_);
    driver_.gl().DeleteProgramPipelines(1, &name_);
}

/// What is not separable the driver refuses, and what does not fit together it does not draw with.
void Pipeline::find_programs(const ObjectTable& objects) {
    for (std::size_t i = 0; i < kStages; ++i) {
        const Program* program = programs_[i] ? objects.find<Program>(programs_[i]) : nullptr;
        const GLuint wanted = program != nullptr ? program->name() : 0;
        if (std::exchange(in_driver_[i], wanted) != wanted) driver_.gl().UseProgramStages(name_, kBits[i], wanted);
    }
}

}  // namespace wall::tileserver
