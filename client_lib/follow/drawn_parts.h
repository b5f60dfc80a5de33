// SPDX-License-Identifier: MIT
// Drawn content, second step (DESIGN, section 4): framebuffer objects that a program only copies to its window as they
// are are drawn in parts. Each node draws the part that its tiles show, so that geometry is sorted for them as for the
// window itself (W3.2), and holds the rest of the images as it was before. When anybody needs more than that, all nodes
// get all of them again, put together of what each has. The session's mutex is held.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/nodes.h"
#include "client_lib/follow/surface.h"

namespace wall::client {

class DrawnParts {
public:
    /// Both outlive it.
    DrawnParts(Nodes& nodes, const OpenSurfaces& surfaces) : nodes_(nodes), surfaces_(surfaces) {}

    /// All of a target's images was copied as it is, its first pixel to (x, y), to a window or to another target that
    /// is drawn in parts, and will be again: it is drawn in parts from now on, if nodes show different ones. By the
    /// thread that draws to it; `source`: of the copy, which reads it.
    void begin(const std::shared_ptr<DrawnTarget>& target, const DrawSource& source, std::int32_t x, std::int32_t y);
    /// A target that was copied to, as in begin(), from one that is drawn in parts, which the source reads: it has of
    /// it what that has. Until end(), which is to follow.
    void inherit(const std::shared_ptr<DrawnTarget>& target, const DrawSource& source, std::int32_t x, std::int32_t y);
    /// Whether a copy of a target that is drawn in parts takes no more than each node has.
    bool suffice(DrawnTarget& target, const DrawTarget& copied_to, std::int32_t x, std::int32_t y);

    /// What a context draws from now on looks these images up, each as often as it is named, and takes no more of them
    /// than each node has; none: that is over.
    void allow(ContextId context, std::vector<ClientName> images);

    /// Before a command is packed for any node that draws to or with what the source names.
    void before_drawing(const DrawSource& source) {
        if (!drawn_.empty()) end_if_needed(source);
    }
    /// Before content of the object changes.
    void before_object_changes(ClientName object);
    /// Before the nodes are told that it is gone.
    void forget(ClientName object);
    /// Before anything else that may read images of the group.
    void end(const ShareGroup& share);
    void end_all();

private:
    /// A target that is drawn in parts.
    struct Drawn {
        std::weak_ptr<ShareGroup> share;
        std::weak_ptr<DrawnTarget> target;
        ClientName target_id;
        std::vector<ClientName> images;
        std::shared_ptr<const ImageParts> parts;
    };

    std::shared_ptr<ImageParts> parts_in(const ClientSurface& window, std::int32_t x, std::int32_t y) const;
    std::shared_ptr<ImageParts> parts_in(const ImageParts& between, std::int32_t x, std::int32_t y) const;
    bool hold_all(const Drawn& drawn) const;
    void add(const std::shared_ptr<DrawnTarget>& target, const DrawSource& source, std::shared_ptr<ImageParts> parts);
    bool still_good(const DrawnTarget& target) const;
    void end_if_needed(const DrawSource& source);
    bool sees_images(const DrawSource& source);
    Drawn* find(ClientName image);
    void end(const Drawn& one);
    void tell(const Drawn& drawn, const DrawnTarget* target);
    void gather(const Drawn& drawn);
    void gather(const ImageParts& parts, const Object& image);
    void give(Node& node, const KeptContent& content);

    Nodes& nodes_;
    const OpenSurfaces& surfaces_;
    std::vector<Drawn> drawn_;
    std::unordered_map<ContextId, UseStamp> seen_;  ///< what they drew with when it was looked at last
    std::unordered_map<ContextId, std::vector<ClientName>> allowed_;
};

}  // namespace wall::client
