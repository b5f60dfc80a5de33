// SPDX-License-Identifier: MIT
// How a program and a walld begin to speak, and how their messages are put on a socket and taken from it: an envelope
// each, its length in front (proto/control.proto). Any thread; greet() blocks.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "client_lib/link/control_messages.h"
#include "common/base/result.h"
#include "common/base/unique_fd.h"

namespace wall::client {

void append_framed(std::string& out, const std::string& envelope);
/// The first whole message is cut off `inbox`; nothing if it is not complete yet.
Result<std::optional<FromWalld>> cut_message(std::string& inbox);
/// Appends what can be read without waiting. False at the end of the stream.
Result<bool> receive_some(int fd, std::string& inbox);

/// A walld that has taken the program up.
struct Greeted {
    UniqueFd fd;
    Welcome welcome;
    std::string rest;  ///< bytes that came after the welcome
    std::string over;  ///< why the session that was to go on does not, and never will; then nothing else means anything
};

/// Connects, says who comes and waits for the answer, for `limit` together. The error names the address.
Result<Greeted> greet(const Hello& hello, const std::string& address, std::chrono::milliseconds limit);

}  // namespace wall::client
