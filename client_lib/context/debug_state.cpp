// SPDX-License-Identifier: MIT
#include "client_lib/context/debug_state.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <string>
#include <utility>

#include "gen/client_lib/api.gen.h"

namespace wall::client {
namespace {

struct ErrorWords {
    GLenum code;
    const char* name;
    const char* meaning;
};
constexpr ErrorWords kErrors[] = {
    {GL_INVALID_ENUM, "GL_INVALID_ENUM", "a word that the command does not take here"},
    {GL_INVALID_VALUE, "GL_INVALID_VALUE", "a number out of range, or a name that no object has"},
    {GL_INVALID_OPERATION, "GL_INVALID_OPERATION", "not allowed in the context's state, or not with these objects"},
    {GL_INVALID_FRAMEBUFFER_OPERATION, "GL_INVALID_FRAMEBUFFER_OPERATION",
     "the framebuffer is not complete; glCheckFramebufferStatus tells why"},
    {GL_OUT_OF_MEMORY, "GL_OUT_OF_MEMORY", "more memory than there is, or than can be carried to a node"},
    {GL_STACK_OVERFLOW, "GL_STACK_OVERFLOW", "pushed more often than the stack is deep"},
    {GL_STACK_UNDERFLOW, "GL_STACK_UNDERFLOW", "popped more often than pushed"},
};

bool is_command(const std::string& name) {
    const auto before = [](const ProcEntry& entry, const char* wanted) { return std::strcmp(entry.name, wanted) < 0; };
    const auto found = std::lower_bound(kProcs.begin(), kProcs.end(), name.c_str(), before);
    return found != kProcs.end() && name == found->name;
}

}  // namespace

DebugMessage error_message(GLenum code, const char* where) {
    const auto* words = std::ranges::find(kErrors, code, &ErrorWords::code);
    std::string text = words == std::end(kErrors) ? "an error" : words->name;
    const std::string command = std::string("gl") + where;
    text += is_command(command) ? " in " + command : " (" + std::string(where) + ")";
    if (words != std::end(kErrors)) text += std::string(": ") + words->meaning;
    return {GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_ERROR, code, GL_DEBUG_SEVERITY_HIGH, std::move(text)};
}

}  // namespace wall::client
