// SPDX-License-Identifier: MIT
// Content that several sessions have in common (A6: global share). Before a client sends something large
// it asks for it by its name; if the node has it, nothing is sent and the sessions hold one object of the driver
// together, until one of them changes it (Executor::bind_for_upload). Render thread.
#include <algorithm>

#include "tileserver/render/executor.h"

namespace wall::tileserver {
namespace {

std::vector<std::byte> answer(bool have) { return {std::byte{have}}; }

}  // namespace

void Executor::ShareTexture(RequestId request, ClientName texture, GLenum target, std::uint32_t own_name,
                            std::span<const std::byte> key) {
    if (!bind_for_upload(texture, target)) return;
    ask(request, texture, target, own_name != 0, key);
}

void Executor::ShareRun(RequestId request, ClientName run, std::span<const std::byte> key) {
    ask(request, run, 0, false, key);
}

Result<bool> Executor::pursue_question() {
    const bool answered = !question_ || answer_question();
    if (refused()) return fail(reason());
    return answered;
}

void Executor::ask(RequestId request, ClientName object, GLenum target, bool own_name, std::span<const std::byte> key) {
    if (question_) return refuse("asks before the last question is answered");
    if (key.size() != sizeof(glapi::ContentKey)) return refuse("a name of content has 32 bytes");
    question_ = Question{request, object, target, own_name, {}};
    std::copy(key.begin(), key.end(), question_->key.begin());
    if (own_name) {
        glapi::ContentHash hash;
        hash.InSession(session_.id(), question_->key);
        question_->key = hash.finish();
    }
    answer_question();
}

bool Executor::answer_question() {
    const Question& question = *question_;
    const auto now = std::chrono::steady_clock::now();
    bool have = false;
    if (question.target != 0) {
        const auto target = texture_target(question.target);
        Texture* texture = target ? session_.make_texture(question.object, *target) : nullptr;
        auto found = node_.textures.ask(question.key, session_.asker(), now);
        have = found.have != nullptr;
        if (!have && !found.send) return false;
        if (texture == nullptr || (have && found.have->target() != texture->content->target()) ||
            (have && !session_.adopt(*texture, std::move(found.have))))
            refuse("no such texture, or more texture memory than a session may have");
        else if (!have)
            texture->promise.emplace(
                Texture::Promise{question.key, question.own_name ? std::nullopt : std::optional(glapi::ContentHash())});
    } else {
        auto found = node_.runs.ask(question.key, session_.asker(), now);
        have = found.have != nullptr;
        if (!have && !found.send) return false;
        if (have) keep_run(question.object, std::move(found.have));
        else promised_run_ = {question.object, question.key};
    }
    output_.reply(question.request, answer(have));
    question_.reset();
    return true;
}

void Executor::TexShared(ClientName name) {
    Texture* texture = session_.texture(name, TextureTarget::t2d);
    if (texture == nullptr || !texture->promise)
        return;  // the client did not wait for the answer, and that was: it is here
    auto promise = *std::exchange(texture->promise, {});
    if (promise.hash && promise.hash->finish() != promise.key) return refuse("content is not what its name says");
    auto held = node_.textures.store(promise.key, texture->content);
    if (held == texture->content) held->key = promise.key;
    else if (held->target() == texture->content->target()) session_.adopt(*texture, std::move(held));
}

}  // namespace wall::tileserver
