// SPDX-License-Identifier: MIT
#include "tools/wallplay/player.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "common/wire/batch.h"

namespace wall::wallplay {

using recording::Record;
using recording::RecordKind;

namespace {

constexpr std::chrono::milliseconds kLook{20};         // for whether somebody wants it to end
constexpr std::chrono::milliseconds kWorthwhile{300};  // of waiting, for a window that was moved to be drawn anew

recording::Time time_of(double seconds) {
    return std::chrono::duration_cast<recording::Time>(std::chrono::duration<double>(seconds));
}

}  // namespace

Result<void> Player::open() {
    const auto named = [&](const Error& error) { return fail(options_.file + ": " + error.message); };
    auto source = recording::Source::open(options_.file);
    if (!source) return named(source.error());
    auto reader = recording::Reader::open(std::move(*source));
    if (!reader) return named(reader.error());
    const auto& header = reader->header();
    if (header.stream != glapi::kStreamVersion)
        return fail(
            fmt::format("{}: recorded by {}, whose programs say it otherwise (stream version {:08x}); this is "
                        "WallGL " WALLGL_VERSION " ({:08x})",
                        options_.file, header.creator, header.stream, glapi::kStreamVersion));
    if (options_.from_frame && *options_.from_frame > reader->index().frames)
        return fail(fmt::format("{}: there is no frame {}: it has {}", options_.file, *options_.from_frame,
                                reader->index().frames));
    if (time_of(options_.from) > reader->index().duration)
        return fail(fmt::format("{}: there is nothing from {} s on: it takes {:.1f} s", options_.file, options_.from,
                                std::chrono::duration<double>(reader->index().duration).count()));
    played_.skipped = reader->recovered().value_or("");
    reader_.emplace(std::move(*reader));
    windows_.emplace(session_, header.program);
    return {};
}

Result<Played> Player::play() {
    if (auto done = open(); !done) return tl::unexpected(done.error());
    do {
        starts_at_ = true;
        go_to(segment_for_start());
        if (auto done = play_on(); !done) return tl::unexpected(done.error());
    } while (options_.loop && !is_over());
    if (options_.stay) stay();
    return played_;
}

bool Player::is_over() const {
    return stop_ || windows_->close_wanted() || (options_.frames && played_.frames >= *options_.frames);
}

/// The last from which showing can begin.
std::size_t Player::segment_for_start() const {
    const auto& segments = reader_->index().segments;
    std::size_t out = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const bool before =
            options_.from_frame ? segments[i].frame < *options_.from_frame : segments[i].time <= time_of(options_.from);
        if (before) out = i;
    }
    return out;
}

bool Player::shows() const {
    if (!starts_at_) return true;
    if (options_.from_frame) return frame_ + 1 >= *options_.from_frame;
    return time_ >= time_of(options_.from);
}

void Player::go_to(std::size_t segment) {
    reader_->seek(segment);
    next_segment_ = pictured_ = segment;
    began_again_ = false;
    frame_ = reader_->index().segments[segment].frame;
    begun_.reset();
}

Result<void> Player::play_on() {
    while (!is_over()) {
        const auto record = reader_->next();
        if (record && !*record) return {};
        auto done = record ? Result<void>() : Result<void>(tl::unexpected(record.error()));
        if (record) {
            time_ = (*record)->time;
            if ((*record)->kind == RecordKind::segment) begin_segment();
            else done = show(**record);
        }
        if (!done && !go_over(done.error().message)) return fail(options_.file + ": " + done.error().message);
    }
    return {};
}

/// What is damaged; the recording goes on where it can be read again. False: nowhere.
bool Player::go_over(const std::string& why) {
    if (next_segment_ >= reader_->index().segments.size()) return false;
    played_.skipped = why;
    go_to(next_segment_);
    return true;
}

void Player::begin_segment() {
    if (!std::exchange(began_again_, false)) forget_all();
    at_ = {.segment = next_segment_++};
}

// ---- commands ----

Result<void> Player::show(const Record& record) {
    const auto batch = wire::split_batch(record.payload);
    if (!batch) return tl::unexpected(batch.error());
    if (shows()) wait_until(record.time);
    if (is_over()) return {};
    windows_->begin_frames();
    last_context_ = batch->context;
    glstate::CommandWalk walk(batch->opcodes, batch->operands);
    std::vector<Sent> waiting;
    for (;;) {
        const auto next = walk.next();
        if (!next) return tl::unexpected(next.error());
        if (!*next || is_of_windows((*next)->op)) send(batch->context, std::exchange(waiting, {}));
        if (!*next) break;
        const glstate::Command& command = **next;
        if (glapi::kOpGroups[static_cast<std::size_t>(command.op)] == glapi::OpGroup::sync)
            return fail("a command of a parallel program");
        drawn_.note(batch->context, command);
        began_again_ = command.op == glapi::Op::BeginAgain;
        if (!is_of_windows(command.op)) {
            waiting.push_back({command, drawn_.of(batch->context)});
            continue;
        }
        ++at_.commands;
        if (command.op == glapi::Op::Swap) {
            end_frame(batch->context, SurfaceId(command.word(0)));
            continue;
        }
        if (auto taken = windows_->take(command); !taken) return taken;
        windows_->begin_frames();
    }
    ++at_.batches;
    at_.commands = 0;
    return {};
}

void Player::send(ContextId context, const std::vector<Sent>& commands) {
    session_.on_every_node(context, [&](wire::PackBuffer&, client::Node& node) {
        if (known_[node.index] != node.stream) catch_up(node);
        wire::PackBuffer& buffer = session_.nodes().batch(node, context);
        windows_->describe_to(node);
        const NodeView view = windows_->view_for(node);
        for (const auto& [command, drawn] : commands) rewrite(command, drawn, view, buffer);
        session_.nodes().send(node);
    });
    at_.commands += commands.size();
}

/// All that the others have since the segment of the last picture, which comes along with it. Frames do not end.
void Player::catch_up(client::Node& node) {
    known_[node.index] = node.stream;
    recording::Reader reader = reader_->another();
    Position at{.segment = pictured_};
    reader.seek(at.segment);
    static_cast<void>(reader.next());  // the segment's own record
    DrawnSurfaces drawn;
    windows_->describe_to(node);
    const NodeView view = windows_->view_for(node);
    bool again = false;
    while (at.segment < at_.segment || at.batches <= at_.batches) {
        const auto record = reader.next();
        if (!record || !*record) return;
        if ((*record)->kind == RecordKind::segment) {
            if (!std::exchange(again, false)) begin_again(node);
            at = {.segment = at.segment + 1};
            drawn = {};
            continue;
        }
        const bool last = at.segment == at_.segment && at.batches++ == at_.batches;
        std::size_t most = last ? at_.commands : SIZE_MAX;
        const auto batch = wire::split_batch((*record)->payload);
        if (!batch || most == 0) return;
        wire::PackBuffer& buffer = session_.nodes().batch(node, batch->context);
        glstate::CommandWalk walk(batch->opcodes, batch->operands);
        for (auto next = walk.next(); most > 0 && next && *next; next = walk.next(), --most) {
            drawn.note(batch->context, **next);
            again = (*next)->op == glapi::Op::BeginAgain;
            if (!is_of_windows((*next)->op)) rewrite(**next, drawn.of(batch->context), view, buffer);
        }
    }
}

void Player::begin_again(client::Node& node) {
    glapi::pack::BeginAgain(session_.nodes().batch(node, ContextId()));
    session_.nodes().send(node);
}

/// Nodes begin at time zero again; windows keep their pictures.
void Player::forget_all() {
    drawn_ = {};
    session_.on_every_node(ContextId(), [this](wire::PackBuffer&, client::Node& node) { begin_again(node); });
}

/// What is on the wall was drawn for other tiles: all that has led to it is drawn for these.
void Player::refresh() {
    windows_->begin_frames();
    const DrawnSurfaces drawn = drawn_;
    forget_all();
    drawn_ = drawn;
    known_.clear();
    send(last_context_, {});
    windows_->swap_all(last_context_);
}

// ---- frames ----

void Player::end_frame(ContextId context, SurfaceId surface) {
    const bool shown = shows();
    ++frame_;
    pictured_ = at_.segment;
    if (!shown) return;
    starts_at_ = false;
    windows_->swap(context, surface);
    ++played_.frames;
}

void Player::wait_until(recording::Time time) {
    if (!begun_) {
        begun_ = Clock::now();
        begun_at_ = time;
    }
    const std::chrono::duration<double, std::micro> later(static_cast<double>((time - begun_at_).count()) /
                                                          options_.speed);
    const auto due = *begun_ + std::chrono::duration_cast<Clock::duration>(later);
    while (Clock::now() < due && !is_over()) {
        const auto left = due - Clock::now();
        if (left > kWorthwhile && windows_->between_frames() && windows_->take_redraw()) refresh();
        std::this_thread::sleep_for(std::min<Clock::duration>(left, kLook));
    }
}

void Player::stay() {
    windows_->drop_frames();
    while (!stop_ && !windows_->close_wanted()) {
        if (windows_->between_frames() && windows_->take_redraw()) refresh();
        std::this_thread::sleep_for(kLook);
    }
}

}  // namespace wall::wallplay
