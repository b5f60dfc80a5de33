// SPDX-License-Identifier: MIT
// Result<T>: what a function returns when its input may be bad (bytes, files, peers). The error is a sentence for a
// person: what was expected, and where. Any thread.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace wall {

struct Error {
    std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

/// Makes the error side of any Result.
inline tl::unexpected<Error> fail(std::string message) { return tl::unexpected<Error>(Error{std::move(message)}); }

}  // namespace wall
