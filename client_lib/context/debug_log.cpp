// SPDX-License-Identifier: MIT
#include "client_lib/context/debug_log.h"

#include <algorithm>
#include <utility>

namespace wall::client {
namespace {

constexpr GLenum kSourceWords[] = {
    GL_DEBUG_SOURCE_API,         GL_DEBUG_SOURCE_WINDOW_SYSTEM, GL_DEBUG_SOURCE_SHADER_COMPILER,
    GL_DEBUG_SOURCE_THIRD_PARTY, GL_DEBUG_SOURCE_APPLICATION,   GL_DEBUG_SOURCE_OTHER};
constexpr GLenum kTypeWords[] = {
    GL_DEBUG_TYPE_ERROR,       GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR, GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR,
    GL_DEBUG_TYPE_PORTABILITY, GL_DEBUG_TYPE_PERFORMANCE,         GL_DEBUG_TYPE_OTHER,
    GL_DEBUG_TYPE_MARKER,      GL_DEBUG_TYPE_PUSH_GROUP,          GL_DEBUG_TYPE_POP_GROUP};
constexpr GLenum kSeverityWords[] = {GL_DEBUG_SEVERITY_HIGH, GL_DEBUG_SEVERITY_LOW, GL_DEBUG_SEVERITY_MEDIUM,
                                     GL_DEBUG_SEVERITY_NOTIFICATION};

/// Calls `use(i)` for the place of a word, or for all of them.
template <std::size_t N, class Use>
void for_each_meant(const GLenum (&words)[N], GLenum word, Use&& use) {
    for (std::size_t i = 0; i < N; ++i)
        if (word == GL_DONT_CARE || words[i] == word) use(i);
}

}  // namespace

bool DebugLog::is_source(GLenum source) { return std::ranges::count(kSourceWords, source) != 0; }
bool DebugLog::is_type(GLenum type) { return std::ranges::count(kTypeWords, type) != 0; }
bool DebugLog::is_severity(GLenum severity) { return std::ranges::count(kSeverityWords, severity) != 0; }

bool DebugLog::wants(const DebugMessage& message) const {
    bool wanted = false;
    for_each_meant(kSourceWords, message.source, [&](std::size_t source) {
        for_each_meant(kTypeWords, message.type, [&](std::size_t type) {
            const Wanted& of = filter_[source][type];
            const auto own = of.by_id.find(message.id);
            const unsigned severities = own == of.by_id.end() ? of.otherwise : own->second;
            for_each_meant(kSeverityWords, message.severity,
                           [&](std::size_t severity) { wanted = (severities >> severity & 1) != 0; });
        });
    });
    return wanted;
}

void DebugLog::say(DebugMessage message) {
    if (!wants(message)) return;
    if (callback)
        callback(message.source, message.type, message.id, message.severity, static_cast<GLsizei>(message.text.size()),
                 message.text.c_str(), user);
    else if (logged.size() < kMostLogged) logged.push_back(std::move(message));
}

void DebugLog::control(GLenum source, GLenum type, GLenum severity, const std::vector<GLuint>& ids, bool enabled) {
    unsigned bits = 0;
    for_each_meant(kSeverityWords, severity, [&](std::size_t i) { bits |= 1u << i; });
    const auto with = [&](unsigned before) { return enabled ? before | bits : before & ~bits; };
    for_each_meant(kSourceWords, source, [&](std::size_t s) {
        for_each_meant(kTypeWords, type, [&](std::size_t t) {
            Wanted& of = filter_[s][t];
            for (const GLuint id : ids) of.by_id[id] = with(of.otherwise);
            if (!ids.empty()) return;
            of.otherwise = with(of.otherwise);
            if (severity == GL_DONT_CARE) of.by_id.clear();
            for (auto& [id, severities] : of.by_id) severities = with(severities);
        });
    });
}

bool DebugLog::push_group(DebugMessage message, bool output) {
    if (depth() >= kMostGroups) return false;
    message.type = GL_DEBUG_TYPE_PUSH_GROUP;
    message.severity = GL_DEBUG_SEVERITY_NOTIFICATION;
    groups_.push_back({message, filter_});
    if (output) say(std::move(message));
    return true;
}

bool DebugLog::pop_group(bool output) {
    if (groups_.empty()) return false;
    Group group = std::move(groups_.back());
    groups_.pop_back();
    filter_ = std::move(group.outside);
    group.message.type = GL_DEBUG_TYPE_POP_GROUP;
    if (output) say(std::move(group.message));
    return true;
}

}  // namespace wall::client
