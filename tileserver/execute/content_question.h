// SPDX-License-Identifier: MIT
// Content that several sessions have in common (A6: global share). Before a client sends something large it asks for it
// by its name; if the node has it, nothing is sent and the sessions hold one object of the driver together, until one
// of them changes it. What is done with content is its kind's affair. Render thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "tileserver/execute/execution.h"
#include "tileserver/objects/shared_content.h"

namespace wall::tileserver {

/// The one question of a stream that the node has not answered yet.
class ContentQuestion {
public:
    /// `execution` outlives it.
    explicit ContentQuestion(Execution& execution) : execution_(execution) {}
    /// What the session has promised to send is not waited for any more.
    ~ContentQuestion();
    ContentQuestion(const ContentQuestion&) = delete;

    /// What the answer means to who has asked. `have`: the content of that name; null: the client sends it, and has
    /// promised to.
    using Answered = std::function<void(std::shared_ptr<SharedContent> have, const glapi::ContentKey& name)>;
    /// `own_name`: a name that the program has given, which holds in its session.
    void ask(RequestId request, bool own_name, std::span<const std::byte> name, Answered answered);
    /// Looks for the answer. False: there is none yet, because another session is sending the content; nothing of this
    /// one may run.
    bool pursue() { return !asked_ || answer(); }

private:
    struct Asked {
        RequestId request;
        glapi::ContentKey name;
        Answered answered;
    };
    bool answer();

    Execution& execution_;
    std::optional<Asked> asked_;
};

}  // namespace wall::tileserver
