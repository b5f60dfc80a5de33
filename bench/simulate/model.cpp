// SPDX-License-Identifier: MIT
#include "bench/simulate/model.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <queue>
#include <string>

namespace wall::simulate {
namespace {

/// Everything that a processor can work on, by its place in `Model::workers_`.
using WorkerIndex = std::uint32_t;

/// A part of a message that goes as one: through the sender's thread, the two links and the node's queue.
struct Piece {
    std::uint32_t program = 0, member = 0, frame = 0;
    NodeIndex node;
    double bytes = 0;
    Seconds send = 0, draw = 0;
};

/// Processors that are shared evenly: each of n tasks runs at rate min(1, processors / n). `clock_` is the work that a
/// task which was always there would have had done, so that a task ends at a fixed place on it.
class SharedProcessors {
public:
    explicit SharedProcessors(double processors) : processors_(processors) {}

    void add(WorkerIndex worker, Seconds work, Seconds now) {
        go_to(now);
        ends_.emplace(clock_ + work, worker);
    }
    /// When the next task ends, if nothing comes before.
    Seconds next_end(Seconds now) const {
        return ends_.empty() ? kUnlimited : std::max(now, at_ + (ends_.begin()->first - clock_) / rate());
    }
    WorkerIndex take_ended(Seconds now) {
        go_to(now);
        clock_ = std::max(clock_, ends_.begin()->first);  // rounding
        const WorkerIndex worker = ends_.begin()->second;
        ends_.erase(ends_.begin());
        return worker;
    }
    bool idle() const { return ends_.empty(); }
    Seconds worked() const { return worked_; }

private:
    double rate() const { return ends_.empty() ? 1 : std::min(1.0, processors_ / static_cast<double>(ends_.size())); }
    void go_to(Seconds now) {
        const Seconds done = (now - at_) * rate();
        clock_ += done;
        worked_ += done * static_cast<double>(ends_.size());
        at_ = now;
    }

    const double processors_;
    std::multimap<Seconds, WorkerIndex> ends_;
    Seconds clock_ = 0, at_ = 0, worked_ = 0;
};

/// One direction of a link. Things come in the order of their first bytes.
struct Link {
    Rate rate = kUnlimited;
    Seconds free_at = 0, busy = 0;

    struct Passed {
        Seconds first = 0, last = 0;
    };
    /// A piece of which the first byte is there at `first` and the last at `last`: when these are through.
    Passed pass(Passed came, double bytes) {
        const Seconds length = bytes / rate, begin = std::max(came.first, free_at);
        free_at = begin + length;
        busy += length;
        return {begin, std::max(came.last, free_at)};
    }
};

struct HostState {
    SharedProcessors processors;
    Link up, down;
    std::uint64_t version = 0;  ///< of what was said about when its next task ends
};

/// A thread that does one piece of work after the other.
struct Worker {
    enum class Kind { packs, sends, draws };
    Kind kind{};
    std::uint32_t host = 0;
    std::deque<Piece> queue = {};
    bool busy = false;
    std::uint32_t program = 0, member = 0;
};

/// A process that packs: where it is in its frame.
struct MemberState {
    WorkerIndex packs = 0, sends = 0;
    std::uint32_t frame = 0;    ///< that it packs, or waits to pack; from 1
    std::size_t next_step = 0;  ///< of `steps`
    bool packing = false;
    struct Step {
        double at = 0;  ///< share of the frame's packing after which it goes
        Piece piece;
    };
    std::vector<Step> steps = {};
};

/// What is still to be drawn of a frame.
struct FrameState {
    std::uint32_t members_to_begin = 0, members_to_pack = 0;
    std::uint64_t pieces_left = 0;
    Seconds begun = kUnlimited;
    std::map<NodeIndex, std::pair<std::uint64_t, Seconds>> nodes;  ///< pieces left and what ends the frame there
};

struct ProgramState {
    std::vector<MemberState> members;
    std::map<std::uint32_t, FrameState> open;  ///< frames that are on their way
    std::uint32_t drawn = 0;                   ///< all up to this one
    std::vector<Seconds> drawn_at;
    Seconds delays = 0;
    double bytes = 0;
};

struct Event {
    enum class Kind { host_ends_task, piece_at_switch, piece_arrives, frame_known };
    Seconds time = 0;
    std::uint64_t order = 0;  ///< of two at the same time
    Kind kind{};
    std::uint32_t host = 0;
    std::uint64_t version = 0;
    std::uint32_t program = 0;
    Piece piece = {};
    Seconds last = 0;  ///< when all of the piece is at the switch
};

struct Later {
    bool operator()(const Event& a, const Event& b) const {
        return a.time != b.time ? a.time > b.time : a.order > b.order;
    }
};

class Model {
public:
    explicit Model(const Scene& scene) : scene_(scene) {
        for (const Host& host : scene.hosts)
            hosts_.push_back({SharedProcessors(host.processors), {.rate = host.up}, {.rate = host.down}, 0});
        for (const std::uint32_t host : scene.nodes)
            node_workers_.push_back(add_worker({.kind = Worker::Kind::draws, .host = host}));
        for (std::uint32_t p = 0; p < scene.programs.size(); ++p) {
            auto& state = programs_.emplace_back();
            for (std::uint32_t m = 0; m < scene.programs[p].members.size(); ++m) {
                const auto host = scene.programs[p].members[m].host;
                const auto packs = add_worker({.kind = Worker::Kind::packs, .host = host, .program = p, .member = m});
                const auto sends = add_worker({.kind = Worker::Kind::sends, .host = host, .program = p, .member = m});
                state.members.push_back({.packs = packs, .sends = sends});
            }
        }
    }

    Figures run() {
        for (std::uint32_t p = 0; p < programs_.size(); ++p)
            for (std::uint32_t m = 0; m < programs_[p].members.size(); ++m) begin_frame(p, m);
        while (!events_.empty()) {
            const Event event = events_.top();
            events_.pop();
            now_ = event.time;
            ++count_;
            switch (event.kind) {
                case Event::Kind::host_ends_task:
                    if (event.version == hosts_[event.host].version) task_ended(event.host);
                    break;
                case Event::Kind::piece_at_switch: passes_switch(event); break;
                case Event::Kind::piece_arrives: arrives(event.piece); break;
                case Event::Kind::frame_known: may_go_on(event.program); break;
            }
        }
        return figures();
    }

private:
    WorkerIndex add_worker(Worker worker) {
        workers_.push_back(std::move(worker));
        return static_cast<WorkerIndex>(workers_.size() - 1);
    }
    void at(Seconds time, Event event) {
        event.time = time;
        event.order = ++order_;
        events_.push(std::move(event));
    }

    // ---- processors ----

    std::uint32_t processors_of(std::uint32_t host) const { return scene_.hosts[host].runs_on.value_or(host); }
    void work(WorkerIndex worker, Seconds amount) {
        const auto host = processors_of(workers_[worker].host);
        workers_[worker].busy = true;
        hosts_[host].processors.add(worker, amount, now_);
        say_next_end(host);
    }
    void say_next_end(std::uint32_t host) {
        HostState& state = hosts_[host];
        ++state.version;
        if (state.processors.idle()) return;
        at(state.processors.next_end(now_),
           {.kind = Event::Kind::host_ends_task, .host = host, .version = state.version});
    }
    void task_ended(std::uint32_t host) {
        const WorkerIndex index = hosts_[host].processors.take_ended(now_);
        say_next_end(host);
        Worker& worker = workers_[index];
        worker.busy = false;
        switch (worker.kind) {
            case Worker::Kind::packs: packed(worker.program, worker.member); break;
            case Worker::Kind::sends: sent(worker); break;
            case Worker::Kind::draws: drawn(worker); break;
        }
        if (worker.kind != Worker::Kind::packs) next_piece(index);
    }
    void next_piece(WorkerIndex index) {
        Worker& worker = workers_[index];
        if (worker.busy || worker.queue.empty()) return;
        const Piece& piece = worker.queue.front();
        work(index, worker.kind == Worker::Kind::sends ? piece.send : piece.draw + end_of_frame(piece));
    }
    void add_piece(WorkerIndex index, const Piece& piece) {
        workers_[index].queue.push_back(piece);
        next_piece(index);
    }

    // ---- programs ----

    const Frame& frame_of(std::uint32_t program, std::uint32_t member, std::uint32_t frame) const {
        const auto& frames = scene_.programs[program].members[member].frames;
        return frames[(frame - 1) % frames.size()];
    }

    void begin_frame(std::uint32_t p, std::uint32_t m) {
        ProgramState& program = programs_[p];
        MemberState& member = program.members[m];
        const std::uint32_t next = member.frame + 1;
        if (member.packing || next > scene_.frames || next > program.drawn + scene_.programs[p].ahead) return;
        const auto [at, is_new] = program.open.try_emplace(next);
        FrameState& open = at->second;
        if (is_new) open.members_to_begin = open.members_to_pack = static_cast<std::uint32_t>(program.members.size());
        --open.members_to_begin;
        open.begun = std::min(open.begun, now_);
        member.frame = next;
        member.packing = true;
        member.next_step = 0;
        plan(p, m, open);
        pack_on(p, m);
    }

    /// When which piece of each message is packed: a piece of the usual size as soon as there is one, the rest in the
    /// end.
    void plan(std::uint32_t p, std::uint32_t m, FrameState& open) {
        MemberState& member = programs_[p].members[m];
        const Frame& frame = frame_of(p, m, member.frame);
        double all_bytes = 0;
        for (const Message& message : frame.messages) all_bytes += message.bytes;
        programs_[p].bytes += all_bytes;
        member.steps.clear();
        for (const Message& message : frame.messages) {
            const auto pieces = std::max(1.0, std::ceil(message.bytes / scene_.piece));
            const double send = all_bytes > 0 ? frame.send * message.bytes / all_bytes
                                              : frame.send / static_cast<double>(frame.messages.size());
            for (double i = 1; i <= pieces; ++i)
                member.steps.push_back(
                    {i / pieces,
                     {p, m, member.frame, message.node, message.bytes / pieces, send / pieces, message.draw / pieces}});
            auto& [left, finish] = open.nodes[message.node];
            left += static_cast<std::uint64_t>(pieces);
            finish = std::max(finish, message.finish);
            open.pieces_left += static_cast<std::uint64_t>(pieces);
        }
        std::ranges::stable_sort(member.steps, {}, &MemberState::Step::at);
    }

    /// Up to the next place in the frame at which something is sent.
    void pack_on(std::uint32_t p, std::uint32_t m) {
        const MemberState& member = programs_[p].members[m];
        const double done = member.next_step == 0 ? 0 : member.steps[member.next_step - 1].at;
        const double next = member.next_step < member.steps.size() ? member.steps[member.next_step].at : 1;
        work(member.packs, frame_of(p, m, member.frame).pack * (next - done));
    }

    void packed(std::uint32_t p, std::uint32_t m) {
        MemberState& member = programs_[p].members[m];
        if (member.next_step < member.steps.size()) {
            const double at = member.steps[member.next_step].at;
            while (member.next_step < member.steps.size() && member.steps[member.next_step].at == at)
                add_piece(member.sends, member.steps[member.next_step++].piece);
            if (member.next_step < member.steps.size()) return pack_on(p, m);
        }
        member.packing = false;
        --programs_[p].open.at(member.frame).members_to_pack;
        look_for_end(p, member.frame);
        begin_frame(p, m);
    }

    // ---- links ----

    void sent(Worker& worker) {
        const Piece piece = worker.queue.front();
        worker.queue.pop_front();
        if (worker.host == scene_.nodes[piece.node]) return arrives(piece);
        const auto [first, last] = hosts_[worker.host].up.pass({now_, now_}, piece.bytes);
        at(first, {.kind = Event::Kind::piece_at_switch, .piece = piece, .last = last});
    }
    void passes_switch(const Event& event) {
        Link& down = hosts_[scene_.nodes[event.piece.node]].down;
        const Seconds there = down.pass({now_, event.last}, event.piece.bytes).last;
        at(there + scene_.latency, {.kind = Event::Kind::piece_arrives, .piece = event.piece});
    }

    // ---- nodes ----

    void arrives(const Piece& piece) { add_piece(node_workers_[piece.node], piece); }

    /// What a node has to do besides when the piece is the last one of its frame there. Each member sends something.
    Seconds end_of_frame(const Piece& piece) const {
        const FrameState& frame = programs_[piece.program].open.at(piece.frame);
        const auto& [left, finish] = frame.nodes.at(piece.node);
        return left == 1 && frame.members_to_begin == 0 ? finish : 0;
    }
    void drawn(Worker& worker) {
        const Piece piece = worker.queue.front();
        worker.queue.pop_front();
        FrameState& frame = programs_[piece.program].open.at(piece.frame);
        --frame.nodes.at(piece.node).first;
        --frame.pieces_left;
        look_for_end(piece.program, piece.frame);
    }

    void look_for_end(std::uint32_t p, std::uint32_t number) {
        ProgramState& program = programs_[p];
        const auto found = program.open.find(number);
        if (found == program.open.end()) return;
        const FrameState& frame = found->second;
        if (frame.members_to_pack != 0 || frame.pieces_left != 0) return;
        program.delays += now_ - frame.begun;
        program.open.erase(found);
        program.drawn_at.push_back(now_);
        program.drawn = number;
        at(now_ + scene_.latency, {.kind = Event::Kind::frame_known, .program = p});
    }
    void may_go_on(std::uint32_t p) {
        for (std::uint32_t m = 0; m < programs_[p].members.size(); ++m) begin_frame(p, m);
    }

    // ---- the end ----

    Figures figures() const {
        Figures out{.programs = {}, .hosts = {}, .time = now_, .events = count_};
        for (const ProgramState& program : programs_) {
            const auto& at = program.drawn_at;
            ProgramFigures figures;
            const std::size_t first = scene_.warm_up - 1, last = at.size() - 1;
            figures.frames_per_second = static_cast<double>(last - first) / std::max(1e-12, at[last] - at[first]);
            for (std::size_t i = first + 1; i <= last; ++i)
                figures.longest = std::max(figures.longest, at[i] - at[i - 1]);
            figures.delay = program.delays / static_cast<double>(at.size());
            figures.bytes_per_frame = program.bytes / static_cast<double>(at.size());
            out.programs.push_back(figures);
        }
        for (std::size_t h = 0; h < hosts_.size(); ++h) {
            const HostState& host = hosts_[h];
            const Seconds all = std::max(1e-12, now_);
            out.hosts.push_back({host.processors.worked() / (all * scene_.hosts[h].processors), host.up.busy / all,
                                 host.down.busy / all});
        }
        return out;
    }

    const Scene& scene_;
    std::vector<HostState> hosts_;
    std::vector<Worker> workers_;
    IdVector<NodeIndex, WorkerIndex> node_workers_;
    std::vector<ProgramState> programs_;
    std::priority_queue<Event, std::vector<Event>, Later> events_;
    Seconds now_ = 0;
    std::uint64_t order_ = 0, count_ = 0;
};

constexpr double kMostPieces = 1e6;  // of a message

/// At least 0, and not beyond all bounds.
bool is_amount(double value) { return value >= 0 && value < kUnlimited; }

Result<void> check(const Scene& scene) {
    if (scene.warm_up < 1 || scene.frames <= scene.warm_up)
        return fail("frames: " + std::to_string(scene.frames) + ", expected more than warm_up, which is at least 1");
    if (!is_amount(scene.latency)) return fail("latency: expected seconds, at least 0");
    if (!(scene.piece > 0)) return fail("piece: expected bytes, more than 0");
    for (std::size_t i = 0; i < scene.hosts.size(); ++i) {
        const Host& host = scene.hosts[i];
        const std::string where = "host " + std::to_string(i) + ": ";
        if (host.runs_on && (*host.runs_on >= scene.hosts.size() || scene.hosts[*host.runs_on].runs_on))
            return fail(where + "runs_on: expected a host with processors of its own");
        if (!(host.processors > 0)) return fail(where + "processors: expected more than 0");
        if (!(host.up > 0) || !(host.down > 0)) return fail(where + "up, down: expected bytes a second, more than 0");
    }
    for (const NodeIndex node : scene.nodes.ids())
        if (scene.nodes[node] >= scene.hosts.size())
            return fail("node " + std::to_string(node.value) + ": there is no host " +
                        std::to_string(scene.nodes[node]));
    for (std::size_t p = 0; p < scene.programs.size(); ++p) {
        const Program& program = scene.programs[p];
        const std::string where = "program " + std::to_string(p) + ": ";
        if (program.members.empty()) return fail(where + "expected a member at least");
        if (program.ahead < 1) return fail(where + "ahead: expected 1 at least");
        for (const Member& member : program.members) {
            if (member.host >= scene.hosts.size())
                return fail(where + "there is no host " + std::to_string(member.host));
            if (member.frames.empty()) return fail(where + "expected a frame at least");
            for (const Frame& frame : member.frames) {
                if (!is_amount(frame.pack) || !is_amount(frame.send))
                    return fail(where + "pack, send: expected seconds, at least 0");
                for (const Message& message : frame.messages) {
                    if (!scene.nodes.contains(message.node))
                        return fail(where + "there is no node " + std::to_string(message.node.value));
                    if (!is_amount(message.bytes) || !is_amount(message.draw) || !is_amount(message.finish))
                        return fail(where + "bytes, draw, finish: expected amounts, at least 0");
                    if (message.bytes > kMostPieces * scene.piece)
                        return fail(where + "bytes: expected at most a million pieces");
                }
            }
        }
    }
    return {};
}

}  // namespace

Result<Figures> simulate(const Scene& scene) {
    if (auto good = check(scene); !good) return tl::unexpected(good.error());
    return Model(scene).run();
}

}  // namespace wall::simulate
