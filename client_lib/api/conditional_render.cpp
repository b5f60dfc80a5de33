// SPDX-License-Identifier: MIT
// Conditional rendering (OpenGL 3.0, 2.14.6). Whether something is drawn is decided here, by the sum over all nodes: a
// tile that decided by its own samples would show another picture than its neighbour.
#include <optional>

#include "client_lib/context/context.h"
#include "client_lib/context/query_result.h"
#include "client_lib/context/query_state.h"

namespace wall::client::api {
namespace {

/// What a mode asks for. The pixels' own regions are not told apart, which is allowed.
struct Mode {
    bool waits, inverted;
};

std::optional<Mode> mode_of(GLenum mode) {
    switch (mode) {
        case GL_QUERY_WAIT:
        case GL_QUERY_BY_REGION_WAIT: return Mode{true, false};
        case GL_QUERY_NO_WAIT:
        case GL_QUERY_BY_REGION_NO_WAIT: return Mode{false, false};
        case GL_QUERY_WAIT_INVERTED:
        case GL_QUERY_BY_REGION_WAIT_INVERTED: return Mode{true, true};
        case GL_QUERY_NO_WAIT_INVERTED:
        case GL_QUERY_BY_REGION_NO_WAIT_INVERTED: return Mode{false, true};
        default: return std::nullopt;
    }
}

}  // namespace

// A result that nobody waits for is drawn by unless it is there already.
void BeginConditionalRender(Context& c, GLuint name, GLenum word) {
    if (c.queries->conditional) return c.error(GL_INVALID_OPERATION);
    const auto mode = mode_of(word);
    if (!mode) return c.error(GL_INVALID_ENUM);
    if (!c.queries->names.known(name)) return c.error(GL_INVALID_VALUE);
    const auto query = c.queries->names.find(name);
    if (!query || query->slot != QuerySlot::samples) return c.error(GL_INVALID_OPERATION);
    if (query == c.queries->current(QuerySlot::samples, 0)) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    c.queries->conditional = true;
    if (!mode->waits && !is_available(c, *query)) return;
    c.draws_nothing = (result_of(c, *query) != 0) == mode->inverted;
}

void EndConditionalRender(Context& c) {
    if (!c.queries->conditional) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    c.queries->conditional = c.draws_nothing = false;
}

}  // namespace wall::client::api
