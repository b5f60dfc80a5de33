// SPDX-License-Identifier: MIT
#include "examples/march/team.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace march {
namespace {

constexpr GLuint kBarrier = 1;  // its name, the same in all processes

template <class Function>
Function entry_point(const char* name) {
    return reinterpret_cast<Function>(glXGetProcAddress(reinterpret_cast<const GLubyte*>(name)));
}

}  // namespace

Rank rank_from_environment() {
    Rank rank;
    const char* text = std::getenv("WALLGL_PARALLEL");  // GROUP:RANK:SIZE
    if (text && std::sscanf(text, "%*[^:]:%d:%d", &rank.own, &rank.all) != 2) rank = {};
    return rank;
}

Team::Team(const Rank& rank) : rank_(rank) {
    if (rank.all == 1) return;
    const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
    if (!extensions || !std::strstr(extensions, "GL_CR_synchronization")) {
        std::fputs("march: several processes need GL_CR_synchronization: start them by wallrun --parallel\n", stderr);
        std::exit(1);
    }
    const auto create = entry_point<void (*)(GLuint name, GLuint count)>("glBarrierCreateCR");
    exec_ = entry_point<void (*)(GLuint name)>("glBarrierExecCR");
    create(kBarrier, static_cast<GLuint>(rank.all));
}

void Team::barrier() const {
    if (exec_) exec_(kBarrier);
}

}  // namespace march
