// SPDX-License-Identifier: MIT
// Several samples a pixel: which are drawn, and where they are (OpenGL 3.2, 3.3.1 and 4.1.3).
#include <algorithm>
#include <array>
#include <cstring>

#include "client_lib/context/ask_one.h"
#include "client_lib/context/framebuffer_binding.h"

namespace wall::client::api {
// There are no more than 32 samples, which one word has.
void SampleMaski(Context& c, GLuint word, GLbitfield mask) {
    if (word != 0) return c.error(GL_INVALID_VALUE);
    c.set<glstate::el::sample_mask>(0, mask);
}

void GetMultisamplefv(Context& c, GLenum pname, GLuint index, GLfloat* position) {
    if (pname != GL_SAMPLE_POSITION) return c.error(GL_INVALID_ENUM);
    const std::uint32_t samples = samples_drawn(c);
    if (index >= samples) return c.error(GL_INVALID_VALUE);
    const auto answer = ask_one_node(c, "glGetMultisamplefv", [&](wire::PackBuffer& buffer, RequestId request) {
        glapi::pack::SamplePosition(buffer, request, samples, index, c.framebuffers->draw == nullptr);
    });
    std::array<GLfloat, 2> place{0.5f, 0.5f};
    if (answer && answer->bytes.size() == sizeof place) std::memcpy(place.data(), answer->bytes.data(), sizeof place);
    std::copy(place.begin(), place.end(), position);
}

}  // namespace wall::client::api
