// SPDX-License-Identifier: MIT
#include "client_lib/context/captured_content.h"

#include <algorithm>

#include "client_lib/context/ask_one.h"
#include "client_lib/context/buffer_use.h"
#include "client_lib/follow/object_sender.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

void fetch_captured(Context& c, const std::shared_ptr<Buffer>& buffer, const char* function) {
    std::size_t size = 0;
    {
        std::lock_guard lock(c.share().mutex);
        if (!buffer->is_drawn()) return;
        size = buffer->size();
    }
    std::vector<std::byte> content;
    for (std::size_t at = 0; at < size; at += kLargestBufferCommand) {
        const std::size_t bytes = std::min(kLargestBufferCommand, size - at);
        const auto answer = ask_one_node(c, function, [&](wire::PackBuffer& batch, RequestId request, Node& node) {
            {
                std::lock_guard lock(c.share().mutex);
                ObjectSender(c.session().nodes(), node, batch).send(*buffer);
            }
            glapi::pack::BufferRead(batch, request, buffer->id, static_cast<std::uint32_t>(at),
                                    static_cast<std::uint32_t>(bytes));
        });
        if (!answer || answer->bytes.size() != bytes) return;  // nobody has it
        content.insert(content.end(), answer->bytes.begin(), answer->bytes.end());
    }
    std::lock_guard lock(c.share().mutex);
    if (buffer->size() == content.size()) buffer->take_drawn(content);
}

void fetch_captured(Context& c, ClientName id, const char* function) {
    const auto found = c.buffers->by_id.find(id);
    if (found != c.buffers->by_id.end()) fetch_captured(c, found->second, function);
}

}  // namespace wall::client
