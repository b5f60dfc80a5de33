// SPDX-License-Identifier: MIT
#include "tileserver/execute/capture_commands.h"

#include <cstring>
#include <utility>
#include <vector>

#include "tileserver/objects/capture.h"

namespace wall::tileserver {

void CaptureCommands::Capture(ClientName name, GLenum mode, std::span<const std::byte> parts) {
    std::vector<glstate::BufferRange> ranges(parts.size() / sizeof(glstate::BufferRange));
    if (parts.size() % sizeof(glstate::BufferRange) != 0 || ranges.size() > kMostCaptured)
        return execution_.refuse("no parts of buffers");
    if (mode != GL_POINTS && mode != GL_LINES && mode != GL_TRIANGLES) return execution_.refuse("no such primitives");
    if (!parts.empty()) std::memcpy(ranges.data(), parts.data(), parts.size());
    const auto made = execution_.session.objects.make<tileserver::Capture>(name, execution_.node.driver);
    if (!made) return execution_.refuse(made.error().message);
    if ((*made)->defined()) return execution_.refuse("transform feedback is defined once");
    (*made)->define(mode, std::move(ranges));
}

}  // namespace wall::tileserver
