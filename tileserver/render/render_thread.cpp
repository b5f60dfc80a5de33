// SPDX-License-Identifier: MIT
#include "tileserver/render/render_thread.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <deque>
#include <future>
#include <map>
#include <optional>
#include <utility>

#include "common/wire/batch.h"
#include "tileserver/execute/executor.h"
#include "tileserver/render/continued.h"
#include "tileserver/render/driver_wait.h"
#include "tileserver/render/frame_limit.h"
#include "tileserver/render/pace.h"
#include "tileserver/render/tile_watches.h"

namespace wall::tileserver {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

/// A stream that had a turn so short a time ago may want the next one soon.
constexpr auto kActive = 100ms;
/// Within it walld says whether a program has ended whose connection was closed.
constexpr auto kUntilWalldSays = 1s;
constexpr auto kStatsInterval = 1s;
constexpr auto kReadbackPoll = 1ms;
constexpr auto kLongestNap = 100ms;  // also until an event of an X server or a monitor is seen

/// Ends a frame, or moves a surface: the frame before must be shown first.
bool needs_shown_frame(std::span<const std::byte> payload) {
    const auto batch = wire::split_batch(payload);
    const auto has = [&](glapi::Op op) {
        return std::memchr(batch->opcodes.data(), static_cast<int>(op), batch->opcodes.size()) != nullptr;
    };
    return batch && !batch->opcodes.empty() && (has(glapi::Op::Swap) || has(glapi::Op::SurfacePlace));
}

}  // namespace

/// Everything that lives in the render thread.
class RenderThread::Loop {
public:
    /// `screens`: that the tiles are shown on; `trials`: of shaders; null: none.
    Loop(const Gl& gl, NodeEvents& events, TurnBoard& board, TileScreens* screens, CompileTrials* trials,
         PartialBox& partials)
        : events_(events), board_(board), driver_(gl), node_(driver_), compositor_(node_, [this](const StackEntry& e) {
              return find(e);
          }) {
        node_.present_at_once = true;
        node_.trials = trials;
        node_.partials = &partials;
        if (screens != nullptr)
            output_.emplace(node_, compositor_, *screens,
                            ScreenOutput::Events{[this](const ScaledTile& tile) { events_.scaled(tile); },
                                                 [this](const MonitorNews& news) { events_.monitor(news); }});
    }

    class Stream final : public SessionOutput {
    public:
        Stream(Loop& loop, StreamId id, SessionId session, std::shared_ptr<BatchQueue> queue,
               std::shared_ptr<ParallelGroup> group, Rank rank)
            : loop_(loop),
              id_(id),
              queue_(std::move(queue)),
              group_(std::move(group)),
              session_(loop.driver_, session, group_.get(), rank),
              executor_(loop.node_, session_, *this) {}
        ~Stream() override { loop_.node_.ended += session_.work; }
        void reply(RequestId request, std::vector<std::byte> answer) override {
            loop_.events_.reply(id_, request, std::move(answer));
        }
        void frame_rendered(SurfaceId surface, std::uint32_t frame) override {
            frame_ended(surface);
            loop_.events_.drawn(id_, surface, frame);
            loop_.events_.rendered(session_.id(), surface, frame);
        }
        void partial(NodeIndex to, std::vector<std::byte> message) override {
            loop_.events_.partial(session_.id(), to, std::move(message));
        }
        void frame_ended(SurfaceId surface) { frame_limit_.frame(surface, Clock::now()); }

        /// A finished frame has not been shown yet.
        bool frame_waits() const {
            bool waits = false;
            session_.for_each_surface(
                [&](SurfaceId, const SurfaceReplica& surface) { waits = waits || surface.waiting_frame(); });
            return waits;
        }
        /// The others of its parallel program must come first.
        bool held() const { return group_ && group_->sync.waits(session_.rank()); }
        /// The turns of one round, as many as its weight says: what is less than one is saved up. True: there may be
        /// more to do at once.
        bool run_turns(Clock::time_point& now, bool contended) {
            if (now < frame_limit_.pause_until() || lingers()) return false;
            turns_ = contended ? std::min(turns_ + weight_, std::max(1.0, weight_)) : 1.0;
            if (turns_ < 1.0) return batch_ || (!failed_ && !held() && queue_->front() != nullptr);
            bool worked = false;
            for (; turns_ >= 1.0 && now >= frame_limit_.pause_until() && run_turn(now, contended); turns_ -= 1.0)
                worked = true;
            return worked;
        }
        void set_quota(const SessionQuota& quota) {
            weight_ = quota.weight;
            pace_.set_weight(quota.weight);
            session_.objects.set_limits(quota.most_bytes, quota.most_objects);
            const auto pixels =
                std::min(kMaxLayerPixels, static_cast<std::int64_t>(quota.most_bytes) / kLayerPixelBytes);
            session_.set_most_pixels(pixels);
            if (group_) group_->set_most_pixels(pixels);
            frame_limit_.set_interval(quota.frame_interval);
        }
        /// True: a batch was executed, or some of it. `now` is the time, before and after. `contended`: others want
        /// turns, too.
        bool run_turn(Clock::time_point& now, bool contended) {
            if (failed_ || executor_.waits() || (contended && !pace_.may_run(now)) || !next_batch()) return false;
            const auto start = now;
            const auto continued_before = continued::count();
            const auto render_before = session_.work.render;
            loop_.board_.begin({id_, session_.id(), start});
            const auto done = executor_.run_slice({start + Pace::kTurn, pace_.commands(contended)});
            if (!done) fail(done.error().message);
            if (!done || *done) {
                queue_->give_back(std::move(*batch_));
                batch_.reset();
            }
            // Whether or not the batch is at its end: the slice may be over behind its last command, and whoever that
            // has set free draws the next frame over this one.
            if (group_) loop_.pass_on_group_frames(*this);
            last_run_ = now = Clock::now();
            if (continued::count() == continued_before) {
                session_.work.decode += now - start - (session_.work.render - render_before);
                if (pace_.spend(now - start, executor_.told(), contended)) wait_for_driver(now, contended);
            }
            loop_.board_.end();
            return true;
        }
        bool active(Clock::time_point now) const {
            const bool pauses = executor_.waits() || now < frame_limit_.pause_until();
            return !failed_ && !lingers() && ((batch_ && !pauses) || now - last_run_ < kActive);
        }
        /// How long it has to wait for its next turn at least.
        Clock::duration delay(Clock::time_point now) const {
            return failed_ ? Clock::duration::zero() : std::max(pace_.not_before(), frame_limit_.pause_until()) - now;
        }
        void fail(std::string reason) {
            failed_ = true;
            if (group_) loop_.end_others(*this, "rank " + std::to_string(session_.rank()) + ": " + reason);
            loop_.events_.failed(id_, session_.id(), std::move(reason));
        }
        /// Without a fault of its own.
        void end(std::string reason) {
            failed_ = true;
            loop_.events_.ended(id_, std::move(reason));
        }
        /// Its connection is closed.
        void close() { closed_ = Clock::now(); }
        /// Nothing of it is left to be executed, or shown.
        bool over(Clock::time_point now) const {
            if (failed_ || !closed_) return failed_;
            return group_ ? !batch_ && queue_->front() == nullptr : !stays_in_sight(now);
        }
        bool lingers() const { return closed_ && !group_; }
        bool has_shown() const {
            bool shown = false;
            session_.for_each_surface(
                [&](SurfaceId, const SurfaceReplica& surface) { shown = shown || surface.shows_something(); });
            return shown;
        }
        bool failed() const { return failed_; }
        const std::shared_ptr<ParallelGroup>& group() const { return group_; }
        SessionStats stats() const {
            const auto& objects = session_.objects;
            return {session_.id(), session_.rank(), session_.work, queue_->bytes(), objects.bytes(), objects.size()};
        }
        SessionReplica& session() { return session_; }
        Executor& executor() { return executor_; }

    private:
        /// What is measured while the process is stopped says nothing.
        void wait_for_driver(Clock::time_point& now, bool contended) {
            const auto continued_before = continued::count();
            if (contended || !pace_.driver_keeps_up()) driver_wait_.finish();
            else driver_wait_.finish_before();
            const auto before = std::exchange(now, Clock::now());
            last_run_ = now;
            if (continued::count() != continued_before) return;
            pace_.finished(now - before, now);
            session_.work.render += now - before;
        }
        /// True: there is one to go on with.
        bool next_batch() {
            if (batch_) return true;
            if (held() || !question_answered()) return false;
            const RawBytes* next = queue_->front();
            if (next == nullptr || (needs_shown_frame(*next) && frame_waits())) return false;
            batch_ = queue_->pop();
            if (auto started = executor_.start_batch(*batch_); !started) fail(started.error().message);
            return !failed_;
        }
        /// If only the link was lost, the program comes again. Until walld says that it has ended, or what it sends
        /// anew is shown, its pictures stay. Nobody says so while walld is away.
        bool stays_in_sight(Clock::time_point now) const {
            if (loop_.node_.present_at_once) return false;
            if (now - *closed_ < kUntilWalldSays || loop_.node_.returning.contains(session_.id())) return true;
            const Stream* next = loop_.open_stream(session_.id());
            return next != nullptr && !next->has_shown();
        }
        bool question_answered() {
            const auto answered = executor_.pursue_question();
            if (!answered) fail(answered.error().message);
            return answered && *answered;
        }

        Loop& loop_;
        StreamId id_;
        std::shared_ptr<BatchQueue> queue_;
        std::shared_ptr<ParallelGroup> group_;
        std::optional<RawBytes> batch_;  // that is being executed
        SessionReplica session_;
        Executor executor_;
        Pace pace_;
        FrameLimit frame_limit_;
        DriverWait driver_wait_{loop_.driver_.gl()};
        Clock::time_point last_run_{};
        double weight_ = 1.0, turns_ = 0.0;  // turns a round; those that are left of this one
        bool failed_ = false;
        std::optional<Clock::time_point> closed_;
    };

    /// The newest that shows something.
    const SurfaceReplica* find(const StackEntry& entry) {
        const SurfaceReplica* found = nullptr;
        for (auto& [id, stream] : streams_)
            if (stream->session().id() == entry.session)
                if (const SurfaceReplica* surface = stream->session().surface(entry.surface);
                    surface != nullptr && (found == nullptr || surface->shows_something()))
                    found = surface;
        return found;
    }
    /// Of a program alone: the last of its streams that is not closed.
    const Stream* open_stream(SessionId session) const {
        const Stream* found = nullptr;
        for (const auto& [id, stream] : streams_)
            if (stream->session().id() == session && !stream->lingers()) found = stream.get();
        return found;
    }

    /// True: there may be more to do at once.
    bool round() {
        bool worked = false;
        auto now = Clock::now();
        const auto active = std::ranges::count_if(streams_, [now](const auto& e) { return e.second->active(now); });
        for (auto& [id, stream] : streams_) worked |= stream->run_turns(now, active > (stream->active(now) ? 1 : 0));
        worked |= remove_ended();
        check_driver();
        show();
        request_pictures();
        for (Picture& picture : compositor_.collect(false)) events_.picture(std::move(picture));
        report();
        return worked;
    }
    void add(StreamId id, SessionId session, std::shared_ptr<BatchQueue> queue, const Membership& membership,
             Rank rank) {
        std::shared_ptr<ParallelGroup> group;
        for (auto& [other, stream] : streams_)
            if (stream->session().id() == session && !stream->failed() && stream->group()) group = stream->group();
        if (!group && membership.members != 0) group = std::make_shared<ParallelGroup>(driver_, membership);
        auto& stream =
            *streams_
                 .emplace(id, std::make_unique<Stream>(*this, id, session, std::move(queue), std::move(group), rank))
                 .first->second;
        if (const auto quota = quotas_.find(session); quota != quotas_.end()) stream.set_quota(quota->second);
    }
    void set_quota(SessionId session, const SessionQuota& quota) {
        quotas_[session] = quota;
        for (auto& [id, stream] : streams_)
            if (stream->session().id() == session) stream->set_quota(quota);
    }
    void remove_session(SessionId session) {
        quotas_.erase(session);
        node_.partials->forget(session);
        node_.damage +=
            std::erase_if(streams_, [session](const auto& entry) { return entry.second->session().id() == session; });
    }
    /// What a parallel program's stream has set free.
    void pass_on_group_frames(Stream& stream) {
        for (const auto& [surface, frame] :
             stream.group()->finish_frames(node_, stream.session().work, stream.session().id())) {
            for (auto& [id, member] : streams_)
                if (member->group() == stream.group() && !member->failed()) {
                    member->frame_ended(surface);
                    events_.drawn(id, surface, frame);
                }
            events_.rendered(stream.session().id(), surface, frame);
        }
        if (auto reason = stream.failed() ? std::nullopt : stream.group()->sync.deadlock())
            stream.fail(std::move(*reason));
    }
    void end_others(Stream& stream, const std::string& reason) {
        for (auto& [id, member] : streams_)
            if (member.get() != &stream && member->group() == stream.group() && !member->failed()) member->end(reason);
    }
    /// True: others may go on without what has ended.
    bool remove_ended() {
        bool removed = false;
        const auto now = Clock::now();
        for (auto at = streams_.begin(); at != streams_.end();) {
            Stream& stream = *at->second;
            if (!stream.over(now)) {
                ++at;
                continue;
            }
            removed = true;
            ++node_.damage;
            if (const Rank rank = stream.session().rank();
                !stream.failed() && stream.group() && !stream.group()->sync.left(rank))
                end_others(stream, "rank " + std::to_string(rank) + " of the parallel program is gone");
            at = streams_.erase(at);
        }
        return removed;
    }
    /// Frames that wait for a word that will not come.
    void show_uncoordinated() {
        for (auto& [id, stream] : streams_) {
            const auto session = stream->session().id();
            stream->session().for_each_surface([&](SurfaceId surface_id, SurfaceReplica& surface) {
                if (surface.waiting_frame() && node_.shows_at_once(session, surface_id))
                    stream->executor().present(surface_id, *surface.waiting_frame());
            });
        }
    }
    void report_frames(SessionId session) {
        for (const auto& [id, stream] : streams_) {
            const auto its = stream->session().id();
            if (stream->failed() || (session && its != session)) continue;
            stream->session().for_each_surface([&](SurfaceId surface, const SurfaceReplica& s) {
                const auto drawn = s.waiting_frame().value_or(s.shown_frame());
                if (drawn > 0) events_.frames(its, surface, drawn, s.shown_frame());
            });
        }
    }
    /// How long it may sleep when there is nothing to do.
    Clock::duration nap() const {
        if (compositor_.busy() || compositor_.full()) return kReadbackPoll;
        const auto now = Clock::now();
        if (!asked_.empty()) return {};
        auto due = std::min<Clock::duration>(kLongestNap, watches_.next_due(node_.damage, now));
        for (const auto& [id, stream] : streams_)
            if (const auto delay = stream->delay(now); delay > Clock::duration::zero()) due = std::min(due, delay);
        return output_ ? std::min(due, output_->next_due(now)) : due;
    }
    /// A tile's picture, once: of this moment, before the frames that walld presents later, since the nodes' pictures
    /// are put together and must not cut a moving window apart. Only where too many are on their way, it comes later.
    void ask(const PictureRequest& request) {
        if (asked_.empty() && !compositor_.full()) compositor_.request(request);
        else asked_.push_back(request);
    }
    /// Without the screens that it was to draw on.
    bool lost() const { return lost_; }

    NodeEvents& events_;
    TurnBoard& board_;
    Driver driver_;
    RenderNode node_;
    Compositor compositor_;
    std::optional<ScreenOutput> output_;  // none: all tiles are headless
    TileWatches watches_;
    std::map<StreamId, std::unique_ptr<Stream>> streams_;  // after what their sessions use to the end

private:
    /// A few in each round: drawing goes on, however many are wanted.
    void request_pictures() {
        for (std::size_t i = 0; i < Compositor::kMostAtOnce && !compositor_.full(); ++i) {
            if (!asked_.empty()) {
                compositor_.request(asked_.front());
                asked_.pop_front();
                continue;
            }
            const auto due = watches_.due(node_.damage, Clock::now(), 1);
            if (due.empty()) return;
            compositor_.request(due.front());
        }
    }
    void show() {
        if (!output_) return;
        auto shown = output_->show(Clock::now());
        if (shown) return;
        lost_ = true;
        events_.output_lost(std::move(shown.error().message));
    }
    /// After a reset all that the driver had is gone, and its calls do nothing. Clients can send all of it again, to
    /// the process that is started in this one's place.
    void check_driver() {
        const char* reset = driver_.reset();
        if (reset == nullptr || lost_) return;
        lost_ = true;
        events_.output_lost(std::string("the driver has reset its context: ") + reset);
    }
    void report() {
        const auto now = Clock::now();
        node_.tile_times.tick(now);
        if (now < next_stats_) return;
        next_stats_ = now + kStatsInterval;
        RenderStats stats{node_.ended, {}, *driver_.gl().objects, node_.tile_times.all()};
        for (const auto& [id, stream] : streams_) stats.work += stats.sessions.emplace_back(stream->stats()).work;
        events_.stats(stats);
    }

    std::map<SessionId, SessionQuota> quotas_;
    std::deque<PictureRequest> asked_;
    Clock::time_point next_stats_ = Clock::now() + kStatsInterval;
    bool lost_ = false;
};

Result<std::unique_ptr<RenderThread>> RenderThread::start(BackendChoice backend, NodeEvents& events,
                                                          ScreenRequest screens, const CompilerHost* compilers) {
    const auto open = [backend, screens = std::move(screens)] {
        if (!screens.monitors.wishes.empty()) return open_kms_backend(screens.monitors);
        return screens.windows.windows.empty() ? open_backend(backend) : open_window_backend(screens.windows);
    };
    return start(open, std::move(backend.name), events, compilers);
}

Result<std::unique_ptr<RenderThread>> RenderThread::start(OpenBackend open, std::string name, NodeEvents& events,
                                                          const CompilerHost* compilers) {
    std::unique_ptr<RenderThread> thread(new RenderThread(events));
    if (compilers != nullptr)
        thread->trials_ = std::make_unique<CompileTrials>(*compilers, [self = thread.get()] { self->wake(); });
    std::promise<Result<Started>> promise;
    auto future = promise.get_future();
    thread->thread_ =
        std::thread([&promise, self = thread.get(), open = std::move(open), name = std::move(name)]() mutable {
            self->run(open, std::move(name),
                      [&promise](Result<Started> started) { promise.set_value(std::move(started)); });
        });
    auto started = future.get();
    if (!started) return tl::unexpected(started.error());
    thread->started_ = std::move(*started);
    return thread;
}

RenderThread::~RenderThread() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_one();
    if (thread_.joinable()) thread_.join();
}

void RenderThread::run(const OpenBackend& open, std::string backend_name,
                       const std::function<void(Result<Started>)>& started) {
    auto backend = open();
    if (!backend) return started(tl::unexpected(backend.error()));
    if (auto current = (*backend)->make_current(); !current) return started(tl::unexpected(current.error()));
    Gl gl;
    gl.load([&](const char* function) { return (*backend)->get_proc_address(function); });
    Loop loop(gl, events_, board_, (*backend)->screens(), trials_.get(), partials_);
    continued::hear();  // behind what the driver has made of threads
    started(Started{query_caps(gl), std::move(backend_name)});
    serve(loop);
}

void RenderThread::serve(Loop& loop) {
    while (!loop.lost()) {
        std::vector<std::function<void(Loop&)>> tasks;
        {
            std::unique_lock lock(mutex_);
            wake_.wait_for(lock, loop.nap(), [this] { return awake_ || stop_ || !tasks_.empty(); });
            if (stop_) break;
            awake_ = false;
            tasks.swap(tasks_);
        }
        for (auto& task : tasks) task(loop);
        if (loop.round()) wake();
    }
}

void RenderThread::post(std::function<void(Loop&)> task) {
    {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
    }
    wake_.notify_one();
}

void RenderThread::wake() {
    {
        const std::lock_guard lock(mutex_);
        awake_ = true;
    }
    wake_.notify_one();
}

Result<void> RenderThread::take_partial(SessionId session, std::vector<std::byte> message) {
    auto put = partials_.put(session, std::move(message));
    if (put) wake();
    return put;
}

void RenderThread::lose_partials(SessionId session, NodeIndex from) {
    partials_.lose(session, from);
    wake();
}

void RenderThread::set_partial_nodes(SessionId session, std::set<NodeIndex> nodes) {
    partials_.set_nodes(session, std::move(nodes));
    wake();
}

void RenderThread::add_stream(StreamId stream, SessionId session, std::shared_ptr<BatchQueue> queue,
                              const Membership& membership, Rank rank) {
    post([=](Loop& loop) { loop.add(stream, session, queue, membership, rank); });
}
void RenderThread::remove_stream(StreamId stream) {
    post([=](Loop& loop) {
        if (const auto at = loop.streams_.find(stream); at != loop.streams_.end()) at->second->close();
    });
}
void RenderThread::replace_stream(StreamId stream) {
    post([=](Loop& loop) {
        const auto at = loop.streams_.find(stream);
        if (at == loop.streams_.end()) return;
        if (!at->second->group()) return at->second->close();
        loop.streams_.erase(at);
        ++loop.node_.damage;
    });
}
void RenderThread::set_quota(SessionId session, const SessionQuota& quota) {
    post([=](Loop& loop) { loop.set_quota(session, quota); });
}
void RenderThread::remove_session(SessionId session) {
    post([=](Loop& loop) { loop.remove_session(session); });
}
void RenderThread::set_orders_triangles(bool on) {
    post([=](Loop& loop) { loop.node_.orders_triangles = on; });
}
void RenderThread::set_tiles(std::vector<Tile> tiles, std::uint32_t background, std::uint32_t version) {
    post([tiles = std::move(tiles), background, version](Loop& loop) {
        loop.node_.tiles = tiles;
        loop.compositor_.tiles_changed();
        loop.compositor_.set_background(background);
        loop.driver_.disable_scissor();
        for (auto& [id, stream] : loop.streams_)
            stream->session().for_each_surface([&](SurfaceId, SurfaceReplica& surface) {
                if (surface.where().window_width != 0) surface.place(SurfacePlace(surface.where()), tiles);
            });
        loop.events_.tiles_taken(version);
    });
}
void RenderThread::measure_tiles(bool on) {
    post([on](Loop& loop) { loop.node_.tile_times.switch_on(on); });
}
void RenderThread::set_stacking(std::vector<StackEntry> bottom_first, std::vector<StackEntry> held,
                                const std::vector<SessionId>& returning) {
    post([=, entries = std::move(bottom_first), held = std::move(held)](Loop& loop) {
        loop.compositor_.set_stacking(entries);
        loop.node_.held.clear();
        for (const auto& entry : held) loop.node_.held.emplace(entry.session, entry.surface);
        loop.node_.returning = {returning.begin(), returning.end()};
        loop.show_uncoordinated();
    });
}
void RenderThread::set_pattern(std::uint32_t slot, std::shared_ptr<const TestPattern> pattern) {
    post([=](Loop& loop) { loop.compositor_.set_pattern(slot, pattern); });
}
void RenderThread::present(SessionId session, SurfaceId surface, std::uint32_t frame) {
    post([=](Loop& loop) {
        for (auto& [id, stream] : loop.streams_)
            if (stream->session().id() == session) stream->executor().present(surface, frame);
    });
}
void RenderThread::set_coordinated(bool coordinated) {
    post([=](Loop& loop) {
        loop.node_.present_at_once = !coordinated;
        loop.show_uncoordinated();
    });
}
void RenderThread::report_frames(SessionId session) {
    post([=](Loop& loop) { loop.report_frames(session); });
}
void RenderThread::request_picture(const PictureRequest& request) {
    post([=](Loop& loop) { loop.ask(request); });
}
void RenderThread::watch(const PictureRequest& request, std::chrono::microseconds interval) {
    post([=](Loop& loop) { loop.watches_.add(request, interval); });
}
void RenderThread::unwatch(PictureId stream) {
    post([=](Loop& loop) { loop.watches_.remove(stream); });
}
void RenderThread::ready(PictureId stream, bool even_unchanged) {
    post([=](Loop& loop) { loop.watches_.ready(stream, even_unchanged); });
}

}  // namespace wall::tileserver
