// SPDX-License-Identifier: MIT
// What objects of several sessions may hold together (A6: global share). A node has one store of it, by the content's
// name; what is special about a kind's content is in that kind's file. Render thread.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "tileserver/objects/content_store.h"
#include "tileserver/objects/object.h"

namespace wall::tileserver {

class SharedContent {
public:
    explicit SharedContent(ObjectKind kind) : kind_(kind) {}
    virtual ~SharedContent() = default;
    SharedContent(const SharedContent&) = delete;

    ObjectKind kind() const { return kind_; }

private:
    const ObjectKind kind_;
};

using SharedContents = ContentStore<SharedContent>;

/// Null: it is the content of another kind of object. `T::kKind`: of the object that may hold it.
template <class T>
std::shared_ptr<T> content_as(std::shared_ptr<SharedContent> content) {
    if (!content || content->kind() != T::kKind) return nullptr;
    return std::static_pointer_cast<T>(std::move(content));
}

}  // namespace wall::tileserver
