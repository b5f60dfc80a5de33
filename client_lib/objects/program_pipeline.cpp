// SPDX-License-Identifier: MIT
#include "client_lib/objects/program_pipeline.h"

#include <algorithm>
#include <string>
#include <vector>

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

void ProgramPipeline::combine() {
    executable = Executable::combine(parts());
    fault_ = find_fault();
}

namespace {

// Indices of glapi::kShaderStages.
constexpr std::size_t kVertex = 0, kFragment = 1, kGeometry = 2, kControl = 3, kEvaluation = 4;
constexpr std::size_t kInOrder[] = {kVertex, kControl, kEvaluation, kGeometry, kFragment};

/// Whether a program has stages before and behind one that another program has.
template <class Programs>
bool is_interrupted(const Programs& programs) {
    std::vector<const Program*> in_order;
    for (const std::size_t stage : kInOrder)
        if (programs[stage] && (in_order.empty() || in_order.back() != programs[stage].get()))
            in_order.push_back(programs[stage].get());
    std::ranges::sort(in_order);
    return std::ranges::adjacent_find(in_order) != in_order.end();
}

}  // namespace

std::string ProgramPipeline::find_fault() const {
    for (const auto& part : executable->parts) {
        const std::string called = "program " + std::to_string(part->name);
        if (!part->linked_separable) return called + " was linked again without GL_PROGRAM_SEPARABLE";
        for (std::size_t i = 0; i < kStages; ++i)
            if ((part->executable->stages >> i & 1) != 0 && programs[i] != part)
                return called + " is not used for all of its stages";
    }
    if (is_interrupted(programs)) return "a program has stages before and behind one of another program";
    if (!programs[kVertex] && (programs[kControl] || programs[kEvaluation] || programs[kGeometry]))
        return "no program has a vertex shader";
    return {};
}

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
