// SPDX-License-Identifier: MIT
#include "tools/wallctl/record_commands.h"

#include <chrono>
#include <iomanip>
#include <iostream>

#include "common/json/parse_json.h"
#include "common/net/base64.h"
#include "common/recording/stream_watch.h"
#include "common/recording/writer.h"
#include "gen/glapi/wire.gen.h"
#include "tools/wallctl/interrupts.h"
#include "tools/wallctl/recording_node.h"

namespace wall::wallctl {
namespace {

using Clock = std::chrono::steady_clock;
using request::Answer;
using request::failed;
using request::Failure;
using request::Outcome;

constexpr std::chrono::milliseconds kAnswerLimit{10'000}, kTurn{20};
constexpr std::chrono::seconds kFirstCommands{10};  // a program comes to a node between two frames

/// A program's stream on its way into the file.
class Tape {
public:
    explicit Tape(const CommandRecording& recording) : recording_(recording) {}

    Result<void> begin(const std::string& program) {
        const auto now = std::chrono::system_clock::now().time_since_epoch();
        auto writer = recording::Writer::create(recording_.file,
                                                {.stream = glapi::kStreamVersion,
                                                 .started = std::chrono::duration_cast<std::chrono::microseconds>(now),
                                                 .program = program,
                                                 .creator = "WallGL " WALLGL_VERSION});
        if (!writer) return tl::unexpected(writer.error());
        writer_.emplace(std::move(*writer));
        begun_ = Clock::now();
        return {};
    }
    Result<void> begin_segment() {
        segment_begun_ = Clock::now();
        asked_ = false;
        return writer_->begin_segment(time(), watch_.frames());
    }
    Result<std::vector<std::byte>> add(std::span<const std::byte> payload) {
        const auto seen = watch_.look(payload);
        if (!seen) return fail("the program has sent what is no batch: " + seen.error().message);
        if (auto added = writer_->add_batch(payload, time()); !added) return tl::unexpected(added.error());
        if (seen->begins_again)
            if (auto begun = begin_segment(); !begun) return tl::unexpected(begun.error());
        std::vector<std::byte> out;
        for (const auto& swap : seen->swaps) {
            const std::uint32_t words[] = {swap.surface.value, swap.frame};
            const auto frame = wire::whole_frame(wire::FrameKind::swap_done, std::as_bytes(std::span(words)));
            out.insert(out.end(), frame.begin(), frame.end());
        }
        return out;
    }
    /// Once, when the segment has become as long as one should be.
    bool wants_snapshot() {
        const std::chrono::duration<double> length = Clock::now() - segment_begun_;
        if (asked_ || writer_->segments() == 0 || length.count() < recording_.snapshot) return false;
        return asked_ = true;
    }
    Result<void> finish() {
        return writer_->finish({.frames = watch_.frames(), .segments = {}, .windows = watch_.windows()});
    }
    bool is_over() const { return std::chrono::duration<double>(Clock::now() - begun_).count() >= recording_.seconds; }
    bool has_begun() const { return writer_->segments() != 0; }

    void say() const {
        std::cerr << "\rrecording: " << std::fixed << std::setprecision(1) << seconds() << " of " << recording_.seconds
                  << " s, " << watch_.frames() << " frames, " << static_cast<double>(writer_->bytes()) / 1e6 << " MB"
                  << std::flush;
    }
    nlohmann::json summary() const {
        auto windows = nlohmann::json::array();
        for (const auto& window : watch_.windows())
            windows.push_back({{"width", window.width}, {"height", window.height}});
        return {{"file", recording_.file},
                {"frames", watch_.frames()},
                {"bytes", writer_->bytes()},
                {"plain_bytes", writer_->batch_bytes()},
                {"segments", writer_->segments()},
                {"seconds", seconds()},
                {"windows", windows}};
    }

private:
    recording::Time time() const { return std::chrono::duration_cast<recording::Time>(Clock::now() - begun_); }
    double seconds() const { return std::chrono::duration<double>(time()).count(); }

    const CommandRecording& recording_;
    recording::StreamWatch watch_;
    std::optional<recording::Writer> writer_;
    Clock::time_point begun_, segment_begun_;
    bool asked_ = false;
};

/// Of the program that is recorded: {"program", ...}, for the file's header.
Outcome<std::string> program_of(const request::Walld& walld, const std::string& session) {
    const auto answer = request::ask(walld, "session", {{"id", session}}, kAnswerLimit);
    if (!answer) return tl::unexpected(answer.error());
    return answer->json.value("program", std::string());
}

/// walld's answer to who wants to record: the ticket that the program will show.
Outcome<std::string> ticket_of(net::ControlClient& walld) {
    const auto answer = walld.receive(kAnswerLimit);
    if (!answer) return tl::unexpected<Failure>({"unavailable", answer.error().message});
    if (answer->has_refused())
        return tl::unexpected<Failure>({"forbidden", "walld refused: " + answer->refused().reason()});
    const auto& reply = answer->operator_reply();
    if (!reply.ok()) return tl::unexpected<Failure>({reply.code(), reply.error()});
    const auto json = parse_json(reply.json(), kAnswerJson);
    if (!json) return failed("walld's answer: " + json.error().message);
    const auto secret = net::from_base64(json->value("ticket", std::string()));
    return std::string(reinterpret_cast<const char*>(secret.data()), secret.size());
}

/// Why walld ends the recording, if it has.
std::optional<std::string> ended_by(net::ControlClient& walld) {
    const auto message = walld.poll(std::chrono::milliseconds(0));
    if (!message) return "walld has gone: " + message.error().message;
    if (!*message) return std::nullopt;
    return (*message)->operator_reply().error();
}

}  // namespace

Outcome<Answer> record_commands(const request::Walld& walld, const CommandRecording& recording) {
    Tape tape(recording);
    auto node = RecordingNode::listen({.begins = [&] { return tape.begin_segment(); },
                                       .batch = [&](std::span<const std::byte> payload) { return tape.add(payload); }});
    if (!node) return failed(node.error().message);
    const auto program = program_of(walld, recording.session);
    if (!program) return tl::unexpected(program.error());
    auto link = request::subscribe(walld, "record", {{"id", recording.session}, {"address", node->address()}});
    if (!link) return tl::unexpected(link.error());
    auto ticket = ticket_of(*link);
    if (!ticket) return tl::unexpected(ticket.error());
    node->expect(std::move(*ticket));
    if (auto begun = tape.begin(*program); !begun) return failed(begun.error().message);
    watch_for_interrupts();
    const auto begin = Clock::now();
    auto next_word = begin + std::chrono::seconds(1);
    std::string ended = "time";
    Result<void> done;
    while (!tape.is_over()) {
        if (done = node->serve(kTurn); !done) break;
        if (interrupted()) ended = "interrupted";
        else if (const auto why = ended_by(*link)) ended = *why;
        if (ended != "time") break;
        if (!tape.has_begun() && Clock::now() > begin + kFirstCommands)
            return failed("the program has not come within " + std::to_string(kFirstCommands.count()) +
                          " s: does it draw, and on this machine?");
        if (tape.wants_snapshot()) node->ask_to_begin_again();
        if (recording.progress && Clock::now() >= next_word) tape.say(), next_word += std::chrono::seconds(1);
    }
    if (recording.progress) tape.say(), std::cerr << '\n';
    auto finished = tape.finish();
    if (!done || !finished) return failed((done ? finished : done).error().message);
    auto summary = tape.summary();
    summary["ended"] = ended;
    return Answer{std::move(summary), {}};
}

}  // namespace wall::wallctl
