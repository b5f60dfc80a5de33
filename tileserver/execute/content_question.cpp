// SPDX-License-Identifier: MIT
#include "tileserver/execute/content_question.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace wall::tileserver {

ContentQuestion::~ContentQuestion() { execution_.node.shared.leave(execution_.session.asker()); }

void ContentQuestion::ask(RequestId request, bool own_name, std::span<const std::byte> name, Answered answered) {
    if (asked_) return execution_.refuse("asks before the last question is answered");
    if (name.size() != sizeof(glapi::ContentKey)) return execution_.refuse("a name of content has 32 bytes");
    asked_.emplace(Asked{request, {}, std::move(answered)});
    std::copy(name.begin(), name.end(), asked_->name.begin());
    if (own_name) {
        glapi::ContentHash hash;
        hash.InSession(execution_.session.id(), asked_->name);
        asked_->name = hash.finish();
    }
    answer();
}

bool ContentQuestion::answer() {
    auto found = execution_.node.shared.ask(asked_->name, execution_.session.asker(), std::chrono::steady_clock::now());
    if (!found.have && !found.send) return false;
    const Asked asked = *std::exchange(asked_, {});
    const bool have = found.have != nullptr;
    asked.answered(std::move(found.have), asked.name);
    execution_.output.reply(asked.request, {std::byte{have}});
    return true;
}

}  // namespace wall::tileserver
