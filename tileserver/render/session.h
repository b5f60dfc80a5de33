// SPDX-License-Identifier: MIT
// What this node holds of one application: soft contexts, surfaces, textures, runs. It lives as long as the
// application's stream; all of it can be sent again. Render thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "common/base/ids.h"
#include "common/glstate/value_history.h"
#include "gen/glstate/state.gen.h"
#include "tileserver/render/attribute_trail.h"
#include "tileserver/render/content_store.h"
#include "tileserver/render/driver.h"
#include "tileserver/render/limits.h"
#include "tileserver/render/parallel_group.h"
#include "tileserver/render/programs.h"
#include "tileserver/render/queries.h"
#include "tileserver/render/soft_maps.h"
#include "tileserver/render/surface.h"
#include "tileserver/render/texture_content.h"
#include "tileserver/render/work.h"

namespace wall::tileserver {

/// A soft context's texture bindings in the driver's names, and what they were looked up from.
struct BoundTextures {
    std::uint64_t state_id = 0,
                  version = 0;  ///< value id of the category `textures`, SessionReplica::texture_version()
    TextureBindings bindings;
};

struct SoftContext {
    glstate::State state;
    glstate::ValueHistory history;
    SurfaceId draw, read;
    SoftMaps maps;
    BoundTextures textures;
};

struct Texture {
    std::shared_ptr<TextureContent> content;  ///< never null; other sessions may hold it, too
    /// While its definition comes that was promised under a name: what has come.
    struct Promise {
        glapi::ContentKey key;
        std::optional<glapi::ContentHash> hash;  ///< of a name that says what the content is
    };
    std::optional<Promise> promise;
    /// Null: nothing is checked.
    glapi::ContentHash* hash() { return promise && promise->hash ? &*promise->hash : nullptr; }
};

/// Geometry that is called by name: display lists of the driver. Mesa cuts quads and strips in a list into other
/// triangles than outside, so only its own lists give the pixels that the application's list would give. A large run is
/// several lists, called one after the other.
struct Run {
    struct Part {
        GLuint list = 0;
        AttributeTrail trail;  ///< what it leaves behind
    };
    explicit Run(const Gl& gl) : gl_(gl) {}
    ~Run() {
        for (const Part& part : parts) gl_.DeleteLists(part.list, 1);
    }
    Run(const Run&) = delete;
    /// Of a new, last part.
    GLuint add_list() { return parts.emplace_back(Part{gl_.GenLists(1), {}}).list; }

    std::vector<Part> parts;
    std::size_t bytes = 0;

private:
    const Gl& gl_;
};

class SessionReplica {
public:
    /// `group`: of a parallel program, of which this is the member `rank`; outlives the session.
    SessionReplica(Driver& driver, SessionId id, ParallelGroup* group = nullptr, Rank rank = 0)
        : programs(driver), queries(driver.gl()), driver_(driver), id_(id), group_(group), rank_(rank) {}
    ~SessionReplica() { driver_.forget_layer(); }
    SessionReplica(const SessionReplica&) = delete;

    SessionId id() const { return id_; }
    ContentAsker asker() const { return ContentAsker(std::uint64_t{id_.value} << 32 | rank_); }
    ParallelGroup* group() const { return group_; }
    Rank rank() const { return rank_; }
    SoftContext& context(ContextId id) { return contexts_[id]; }
    void destroy_context(ContextId id) { contexts_.erase(id); }
    std::size_t context_count() const { return contexts_.size(); }

    /// Of its own or, in a parallel program, of all members.
    SurfaceReplica* surface(SurfaceId id);
    bool shares(SurfaceId id) const { return group_ != nullptr && ParallelGroup::shares(id); }
    template <class Visit>
    void for_each_surface(Visit&& visit) const {
        for (const auto& [id, surface] : surfaces_) visit(id, *surface);
        if (group_ == nullptr) return;
        for (const auto& [id, surface] : group_->surfaces()) visit(id, *surface);
    }
    /// Null if the session has too many, or if the other members have made it in another format.
    SurfaceReplica* create_surface(SurfaceId id, const SurfaceFormat& format);
    void destroy_surface(SurfaceId id);

    /// The texture of a name; name 0 is the default texture of its target. Null if there is none.
    Texture* texture(ClientName name, TextureTarget target);
    /// Makes it if there is none. Null: the name has another target, or there are too many.
    Texture* make_texture(ClientName name, TextureTarget target);
    void delete_texture(ClientName name);
    /// Grows with every texture made or deleted: bindings by name must be looked up again.
    std::uint64_t texture_version() const { return texture_version_; }
    /// The texture is that content from now on, which other sessions may hold, too. False: more memory than a session
    /// may have.
    bool adopt(Texture& texture, std::shared_ptr<TextureContent> content);
    /// Whether the session may have `bytes` for that image, instead of what it has for it now.
    bool affords(const Texture& texture, GLenum image_target, std::int32_t level, std::uint64_t bytes) const;
    /// Notes what the driver has of one image after a definition (TextureContent::note_image).
    void account(Texture& texture, GLenum image_target, std::int32_t level, const TextureContent::ImageFormat* format);
    std::uint64_t texture_bytes() const { return texture_bytes_; }

    Programs programs;
    Queries queries;
    std::unordered_map<ClientName, std::shared_ptr<const Run>> runs;
    std::uint64_t run_bytes = 0;
    Work work;

private:
    static std::uint64_t key(ClientName name, TextureTarget target);
    Driver& driver_;
    SessionId id_;
    ParallelGroup* group_;
    Rank rank_;
    std::unordered_map<ContextId, SoftContext> contexts_;
    PixelBudget pixels_{kMaxLayerPixels};  // before the surfaces, which use it to the end
    std::unordered_map<SurfaceId, std::unique_ptr<SurfaceReplica>> surfaces_;
    std::unordered_map<std::uint64_t, Texture> textures_;
    std::uint64_t texture_version_ = 1, texture_bytes_ = 0;
};

}  // namespace wall::tileserver
