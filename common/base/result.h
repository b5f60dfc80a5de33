// SPDX-License-Identifier: MIT
// Result<T>: what a function returns when its input may be bad (bytes, files, peers). The error is a sentence for a
// person: what was expected, and where. A Result that nobody looks at does not compile. Any thread.
#pragma once

#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <type_traits>
#include <utility>

namespace wall {

/// tl::expected as a class of its own, because only a class can say that it must not be ignored.
template <class T, class E>
class [[nodiscard]] Expected : public tl::expected<T, E> {
    using Plain = tl::expected<T, E>;

public:
    using Plain::Plain;
    Expected() = default;
    Expected(Plain plain) : Plain(std::move(plain)) {}

    /// The Expected that `next` makes of the value, or this error.
    template <class F>
    auto and_then(F&& next) const& {
        return chained(*this, std::forward<F>(next));
    }
    template <class F>
    auto and_then(F&& next) && {
        return chained(std::move(*this), std::forward<F>(next));
    }
    /// What `change` makes of the value, or this error.
    template <class F>
    auto map(F&& change) && {
        return changed(static_cast<Plain&&>(*this).map(std::forward<F>(change)));
    }

private:
    template <class Self, class F>
    static auto chained(Self&& self, F&& next) {
        if constexpr (std::is_void_v<T>) {
            using Next = std::invoke_result_t<F>;
            return self ? std::invoke(std::forward<F>(next)) : Next(tl::unexpected(std::forward<Self>(self).error()));
        } else {
            using Next = std::invoke_result_t<F, decltype(*std::forward<Self>(self))>;
            return self ? std::invoke(std::forward<F>(next), *std::forward<Self>(self))
                        : Next(tl::unexpected(std::forward<Self>(self).error()));
        }
    }
    template <class U>
    static Expected<U, E> changed(tl::expected<U, E>&& plain) {
        return std::move(plain);
    }
};

struct Error {
    std::string message;
};

template <class T>
using Result = Expected<T, Error>;

/// Makes the error side of any Result.
inline tl::unexpected<Error> fail(std::string message) { return tl::unexpected<Error>(Error{std::move(message)}); }

}  // namespace wall
