// SPDX-License-Identifier: MIT
// The windows of a recorded program, as windows on this wall: opened, resized and closed as the recording says, placed
// where the wall wants them. The main thread; messages of walld come on others.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "client_lib/follow/session.h"
#include "common/glstate/command_walk.h"
#include "tools/wallplay/rewrite.h"

namespace wall::wallplay {

class Windows {
public:
    /// `session` outlives it. `title`: of windows, for people.
    Windows(client::ClientSession& session, std::string title) : session_(session), title_(std::move(title)) {}
    ~Windows() { close_all(); }

    /// A command that is_of_windows(), but for Swap. An error: it says what no program says.
    Result<void> take(const glstate::Command& command);
    /// Where frames begin: windows that are between two take what walld wants, and their programs' sizes.
    void begin_frames();
    /// What was begun of frames will not be ended.
    void drop_frames();
    /// No window is within a frame.
    bool between_frames() const;
    /// Shows what was drawn again; all windows that had a frame.
    void swap_all(ContextId context);
    /// Ends a frame of a recorded window, and waits as a program does. `context`: that was current.
    void swap(ContextId context, SurfaceId recorded);
    void close_all() { windows_.clear(); }

    // ---- while the session's mutex is held ----
    /// Tells the node of all windows what it does not know.
    void describe_to(client::Node& node) const;
    /// For the node; as long as this lives.
    NodeView view_for(const client::Node& node) const;

    /// Somebody wants them closed.
    bool close_wanted() const { return wishes_->close; }
    /// What is on the wall was drawn for another layout; once for each time.
    bool take_redraw() { return wishes_->redraw.exchange(false); }

private:
    /// Outlive the windows in walld's thread.
    struct Wishes {
        std::atomic<bool> close{false}, redraw{false};
    };
    struct Closer {
        client::ClientSession* session;
        void operator()(client::ClientSurface* surface) const;
    };
    struct Window {
        client::SurfaceFormat format;
        bool srgb = false;
        std::shared_ptr<client::Extent> size;                    ///< that it should have
        std::unique_ptr<client::ClientSurface, Closer> surface;  ///< none: it was never placed
    };
    Result<void> create(const glstate::Command& command);
    Result<void> place(const glstate::Command& command);
    void open(Window& window);

    client::ClientSession& session_;
    std::string title_;
    std::shared_ptr<Wishes> wishes_ = std::make_shared<Wishes>();
    std::map<SurfaceId, Window> windows_;  ///< by their recorded names
};

}  // namespace wall::wallplay
