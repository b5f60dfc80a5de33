// SPDX-License-Identifier: MIT
// Storage that several textures are parts of (TextureCommands, group [texture_view]).
#include <algorithm>
#include <array>
#include <cstdint>

#include "common/glapi/texture_target.h"
#include "tileserver/execute/texture_commands.h"

namespace wall::tileserver {
namespace {

constexpr std::uint32_t kMaxLevels = 15, kMaxSamples = 64;

/// Nothing: not the word of a target that has images.
std::optional<TextureTarget> stored_target(GLenum word) {
    const auto found = glapi::find_target_word(word);
    if (!found || !found->is_object() || glapi::dimensions_of(*found->info) == 0) return std::nullopt;
    return found->info->id;
}

bool sane_extent(const ImageExtent& extent) {
    return std::ranges::all_of(std::array{extent.width, extent.height, extent.depth},
                               [](std::int32_t side) { return side >= 1 && side <= kMaxImageSide; });
}

}  // namespace

void TextureCommands::TexStorage(ClientName name, GLenum target, std::uint32_t levels, GLenum internal_format,
                                 std::int32_t width, std::int32_t height, std::int32_t depth, std::uint32_t samples,
                                 std::uint32_t fixed_places) {
    const auto kind = stored_target(target);
    if (!kind || glapi::info_of(*kind).samples != (samples != 0)) return execution_.refuse("no such target");
    if (!sane_extent({width, height, depth}) || levels < 1 || levels > kMaxLevels || samples > kMaxSamples)
        return execution_.refuse("absurd size");
    Texture* texture = bind_to_edit(name, target);
    if (texture == nullptr || texture->content().storage()) return;
    if (texture->promise) return execution_.refuse("content under a name has no storage");
    const auto estimate = std::uint64_t{8} * std::max(samples, 1u) * glapi::face_count(glapi::info_of(*kind)) *
                          static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
                          static_cast<std::uint64_t>(depth);
    const bool afforded = execution_.session.objects.affords(estimate);
    if (!afforded || !texture->store({internal_format,
                                      static_cast<GLsizei>(levels),
                                      static_cast<GLsizei>(samples),
                                      {width, height, depth},
                                      fixed_places != 0}))
        execution_.refuse(too_much("texture memory"));
    execution_.session.work.gl_errors += execution_.node.driver.drain_errors();
}

// Where the driver has refused the storage there is nothing to show a part of.
void TextureCommands::TexView(ClientName name, ClientName origin_name, GLenum target, GLenum internal_format,
                              std::uint32_t first_level, std::uint32_t levels, std::uint32_t first_layer,
                              std::uint32_t layers) {
    const auto kind = stored_target(target);
    if (!kind || !name || !origin_name) return execution_.refuse("no such target or name");
    const Texture* origin = execution_.session.objects.find<Texture>(ObjectKey(origin_name));
    if (origin == nullptr || name == origin_name) return execution_.refuse("no such texture to show a part of");
    Texture* texture = bind_to_edit(name, target);
    if (texture == nullptr) return;
    if (texture->promise) return execution_.refuse("content under a name is no part of other content");
    const auto& storage = origin->content().storage();
    if (!storage) return;
    const auto within = [](std::uint32_t first, std::uint32_t count, std::uint32_t all) {
        return count >= 1 && first < all && count <= all - first;
    };
    if (!within(first_level, levels, static_cast<std::uint32_t>(storage->levels)) ||
        !within(first_layer, layers, storage->layers(origin->target())))
        return execution_.refuse("no such part of a texture");
    execution_.session.work.gl_errors += execution_.node.driver.drain_errors();
    if (!texture->show(execution_.node.driver, *origin, {internal_format, first_level, levels, first_layer, layers}))
        execution_.refuse(too_much("texture memory"));
    execution_.session.work.gl_errors += execution_.node.driver.drain_errors();
}

}  // namespace wall::tileserver
