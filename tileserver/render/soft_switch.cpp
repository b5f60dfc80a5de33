// SPDX-License-Identifier: MIT
#include "tileserver/render/soft_switch.h"

#include "gen/glstate/texture_elements.gen.h"

namespace wall::tileserver {
namespace {

std::uint64_t textures_id(const SoftContext& context) {
    return context.state.ids[static_cast<std::size_t>(glstate::Category::textures)];
}

void look_up_textures(SessionReplica& session, SoftContext& context) {
    BoundTextures& bound = context.textures;
    TextureNames found{};
    for (unsigned unit = 0; unit < kTextureUnits; ++unit) {
        for (std::size_t target = 0; target < kTextureTargets; ++target) {
            const std::uint32_t name = (context.state.textures.*glstate::kTextureBindings[target])[unit];
            const Texture* texture = session.texture(ClientName(name), static_cast<TextureTarget>(target));
            if (texture != nullptr && texture->content->target() == static_cast<TextureTarget>(target))
                found[unit][target] = texture->content->name();
        }
    }
    if (found != bound.bindings.names) bound.bindings = {found == TextureNames{} ? 0 : glstate::next_value_id(), found};
    bound.state_id = textures_id(context);
    bound.version = session.texture_version();
}

}  // namespace

bool switch_to(RenderNode& node, SessionReplica& session, SoftContext& context, Layer& layer, bool counts) {
    node.driver.sync(context.state);
    if (context.textures.state_id != textures_id(context) || context.textures.version != session.texture_version())
        look_up_textures(session, context);
    node.driver.bind_textures(context.textures.bindings);
    node.maps.sync_evaluators(node.driver, context.maps);
    node.driver.bind_layer(layer, context.state);
    session.programs.use(ClientName(glstate::el::current_program::ref(context.state)), layer.geometry());
    node.driver.sync_current(context.state);
    const ClientName query(glstate::el::occlusion_query::ref(context.state));
    return !query || !counts || session.queries.begin(query, layer.geometry().scale_x() * layer.geometry().scale_y());
}

}  // namespace wall::tileserver
