// SPDX-License-Identifier: MIT
// Geometry that is called by name: display lists of the driver. Mesa cuts quads and strips in a list into other
// triangles than outside, so only its own lists give the pixels that the application's list would give. A large run is
// several lists, called one after the other, so that a call of it can be left between two of them. Render thread.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "tileserver/driver/attribute_trail.h"
#include "tileserver/gpu/gl.h"
#include "tileserver/objects/object.h"
#include "tileserver/objects/shared_content.h"

namespace wall::tileserver {

/// What a run draws. Nothing of it changes once it is complete, so sessions can hold it together.
class RunContent final : public SharedContent {
public:
    static constexpr ObjectKind kKind = ObjectKind::run;

    struct Part {
        GLuint list = 0;
        AttributeTrail trail;  ///< what it leaves behind
    };
    /// `bytes`: of the commands that define it.
    RunContent(const Gl& gl, std::uint64_t bytes) : SharedContent(kKind), gl_(gl), bytes_(bytes) {}
    ~RunContent() override {
        for (const Part& part : parts) gl_.DeleteLists(part.list, 1);
    }
    /// Of a new, last part.
    GLuint add_list() { return parts.emplace_back(Part{gl_.GenLists(1), {}}).list; }
    std::uint64_t bytes() const { return bytes_; }

    std::vector<Part> parts;

private:
    const Gl& gl_;
    const std::uint64_t bytes_;
};

class Run final : public ObjectOf<ObjectKind::run> {
public:
    explicit Run(ObjectAccount& account) : ObjectOf(account) {}

    /// Null until it is defined.
    const std::shared_ptr<const RunContent>& content() const { return content_; }
    /// It is that from now on, which other sessions may hold, too. False: more memory than a session may have.
    [[nodiscard]] bool adopt(std::shared_ptr<const RunContent> content) {
        content_ = std::move(content);
        return has_content(content_->bytes());
    }

private:
    std::shared_ptr<const RunContent> content_;
};

}  // namespace wall::tileserver
