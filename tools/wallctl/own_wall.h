// SPDX-License-Identifier: MIT
// A wall of one's own: walld and a tileserver as children of this process, whose tiles are windows inside of windows of
// another program. It ends with this process. One thread.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/request/request.h"

namespace wall::wallctl {

/// An X window that a tile covers.
struct Covered {
    std::string display;                  ///< as in DISPLAY
    std::uint64_t number = 0;             ///< X's
    std::uint32_t width = 0, height = 0;  ///< pixels
    bool operator==(const Covered&) const = default;
};

/// As wall.toml has them, side by side; all on one display. `folder`: for sockets and state.
std::string own_wall_toml(const std::filesystem::path& folder, const std::vector<Covered>& windows);
/// Left edge of the tile that covers the window of that index, on the canvas; pixels.
std::int64_t own_wall_left(const std::vector<Covered>& windows, std::size_t index);

class OwnWall {
public:
    /// Waits until it serves.
    static request::Outcome<OwnWall> start(const std::vector<Covered>& windows);
    OwnWall(OwnWall&& other) noexcept;
    ~OwnWall();

    const request::Walld& walld() const { return walld_; }
    /// The windows have other sizes now.
    request::Outcome<void> resize(const std::vector<Covered>& windows) const;
    /// An error: one of its daemons has ended.
    request::Outcome<void> check();

private:
    struct Daemon {
        std::string name;
        pid_t pid = 0;
    };
    OwnWall(std::filesystem::path folder);
    Result<void> write(const std::vector<Covered>& windows) const;
    request::Outcome<void> run(const std::string& program, std::vector<std::string> arguments);
    request::Outcome<void> wait_until_it_serves();
    std::string last_words(const std::string& daemon) const;

    std::filesystem::path folder_;  ///< empty: moved from
    request::Walld walld_;
    std::vector<Daemon> daemons_;
};

}  // namespace wall::wallctl
