// SPDX-License-Identifier: MIT
// Group [renderbuffer]: images that nothing samples. Render thread.
#pragma once

#include <cstdint>
#include <span>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class RenderbufferCommands {
public:
    /// `execution` outlives it.
    explicit RenderbufferCommands(Execution& execution) : execution_(execution) {}

    void Renderbuffer(ClientName renderbuffer, std::uint32_t samples, GLenum internal_format, std::uint32_t width,
                      std::uint32_t height);
    void RenderbufferRead(RequestId request, ClientName renderbuffer, std::int32_t first_row, std::int32_t rows,
                          GLenum format, GLenum type);
    void RenderbufferWrite(ClientName renderbuffer, std::int32_t first_row, std::int32_t rows, GLenum format,
                           GLenum type, std::span<const std::byte> pixels);

private:
    Execution& execution_;
};

}  // namespace wall::tileserver
