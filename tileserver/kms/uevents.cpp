// SPDX-License-Identifier: MIT
#include "tileserver/kms/uevents.h"

#include <linux/netlink.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

namespace wall::tileserver {
namespace {

constexpr std::uint32_t kFromKernel = 1;      // the group of events that the kernel sends itself; 2: those of udev
constexpr std::size_t kMostOfMessage = 8192;  // the kernel's are 2 KiB at most

}  // namespace

bool is_hot_plug(std::string_view message, std::string_view device) {
    bool of_graphics = false, hot_plug = false, of_device = true;
    while (!message.empty()) {
        const auto line = message.substr(0, message.find('\0'));
        message.remove_prefix(std::min(line.size() + 1, message.size()));
        if (line == "SUBSYSTEM=drm") of_graphics = true;
        if (line == "HOTPLUG=1") hot_plug = true;
        if (line.starts_with("DEVNAME=")) of_device = line.substr(line.find('=') + 1) == device;
    }
    return of_graphics && hot_plug && of_device;
}

Result<Uevents> Uevents::open(std::string device) {
    UniqueFd socket(::socket(AF_NETLINK, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_KOBJECT_UEVENT));
    sockaddr_nl address{};
    address.nl_family = AF_NETLINK;
    address.nl_groups = kFromKernel;
    if (!socket || ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        return fail(std::string("the kernel's events of monitors cannot be heard: ") + std::strerror(errno));
    return Uevents(std::move(socket), std::move(device));
}

bool Uevents::take() {
    bool out = false;
    for (;;) {
        std::array<char, kMostOfMessage> message{};
        sockaddr_nl sender{};
        socklen_t size = sizeof sender;
        const auto length =
            ::recvfrom(socket_.get(), message.data(), message.size(), 0, reinterpret_cast<sockaddr*>(&sender), &size);
        if (length < 0 && errno == EINTR) continue;
        if (length < 0) return out || errno == ENOBUFS;
        if (size < sizeof sender || sender.nl_pid != 0) continue;  // a process may say anything
        out = out || is_hot_plug({message.data(), static_cast<std::size_t>(length)}, device_);
    }
}

}  // namespace wall::tileserver
