// SPDX-License-Identifier: MIT
// What state tracking costs: one context difference when nothing, one element, or everything has changed (T4; A7.1
// gives 3.3 to 7.1 us on machines of 600 MHz and 1.5 GHz), the same into packed commands, and decoding a packed stream
// into nothing.
#include <benchmark/benchmark.h>

#include "common/glstate/diff.h"
#include "common/glstate/elements.h"
#include "common/glstate/pack_sink.h"
#include "gen/glapi/null_handler.gen.h"

namespace wall {
namespace {

namespace el = glstate::el;

struct CountingSink {
    std::size_t values = 0;
    template <class E>
    void set(unsigned, const typename E::type& v) {
        benchmark::DoNotOptimize(v);
        ++values;
    }
};

/// Every value of the state differs from its default.
glstate::State everything_changed() {
    glstate::State state;
    for (std::uint32_t id = 1; id <= glstate::kLastSentId; ++id) {
        std::array<std::byte, 256> value{};
        auto* at = reinterpret_cast<std::byte*>(&state) + glstate::element_offset(id);
        const std::uint32_t bytes = glstate::element_bytes(id);
        for (std::uint32_t i = 0; i < bytes; ++i) value[i] = at[i] ^ (i % 4 == 0 ? std::byte{1} : std::byte{0});
        glstate::apply(state, id, {value.data(), bytes});
    }
    state.material.color_material_enabled = 0;
    return state;
}

void DiffUnchanged(benchmark::State& run) {
    glstate::State from, to;
    CountingSink sink;
    for (auto _ : run) glstate::diff(from, to, sink);
    if (sink.values != 0) run.SkipWithError("something was told");
}
BENCHMARK(DiffUnchanged);

/// One element of one category, another value each time. Argument: which one.
template <class E>
void DiffOneElement(benchmark::State& run) {
    glstate::State from, to;
    CountingSink sink;
    typename E::type value = E::ref(to, 0);
    std::uint32_t word = 0;
    for (auto _ : run) {
        std::memcpy(&value, &++word, sizeof word);
        glstate::assign<E>(to, 0, value);
        glstate::diff(from, to, sink);
    }
    run.counters["values"] = benchmark::Counter(static_cast<double>(sink.values), benchmark::Counter::kAvgIterations);
}
BENCHMARK(DiffOneElement<el::fog_density>);
BENCHMARK(DiffOneElement<el::modelview>);
BENCHMARK(DiffOneElement<el::light_diffuse>);
BENCHMARK(DiffOneElement<el::material_diffuse>);
BENCHMARK(DiffOneElement<el::texture_binding_2d>);
BENCHMARK(DiffOneElement<el::tex_env_mode>);

void DiffEverything(benchmark::State& run) {
    const glstate::State states[2] = {glstate::State(), everything_changed()};
    glstate::State from = states[0];
    CountingSink sink;
    for (auto _ : run) glstate::diff(from, states[from.ids == states[0].ids], sink);
}
BENCHMARK(DiffEverything);

void DiffOneElementPacked(benchmark::State& run) {
    glstate::State from, to;
    glstate::ValueHistory history;
    wire::PackBuffer buffer;
    float density = 0;
    for (auto _ : run) {
        glstate::assign<el::fog_density>(to, 0, density += 1);
        glstate::diff(from, to, glstate::PackSink{buffer, history});
        if (buffer.bytes() > 32 << 10) buffer.clear();
    }
}
BENCHMARK(DiffOneElementPacked);

void DiffEverythingPacked(benchmark::State& run) {
    const glstate::State states[2] = {glstate::State(), everything_changed()};
    glstate::State from = states[0];
    glstate::ValueHistory history;
    wire::PackBuffer buffer;
    std::size_t bytes = 0;
    for (auto _ : run) {
        buffer.clear();
        glstate::diff(from, states[from.ids == states[0].ids], glstate::PackSink{buffer, history});
        bytes = buffer.bytes();
    }
    run.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(DiffEverythingPacked);

/// A driver that does nothing.
struct NullDriver : glapi::NullHandler {
    glstate::State state;
    float sum = 0;
    std::uint32_t state_bytes(std::uint32_t id) { return glstate::element_bytes(id); }
    bool State(std::uint32_t id, std::span<const std::byte> value) { return glstate::apply(state, id, value); }
    void Vertex3f(float x, float y, float z) { sum += x + y + z; }
};

void DecodeVertices(benchmark::State& run) {
    constexpr std::uint32_t kVertices = 1 << 14;
    wire::PackBuffer body, batch;
    glapi::pack::Begin(body, GL_TRIANGLES);
    for (std::uint32_t i = 0; i < kVertices; ++i) glapi::pack::Vertex3f(body, static_cast<float>(i), 1, 2);
    glapi::pack::End(body);
    glapi::pack::Block(batch, 1, 0, static_cast<std::uint32_t>(body.commands()),
                       static_cast<std::uint32_t>(body.operand_bytes()));
    batch.append(body, {}, body.mark());
    NullDriver driver;
    for (auto _ : run) {
        if (!glapi::decode(batch.opcodes(), batch.operands(), driver)) run.SkipWithError("refused");
    }
    benchmark::DoNotOptimize(driver.sum);
    run.SetItemsProcessed(static_cast<std::int64_t>(run.iterations()) * kVertices);
    run.SetBytesProcessed(static_cast<std::int64_t>(run.iterations() * batch.bytes()));
}
BENCHMARK(DecodeVertices);

}  // namespace
}  // namespace wall
