// SPDX-License-Identifier: MIT
#include "client_lib/context/share_group.h"

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/context.h"
#include "client_lib/context/maps.h"
#include "client_lib/follow/session.h"
#include "client_lib/follow/sharing.h"

namespace wall::client {
namespace {

constexpr std::size_t kObjectBatchBytes = std::size_t{4} << 20;  // a batch of objects is sent when it reaches this

/// Ids of the textures that a unit draws with. Targets that are not enabled cannot matter.
template <class Use>
void for_each_used(const glstate::State& state, Use&& use) {
    const auto& enabled = state.texture_units;
    const auto& bound = state.textures;
    for (unsigned unit = 0; unit < kTextureUnits; ++unit) {
        if (enabled.texture_1d_enabled[unit]) use(ClientName(bound.texture_binding_1d[unit]));
        if (enabled.texture_2d_enabled[unit]) use(ClientName(bound.texture_binding_2d[unit]));
        if (enabled.texture_3d_enabled[unit]) use(ClientName(bound.texture_binding_3d[unit]));
        if (enabled.texture_cube_map_enabled[unit]) use(ClientName(bound.texture_binding_cube_map[unit]));
        if (enabled.texture_rectangle_enabled[unit]) use(ClientName(bound.texture_binding_rectangle[unit]));
    }
}

/// The same for the samplers of the program that the context draws with.
template <class Use>
void for_each_sampled(const Context& context, Use&& use) {
    const auto& bound = context.state.textures;
    context.program->executable->for_each_sampler([&](std::uint32_t unit, GLenum target) {
        if (unit >= kTextureUnits) return;
        switch (target) {
            case GL_TEXTURE_1D: return use(ClientName(bound.texture_binding_1d[unit]));
            case GL_TEXTURE_2D: return use(ClientName(bound.texture_binding_2d[unit]));
            case GL_TEXTURE_3D: return use(ClientName(bound.texture_binding_3d[unit]));
            case GL_TEXTURE_CUBE_MAP: return use(ClientName(bound.texture_binding_cube_map[unit]));
            default: return use(ClientName(bound.texture_binding_rectangle[unit]));
        }
    });
}

void bring_program_up_to_date(const Program& program, Node& node, wire::PackBuffer& buffer) {
    auto& known = node.object_stamps[program.id];
    if (known == program.executable->last_change) return;
    pack_program(program, known, buffer);
    known = program.executable->last_change;
}

template <class E>
void adopt_default(glstate::State& state, ClientName id) {
    for (unsigned unit = 0; unit < E::count; ++unit)
        if (E::ref(state, unit) == 0) glstate::assign<E>(state, unit, id.value);
}

/// Name 0 of a target stands for the default texture that has got content since it was bound: through another context
/// of the group, or before glPopAttrib.
void adopt_default(glstate::State& state, const Texture& texture) {
    namespace el = glstate::el;
    switch (texture.target) {
        case GL_TEXTURE_1D: return adopt_default<el::texture_binding_1d>(state, texture.id);
        case GL_TEXTURE_2D: return adopt_default<el::texture_binding_2d>(state, texture.id);
        case GL_TEXTURE_3D: return adopt_default<el::texture_binding_3d>(state, texture.id);
        case GL_TEXTURE_CUBE_MAP: return adopt_default<el::texture_binding_cube_map>(state, texture.id);
        default: return adopt_default<el::texture_binding_rectangle>(state, texture.id);
    }
}

/// Equal ones: nothing that drawing with the context needs has changed.
std::array<std::uint64_t, 5> object_stamps_of(const Context& context, std::uint64_t last_change) {
    using glstate::Category;
    const auto& ids = context.state.ids;
    return {ids[static_cast<std::size_t>(Category::texture_units)], ids[static_cast<std::size_t>(Category::textures)],
            last_change, context.maps->stamp, ids[static_cast<std::size_t>(Category::objects)]};
}

/// Packs textures for a node that lacks them. `sent` counts what is no longer in the buffer, `start` is where the rest
/// begins.
struct ObjectSender {
    ClientSession& session;
    Node& node;
    wire::PackBuffer& buffer;
    std::size_t& start;
    std::size_t& sent;

    void send(const Texture& texture) {
        auto& known = node.object_stamps[texture.id];
        if (known == texture.stamp) return;
        const std::uint64_t before = std::exchange(known, texture.stamp);
        const std::function<void()> limit = [this] {  // a node at time zero may need more than a frame holds
            if (buffer.bytes() >= kObjectBatchBytes) send_off();
        };
        const bool worth_asking = before == 0 && (texture.global || content_bytes(texture) >= kLeastShared);
        if (!worth_asking || !may_be_asked(node)) return pack_texture(texture, before, buffer, limit);
        const bool held = node_holds(session, node, [&](wire::PackBuffer& batch, RequestId request) {
            glapi::pack::ShareTexture(batch, request, texture.id, texture.target, texture.global ? 1 : 0,
                                      content_key(texture));
            sent += batch.bytes() - start;
            start = 0;  // it goes out
        });
        if (held) return;
        pack_texture(texture, 0, buffer, limit);
        glapi::pack::TexShared(buffer, texture.id);
        send_off();  // others may be waiting for it
    }

private:
    void send_off() {
        sent += buffer.bytes() - start;
        session.send(node);
        start = buffer.bytes();
    }
};

}  // namespace

ShareGroup::ShareGroup() = default;
ShareGroup::~ShareGroup() = default;

std::size_t ShareGroup::bring_up_to_date(Node& node, Context& context, wire::PackBuffer& buffer) {
    const auto now = object_stamps_of(context, last_change.load(std::memory_order_acquire));
    Mirror& mirror = node.mirrors[context.id];
    if (mirror.objects == now) return 0;
    std::size_t start = buffer.bytes(), sent = 0;
    context.maps->bring_up_to_date(node, buffer);
    std::lock_guard lock(mutex);
    for (const auto& [target, texture] : default_textures) adopt_default(context.state, *texture);
    ObjectSender sender{context.session(), node, buffer, start, sent};
    const auto bring_texture = [&](ClientName id) {
        if (const auto found = textures_by_id.find(id); found != textures_by_id.end()) sender.send(*found->second);
    };
    for_each_used(context.state, bring_texture);
    if (context.program) {
        bring_program_up_to_date(*context.program, node, buffer);
        for_each_sampled(context, bring_texture);
    }
    mirror.objects = now;
    return sent + buffer.bytes() - start;
}

void ShareGroup::note_used(Node& follower, Mirror& mirror, Context& context, wire::PackBuffer& buffer) {
    const auto now = object_stamps_of(context, last_change.load(std::memory_order_acquire));
    if (mirror.objects == now) return;
    std::lock_guard lock(mutex);
    for (const auto& [target, texture] : default_textures) adopt_default(context.state, *texture);
    const auto note = [&](ClientName id) {
        if (const auto found = textures_by_id.find(id); found != textures_by_id.end())
            follower.object_stamps[id] = found->second->stamp;
    };
    for_each_used(context.state, note);
    if (context.program) {
        const Program& program = *context.program;
        auto& known = follower.object_stamps[program.id];
        if (known == 0) pack_all_uniforms(program, buffer);
        else pack_program(program, known, buffer);
        known = program.executable->last_change;
        for_each_sampled(context, note);
    }
    mirror.objects = now;
}

void ShareGroup::bring(ClientSession& session, Node& node, const std::unordered_map<ClientName, std::uint64_t>& used,
                       wire::PackBuffer& buffer) {
    std::lock_guard lock(mutex);
    std::size_t start = buffer.bytes(), sent = 0;
    ObjectSender sender{session, node, buffer, start, sent};
    for (const auto& [id, stamp] : used) {
        if (const auto texture = textures_by_id.find(id); texture != textures_by_id.end()) {
            sender.send(*texture->second);
        } else if (const auto name = program_names.find(id); name != program_names.end()) {
            const auto& program = static_cast<const Program&>(*glsl_objects.find(name->second));
            bring_program_up_to_date(program, node, buffer);
            node.object_stamps[id] = program.executable->stamp;  // other values of uniforms follow
        }
    }
    session.count_objects(node, sent + buffer.bytes() - start);
}

GLuint object_name(Context& c, glstate::ValueKind kind, ClientName id) {
    ShareGroup& share = c.share();
    std::lock_guard lock(share.mutex);
    const auto name_in = [id](const auto& objects) {
        const auto found = objects.find(id);
        return found == objects.end() ? GLuint{0} : found->second->name;
    };
    switch (kind) {
        case glstate::ValueKind::name_texture: return name_in(share.textures_by_id);
        case glstate::ValueKind::name_buffer: return name_in(c.buffers->by_id);
        case glstate::ValueKind::name_program: {
            const auto found = share.program_names.find(id);
            return found == share.program_names.end() ? 0 : found->second;
        }
        default: return 0;  // nothing of this kind can be bound yet
    }
}

}  // namespace wall::client
