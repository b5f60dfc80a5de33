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
    if (tileserver::Capture* made = make(name)) made->define(mode, std::move(ranges));
}

tileserver::Capture* CaptureCommands::make(ClientName name) {
    const auto made = execution_.session.objects.make<tileserver::Capture>(name, execution_.node.driver);
    if (!made) return execution_.refuse(made.error().message), nullptr;
    if (!(*made)->defined()) return *made;
    return execution_.refuse("transform feedback is defined once"), nullptr;
}

void CaptureCommands::CaptureEnd(ClientName name) {
    const auto found = execution_.session.objects.get<tileserver::Capture>(name);
    if (!found) return execution_.refuse(found.error().message);
    (*found)->end();
}

void CaptureCommands::CaptureCounts(RequestId request, ClientName name) {
    const Timed timed(execution_.session.work.render);
    const auto found = execution_.session.objects.look_up<tileserver::Capture>(name);
    if (!found) return execution_.refuse(found.error().message);
    std::vector<std::byte> answer;
    if (*found != nullptr && (*found)->ended()) {
        const auto counts = std::as_bytes(std::span((*found)->counts()));
        answer.assign(counts.begin(), counts.end());
    }
    execution_.output.reply(request, std::move(answer));
}

void CaptureCommands::CaptureCounted(ClientName name, std::span<const std::byte> bytes) {
    tileserver::Capture::Counts counts{};
    if (bytes.size() != sizeof counts) return execution_.refuse("no counts of streams");
    std::memcpy(counts.data(), bytes.data(), sizeof counts);
    if (tileserver::Capture* made = make(name)) made->define_ended(counts);
}

}  // namespace wall::tileserver
