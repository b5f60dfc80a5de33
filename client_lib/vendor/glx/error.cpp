// SPDX-License-Identifier: MIT
#include "client_lib/vendor/glx/error.h"

#include <X11/Xlibint.h>
#undef min
#undef max

#include "client_lib/process/log.h"

namespace wall::client::glx {
namespace {

void send(Display* display, int code, bool core, XID resource, int minor_opcode) {
    log(LogLevel::debug, "x_error code=%d core=%d resource=0x%lx request=%d", code, core, resource, minor_opcode);
    int major = 0, first_event = 0, first_error = 0;
    const bool has_glx = XQueryExtension(display, "GLX", &major, &first_event, &first_error);
    if (!has_glx && !core) return;
    xError error{};
    error.type = X_Error;
    error.errorCode = static_cast<BYTE>(core ? code : first_error + code);
    error.resourceID = static_cast<CARD32>(resource);
    error.minorCode = static_cast<CARD16>(minor_opcode);
    error.majorCode = static_cast<CARD8>(major);
    LockDisplay(display);
    error.sequenceNumber = static_cast<CARD16>(display->request);
    _XError(display, &error);
    UnlockDisplay(display);
}

}  // namespace

void send_glx_error(Display* display, int code, XID resource, int minor_opcode) {
    send(display, code, false, resource, minor_opcode);
}

void send_x_error(Display* display, int code, XID resource, int minor_opcode) {
    send(display, code, true, resource, minor_opcode);
}

}  // namespace wall::client::glx
