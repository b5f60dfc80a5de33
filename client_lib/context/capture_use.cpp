// SPDX-License-Identifier: MIT
#include "client_lib/context/capture_use.h"

#include <algorithm>

#include "common/glstate/diff.h"

namespace wall::client {

namespace el = glstate::el;

namespace {

using StreamQueries = std::array<std::uint32_t, kVertexStreams>;

template <class E>
void set_queries(glstate::State& state, const StreamQueries& queries) {
    for (unsigned stream = 0; stream < kVertexStreams; ++stream) glstate::assign<E>(state, stream, queries[stream]);
}

}  // namespace

bool CaptureUse::uses(const Program& program) const {
    bool used = false;
    for_each_object([&](const FeedbackObject& object) { used = used || object.program.get() == &program; });
    return used;
}

Capture* captured_by(const glstate::State& state, CaptureUse& use) {
    if (Capture* active = use.captures()) return active;
    if (std::ranges::none_of(state.objects.primitives_query, [](std::uint32_t query) { return query != 0; }))
        return nullptr;
    if (!use.counter) use.counter = std::make_shared<Capture>(GL_POINTS, std::vector<CapturedPart>());
    return use.counter.get();
}

CapturePass::CapturePass(glstate::State& state, CaptureUse& use, Capture& capture) : state_(state), use_(use) {
    use_.now = &capture;
    glstate::assign<el::capture>(state_, 0, capture.id.value);
}

CapturePass::~CapturePass() {
    use_.now = nullptr;
    glstate::assign<el::capture>(state_, 0, 0u);
}

SeenPass::SeenPass(glstate::State& state)
    : state_(state), primitives_(state.objects.primitives_query), captured_(state.objects.captured_query) {
    set_queries<el::primitives_query>(state_, {});
    set_queries<el::captured_query>(state_, {});
}

SeenPass::~SeenPass() {
    set_queries<el::primitives_query>(state_, primitives_);
    set_queries<el::captured_query>(state_, captured_);
}

}  // namespace wall::client
