// SPDX-License-Identifier: MIT
#include "client_lib/objects/program_pipeline.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "gen/glapi/wire.gen.h"

namespace wall::client {

ProgramPipeline::ProgramPipeline(GLuint pipeline_name, bool exact)
    : Program(next_object_id(), 0), pipeline(pipeline_name), exact_(exact) {
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

/// "name" of "name[0]".
std::string_view bare(std::string_view name) { return name.ends_with("[0]") ? name.substr(0, name.size() - 3) : name; }

bool is_built_in(std::string_view name) { return name.starts_with("gl_"); }

/// Whether an input takes an output: by the location that both have of their shaders (others have none between
/// stages) or by the name.
bool matches(const glapi::ActiveAttribute& input, const glapi::ActiveOutput& output) {
    const bool located = input.location >= 0 && output.location >= 0;
    const bool met = located ? input.location == output.location : bare(input.name) == output.name;
    return met && input.type == output.type && input.patch == output.patch;
}

/// Whether each input of a program has its output of the one before, and each output its input (OpenGL ES 3.1, 7.4.1).
bool interfaces_match(const Executable& before, const Executable& behind) {
    std::vector<bool> taken(before.outputs.size());
    for (const auto& input : behind.taken()) {
        if (is_built_in(input.name)) continue;
        const auto found =
            std::ranges::find_if(before.outputs, [&](const auto& output) { return matches(input, output); });
        if (found == before.outputs.end()) return false;
        taken[static_cast<std::size_t>(found - before.outputs.begin())] = true;
    }
    for (std::size_t i = 0; i < taken.size(); ++i)
        if (!taken[i] && !is_built_in(before.outputs[i].name)) return false;
    return true;
}

/// Of all programs that follow each other.
template <class Programs>
bool all_interfaces_match(const Programs& programs) {
    const Program* before = nullptr;
    for (const std::size_t stage : kInOrder) {
        const Program* behind = programs[stage].get();
        if (!behind || behind == before) continue;
        if (before && !interfaces_match(*before->executable, *behind->executable)) return false;
        before = behind;
    }
    return true;
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
    if (exact_ && !all_interfaces_match(programs)) return "a program takes other variables than the one before gives";
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
