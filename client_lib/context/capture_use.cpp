// SPDX-License-Identifier: MIT
#include "client_lib/context/capture_use.h"

#include "common/glstate/diff.h"

namespace wall::client {

namespace el = glstate::el;

Capture* captured_by(const glstate::State& state, CaptureUse& use) {
    if (use.active) return use.active.get();
    if (el::primitives_query::ref(state) == 0) return nullptr;
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
    : state_(state), primitives_(el::primitives_query::ref(state)), captured_(el::captured_query::ref(state)) {
    glstate::assign<el::primitives_query>(state_, 0, 0u);
    glstate::assign<el::captured_query>(state_, 0, 0u);
}

SeenPass::~SeenPass() {
    glstate::assign<el::primitives_query>(state_, 0, primitives_);
    glstate::assign<el::captured_query>(state_, 0, captured_);
}

}  // namespace wall::client
