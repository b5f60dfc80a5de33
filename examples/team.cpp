// SPDX-License-Identifier: MIT
#include "examples/team.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace example {
namespace {

// Names are the same in all processes.
constexpr GLuint kBarrier = 1;
GLuint turn_of(int place) { return 1 + static_cast<GLuint>(place); }  // a semaphore

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

Team::Team(const char* title, const Rank& rank) : rank_(rank) {
    if (rank.all == 1) return;
    const auto* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
    if (!extensions || !std::strstr(extensions, "GL_CR_synchronization")) {
        std::fprintf(stderr, "%s: several processes need GL_CR_synchronization: start them by wallrun --parallel\n",
                     title);
        std::exit(1);
    }
    using Create = void (*)(GLuint name, GLuint count);
    entry_point<Create>("glBarrierCreateCR")(kBarrier, static_cast<GLuint>(rank.all));
    const auto create = entry_point<Create>("glSemaphoreCreateCR");
    for (int place = 0; place < rank.all; ++place) create(turn_of(place), place == 0 ? 1 : 0);
    barrier_ = entry_point<Call>("glBarrierExecCR");
    take_ = entry_point<Call>("glSemaphorePCR");
    give_ = entry_point<Call>("glSemaphoreVCR");
}

void Team::barrier() const {
    if (barrier_) barrier_(kBarrier);
}

void Team::begin_turn(int place) const {
    if (take_) take_(turn_of(place));
}

void Team::end_turn(int place) const {
    if (give_) give_(turn_of((place + 1) % rank_.all));
}

}  // namespace example
