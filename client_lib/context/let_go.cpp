// SPDX-License-Identifier: MIT
#include "client_lib/context/let_go.h"

#include <utility>
#include <vector>

#include "client_lib/context/forget_objects.h"
#include "client_lib/context/memory_use.h"
#include "client_lib/context/program_use.h"

namespace wall::client {
namespace {

void forget_active(Context& c, FeedbackObject& object) {
    const auto active = std::exchange(object.active, nullptr);
    if (!active) return;
    forget(c, active->id);
    for (const ClientName id : active->target_ids()) forget(c, id);
}

}  // namespace

void forget_ended(Context& c, FeedbackObject& object) {
    if (const auto ended = std::exchange(object.ended, nullptr)) forget(c, ended->id);
}

void forget_pipeline(Context& c, ProgramPipeline& pipeline) {
    std::vector<std::shared_ptr<Program>> dropped;
    {
        std::lock_guard lock(c.share().mutex);
        for (auto& program : pipeline.programs)
            if (program) dropped.push_back(std::exchange(program, nullptr));
        pipeline.combine();
    }
    for (const auto& program : dropped) drop_user(c, program);
    forget(c, pipeline.id);
}

void let_go_of_own_objects(Context& c) {
    const auto let_go = [&](FeedbackObject& object) {
        forget_active(c, object);
        forget_ended(c, object);
    };
    let_go(*c.captures->find(0));
    c.captures->names.for_each(let_go);
    if (c.memory->target)
        for (const ClientName id : c.memory->target->ids()) c.forget_object(id);
    c.memory->target.reset();
    c.pipelines->names.for_each([&](ProgramPipeline& pipeline) { forget_pipeline(c, pipeline); });
}

}  // namespace wall::client
