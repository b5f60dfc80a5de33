// SPDX-License-Identifier: MIT
// A program goes to another wall while it runs (docs/operation.md, "Programs that move"). Nothing is given up before
// the other wall has taken it: it is asked first, by a second link; then the program's thread keeps what only nodes
// have, and says go; only then the link to the old walld ends.
#include <poll.h>

#include "client_lib/link/caps_cover.h"
#include "client_lib/link/control.h"
#include "client_lib/link/remaining_time.h"
#include "client_lib/process/log.h"
#include "client_lib/process/process.h"
#include "common/base/quoted.h"

namespace wall::client {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kAskLimit{3};     // the other walld, for its welcome
constexpr std::chrono::seconds kFrameLimit{10};  // until the program comes between two frames
constexpr std::chrono::seconds kGoLimit{5};      // from there to the other link
constexpr std::chrono::seconds kFarewell{1};     // the old walld, until it has read that the program goes

}  // namespace

// The application's thread.
bool ControlLink::go() {
    if (in_forked_child()) return false;
    std::unique_lock lock(mutex_);
    going_ = Going::asked;
    wake();
    changed_.wait_for(lock, kGoLimit, [&] { return going_ != Going::asked; });
    return std::exchange(going_, Going::no) == Going::gone;
}

void ControlLink::attend_move() {
    if (!move_to_.empty() && fd_) begin_move(std::exchange(move_to_, {}));
    std::unique_lock lock(mutex_);
    const bool told = going_ == Going::asked;
    if (move_ && !told && Clock::now() >= move_->until) {
        queue(encode_move_answer("it has drawn no frame for " + std::to_string(kFrameLimit.count()) + " s"));
        move_.reset();
    }
    if (!told) return;
    lock.unlock();
    const bool goes = move_.has_value();
    if (goes) move_now();
    lock.lock();
    going_ = goes ? Going::gone : Going::no;
    changed_.notify_all();
}

/// The other wall, if it takes the program, and can do what that was promised when it began.
Result<ControlLink::Move> ControlLink::other_wall(const std::string& address) {
    if (address == address_) return fail("it is on that wall");
    if (move_) return fail("it is about to go to " + move_->address);
    Hello hello = hello_;
    hello.token.clear();  // the other wall's people are others, and it is no place for this one's secrets
    hello.rect.reset();
    hello.resume.reset();
    auto there = greet(hello, address, kAskLimit);
    if (!there) return tl::unexpected(there.error());
    if (const auto lacks = lacking(there->welcome.caps, welcome_.caps); !lacks.empty())
        return fail("the other wall lacks " + lacks + ", which it was promised here");
    return Move{std::move(*there), address, std::move(hello), Clock::now() + kFrameLimit};
}

void ControlLink::begin_move(const std::string& address) {
    auto move = other_wall(address);
    std::lock_guard lock(mutex_);
    if (!move) return queue(encode_move_answer(move.error().message));
    move_ = std::move(*move);
    events_.asked_to_move = has_events_ = true;
    for (const auto& [id, surface] : surfaces_) wishes_.redraw.insert(id);  // so that one comes to it that draws rarely
}

void ControlLink::move_now() {
    Move move = std::move(*std::exchange(move_, std::nullopt));
    {
        std::lock_guard lock(mutex_);
        queue(encode_move_answer(""));
    }
    const auto said = [this] {
        std::lock_guard lock(mutex_);
        return outbox_.empty();
    };
    for (const auto until = Clock::now() + kFarewell; Clock::now() < until && write_some() && !said();) {
        pollfd p{fd_.get(), POLLOUT, 0};
        ::poll(&p, 1, remaining_ms(until));
    }
    log(LogLevel::info, "moved from=%s to=%s session=%u", in_quotes(address_).c_str(), in_quotes(move.address).c_str(),
        move.there.welcome.session.value);
    {
        std::lock_guard lock(mutex_);
        outbox_.clear();
        heard_ = asked_ = silent_ = false;
    }
    address_ = std::move(move.address);
    hello_ = std::move(move.hello);
    take_up(std::move(move.there), true);
    take_messages();
}

}  // namespace wall::client
