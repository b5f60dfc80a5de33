// SPDX-License-Identifier: MIT
// systemd's view of a daemon (Type=notify): ready, status, watchdog, stopping. Does nothing when not started by it.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace wall::walld {

void notify_ready(const std::string& status);
void notify_stopping();
/// Until notify_ready().
void notify_reloading();
void notify_alive();
/// How often notify_alive() is wanted; nothing if there is no watchdog.
std::optional<std::chrono::microseconds> watchdog_interval();

}  // namespace wall::walld
