// SPDX-License-Identifier: MIT
// GLSL programs (programs.h) and occlusion queries (queries.h). Render thread.
#include <cstring>

#include "tileserver/render/executor.h"

namespace wall::tileserver {

void Executor::ShaderCompile(RequestId request, GLenum type, std::span<const std::byte> source) {
    auto answer = session_.programs.compile(type, source);
    if (!answer) return refuse(answer.error().message);
    output_.reply(request, std::move(*answer));
}

void Executor::ProgramLink(RequestId request, ClientName program, std::span<const std::byte> definition) {
    auto answer = session_.programs.link(program, definition, static_cast<bool>(request));
    if (!answer) return refuse(answer.error().message);
    if (request) output_.reply(request, std::move(*answer));
}

void Executor::ProgramDelete(ClientName program) { session_.programs.erase(program); }

void Executor::Uniform(ClientName program, std::uint32_t location, GLenum type, std::uint32_t count,
                       std::span<const std::byte> values) {
    if (auto done = session_.programs.set_uniform(program, location, type, count, values); !done)
        refuse(done.error().message);
}

void Executor::QueryResult(RequestId request, ClientName query) {
    const Timed timed(session_.work.render);
    const std::uint64_t samples = session_.queries.result(query);
    std::vector<std::byte> answer(sizeof samples);
    std::memcpy(answer.data(), &samples, sizeof samples);
    output_.reply(request, std::move(answer));
}

void Executor::QueryDelete(ClientName query) { session_.queries.erase(query); }

}  // namespace wall::tileserver
