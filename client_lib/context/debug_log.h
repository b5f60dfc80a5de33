// SPDX-License-Identifier: MIT
// The debug output of a context (GL_KHR_debug; OpenGL 4.3, chapter 20): which messages are wanted, those that wait to
// be read, and the groups. Limits and defaults are Mesa's. Pure; the application's thread.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "common/glapi/gl_types.h"

namespace wall::client {

struct DebugMessage {
    GLenum source = 0, type = 0;
    GLuint id = 0;
    GLenum severity = 0;
    std::string text;
};

class DebugLog {
public:
    static constexpr std::size_t kMostText = 4096;  ///< GL_MAX_DEBUG_MESSAGE_LENGTH, with the zero behind it
    static constexpr std::size_t kMostLogged = 10;  ///< GL_MAX_DEBUG_LOGGED_MESSAGES
    static constexpr std::size_t kMostGroups = 64;  ///< GL_MAX_DEBUG_GROUP_STACK_DEPTH, with the default group

    GLDEBUGPROC callback = nullptr;
    const void* user = nullptr;

    /// Whether there is such a source, type or severity. GL_DONT_CARE is none.
    static bool is_source(GLenum source);
    static bool is_type(GLenum type);
    static bool is_severity(GLenum severity);

    /// Gives the message to the callback, or keeps it until it is read, if it is wanted.
    void say(DebugMessage message);
    /// Of messages with these properties, each of which may be GL_DONT_CARE; without ids: all of them.
    void control(GLenum source, GLenum type, GLenum severity, const std::vector<GLuint>& ids, bool enabled);

    /// What waits to be read, the oldest first. When it is full, new ones are lost.
    std::deque<DebugMessage> logged;

    /// Groups, the default one included.
    std::size_t depth() const { return groups_.size() + 1; }
    /// A message opens a group, and a copy of what is wanted with it; it is said with `output`. False: there are too
    /// many.
    bool push_group(DebugMessage message, bool output);
    /// False: there is none but the default one.
    bool pop_group(bool output);

private:
    static constexpr std::size_t kSources = 6, kTypes = 9;
    /// Of one source and type: a bit for each severity.
    struct Wanted {
        unsigned otherwise = 0b1101;  ///< all but GL_DEBUG_SEVERITY_LOW
        std::map<GLuint, unsigned> by_id;
    };
    using Filter = std::array<std::array<Wanted, kTypes>, kSources>;
    struct Group {
        DebugMessage message;
        Filter outside;
    };
    bool wants(const DebugMessage& message) const;

    Filter filter_;
    std::vector<Group> groups_;
};

}  // namespace wall::client
