// SPDX-License-Identifier: MIT
// No exception leaves the library: what a C function does runs inside guarded(), which answers `fallback` instead.
#pragma once

#include <exception>
#include <utility>

#include "client_lib/log.h"

namespace wall::client::vendor {

template <class R, class F>
R guarded(const char* function, R fallback, F&& body) noexcept {
    try {
        return std::forward<F>(body)();
    } catch (const std::exception& e) {
        log(LogLevel::error, "exception function=%s what=%s", function, e.what());
        return fallback;
    }
}

template <class F>
void guarded(const char* function, F&& body) noexcept {
    guarded(function, 0, [&] {
        body();
        return 0;
    });
}

}  // namespace wall::client::vendor
