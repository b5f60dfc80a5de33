// SPDX-License-Identifier: MIT
#include "tileserver/driver/render_modes.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>

namespace wall::tileserver {
namespace {

constexpr std::size_t kNameStackDepth = 64;  // as Mesa has it
/// Epochs, and so hits, between enter() and leave(); then the hits are fetched.
constexpr std::size_t kMostEpochs = 1024;
constexpr std::size_t kHitValues = 4;  // of a hit with one name: how many names, two depths, the name

template <class T>
std::vector<std::byte> answer(std::int32_t result, std::span<const T> content) {
    std::vector<std::byte> bytes(sizeof result + content.size_bytes());
    std::memcpy(bytes.data(), &result, sizeof result);
    if (!content.empty()) std::memcpy(bytes.data() + sizeof result, content.data(), content.size_bytes());
    return bytes;
}

}  // namespace

std::vector<std::byte> RenderModes::change(GLenum mode, GLenum feedback_type, std::uint32_t entries) {
    leave();
    std::vector<std::byte> bytes = answer<GLuint>(0, {});
    if (mode_ == GL_SELECT) {
        const std::int32_t result = end_selection();
        bytes = answer<GLuint>(result, std::span(selection_).first(std::min(written_, selection_.size())));
    } else if (mode_ == GL_FEEDBACK) {
        const std::int32_t result = end_feedback();
        bytes = answer<GLfloat>(result, std::span(feedback_).first(std::min(used_, feedback_.size() - 1)));
    }
    mode_ = mode;
    feedback_type_ = feedback_type;
    selection_.assign(mode == GL_SELECT ? entries : 0, 0);
    feedback_.assign(mode == GL_FEEDBACK ? std::size_t{entries} + 1 : 0, 0);
    written_ = used_ = 0;
    hits_ = 0;
    names_.clear();
    open_.reset();
    goes_on_ = false;
    return bytes;
}

void RenderModes::enter() {
    if (mode_ == GL_RENDER || std::exchange(entered_, true)) return;
    if (mode_ == GL_FEEDBACK) {
        const auto room = std::span(feedback_).subspan(std::min(used_, feedback_.size() - 1));
        gl_.FeedbackBuffer(static_cast<GLsizei>(room.size()), feedback_type_, room.data());
        gl_.RenderMode(GL_FEEDBACK);
        return;
    }
    driver_hits_.resize(kMostEpochs * kHitValues);
    gl_.SelectBuffer(static_cast<GLsizei>(driver_hits_.size()), driver_hits_.data());
    gl_.RenderMode(GL_SELECT);
    gl_.InitNames();
    epochs_.assign(1, names_);
    gl_.PushName(0);
}

void RenderModes::leave() {
    if (!std::exchange(entered_, false)) return;
    const GLint result = gl_.RenderMode(GL_RENDER);
    if (mode_ == GL_SELECT) return collect_hits(result);
    used_ = result < 0 ? feedback_.size() : used_ + static_cast<std::size_t>(result);  // more than the program's
}

// ---- selection ----

/// The driver records a hit, if there was one since the last epoch began.
void RenderModes::begin_epoch() {
    if (epochs_.size() == kMostEpochs) {
        leave();
        goes_on_ = false;
        enter();
        return;
    }
    epochs_.push_back(names_);
    gl_.LoadName(static_cast<GLuint>(epochs_.size() - 1));
}

void RenderModes::init_names() {
    if (mode_ != GL_SELECT) return;
    names_.clear();
    begin_epoch();
}

void RenderModes::load_name(GLuint name) {
    if (mode_ != GL_SELECT || names_.empty()) return;
    names_.back() = name;
    begin_epoch();
}

void RenderModes::push_name(GLuint name) {
    if (mode_ != GL_SELECT || names_.size() == kNameStackDepth) return;
    names_.push_back(name);
    begin_epoch();
}

void RenderModes::pop_name() {
    if (mode_ != GL_SELECT || names_.empty()) return;
    names_.pop_back();
    begin_epoch();
}

void RenderModes::collect_hits(GLint hits) {
    bool last_epoch_hit = false;
    for (GLint i = 0; i < hits && static_cast<std::size_t>(i) < kMostEpochs; ++i) {
        const GLuint* record = &driver_hits_[static_cast<std::size_t>(i) * kHitValues];
        const std::size_t epoch = std::min<std::size_t>(record[3], epochs_.size() - 1);
        Hit hit{epochs_[epoch], record[1], record[2]};
        if (epoch == 0 && goes_on_ && open_) {
            hit.nearest = std::min(hit.nearest, open_->nearest);
            hit.farthest = std::max(hit.farthest, open_->farthest);
        } else if (open_) {
            write_hit(*open_);
        }
        open_ = std::move(hit);
        last_epoch_hit = epoch == epochs_.size() - 1;
    }
    // What was open stays so as long as its epoch is the last one.
    const bool same_epoch = epochs_.size() == 1 && goes_on_;
    if (open_ && !last_epoch_hit && !same_epoch) {
        write_hit(*open_);
        open_.reset();
    }
    goes_on_ = true;
}

void RenderModes::write_hit(const Hit& hit) {
    ++hits_;
    write(static_cast<GLuint>(hit.names.size()));
    write(hit.nearest);
    write(hit.farthest);
    for (const GLuint name : hit.names) write(name);
}

void RenderModes::write(GLuint value) {
    if (written_ < selection_.size()) selection_[written_] = value;
    ++written_;
}

std::int32_t RenderModes::end_selection() {
    if (open_) write_hit(*open_);
    return written_ > selection_.size() ? -1 : hits_;
}

// ---- feedback ----

std::int32_t RenderModes::end_feedback() {
    const std::size_t room = feedback_.size() - 1;
    return used_ > room ? -1 : static_cast<std::int32_t>(used_);
}

}  // namespace wall::tileserver
