// SPDX-License-Identifier: MIT
// Why somebody does not get what they asked for: a sentence for a person, a code for a program. Pure.
#pragma once

#include <string>
#include <utility>

#include "common/base/result.h"

namespace wall::walld {

enum class RefusalKind {
    invalid,      ///< the request is not well formed, or asks for what cannot be
    forbidden,    ///< the person may not
    not_found,    ///< there is no such thing
    conflict,     ///< not as things are now
    busy,         ///< too much of it is going on: later
    unavailable,  ///< what it needs is away
    failed,       ///< our own fault
};
const char* name_of(RefusalKind kind);

struct Refusal {
    RefusalKind kind;
    std::string message;
};

template <class T>
using Outcome = Expected<T, Refusal>;

inline tl::unexpected<Refusal> refuse(RefusalKind kind, std::string message) {
    return tl::unexpected<Refusal>(Refusal{kind, std::move(message)});
}

}  // namespace wall::walld
