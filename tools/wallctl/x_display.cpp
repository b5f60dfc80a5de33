// SPDX-License-Identifier: MIT
#include "tools/wallctl/x_display.h"

#include <xcb/xcb.h>

#include <cstdlib>
#include <memory>

namespace wall::wallctl {

Result<void> check_display(const std::string& name) {
    const std::unique_ptr<xcb_connection_t, decltype(&xcb_disconnect)> server(xcb_connect(name.c_str(), nullptr),
                                                                              xcb_disconnect);
    if (xcb_connection_has_error(server.get()) != 0)
        return fail("display '" + name + "' does not let programs in: is the X server running, is XAUTHORITY right?");
    constexpr std::string_view kGlx = "GLX";
    const auto asked = xcb_query_extension(server.get(), kGlx.size(), kGlx.data());
    const std::unique_ptr<xcb_query_extension_reply_t, decltype(&std::free)> answer(
        xcb_query_extension_reply(server.get(), asked, nullptr), std::free);
    if (!answer || answer->present == 0)
        return fail("display '" + name + "' has no GLX: start its server with +extension GLX, or its driver's");
    return {};
}

}  // namespace wall::wallctl
