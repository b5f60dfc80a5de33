// SPDX-License-Identifier: MIT
// What executing a stream costs beside the driver: packed commands decoded and executed on a driver that does nothing.
#include <benchmark/benchmark.h>

#include "bench/render_side.h"

namespace wall::tileserver {
namespace {

namespace el = glstate::el;
namespace pack = glapi::pack;
using namespace bench;

constexpr std::uint32_t kVertices = 30000;  // of one block
constexpr std::uint32_t kTextures = 1000;

/// The payload of a batch with one block, for one tile.
template <class Draw>
void append_block(wire::PackBuffer& buffer, Draw&& draw) {
    wire::PackBuffer body;
    draw(body);
    pack::Block(buffer, 1, 0, static_cast<std::uint32_t>(body.commands()),
                static_cast<std::uint32_t>(body.operand_bytes()));
    buffer.append(body, {}, body.mark());
}

std::vector<std::byte> payload_of(const wire::PackBuffer& buffer) {
    std::vector<std::byte> payload;
    wire::append_batch(payload, {ContextId(1), buffer.opcodes(), buffer.operands()});
    return payload;
}

/// A mesh in immediate mode; `attributes`: with a colour, a normal and a texture coordinate at each vertex.
void Geometry(benchmark::State& run, bool attributes) {
    Node node(To::null);
    Client client(node, SessionId(1));
    wire::PackBuffer buffer;
    append_block(buffer, [&](wire::PackBuffer& body) {
        pack::Begin(body, GL_TRIANGLES);
        for (std::uint32_t i = 0; i < kVertices; ++i) {
            const auto x = static_cast<float>(i);
            if (attributes) {
                pack::Color4ub(body, i);
                pack::Normal3f(body, x, 0, 1);
                pack::TexCoord2f(body, x, 0);
            }
            pack::Vertex3f(body, x, 1, 0);
        }
        pack::End(body);
    });
    const auto payload = payload_of(buffer);
    for (auto _ : run) benchmark::DoNotOptimize(client.executor.run_batch(payload));
    run.SetItemsProcessed(static_cast<std::int64_t>(run.iterations()) * kVertices);
}
BENCHMARK_CAPTURE(Geometry, vertices, false)->Name("geometry/vertices");
BENCHMARK_CAPTURE(Geometry, attributes, true)->Name("geometry/vertices with colour, normal, texture coordinate");

/// Blocks of one triangle, each with another texture than the one before, of a session that has many.
void TextureBindings(benchmark::State& run) {
    Node node(To::null);
    Client client(node, SessionId(1));
    wire::PackBuffer textures, buffer;
    for (std::uint32_t name = 1; name <= kTextures; ++name)
        pack::TexImage(textures, ClientName(name), GL_TEXTURE_2D, 0, GL_RGBA, 8, 8, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                       {});
    client.run(ContextId(1), textures);
    for (std::uint32_t name = 1; name <= kTextures; ++name) {
        const std::uint32_t bound = name * 7 % kTextures + 1;
        glapi::pack_state(buffer, el::texture_binding_2d::id, &bound, sizeof bound);
        append_block(buffer, [](wire::PackBuffer& body) {
            pack::Begin(body, GL_TRIANGLES);
            for (const float x : {0.0f, 1.0f, 2.0f}) pack::Vertex3f(body, x, 1, 0);
            pack::End(body);
        });
    }
    const auto payload = payload_of(buffer);
    for (auto _ : run) benchmark::DoNotOptimize(client.executor.run_batch(payload));
    run.SetItemsProcessed(static_cast<std::int64_t>(run.iterations()) * kTextures);
}
BENCHMARK(TextureBindings)->Name("texture bindings");

/// Calls of runs of one triangle, of a session that has many.
void RunCalls(benchmark::State& run) {
    Node node(To::null);
    Client client(node, SessionId(1));
    wire::PackBuffer runs, buffer, triangle;
    pack::Begin(triangle, GL_TRIANGLES);
    for (const float x : {0.0f, 1.0f, 2.0f}) pack::Vertex3f(triangle, x, 1, 0);
    pack::End(triangle);
    std::vector<std::byte> content(wire::padded4(triangle.commands()) - triangle.commands());
    content.insert(content.end(), triangle.opcodes().begin(), triangle.opcodes().end());
    content.insert(content.end(), triangle.operands().begin(), triangle.operands().end());
    for (std::uint32_t name = 1; name <= kTextures; ++name)
        pack::RunDefine(runs, ClientName(name), static_cast<std::uint32_t>(triangle.commands()),
                        static_cast<std::uint32_t>(triangle.operand_bytes()), content);
    client.run(ContextId(1), runs);
    append_block(buffer, [](wire::PackBuffer& body) {
        for (std::uint32_t name = 1; name <= kTextures; ++name) pack::RunCall(body, ClientName(name));
    });
    const auto payload = payload_of(buffer);
    for (auto _ : run) benchmark::DoNotOptimize(client.executor.run_batch(payload));
    run.SetItemsProcessed(static_cast<std::int64_t>(run.iterations()) * kTextures);
}
BENCHMARK(RunCalls)->Name("run calls");

}  // namespace
}  // namespace wall::tileserver
