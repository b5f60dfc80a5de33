// SPDX-License-Identifier: MIT
#include "client_lib/context/image_work.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>

#include "client_lib/context/memory_use.h"
#include "client_lib/context/texture_image.h"
#include "client_lib/objects/share_group.h"
#include "client_lib/objects/texture_view.h"

namespace wall::client {
namespace {

/// What is sent is for the target that nobody sees while it lives, and is that work.
class WorkPass {
public:
    WorkPass(MemoryUse& use, const ImageWork& work) : use_(use) {
        if (!use_.target) use_.target = std::make_unique<DispatchTarget>();
        use_.now = use_.target.get();
        use_.work = &work;
    }
    ~WorkPass() {
        use_.now = nullptr;
        use_.work = nullptr;
    }
    WorkPass(const WorkPass&) = delete;

private:
    MemoryUse& use_;
};

/// A context that is not attached has no nodes.
template <class Pack>
void run_on_nodes(Context& c, const ImageWork& work, Pack&& pack) {
    c.flush_block();
    if (!c.attached()) {
        std::lock_guard lock(c.share().mutex);
        return work.note_drawn();
    }
    const WorkPass pass(*c.memory, work);
    c.session().draw(c.draw_source(), std::nullopt, Needs{}, pack);
}

const Object& keeper(const WorkedImage& image) {
    if (image.renderbuffer) return *image.renderbuffer;
    return keeper_of(*image.texture);
}

/// The layers of a texture's image from `z` on, or the renderbuffer.
void note_drawn(const WorkedImage& image, GLsizei depth) {
    if (image.renderbuffer) return image.renderbuffer->note_drawn();
    const bool faces = image.texture->info.first_face != 0;
    for (GLint face = faces ? image.z : 0; face < (faces ? image.z + depth : 1); ++face)
        image.texture->note_drawn(static_cast<unsigned>(face), image.level);
}

}  // namespace

std::shared_ptr<const Object> WorkedImage::object() const {
    if (texture) return texture;
    return renderbuffer;
}

void copy_images_on_nodes(Context& c, const WorkedImage& from, const WorkedImage& to, const WorkedSize& size) {
    if (to.texture) before_texels_change(c, *to.texture);
    const auto source = from.object(), target = to.object();
    const ImageWork work{{source, target}, &keeper(to), [&] { note_drawn(to, size.depth); }};
    run_on_nodes(c, work, [&](wire::PackBuffer& buffer) {
        glapi::pack::CopyImage(buffer, source->id, from.target(), from.level, from.x, from.y, from.z, target->id,
                               to.target(), to.level, to.x, to.y, to.z, size.width, size.height, size.depth);
    });
}

void make_view_mipmaps(Context& c, const std::shared_ptr<Texture>& view) {
    const auto levels = static_cast<GLint>(view->view.levels);
    const GLint base = view->parameters.base_level, last = std::min(view->parameters.max_level, levels - 1);
    if (base >= last) return;
    before_texels_change(c, *view);
    const ImageWork work{{view}, &keeper_of(*view), [&] {
                             for (unsigned face = 0; face < glapi::face_count(view->info); ++face)
                                 for (GLint level = base + 1; level <= last; ++level) view->note_drawn(face, level);
                         }};
    run_on_nodes(c, work, [&](wire::PackBuffer& buffer) {
        glapi::pack::ViewMipmaps(buffer, view->id, view->info.target, base, last);
    });
}

}  // namespace wall::client
