// SPDX-License-Identifier: MIT
// GLSL programs (programs.h) and occlusion queries (queries.h). Render thread.
#include <cstring>

#include "tileserver/render/executor.h"

namespace wall::tileserver {

void Executor::ShaderCompile(std::uint32_t request, GLenum type, std::span<const std::byte> source) {
    auto answer = session_.programs.compile(type, source);
    if (!answer) return refuse(answer.error().message);
    output_.reply(request, std::move(*answer));
}

void Executor::ProgramLink(std::uint32_t request, std::uint32_t program, std::span<const std::byte> definition) {
    auto answer = session_.programs.link(ClientName(program), definition, request != 0);
    if (!answer) return refuse(answer.error().message);
    if (request != 0) output_.reply(request, std::move(*answer));
}

void Executor::ProgramDelete(std::uint32_t program) { session_.programs.erase(ClientName(program)); }

void Executor::Uniform(std::uint32_t program, std::uint32_t location, GLenum type, std::uint32_t count,
                       std::span<const std::byte> values) {
    if (auto done = session_.programs.set_uniform(ClientName(program), location, type, count, values); !done)
        refuse(done.error().message);
}

void Executor::QueryResult(std::uint32_t request, std::uint32_t query) {
    const Timed timed(session_.work.render);
    const std::uint64_t samples = session_.queries.result(ClientName(query));
    std::vector<std::byte> answer(sizeof samples);
    std::memcpy(answer.data(), &samples, sizeof samples);
    output_.reply(request, std::move(answer));
}

void Executor::QueryDelete(std::uint32_t query) { session_.queries.erase(ClientName(query)); }

}  // namespace wall::tileserver
