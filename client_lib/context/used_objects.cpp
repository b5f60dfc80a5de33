// SPDX-License-Identifier: MIT
#include "client_lib/context/used_objects.h"

#include "client_lib/context/assembly_binding.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/context.h"
#include "client_lib/context/framebuffer_use.h"
#include "client_lib/context/indexed_buffers.h"
#include "client_lib/context/memory_use.h"
#include "client_lib/context/shader_memory.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/share_group.h"
#include "gen/glstate/texture_elements.gen.h"

namespace wall::client {
namespace {

using Use = std::function<void(const Object&)>;

/// Name 0 of a target stands for the default texture that has got content since it was bound: through another context
/// of the group, or before glPopAttrib.
void adopt_default(glstate::State& state, const Texture& texture) {
    glstate::with_binding(texture.info.id, [&]<class E>(E) {
        for (unsigned unit = 0; unit < E::count; ++unit)
            if (E::ref(state, unit) == 0) glstate::assign<E>(state, unit, texture.id.value);
    });
}

/// The same of assembly programs.
void adopt_default(glstate::State& state, const AssemblyProgram& program) {
    const bool vertices = program.stage == glapi::AssemblyStage::vertex;
    if ((vertices ? state.objects.vertex_program : state.objects.fragment_program) != 0) return;
    if (vertices) glstate::assign<glstate::el::vertex_program>(state, 0, program.id.value);
    else glstate::assign<glstate::el::fragment_program>(state, 0, program.id.value);
}

/// What is bound to a target of a unit.
ClientName bound_to(const glstate::State& state, glapi::TextureTarget target, std::uint32_t unit) {
    return ClientName((state.textures.*glstate::kTextureBindings[static_cast<std::size_t>(target)])[unit]);
}

/// Ids of the textures of fixed function. Targets that are not enabled cannot matter.
template <class UseId>
void for_each_enabled(const glstate::State& state, UseId&& use) {
    for (const auto& info : glapi::kTextureTargetInfo) {
        const glstate::TextureSwitch enabled = glstate::kTextureSwitches[static_cast<std::size_t>(info.id)];
        for (unsigned unit = 0; enabled != nullptr && unit < kTextureUnits; ++unit)
            if ((state.texture_units.*enabled)[unit]) use(bound_to(state, info.id, unit));
    }
}

/// The same of a program's samplers.
template <class UseId>
void for_each_sampled(const glstate::State& state, const Executable& executable, UseId&& use) {
    executable.for_each_sampler([&](std::uint32_t unit, glapi::TextureTarget target) {
        if (unit < kTextureImageUnits) use(bound_to(state, target, unit));
    });
}

/// The assembly programs that the context draws with, and the textures that they look up.
template <class Use, class UseId>
void for_each_assembly(Context& c, Use&& use, UseId&& use_id) {
    for (const auto stage : {glapi::AssemblyStage::vertex, glapi::AssemblyStage::fragment}) {
        if (!draws_with_assembly(c, stage)) continue;
        const AssemblyProgram* program = bound_assembly(c, stage);
        if (!program || !program->loaded()) continue;
        use(*program);
        for (const glapi::AssemblyTexture& texture : program->reflection().textures)
            if (texture.unit < kTextureImageUnits) use_id(bound_to(c.state, texture.target, texture.unit));
    }
}

}  // namespace

void for_each_used(Context& context, const Use& use_one) {
    const Use use = [&](const Object& object) { use_with_base(object, use_one); };
    ShareGroup& share = context.share();
    context.maps->for_each(use);
    std::lock_guard lock(share.mutex);
    for (const auto& [target, texture] : share.default_textures) adopt_default(context.state, *texture);
    for (const auto& program : share.default_assembly_programs)
        if (program) adopt_default(context.state, *program);
    const auto use_bound = [&](ClientName id) {
        if (const auto found = share.by_id.find(id); found != share.by_id.end()) use(*found->second);
    };
    for (const auto& framebuffer : {context.framebuffers->draw, context.framebuffers->read}) {
        if (!framebuffer) continue;
        framebuffer->for_each_image(use);
        use(*framebuffer);
    }
    for (const std::uint32_t sampler : context.state.objects.sampler_binding)
        if (sampler != 0) use_bound(ClientName(sampler));
    if (context.captures->now) context.captures->now->for_each_used(use);
    if (context.memory->now) context.memory->now->for_each_used(use);
    if (context.memory->work)
        for (const auto& object : context.memory->work->used) use(*object);
    for_each_enabled(context.state, use_bound);
    for_each_assembly(context, use, use_bound);
    if (!context.program) return;
    for (const auto& part : context.program->executable->parts) use(*part);
    use(*context.program);
    for_each_read_buffer(context, [&](const auto& buffer) { use(*buffer); });  // before textures that are made of them
    for_each_touched(context, use);
    for_each_sampled(context.state, *context.program->executable, use_bound);
}

UseStamp use_stamp(const Context& context) {
    using glstate::Category;
    const auto& ids = context.state.ids;
    return {
        .texture_units = ids[static_cast<std::size_t>(Category::texture_units)],
        .textures = ids[static_cast<std::size_t>(Category::textures)],
        .objects = ids[static_cast<std::size_t>(Category::objects)],
        .uniform_buffers = ids[static_cast<std::size_t>(Category::uniform_buffers)],
        .read_buffers = latest_of_read_buffers(context),
        .shader_memory = context.memory->work ? next_stamp() : ids[static_cast<std::size_t>(Category::shader_memory)],
        .targets = context.memory->now ? context.memory->now->stamp() : context.framebuffers->stamp,
        .shared = context.share().last_change.load(std::memory_order_acquire),
        .maps = context.maps->stamp};
}

}  // namespace wall::client
