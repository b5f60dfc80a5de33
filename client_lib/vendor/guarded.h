// SPDX-License-Identifier: MIT
// What a C function of a window system does runs inside guarded(), which answers `fallback` where it throws (guard.h).
#pragma once

#include <utility>

#include "client_lib/process/guard.h"

namespace wall::client::vendor {

template <class R, class F>
R guarded(const char* function, R fallback, F&& body) {
    try {
        return std::forward<F>(body)();
    } catch (...) {
        caught_exception(function);
        return fallback;
    }
}

template <class F>
void guarded(const char* function, F&& body) {
    guarded(function, 0, [&] {
        body();
        return 0;
    });
}

}  // namespace wall::client::vendor
