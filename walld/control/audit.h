// SPDX-License-Identifier: MIT
// One line of the log for each request that changes the wall, done or refused. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "walld/wall/person.h"

namespace wall::walld {

struct Deed {
    const Person& who;
    const char* via;                  ///< "control", "http"
    const std::string& what;          ///< the verb
    const nlohmann::json& arguments;  ///< with the target
    const Refusal* refusal;           ///< null: it was done
};

/// `audit who="alice" role=user via=http what=place target="3" arguments={...} result=ok`. What people wrote is quoted
/// and bounded, so that nobody can forge a line.
std::string audit_line(const Deed& deed);

}  // namespace wall::walld
