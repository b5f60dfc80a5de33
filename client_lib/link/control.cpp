// SPDX-License-Identifier: MIT
#include "client_lib/link/control.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>

#include "client_lib/link/node_greeting.h"
#include "client_lib/link/remaining_time.h"
#include "client_lib/link/walld_greeting.h"
#include "client_lib/process/log.h"
#include "client_lib/process/process.h"
#include "client_lib/process/stats.h"
#include "common/base/address.h"
#include "common/base/lossy_pixels.h"
#include "common/base/quoted.h"

namespace wall::client {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kLeaveLimit{1000};
constexpr milliseconds kTick{1000};      // statistics are written and told
constexpr milliseconds kTryAgain{200};   // a lost link, over which the wall may be right again within two seconds
constexpr std::size_t kMaxOffered = 64;  // placements of a surface that does not draw; only the newest ones matter

std::string environment(const char* name) {
    const char* value = secure_getenv(name);
    return value ? value : "";
}

/// The first line of the file; nothing without one.
void read_token(const std::string& path, Hello& hello) {
    if (path.empty()) return;
    std::ifstream file(path);
    if (!std::getline(file, hello.token) || hello.token.empty())
        hello.invalid = "WALLGL_TOKEN_FILE: expected a file with a token, got '" + path + "'";
}

}  // namespace

std::string walld_address() {
    const auto given = environment("WALLGL_WALLD");
    return given.empty() ? kDefaultWalld : given;
}

Hello Hello::from_environment() {
    Hello hello;
    hello.pid = static_cast<std::uint32_t>(getpid());
    hello.program = program_name();
    hello.name = environment("WALLGL_NAME");
    read_token(environment("WALLGL_TOKEN_FILE"), hello);
    hello.group = parallel();
    if (const auto text = environment("WALLGL_PARALLEL"); !text.empty() && !hello.group)
        hello.invalid = parse_parallel(text).error().message;
    const auto hold = environment("WALLGL_HOLD");
    hello.hold = !hold.empty() && hold != "0";
    hello.sort_last = environment("WALLGL_SORT_LAST") == "1";
    if (const auto pixels = environment("WALLGL_LOSSY_PIXELS"); !pixels.empty()) {
        hello.lossy_pixels = lossy_pixels_of_text(pixels);
        if (!hello.lossy_pixels)
            hello.invalid = "WALLGL_LOSSY_PIXELS: expected a number from 0 to 16, got '" + pixels + "'";
    }
    if (const auto stereo = environment("WALLGL_STEREO"); !stereo.empty()) {
        hello.stereo = stereo_of_text(stereo);
        if (!hello.stereo) hello.invalid = "WALLGL_STEREO: expected PERCENT or PERCENT,DISTANCE, got '" + stereo + "'";
    }
    const auto rect = environment("WALLGL_RECT");
    if (rect.empty()) return hello;
    hello.fullscreen = rect == "fullscreen";
    if (hello.fullscreen) return hello;
    geom::Rect r;
    char extra;
    if (sscanf(rect.c_str(), "%d,%d,%d,%d%c", &r.x, &r.y, &r.width, &r.height, &extra) != 4 || r.empty())
        hello.invalid = "WALLGL_RECT: expected X,Y,W,H or fullscreen, got '" + rect + "'";
    else hello.rect = r;
    return hello;
}

Result<std::unique_ptr<ControlLink>> ControlLink::open(const Hello& hello, const std::string& address,
                                                       milliseconds limit) {
    if (!hello.invalid.empty()) return fail(hello.invalid);
    auto opened = greet(hello, address, limit);
    if (!opened) return tl::unexpected(opened.error());
    return std::unique_ptr<ControlLink>(
        new ControlLink(std::move(opened->fd), hello, address, std::move(opened->welcome), std::move(opened->rest)));
}

ControlLink::ControlLink(UniqueFd fd, Hello hello, std::string address, Welcome welcome, std::string rest)
    : hello_(std::move(hello)),
      address_(std::move(address)),
      welcome_(std::move(welcome)),
      wake_fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      fd_(std::move(fd)),
      inbox_(std::move(rest)),
      session_(welcome_.session) {
    take_welcome(welcome_);
    SignalsBlocked blocked;
    thread_ = std::thread([this] { run(); });
}

ControlLink::~ControlLink() {
    if (in_forked_child()) {
        thread_.detach();  // it does not exist here
        return;
    }
    stop_ = true;
    wake();
    thread_.join();
}

void ControlLink::wake() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto n = ::write(wake_fd_.get(), &one, sizeof one);
}

// With the mutex held.
void ControlLink::queue(const std::string& envelope) {
    if (up_) append_framed(outbox_, envelope);
}

void ControlLink::surface_open(SurfaceId id, OpenWindow window, WindowMessages messages) {
    if (in_forked_child()) return;
    std::lock_guard lock(mutex_);
    queue(encode_surface_open(id, window));
    surfaces_[id] = OpenSurface{.window = std::move(window),
                                .messages = std::move(messages),
                                .awaited = 1,
                                .offered = {},
                                .drawn = {},
                                .wanted = {},
                                .note = {},
                                .member = {}};
    wake();
}

void ControlLink::surface_resize(SurfaceId id, std::uint32_t width, std::uint32_t height) {
    if (in_forked_child()) return;
    std::lock_guard lock(mutex_);
    auto& surface = surfaces_[id];
    surface.window.width = width;
    surface.window.height = height;
    ++surface.awaited;
    placements_.erase(id);
    queue(encode_surface_resize(id, width, height));
    wake();
}

void ControlLink::surface_views(SurfaceId id, Views views) {
    if (in_forked_child()) return;
    std::lock_guard lock(mutex_);
    if (const auto found = surfaces_.find(id); found != surfaces_.end()) found->second.views = views;
}

void ControlLink::surface_close(SurfaceId id) {
    if (in_forked_child()) return;
    std::lock_guard lock(mutex_);
    surfaces_.erase(id);
    placements_.erase(id);
    queue(encode_surface_close(id));
    wake();
}

bool ControlLink::surface_adopted(SurfaceId id, std::uint32_t layout_version, std::uint32_t frame,
                                  milliseconds timeout) {
    if (in_forked_child()) return false;
    std::unique_lock lock(mutex_);
    auto& surface = surfaces_[id];
    if (const auto found = surface.offered.find(layout_version); found != surface.offered.end()) {
        surface.drawn = found->second;
        surface.offered.erase(surface.offered.begin(), std::next(found));
    }
    queue(encode_surface_adopted(id, layout_version, frame));
    wake();
    const auto noted = [&] { return surfaces_[id].noted == layout_version; };
    changed_.wait_for(lock, timeout, [&] { return !answers() || noted(); });
    return up_ && noted();
}

void ControlLink::begin_frame(SurfaceId id, std::uint32_t frame) {
    if (in_forked_child()) return;
    std::unique_lock lock(mutex_);
    const auto known = [&] {
        const auto found = surfaces_.find(id);
        return over_ || found == surfaces_.end() || found->second.member.known(frame);
    };
    changed_.wait(lock, known);
    if (const auto found = surfaces_.find(id); found != surfaces_.end()) found->second.member.begin(frame);
}

void ControlLink::leave() {
    if (in_forked_child() || !hello_.group) return;
    std::unique_lock lock(mutex_);
    queue(encode_member_leaves(hello_.group->rank));
    wake();
    changed_.wait_for(lock, kLeaveLimit, [&] { return !answers() || outbox_.empty(); });
}

void ControlLink::on_end(std::function<void(const std::string&)> action) {
    std::lock_guard lock(mutex_);
    end_ = std::move(action);
}

void ControlLink::ask_to_redraw(SurfaceId id) {
    if (in_forked_child()) return;
    std::lock_guard lock(mutex_);
    wishes_.redraw.insert(id);
    wake();
}

void ControlLink::ask_all_to_redraw() {
    if (in_forked_child()) return;
    std::lock_guard lock(mutex_);
    for (const auto& [id, surface] : surfaces_) wishes_.redraw.insert(id);
    wake();
}

ControlLink::Events ControlLink::take_events() {
    if (!has_events_.load(std::memory_order_relaxed)) return {};
    std::lock_guard lock(mutex_);
    has_events_ = false;
    return std::exchange(events_, {});
}

std::optional<Placement> ControlLink::wait_placement(SurfaceId surface, milliseconds timeout) {
    if (in_forked_child()) return std::nullopt;
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [&] { return !answers() || placements_.contains(surface); });
    const auto found = placements_.find(surface);
    if (found == placements_.end()) return std::nullopt;
    return found->second;
}

void ControlLink::run() {
    try {
        take_messages();
        while (!stop_) {
            serve();
            for (auto next_tick = Clock::now() + kTick; !stop_ && !reconnect();) {
                pollfd p{wake_fd_.get(), POLLIN, 0};
                ::poll(&p, 1, static_cast<int>(kTryAgain.count()));
                std::uint64_t count;
                [[maybe_unused]] const auto n = ::read(wake_fd_.get(), &count, sizeof count);
                if (Clock::now() < next_tick) continue;
                stats().write();
                next_tick = Clock::now() + kTick;
            }
        }
    } catch (const std::exception& e) {  // out of memory: drawing goes on, the wall's changes do not arrive
        log(LogLevel::error, "control_thread_ended why=%s", e.what());
    }
}

/// Moves messages until the link breaks or must stop.
void ControlLink::serve() {
    auto next_tick = Clock::now() + kTick;
    for (tell_windows(); write_some() && !stop_; tell_windows()) {
        bool more_to_write;
        {
            std::lock_guard lock(mutex_);
            more_to_write = !outbox_.empty();
        }
        pollfd fds[2] = {{wake_fd_.get(), POLLIN, 0},
                         {fd_.get(), static_cast<short>(POLLIN | (more_to_write ? POLLOUT : 0)), 0}};
        ::poll(fds, 2, remaining_ms(next_tick));
        std::uint64_t count;
        if (fds[0].revents) [[maybe_unused]]
            const auto n = ::read(wake_fd_.get(), &count, sizeof count);
        if (fds[1].revents && !read_some()) return;
        attend_move();
        if (!fd_) return;
        if (Clock::now() >= next_tick) {
            stats().write();
            tell_traffic();
            watch_walld();
            next_tick = Clock::now() + kTick;
        }
    }
}

bool ControlLink::read_some() {
    const auto more = receive_some(fd_.get(), inbox_);
    if (!more || !*more) {
        on_lost(more ? "walld closed the connection" : more.error().message);
        return false;
    }
    return take_messages();
}

bool ControlLink::take_messages() {
    for (;;) {
        auto message = cut_message(inbox_);
        if (!message) {
            on_lost(message.error().message);
            return false;
        }
        if (!*message) return true;
        if (!handle(std::move(**message))) return false;
    }
}

bool ControlLink::write_some() {
    std::string why;
    {
        std::lock_guard lock(mutex_);
        while (!outbox_.empty()) {
            const ssize_t n = ::send(fd_.get(), outbox_.data(), outbox_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
            if (n > 0) {
                outbox_.erase(0, static_cast<std::size_t>(n));
            } else if (errno != EINTR) {
                if (errno != EAGAIN) why = strerror(errno);
                break;
            }
        }
        if (outbox_.empty()) changed_.notify_all();
    }
    if (why.empty()) return true;
    // What walld said before it closed comes first: a reason, or where a window goes.
    for (pollfd come{fd_.get(), POLLIN, 0}; ::poll(&come, 1, 0) > 0;)
        if (!read_some()) return false;
    on_lost(why);
    return false;
}

bool ControlLink::handle(FromWalld message) {
    if (const auto* refused = std::get_if<Refused>(&message)) {
        refused_ = true;
        complain_once("walld at " + address_ + " has ended this program's drawing: " + refused->reason, "ended");
        on_lost(refused->reason);
        return false;
    }
    std::lock_guard lock(mutex_);
    heard_ = true;
    if (std::exchange(silent_, false)) log(LogLevel::info, "walld_answers");
    if (auto* placement = std::get_if<Placement>(&message)) {
        placement->tiles = tiles_;
        arrived(*placement);
    } else if (auto* changed = std::get_if<TilesChanged>(&message)) {
        tiles_ = std::make_shared<const std::vector<TileInfo>>(std::move(changed->tiles));
        return true;  // placements follow
    } else if (auto* node = std::get_if<NodeInfo>(&message)) {
        log(LogLevel::info, "node_%s node=%u address=%s", node->up ? "up" : "down", node->node.value,
            in_quotes(node->address).c_str());
        if (node->up) tickets_[node->node] = node->ticket;
        // What it shows of programs that do not draw by themselves is lost with its process.
        for (const auto& [id, surface] : surfaces_)
            if (node->up) wishes_.redraw.insert(id);
        events_.node_changes.push_back(std::move(*node));
    } else if (auto* noted = std::get_if<AdoptionNoted>(&message)) {
        if (const auto found = surfaces_.find(noted->surface); found != surfaces_.end())
            found->second.noted = noted->layout_version;
    } else if (const auto* agreed = std::get_if<PlacementAgreed>(&message)) {
        if (const auto found = surfaces_.find(agreed->surface); found != surfaces_.end())
            if (const auto now_holds = found->second.member.agree(agreed->layout_version))
                holds(found->second, *now_holds);
    } else if (auto* note = std::get_if<SurfaceNote>(&message)) {
        if (const auto found = surfaces_.find(note->surface); found != surfaces_.end())
            found->second.note = std::move(note->note);
        return true;  // nobody waits for that
    } else if (auto* move = std::get_if<MoveRequest>(&message)) {
        move_to_ = std::move(move->address);
        return true;
    } else if (std::holds_alternative<std::monostate>(message)) {
        return true;
    } else if (auto* close = std::get_if<CloseRequest>(&message)) {
        log(LogLevel::info, "close_requested surface=%u reason=%s", close->surface.value,
            in_quotes(close->reason).c_str());
        wishes_.close.insert(close->surface);
    }
    has_events_ = true;
    changed_.notify_all();
    return true;
}

// With the mutex held.
/// Before the other thread runs, or with the mutex held.
void ControlLink::take_welcome(const Welcome& welcome) {
    tickets_.clear();
    for (const auto& node : welcome.nodes) tickets_[node.node] = node.ticket;
    tiles_ = std::make_shared<const std::vector<TileInfo>>(welcome.tiles);
}

void ControlLink::arrived(const Placement& placement) {
    const auto found = surfaces_.find(placement.surface);
    if (hello_.group) {
        if (found != surfaces_.end()) arrived_at_member(found->second, placement);
        return;
    }
    events_.placements.push_back(placement);
    if (found == surfaces_.end()) return;
    placements_[placement.surface] = placement;
    auto& surface = found->second;
    surface.wanted = placement.rect;
    if (!surface.drawn) surface.drawn = placement.rect;  // the first one needs no adoption
    surface.offered[placement.layout_version] = placement.rect;
    if (surface.offered.size() > kMaxOffered) surface.offered.erase(surface.offered.begin());
    // A program that draws only when asked would never come to adopt it.
    if (surface.awaited > 0) --surface.awaited;
    else wishes_.redraw.insert(placement.surface);
}

void ControlLink::arrived_at_member(OpenSurface& surface, const Placement& placement) {
    if (placement.layout_version >= surface.wanted_version) {  // not one that is only told once more
        surface.wanted = placement.rect;
        surface.wanted_version = placement.layout_version;
    }
    if (placement.agreed) {
        if (surface.member.add(placement)) holds(surface, placement);
        return;
    }
    queue(encode_placement_noted(placement.surface, placement.layout_version, surface.member.propose(placement)));
    wake();
}

void ControlLink::holds(OpenSurface& surface, const Placement& placement) {
    events_.placements.push_back(placement);
    placements_[placement.surface] = placement;
    surface.drawn = placement.rect;
    if (surface.awaited > 0) --surface.awaited;
    else wishes_.redraw.insert(placement.surface);  // so that one comes to it that draws only when asked
}

/// A walld that hangs costs no more than one that is gone: once it has not answered, nobody waits for it.
void ControlLink::watch_walld() {
    std::lock_guard lock(mutex_);
    if (std::exchange(heard_, false)) {
        asked_ = false;
    } else if (!std::exchange(asked_, true)) {
        queue(encode_ping());
    } else if (!std::exchange(silent_, true)) {
        log(LogLevel::warn, "walld_silent address=%s", in_quotes(address_).c_str());
        changed_.notify_all();
    }
}

void ControlLink::tell_windows() {
    std::vector<std::pair<SurfaceId, std::function<bool()>>> close;
    std::vector<std::function<void()>> redraw;
    {
        std::lock_guard lock(mutex_);
        if (wishes_.empty()) return;
        for (const auto id : wishes_.close)
            if (const auto found = surfaces_.find(id); found != surfaces_.end())
                close.emplace_back(id, found->second.messages.close);
        for (const auto id : wishes_.redraw)
            if (const auto found = surfaces_.find(id); found != surfaces_.end() && found->second.messages.redraw)
                redraw.push_back(found->second.messages.redraw);
        wishes_ = {};
    }
    for (const auto& [id, ask] : close) {
        const bool asked = ask && ask();
        std::lock_guard lock(mutex_);
        if (!asked) {
            queue(encode_close_refused(id));
            continue;
        }
        // Only a call of the program notices that the window is gone; if the others stand still, they make one now.
        for (const auto& [other, surface] : surfaces_)
            if (other != id) wishes_.redraw.insert(other);
        wake();
    }
    for (const auto& ask : redraw) ask();
}

void ControlLink::tell_traffic() {
    Traffic traffic = stats().traffic();
    if (traffic.nodes.empty()) return;  // nothing was sent to anybody yet
    std::lock_guard lock(mutex_);
    for (const auto& [id, surface] : surfaces_)
        if (surface.views != Views::none) (surface.views == Views::seen ? traffic.seen : traffic.flat).push_back(id);
    if (outbox_.empty()) queue(encode(traffic));  // walld does not read now: the next second's figures will do
}

void ControlLink::on_lost(const std::string& why) {
    log(LogLevel::error, "walld_lost address=%s why=%s", in_quotes(address_).c_str(), in_quotes(why).c_str());
    fd_.reset();
    inbox_.clear();
    move_.reset();
    {
        std::lock_guard lock(mutex_);
        if (going_ == Going::asked) going_ = Going::no;
        outbox_.clear();
        up_ = heard_ = asked_ = silent_ = false;
        events_.lost = true;
        has_events_ = true;
        changed_.notify_all();
    }
    if (refused_) end_group(why);
}

void ControlLink::end_group(const std::string& why) {
    std::unique_lock lock(mutex_);
    over_ = true;
    changed_.notify_all();
    const auto end = hello_.group ? end_ : nullptr;
    lock.unlock();
    if (end) end(why);
}

/// With what a walld that was started again cannot know.
Hello ControlLink::hello_again() {
    Hello hello = hello_;
    std::lock_guard lock(mutex_);
    hello.resume = {session_, tickets_, 0};
    for (const auto& [id, surface] : surfaces_) hello.resume->windows += surface.restore().has_value();
    return hello;
}

bool ControlLink::reconnect() {
    if (fd_) return true;
    if (refused_) return false;
    auto opened = greet(hello_again(), address_, kOpenLimit);
    if (!opened) {
        log(LogLevel::debug, "walld_unreachable why=%s", in_quotes(opened.error().message).c_str());
        return false;
    }
    if (!opened->over.empty()) {
        refused_ = true;
        log(LogLevel::error, "session_ended why=%s", in_quotes(opened->over).c_str());
        end_group(opened->over);
        return false;
    }
    log(LogLevel::info, "walld_reconnected session=%u", opened->welcome.session.value);
    take_up(std::move(*opened), false);
    return take_messages();
}

/// From now on the link is that one, and the wall what it says.
void ControlLink::take_up(Greeted greeted, bool moved) {
    fd_ = std::move(greeted.fd);
    inbox_ = std::move(greeted.rest);
    std::lock_guard lock(mutex_);
    up_ = true;
    auto before = std::exchange(events_, {});
    if (hello_.group) events_.placements = std::move(before.placements);  // agreed is agreed
    events_.lost = true;
    events_.moved = moved || before.moved;
    session_ = greeted.welcome.session;
    take_welcome(greeted.welcome);
    events_.reconnected = std::move(greeted.welcome);
    placements_.clear();
    for (auto& [id, surface] : surfaces_) {
        surface.awaited = 0;  // nobody waits for these answers: the program has to draw again
        if (moved) {          // that wall places it anew
            surface.drawn = surface.wanted = std::nullopt;
            surface.wanted_version = 0;
            surface.note.clear();
        }
        queue(encode_surface_open(id, surface.window, surface.restore()));
        surface.offered.clear();  // the new walld counts its versions from 1
        surface.noted = 0;
    }
    has_events_ = true;
}

}  // namespace wall::client
