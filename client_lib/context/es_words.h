// SPDX-License-Identifier: MIT
// The words of OpenGL ES: what a context of a version knows of GLenum values. Any thread.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "common/glapi/gl_types.h"

namespace wall::client {

/// Whether contexts of this version (times ten) have the word, by their version or an extension.
bool is_es_word(unsigned version, GLenum word);

namespace es_detail {

template <class T>
bool is_known(unsigned version, T value) {
    if constexpr (std::is_same_v<T, GLenum>) return is_es_word(version, value);
    else return true;
}

}  // namespace es_detail

/// The same of those of a command's arguments that are words: a bit each in kWords, the first argument's the lowest.
template <unsigned kWords, class... A>
bool are_es_words(unsigned version, A... arguments) {
    return [&]<std::size_t... kPlace>(std::index_sequence<kPlace...>) {
        return (((kWords >> kPlace & 1) == 0 || es_detail::is_known(version, arguments)) && ...);
    }
    (std::index_sequence_for<A...>());
}

}  // namespace wall::client
