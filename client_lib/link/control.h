// SPDX-License-Identifier: MIT
// The link to walld. Opened by an application thread; from then on one background thread moves the messages, and leaves
// what walld says in a mailbox. Functions never block unless they say so, and then not for a walld that is silent. When
// walld goes away drawing goes on with the old layout; the link is made again in the background, and walld is told what
// there was (Events::reconnected).
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "client_lib/link/control_messages.h"
#include "client_lib/link/member_placements.h"
#include "client_lib/link/walld_greeting.h"
#include "client_lib/link/window_messages.h"
#include "common/base/result.h"
#include "common/base/unique_fd.h"

namespace wall::client {

/// WALLGL_WALLD, or the default.
std::string walld_address();

class ControlLink {
public:
    static constexpr std::chrono::milliseconds kOpenLimit{5000};  ///< connect, hello and welcome together

    /// Blocks, at most `limit`. The error names the address.
    static Result<std::unique_ptr<ControlLink>> open(const Hello& hello, const std::string& address = walld_address(),
                                                     std::chrono::milliseconds limit = kOpenLimit);
    ~ControlLink();

    /// As it was when the link was opened; later changes are Events.
    const Welcome& welcome() const { return welcome_; }

    /// `messages`: how walld's wishes reach the window.
    void surface_open(SurfaceId id, OpenWindow window, WindowMessages messages = {});
    /// How tiles show the window that look elsewhere; walld is told with the next figures.
    enum class Views : std::uint8_t { none, seen, flat };
    void surface_views(SurfaceId id, Views views);
    void surface_resize(SurfaceId id, std::uint32_t width, std::uint32_t height);
    void surface_close(SurfaceId id);
    /// The placement of that version holds from `frame` on. Waits until walld knows; false when the time is over or the
    /// link breaks.
    bool surface_adopted(SurfaceId id, std::uint32_t layout_version, std::uint32_t frame,
                         std::chrono::milliseconds timeout);
    /// In a parallel program, before anything of a frame of the window is drawn, and before take_events(): waits while
    /// it is open where that frame is drawn, which takes longer than a moment only if walld has gone meanwhile.
    void begin_frame(SurfaceId id, std::uint32_t frame);
    /// In a parallel program: this process ends in order. Waits a moment until that is said.
    void leave();
    /// Called by the background thread when a parallel program's session is over; before any other thread uses the
    /// link.
    void on_end(std::function<void(const std::string& why)> action);

    /// Asks the program, soon, to draw the window again: what is on the wall was drawn for another layout.
    void ask_to_redraw(SurfaceId id);
    /// The same for all open windows. Any thread.
    void ask_all_to_redraw();

    /// Goes to the wall that has taken the program up, which takes a moment. False: it stays, as that wall, or the
    /// program's time to go, is gone.
    bool go();

    struct Events {
        std::vector<Placement> placements;  ///< in order of arrival
        std::vector<NodeInfo> node_changes;
        bool asked_to_move = false;          ///< another wall has taken the program: go(), between two frames
        bool moved = false;                  ///< `reconnected` is another wall, of other nodes and tiles
        bool lost = false;                   ///< the link broke; it is being made again
        std::optional<Welcome> reconnected;  ///< the session goes on, or is a new one: what it has of nodes with other
                                             ///< tickets is gone. Open surfaces were announced again
    };
    /// What came since the last call. One atomic read when nothing did.
    Events take_events();

    /// The surface's newest placement since it was opened or last resized (walld answers both with one); waits for it.
    /// Nothing when the time is over or the link breaks. Does not take events: it is also in the next take_events().
    std::optional<Placement> wait_placement(SurfaceId surface, std::chrono::milliseconds timeout);

private:
    struct OpenSurface {
        OpenWindow window;
        WindowMessages messages;
        unsigned awaited = 0;                         ///< placements that answer us; another one is a move
        std::uint32_t noted = 0;                      ///< layout version that walld knows to be adopted
        std::map<std::uint32_t, geom::Rect> offered;  ///< by layout version: placements that may still be adopted
        std::optional<geom::Rect> drawn, wanted;      ///< nothing: walld has placed it nowhere yet
        std::uint32_t wanted_version = 0;             ///< in a parallel program
        std::string note;                             ///< walld's, of this surface
        MemberPlacements member;                      ///< in a parallel program
        Views views = Views::none;

        std::optional<Restore> restore() const {
            return drawn ? std::optional(Restore{*drawn, *wanted, wanted_version, note, member.agreed()})
                         : std::nullopt;
        }
    };
    /// What the windows are to be told.
    struct Wishes {
        std::set<SurfaceId> close, redraw;
        bool empty() const { return close.empty() && redraw.empty(); }
    };

    ControlLink(UniqueFd fd, Hello hello, std::string address, Welcome welcome, std::string rest);
    void queue(const std::string& envelope);
    void wake();

    // ---- background thread ----
    void run();
    void serve();
    bool read_some();
    bool write_some();
    bool take_messages();
    bool handle(FromWalld message);
    void take_welcome(const Welcome& welcome);
    void arrived(const Placement& placement);
    void arrived_at_member(OpenSurface& surface, const Placement& placement);
    void holds(OpenSurface& surface, const Placement& placement);
    void watch_walld();
    bool answers() const { return up_ && !silent_; }
    Hello hello_again();
    void tell_windows();
    void tell_traffic();
    void on_lost(const std::string& why);
    bool reconnect();
    void end_group(const std::string& why);
    void take_up(Greeted greeted, bool moved);

    // ---- of the same thread: to another wall (control_move.cpp) ----
    /// A wall that has taken the program up, to which it has not gone yet.
    struct Move {
        Greeted there;
        std::string address;
        Hello hello;
        std::chrono::steady_clock::time_point until;
    };
    void attend_move();
    void begin_move(const std::string& address);
    void move_now();
    Result<Move> other_wall(const std::string& address);

    Hello hello_;          // background thread; what others look at does not change
    std::string address_;  // background thread
    const Welcome welcome_;
    UniqueFd wake_fd_;
    std::atomic<bool> stop_{false};
    std::atomic<bool> has_events_{false};

    UniqueFd fd_;               // background thread
    std::string inbox_;         // background thread: bytes of unfinished messages
    std::string move_to_;       // background thread: where walld wants the program
    std::optional<Move> move_;  // background thread
    bool refused_ = false;      // background thread: walld has ended the session (an operator did); no second one

    std::mutex mutex_;  // guards what follows
    std::condition_variable changed_;
    std::string outbox_;
    Events events_;
    bool up_ = true;
    enum class Going : std::uint8_t { no, asked, gone } going_ = Going::no;
    bool heard_ = false;   // since the last tick
    bool asked_ = false;   // for a sign of life
    bool silent_ = false;  // none has come: nobody waits for walld until it says something
    bool over_ = false;    // the session, for good
    SessionId session_;
    std::map<NodeIndex, std::string> tickets_;
    Tiles tiles_;  ///< the wall's, as walld said last
    std::function<void(const std::string&)> end_;
    std::map<SurfaceId, OpenSurface> surfaces_;
    Wishes wishes_;
    std::map<SurfaceId, Placement> placements_;  ///< newest of each since it was opened or resized

    std::thread thread_;
};

}  // namespace wall::client
