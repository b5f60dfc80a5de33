// SPDX-License-Identifier: MIT
#include "client_lib/process/guard.h"

#include <cxxabi.h>

#include <exception>
#include <new>
#include <stdexcept>

#include "client_lib/process/log.h"

namespace wall::client {

Caught caught_exception(const char* function) {
    try {
        throw;
    } catch (abi::__forced_unwind&) {
        throw;
    } catch (const std::bad_alloc&) {
        log(LogLevel::error, "event=out_of_memory function=%s", function);
        return Caught::no_memory;
    } catch (const std::length_error&) {  // more than any vector can hold
        log(LogLevel::error, "event=out_of_memory function=%s", function);
        return Caught::no_memory;
    } catch (const std::exception& e) {
        log(LogLevel::error, "event=exception function=%s what=%s", function, e.what());
    } catch (...) {
        log(LogLevel::error, "event=exception function=%s", function);
    }
    return Caught::other;
}

}  // namespace wall::client
