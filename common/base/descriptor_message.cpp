// SPDX-License-Identifier: MIT
#include "common/base/descriptor_message.h"

#include <sys/socket.h>
#include <sys/uio.h>

#include <cstring>

namespace wall {
namespace {

/// A message of one piece, with room for one descriptor beside it.
struct Message {
    Message(std::byte* data, std::size_t size) : piece{data, size} {
        header.msg_iov = &piece;
        header.msg_iovlen = 1;
        header.msg_control = control;
        header.msg_controllen = sizeof control;
    }
    Message(const Message&) = delete;
    Message& operator=(const Message&) = delete;

    iovec piece;
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
    msghdr header{};
};

}  // namespace

ssize_t send_with_descriptor(int socket, std::span<const std::byte> bytes, int descriptor) {
    Message message(const_cast<std::byte*>(bytes.data()), bytes.size());  // sendmsg() only reads
    cmsghdr* const about = CMSG_FIRSTHDR(&message.header);
    about->cmsg_level = SOL_SOCKET;
    about->cmsg_type = SCM_RIGHTS;
    about->cmsg_len = CMSG_LEN(sizeof descriptor);
    std::memcpy(CMSG_DATA(about), &descriptor, sizeof descriptor);
    return ::sendmsg(socket, &message.header, MSG_NOSIGNAL);
}

ssize_t receive_with_descriptor(int socket, std::span<std::byte> room, UniqueFd& with, int flags) {
    Message message(room.data(), room.size());
    message.header.msg_controllen = CMSG_LEN(sizeof(int));  // what pads it would be room for a second one
    const ssize_t bytes = ::recvmsg(socket, &message.header, flags | MSG_CMSG_CLOEXEC);
    if (bytes < 0) return bytes;
    const cmsghdr* const about = CMSG_FIRSTHDR(&message.header);
    if (about && about->cmsg_level == SOL_SOCKET && about->cmsg_type == SCM_RIGHTS &&
        about->cmsg_len == CMSG_LEN(sizeof(int))) {
        int descriptor = -1;
        std::memcpy(&descriptor, CMSG_DATA(about), sizeof descriptor);
        with.reset(descriptor);
    }
    return bytes;
}

}  // namespace wall
