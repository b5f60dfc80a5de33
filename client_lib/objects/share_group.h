// SPDX-License-Identifier: MIT
// The objects that contexts share: textures, display lists, buffers, programs. An object has the application's name
// (glGenTextures), and an id that is unique in the process and stands for it in state elements and on the wire; a
// deleted and generated name is another object. The mutex guards the tables and the objects in them; it is taken after
// a session's, never before.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

#include "client_lib/objects/assembly_program.h"
#include "client_lib/objects/buffer.h"
#include "client_lib/objects/program.h"
#include "client_lib/objects/renderbuffer.h"
#include "client_lib/objects/sampler.h"
#include "client_lib/objects/texture.h"
#include "common/glapi/gl_types.h"

namespace wall::client {

struct DisplayList;  // context/lists.h
struct FenceObject;  // context/fence_object.h
class ObjectLabels;  // context/object_labels.h

/// The application's names of one kind. A name is free, reserved (null), or an object's. New names are given above all
/// that were ever used, as Mesa does, so that a program sees the same numbers.
template <class T>
class NameTable {
public:
    /// Reserves `count` names in a row; the first, or 0 when they run out.
    GLuint reserve(GLuint count) {
        if (count == 0 || last_ > ~GLuint{0} - 1 - count) return 0;
        const GLuint first = last_ + 1;
        for (GLuint i = 0; i < count; ++i) names_.emplace(first + i, nullptr);
        last_ += count;
        return first;
    }
    bool known(GLuint name) const { return names_.contains(name); }
    GLuint last() const { return last_; }  ///< no name above it is known
    std::shared_ptr<T> find(GLuint name) const {
        const auto at = names_.find(name);
        return at == names_.end() ? nullptr : at->second;
    }
    void put(GLuint name, std::shared_ptr<T> object) {
        names_[name] = std::move(object);
        last_ = std::max(last_, name);
    }
    /// Calls look(object) with each object, in no order.
    template <class Look>
    void for_each(Look&& look) const {
        for (const auto& [name, object] : names_)
            if (object) look(*object);
    }
    /// What the name stood for.
    std::shared_ptr<T> erase(GLuint name) {
        const auto at = names_.find(name);
        if (at == names_.end()) return nullptr;
        auto object = std::move(at->second);
        names_.erase(at);
        return object;
    }

private:
    std::unordered_map<GLuint, std::shared_ptr<T>> names_;
    GLuint last_ = 0;
};

struct ShareGroup {
    ShareGroup();
    ~ShareGroup();
    ShareGroup(const ShareGroup&) = delete;

    std::mutex mutex;
    NameTable<Texture> textures;
    NameTable<DisplayList> lists;
    NameTable<Buffer> buffers;
    NameTable<GlslObject> glsl_objects;  ///< shaders and programs
    NameTable<Renderbuffer> renderbuffers;
    NameTable<Sampler> samplers;
    NameTable<AssemblyProgram> assembly_programs;
    /// Name 0 of each target, made when it is first needed; until then the state names it by id 0.
    std::array<std::shared_ptr<AssemblyProgram>, glapi::kAssemblyStages> default_assembly_programs;
    std::unordered_map<GLsync, std::shared_ptr<FenceObject>> fences;
    std::shared_ptr<ObjectLabels> labels;  ///< of what is shared; set by the first context of the group

    /// By id: textures and programs, as state elements name them. They are kept as long as their name or any binding
    /// lives. (Buffers are kept by the contexts that name them: context/buffer_binding.h.)
    std::unordered_map<ClientName, std::shared_ptr<Object>> by_id;
    /// That a binding names; null: it is gone.
    std::shared_ptr<Texture> texture_of(ClientName id) const {
        const auto found = by_id.find(id);
        return found == by_id.end() ? nullptr : std::static_pointer_cast<Texture>(found->second);
    }
    /// Name 0 of each target, made when it first gets content; until then a binding of it is id 0.
    std::map<glapi::TextureTarget, std::shared_ptr<Texture>> default_textures;
    /// By target and internal format: what a node's driver said for each of glapi::kFormatWords.
    std::map<std::pair<GLenum, GLenum>, std::vector<GLint64>> format_answers;

    std::atomic<std::uint64_t> buffer_deletions{0};  ///< so far

    /// Something was drawn to: from then on nodes may lack what only others have.
    std::atomic<bool> has_drawn{false};

    /// Stamp of the latest change of any object, so that a look at one number tells that there is nothing to send.
    std::atomic<std::uint64_t> last_change{0};
};

/// Calls `use` with every group of the process. None of their mutexes is held.
void for_each_share_group(const std::function<void(ShareGroup&)>& use);

}  // namespace wall::client
