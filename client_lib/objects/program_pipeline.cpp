// SPDX-License-Identifier: MIT
#include "client_lib/objects/program_pipeline.h"

#include <algorithm>

#include "gen/glapi/wire.gen.h"

namespace wall::client {

ProgramPipeline::ProgramPipeline(GLuint pipeline_name) : Program(next_object_id(), 0), pipeline(pipeline_name) {
    linked = true;
    combine();
}

std::vector<std::shared_ptr<Program>> ProgramPipeline::parts() const {
    std::vector<std::shared_ptr<Program>> out;
    for (const auto& program : programs)
        if (program && std::ranges::find(out, program) == out.end()) out.push_back(program);
    return out;
}

void ProgramPipeline::combine() { executable = Executable::combine(parts()); }

bool ProgramPipeline::is_outdated() const {
    return std::ranges::any_of(executable->parts,
                               [&](const auto& part) { return part->executable->stamp > executable->stamp; });
}

void ProgramPipeline::pack_changes(std::uint64_t, wire::PackBuffer& buffer, const std::function<void()>&) const {
    std::array<std::uint32_t, kStages> words{};
    for (std::size_t i = 0; i < kStages; ++i) words[i] = programs[i] ? programs[i]->id.value : 0;
    glapi::pack::Pipeline(buffer, id, std::as_bytes(std::span(words)));
}

}  // namespace wall::client
