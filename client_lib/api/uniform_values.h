// SPDX-License-Identifier: MIT
// What the commands that set uniforms have in common: glUniform for the program that is in use, glProgramUniform for
// any. The context's thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/objects/program.h"

namespace wall::client::api {

template <class T>
constexpr glapi::UniformBase kBaseOf = std::is_same_v<T, GLfloat>    ? glapi::UniformBase::real
                                       : std::is_same_v<T, GLdouble> ? glapi::UniformBase::double_real
                                       : std::is_same_v<T, GLint>    ? glapi::UniformBase::integer
                                                                     : glapi::UniformBase::unsigned_integer;

/// Of a component.
template <class T>
constexpr std::size_t kWordsOf = sizeof(T) / sizeof(std::uint32_t);

/// What a glUniform command brings.
struct Given {
    glapi::UniformBase base;
    unsigned columns, rows;
    std::span<const std::uint32_t> words;
    unsigned words_each() const { return columns * rows * (base == glapi::UniformBase::double_real ? 2 : 1); }
};

/// The program whose uniforms glUniform sets; null, and an error: none.
std::shared_ptr<Program> uniform_target(Context& c);
/// One that was linked; null, and an error: none of that name.
std::shared_ptr<Program> uniform_target(Context& c, GLuint name);
/// Sets `count` elements from a location on. `program` may be null, which was an error.
void set_uniform(Context& c, const std::shared_ptr<Program>& program, GLint location, GLsizei count,
                 const Given& given);

template <unsigned kRows, class T>
void set_vectors(Context& c, const std::shared_ptr<Program>& program, GLint location, GLsizei count, const T* values) {
    const std::size_t words = count > 0 && values ? static_cast<std::size_t>(count) * kRows * kWordsOf<T> : 0;
    set_uniform(c, program, location, count,
                {kBaseOf<T>, 1, kRows, {reinterpret_cast<const std::uint32_t*>(values), words}});
}

template <class T, class... More>
void set_one(Context& c, const std::shared_ptr<Program>& program, GLint location, T first, More... more) {
    const T values[] = {first, more...};
    set_vectors<1 + sizeof...(More)>(c, program, location, 1, values);
}

template <unsigned kColumns, unsigned kRows, class T>
void set_matrices(Context& c, const std::shared_ptr<Program>& program, GLint location, GLsizei count,
                  GLboolean transpose, const T* values) {
    const std::size_t numbers = count > 0 && values ? static_cast<std::size_t>(count) * kColumns * kRows : 0;
    std::vector<T> turned;
    if (transpose && numbers != 0) {
        turned.resize(numbers);
        for (std::size_t i = 0; i < numbers; ++i) {
            const std::size_t matrix = i - i % (kColumns * kRows), column = i % (kColumns * kRows) / kRows,
                              row = i % kRows;
            turned[i] = values[matrix + row * kColumns + column];
        }
        values = turned.data();
    }
    set_uniform(c, program, location, count,
                {kBaseOf<T>, kColumns, kRows, {reinterpret_cast<const std::uint32_t*>(values), numbers * kWordsOf<T>}});
}

}  // namespace wall::client::api
