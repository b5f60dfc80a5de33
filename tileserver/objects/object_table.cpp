// SPDX-License-Identifier: MIT
#include "tileserver/objects/object_table.h"

namespace wall::tileserver {
namespace {

std::string name_of(ObjectKind kind) { return kObjectKindNames[static_cast<std::size_t>(kind)]; }
std::string id_of(ObjectKey key) { return std::to_string(static_cast<std::uint32_t>(key.value())); }

}  // namespace

Result<void> ObjectTable::has_room_for(ObjectKey key) const {
    if (!key) return fail("object 0 is none");
    if (objects_.size() >= most_objects_ || !account_.affords(kLeastObjectBytes)) return fail(too_much("objects"));
    return {};
}

tl::unexpected<Error> ObjectTable::another_kind(ObjectKey key, ObjectKind wanted) const {
    return fail("object " + id_of(key) + " is a " + name_of(objects_.at(key)->kind()) + ", not a " + name_of(wanted));
}

tl::unexpected<Error> ObjectTable::none(ObjectKey key, ObjectKind wanted) {
    return fail("there is no " + name_of(wanted) + " " + id_of(key));
}

}  // namespace wall::tileserver
