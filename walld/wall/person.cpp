// SPDX-License-Identifier: MIT
#include "walld/wall/person.h"

namespace wall::walld {

const char* name_of(RefusalKind kind) {
    switch (kind) {
        case RefusalKind::invalid: return "invalid";
        case RefusalKind::forbidden: return "forbidden";
        case RefusalKind::not_found: return "not_found";
        case RefusalKind::conflict: return "conflict";
        case RefusalKind::busy: return "busy";
        case RefusalKind::unavailable: return "unavailable";
        case RefusalKind::failed: return "failed";
    }
    return "";
}

std::string Person::text() const {
    switch (kind) {
        case Kind::unix_user:
        case Kind::host_user:
        case Kind::machine: return name;
        case Kind::token: return "token " + name;
        case Kind::unknown: return "somebody unknown";
    }
    return "";
}

bool Person::same_as(const Person& other) const {
    if (kind != other.kind || kind == Kind::unknown) return false;
    return kind == Kind::unix_user ? user == other.user : name == other.name;
}

Outcome<void> may(const Person& who, Need need, const std::string& what, const Person* owner) {
    const auto no = [&](const std::string& why) {
        return refuse(RefusalKind::forbidden, who.text() + " may not " + what + ": " + why);
    };
    if (who.role == Role::operator_) return {};
    if (need == Need::look) return who.role >= Role::viewer ? Outcome<void>() : no("that needs the role viewer");
    if (need == Need::operate)
        return no("that needs the role operator, and theirs is " + std::string(config::name_of(who.role)));
    if (who.role < Role::user)
        return no("that needs the role user, and theirs is " + std::string(config::name_of(who.role)));
    if (owner && who.same_as(*owner)) return {};
    return no(owner ? "it belongs to " + owner->text() : "that needs the role operator");
}

}  // namespace wall::walld
