// SPDX-License-Identifier: MIT
// A batch's payload taken apart and put together (frame.h has the grammar). Pure.
#pragma once

#include <cstring>
#include <span>

#include "common/base/result.h"
#include "common/wire/frame.h"
#include "common/wire/limits.h"
#include "common/wire/padding.h"

namespace wall::wire {

struct BatchView {
    ContextId context;
    std::span<const std::byte> opcodes;  ///< last first
    std::span<const std::byte> operands;
};

/// Refuses a payload whose size is not exactly what its header says.
inline Result<BatchView> split_batch(std::span<const std::byte> payload) {
    BatchHeader header;
    if (payload.size() < sizeof header) return fail("batch: shorter than its header");
    std::memcpy(&header, payload.data(), sizeof header);
    if (header.opcode_bytes > kMaxBatchPayload || header.operand_bytes > kMaxBatchPayload)
        return fail("batch: larger than one may be");
    if (header.operand_bytes % 4 != 0) return fail("batch: operands are not a multiple of 4 bytes");
    const std::size_t room = padded4(header.opcode_bytes);
    if (payload.size() != sizeof header + room + header.operand_bytes)
        return fail("batch: size differs from its header");
    const auto content = payload.subspan(sizeof header);
    return BatchView{header.context, content.subspan(room - header.opcode_bytes, header.opcode_bytes),
                     content.subspan(room)};
}

/// The payload of one batch frame, appended to a vector of bytes.
template <class Bytes>
void append_batch(Bytes& to, const BatchView& batch) {
    const BatchHeader header{batch.context, static_cast<std::uint32_t>(batch.opcodes.size()),
                             static_cast<std::uint32_t>(batch.operands.size())};
    const std::size_t start = to.size(), padding = padded4(batch.opcodes.size()) - batch.opcodes.size();
    to.resize(start + sizeof header + padding + batch.opcodes.size() + batch.operands.size());
    std::byte* at = to.data() + start;
    std::memcpy(at, &header, sizeof header);
    at += sizeof header + padding;
    if (!batch.opcodes.empty()) std::memcpy(at, batch.opcodes.data(), batch.opcodes.size());
    if (!batch.operands.empty()) std::memcpy(at + batch.opcodes.size(), batch.operands.data(), batch.operands.size());
}

}  // namespace wall::wire
