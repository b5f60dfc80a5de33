// SPDX-License-Identifier: MIT
// What the kernel says when a monitor is plugged in or out (netlink, NETLINK_KOBJECT_UEVENT). Render thread.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/base/unique_fd.h"

namespace wall::tileserver {

/// `message`: a line "change@/devices/..." and KEY=VALUE, each ended by a zero byte. True: a connector of the device
/// (such as "dri/card0") has another monitor, or none.
bool is_hot_plug(std::string_view message, std::string_view device);

class Uevents {
public:
    /// `device`: whose events count, such as "dri/card0".
    static Result<Uevents> open(std::string device);

    /// There was one since the last call. Where some were lost there may have been.
    bool take();

private:
    Uevents(UniqueFd socket, std::string device) : socket_(std::move(socket)), device_(std::move(device)) {}

    UniqueFd socket_;
    std::string device_;
};

}  // namespace wall::tileserver
