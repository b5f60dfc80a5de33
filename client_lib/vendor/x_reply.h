// SPDX-License-Identifier: MIT
// What XCB gives, a reply or an error, belongs to who asked.
#pragma once

#include <cstdlib>
#include <memory>

namespace wall::client::vendor {

/// Null stays null.
template <class T>
std::unique_ptr<T, void (*)(void*)> owned(T* reply) {
    return {reply, &std::free};
}

}  // namespace wall::client::vendor
