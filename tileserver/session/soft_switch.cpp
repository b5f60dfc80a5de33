// SPDX-License-Identifier: MIT
#include "tileserver/session/soft_switch.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <span>

#include "common/glstate/draw_buffers.h"
#include "gen/glstate/texture_elements.gen.h"
#include "tileserver/objects/assembly_program.h"
#include "tileserver/objects/buffer.h"
#include "tileserver/objects/capture.h"
#include "tileserver/objects/pipeline.h"
#include "tileserver/objects/program.h"
#include "tileserver/objects/query.h"
#include "tileserver/objects/sampler.h"
#include "tileserver/objects/texture.h"
#include "tileserver/session/shader_memory.h"

namespace wall::tileserver {
namespace {

std::uint64_t objects_id(const SoftContext& context) {
    return context.state.ids[static_cast<std::size_t>(glstate::Category::objects)];
}

std::uint64_t textures_id(const SoftContext& context) {
    return context.state.ids[static_cast<std::size_t>(glstate::Category::textures)];
}

/// 0: the session has no such texture.
GLuint driver_name(const SessionReplica& session, ClientName name, TextureTarget target) {
    const Texture* texture = session.objects.find<Texture>(Texture::key(name, target));
    return texture != nullptr && texture->target() == target ? texture->content().name() : 0;
}

/// Of which most often none is used; whether one is takes a few operations of the processor's.
constexpr unsigned kUnitsAtOnce = 16;
static_assert(kTextureUnits % kUnitsAtOnce == 0);

void look_up_textures(SessionReplica& session, SoftContext& context) {
    BoundTextures& bound = context.textures;
    TextureNames found{};
    for (std::size_t target = 0; target < kTextureTargets; ++target) {
        const auto kind = static_cast<TextureTarget>(target);
        const auto& names = context.state.textures.*glstate::kTextureBindings[target];
        const GLuint otherwise = driver_name(session, ClientName(), kind);
        for (unsigned first = 0; first < kTextureUnits; first += kUnitsAtOnce) {
            const auto some = std::span(names).subspan(first).template first<kUnitsAtOnce>();
            if (otherwise == 0 && std::accumulate(some.begin(), some.end(), 0u, std::bit_or<>()) == 0) continue;
            for (unsigned unit = first; unit < first + kUnitsAtOnce; ++unit)
                found[unit][target] =
                    names[unit] == 0 ? otherwise : driver_name(session, ClientName(names[unit]), kind);
        }
    }
    if (found != bound.bindings.names) bound.bindings = {found == TextureNames{} ? 0 : glstate::next_value_id(), found};
    bound.state_id = textures_id(context);
    bound.version = session.objects.version(Texture::kKind);
}

/// The part in the driver's name, as large as the buffer is now. Nothing, if the buffer is not there or does not reach
/// so far, or if the driver would refuse it: what is bound must be this session's.
glstate::BufferRange found_range(const RenderNode& node, const SessionReplica& session,
                                 const glstate::BufferRange& wanted) {
    const Buffer* buffer = wanted.buffer != 0 ? session.objects.find<Buffer>(ClientName(wanted.buffer)) : nullptr;
    if (buffer == nullptr || wanted.offset >= buffer->size()) return {};
    if (wanted.offset % node.driver.uniform_buffer_alignment() != 0) return {};
    const auto rest = static_cast<std::uint32_t>(buffer->size() - wanted.offset);
    return {buffer->name(), wanted.offset, wanted.size != 0 ? std::min(wanted.size, rest) : rest};
}

bool counts_or_captures(const glstate::State& state) {
    return (glstate::el::occlusion_query::ref(state) | glstate::el::capture::ref(state)) != 0 ||
           glstate::counts_primitives(state);
}

/// Assembly programs are switched on.
bool has_assembly(const glstate::State& state) {
    return (glstate::el::vertex_program_enabled::ref(state) | glstate::el::fragment_program_enabled::ref(state)) != 0;
}

void look_up_samplers(SessionReplica& session, SoftContext& context) {
    BoundSamplers& bound = context.samplers;
    SamplerNames found{};
    for (unsigned unit = 0; unit < found.size(); ++unit) {
        const ClientName name(glstate::el::sampler_binding::ref(context.state, unit));
        const Sampler* sampler = name ? session.objects.find<Sampler>(name) : nullptr;
        found[unit] = sampler != nullptr ? sampler->name() : 0;
    }
    if (found != bound.bindings.names) bound.bindings = {found == SamplerNames{} ? 0 : glstate::next_value_id(), found};
    bound.values = objects_id(context);
    bound.version = session.objects.version(Sampler::kKind);
    bound.only_samplers = glstate::el::current_program::ref(context.state) == 0 && !has_assembly(context.state) &&
                          !counts_or_captures(context.state);
}

/// The one that draws a stage where no shader does; null: none, or one that is not there.
AssemblyProgram* use_assembly(RenderNode& node, const SessionReplica& session, glapi::AssemblyStage stage,
                              ClientName name, const LayerGeometry& layer) {
    AssemblyProgram* program = name ? session.objects.find<AssemblyProgram>(name) : nullptr;
    if (program == nullptr || program->stage() != stage) return node.driver.use_assembly(stage, 0), nullptr;
    program->use(layer);
    return program;
}

/// Both stages. The generic attributes that vertices are made of, a bit each.
std::uint32_t use_assembly(RenderNode& node, const SessionReplica& session, const glstate::State& state,
                           const LayerGeometry& layer) {
    namespace el = glstate::el;
    const bool vertices = el::vertex_program_enabled::ref(state) != 0,
               fragments = el::fragment_program_enabled::ref(state) != 0;
    use_assembly(node, session, glapi::AssemblyStage::fragment,
                 ClientName(fragments ? el::fragment_program::ref(state) : 0), layer);
    const AssemblyProgram* program = use_assembly(node, session, glapi::AssemblyStage::vertex,
                                                  ClientName(vertices ? el::vertex_program::ref(state) : 0), layer);
    return program != nullptr ? program->attributes() : 0;
}

/// None, and what is neither a program nor several: assembly programs, or fixed function.
void use_program(RenderNode& node, SessionReplica& session, const glstate::State& state, const LayerGeometry& layer) {
    const ClientName name(glstate::el::current_program::ref(state));
    const std::uint32_t attributes = use_assembly(node, session, state, layer);
    const auto bind_blocks = [&](const Program& program) {
        for (const std::uint32_t place : program.block_bindings())
            node.driver.bind_uniform_buffer(place,
                                            found_range(node, session, glstate::el::uniform_buffer::ref(state, place)));
        bind_memory(node, session, state, program);
    };
    if (Program* program = name ? session.objects.find<Program>(name) : nullptr) {
        program->use(layer);
        bind_blocks(*program);
    } else if (Pipeline* pipeline = name ? session.objects.find<Pipeline>(name) : nullptr) {
        pipeline->use(session.objects, layer, bind_blocks);
    } else {
        node.driver.use_program(0, attributes);
    }
}

/// What a context counts and captures while it draws to a target.
class Counting {
public:
    Counting(RenderNode& node, SessionReplica& session, Capture* capture)
        : node_(node), session_(session), capture_(capture) {}

    /// `scale`: as of Query::begin(). False: there is no such query, or the session may have no more.
    template <class E>
    bool count(E, const glstate::State& state, QueryTarget target, double scale) {
        for (unsigned stream = 0; stream < E::count; ++stream)
            if (!count(ClientName(E::ref(state, stream)), target, stream, scale)) return false;
        return true;
    }

private:
    bool count(ClientName name, QueryTarget target, unsigned stream, double scale) {
        if (!name) return true;
        const auto query = session_.objects.make<Query>(name, node_.driver, target, stream);
        if (!query || (*query)->target() != target || (*query)->stream() != stream) return false;
        // The driver counts for one at a time.
        if (target == QueryTarget::captured && capture_ != nullptr && capture_->counting(stream))
            return (*query)->begin(capture_->counting(stream), scale);
        return (*query)->begin(scale);
    }

    RenderNode& node_;
    SessionReplica& session_;
    Capture* const capture_;
};

/// Last, since it takes part in no other state.
bool count_and_capture(RenderNode& node, SessionReplica& session, const glstate::State& state,
                       const LayerGeometry& layer, Counted counted) {
    namespace el = glstate::el;
    if (!counts_or_captures(state)) return true;
    const ClientName name(el::capture::ref(state));
    Capture* capture = name ? session.objects.find<Capture>(name) : nullptr;
    if (capture != nullptr && !capture->go_on(session.objects)) return false;
    Counting counting(node, session, capture);
    if (counted.samples &&
        !counting.count(el::occlusion_query{}, state, QueryTarget::samples, layer.scale_x() * layer.scale_y()))
        return false;
    return !counted.primitives || (counting.count(el::primitives_query{}, state, QueryTarget::primitives, 1) &&
                                   counting.count(el::captured_query{}, state, QueryTarget::captured, 1));
}

}  // namespace

bool bring_driver_to(RenderNode& node, SessionReplica& session, SoftContext& context, RenderTarget& target,
                     Counted counted) {
    if (!own_written_textures(node, session, context.state)) return false;
    const bool held = node.driver.holds(context.state);
    if (!held) node.driver.sync(context.state);
    if (!textures_are_known(session, context)) look_up_textures(session, context);
    node.driver.bind_textures(context.textures.bindings);
    if (!samplers_are_known(session, context)) look_up_samplers(session, context);
    node.driver.bind_samplers(context.samplers.bindings);
    node.maps.sync_evaluators(node.driver, context.maps);
    node.driver.bind_target(target, context.state);
    use_program(node, session, context.state, target.geometry());
    if (!held || !node.driver.holds(context.state)) {  // a pipeline's programs may read others than before
        node.driver.sync_current(context.state);
        node.driver.follow(context.state);
    }
    return count_and_capture(node, session, context.state, target.geometry(), counted);
}

}  // namespace wall::tileserver
