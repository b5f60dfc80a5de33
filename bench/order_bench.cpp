// SPDX-License-Identifier: MIT
// The order of triangles (docs/vertex-data.md, "Order"): how many vertices a cache of 16 processes for each triangle,
// as a mesh comes and as a node orders it, as a whole and within pieces; what ordering takes; and a frame of it on
// llvmpipe, which has no such cache and gains nothing but memory that lies together.
#include <benchmark/benchmark.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "bench/render_side.h"
#include "common/glstate/pieces.h"
#include "common/glstate/vertex_input.h"
#include "tileserver/objects/index_orders.h"
#include "tileserver/objects/triangle_order.h"

namespace wall::tileserver {
namespace {

using namespace bench;
using Indices = std::vector<std::uint32_t>;

constexpr std::uint32_t kColumns = 500, kRows = 250;  ///< 250,000 triangles
constexpr std::size_t kVertices = std::size_t{kColumns + 1} * (kRows + 1);
constexpr std::size_t kWhole = IndexOrders::kIndicesADraw, kPieces = glstate::kPieceElements;

std::uint32_t at(std::uint32_t column, std::uint32_t row) { return row * (kColumns + 1) + column; }

/// Row by row, as heightfields and simulations have it.
Indices by_rows() {
    Indices out;
    for (std::uint32_t row = 0; row < kRows; ++row)
        for (std::uint32_t column = 0; column < kColumns; ++column)
            for (const auto& [c, r] : {std::pair{0u, 0u}, {1u, 0u}, {0u, 1u}, {1u, 0u}, {1u, 1u}, {0u, 1u}})
                out.push_back(at(column + c, row + r));
    return out;
}

/// In any order among so many triangles: exporters leave meshes so that have no order of their own.
Indices shuffled(std::size_t among) {
    const Indices rows = by_rows();
    std::vector<std::array<std::uint32_t, 3>> triangles(rows.size() / 3);
    for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = {rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]};
    std::mt19937 random(1);
    for (std::size_t first = 0; first < triangles.size(); first += among)
        std::shuffle(triangles.begin() + static_cast<std::ptrdiff_t>(first),
                     triangles.begin() + static_cast<std::ptrdiff_t>(std::min(first + among, triangles.size())),
                     random);
    Indices out;
    for (const auto& each : triangles) out.insert(out.end(), each.begin(), each.end());
    return out;
}

double misses(const Indices& indices) {
    return static_cast<double>(meshopt_analyzeVertexCache(indices.data(), indices.size(), kVertices, 16, 0, 0).acmr);
}

void order(benchmark::State& state, const Indices& mesh, std::size_t step) {
    Indices ordered;
    for (auto _ : state) {
        ordered = mesh;
        benchmark::DoNotOptimize(order_triangles(ordered, step));
    }
    state.counters["ACMR before"] = misses(mesh);
    state.counters["ACMR after"] = misses(ordered);
    state.counters["indices"] =
        benchmark::Counter(static_cast<double>(mesh.size()), benchmark::Counter::kIsIterationInvariantRate);
}

struct Vertex {
    float x, y, z;
};

/// A frame of the mesh, lit by nothing, in a window of kSize; the driver has finished.
void frame(benchmark::State& state, const Indices& mesh, bool orders) {
    constexpr ClientName kVertexBuffer(11), kIndexBuffer(12), kInput(13);
    Node node(To::llvmpipe);
    node.node().orders_triangles = orders;
    Client client(node, SessionId(1));
    std::vector<Vertex> vertices;
    for (std::uint32_t row = 0; row <= kRows; ++row)
        for (std::uint32_t column = 0; column <= kColumns; ++column) {
            const float x = 2 * static_cast<float>(column) / kColumns - 1, y = 2 * static_cast<float>(row) / kRows - 1;
            vertices.push_back({x, y, 0.4f * std::sin(6 * x) * std::cos(4 * y)});
        }
    wire::PackBuffer b;
    const auto define = [&](ClientName name, std::span<const std::byte> content) {
        glapi::pack::BufferData(b, name, static_cast<std::uint32_t>(content.size()), GL_STATIC_DRAW);
        glapi::pack::BufferSubData(b, name, 0, content);
    };
    define(kVertexBuffer, std::as_bytes(std::span(vertices)));
    define(kIndexBuffer, std::as_bytes(std::span(mesh)));
    const glstate::VertexInputDefinition input{kIndexBuffer,
                                               {{.place = glstate::kPositionArray,
                                                 .buffer = kVertexBuffer,
                                                 .stride = sizeof(Vertex),
                                                 .type = GL_FLOAT,
                                                 .size = 3}}};
    glapi::pack::VertexInput(b, kInput, glstate::encode(input));
    client.run(ContextId(1), b);
    glstate::assign<glstate::el::depth_test>(client.context(ContextId(1)).state, 0, true);
    const auto draw = [&] {
        wire::PackBuffer body, block;
        glapi::pack::Clear(body, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glapi::pack::DrawElements(body, kInput, {}, GL_TRIANGLES, static_cast<std::int32_t>(mesh.size()),
                                  GL_UNSIGNED_INT, 0, 0);
        glapi::pack::Block(block, 1, 0, static_cast<std::uint32_t>(body.commands()),
                           static_cast<std::uint32_t>(body.operand_bytes()));
        block.append(body, {}, body.mark());
        client.run(ContextId(1), block);
        node.gl().Finish();
    };
    for (unsigned i = 0; i < 2 * IndexOrders::kFirstWait + mesh.size() / kWhole + 2; ++i)
        draw();  // all is in order then
    for (auto _ : state) draw();
}

const bool registered = [] {
    const std::vector<std::pair<std::string, Indices>> meshes{
        {"rows", by_rows()}, {"shuffled among 256", shuffled(256)}, {"shuffled", shuffled(std::size_t{1} << 30)}};
    for (const auto& [name, mesh] : meshes) {
        const auto add = [&](const std::string& what, auto&& run) {
            benchmark::RegisterBenchmark((name + ", " + what).c_str(), run)
                ->Unit(benchmark::kMillisecond)
                ->UseRealTime();
        };
        add("ordered as a whole", [mesh](benchmark::State& s) { order(s, mesh, kWhole); });
        add("ordered in pieces", [mesh](benchmark::State& s) { order(s, mesh, kPieces); });
        add("a frame as it is", [mesh](benchmark::State& s) { frame(s, mesh, false); });
        add("a frame in order", [mesh](benchmark::State& s) { frame(s, mesh, true); });
    }
    return true;
}();

}  // namespace
}  // namespace wall::tileserver
