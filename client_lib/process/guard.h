// SPDX-License-Identifier: MIT
// No exception leaves the library: what programs call catches everything and ends in one of these. A try block costs
// nothing until something is thrown. Any thread.
#pragma once

#include <cstdint>

namespace wall::client {

enum class Caught : std::uint8_t { no_memory, other };

/// Called in a handler `catch (...)`: logs what was caught in which function. The unwinding of a thread that is
/// cancelled is no failure and goes on.
Caught caught_exception(const char* function);

}  // namespace wall::client
