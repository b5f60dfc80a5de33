// SPDX-License-Identifier: MIT
// A ring of which the other side writes what it likes into the counters, whenever it likes: nothing is read or written
// outside of its memory, and whoever is lied to stops. Input: (what:u8 number:u8...)*.
#include <algorithm>
#include <cstring>
#include <vector>

#include "common/base/assert.h"
#include "common/wire/ring.h"
#include "tests/fuzz/input_pieces.h"

namespace {

using namespace wall;

std::uint64_t number(fuzz::InputPieces& input) {
    std::uint64_t value = 0;
    const auto bytes = input.bytes(sizeof value);
    std::memcpy(&value, bytes.data(), bytes.size());
    return value;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::InputPieces input(data, size);
    auto writer = wire::RingWriter::create(wire::RingMemory::kSmallest);
    WALL_ASSERT(writer);
    const UniqueFd mine(::dup(writer->descriptor()));
    auto reader = wire::RingReader::open(mine);
    auto other = wire::RingMemory::map(mine.get(), wire::RingMemory::kSmallest);
    WALL_ASSERT(reader && other);
    static const std::vector<std::byte> bytes(wire::RingMemory::kLargest >> 8, std::byte{42});
    std::vector<std::byte> room(bytes.size());
    bool lied = false;
    std::uint64_t written = 0, read = 0;
    for (bool good = true; good && !input.empty();) {
        const std::uint8_t what = input.byte();
        const std::size_t amount = std::min<std::size_t>(bytes.size(), std::size_t{what & 0xf8u} << 10);
        switch (what % 8) {
            case 0:
            case 1: written += writer->write(std::span(bytes).first(amount)); break;
            case 2:
            case 3:
                if (const auto got = reader->read(std::span(room).first(amount))) {
                    read += *got;
                    WALL_ASSERT(lied || std::all_of(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(*got),
                                                    [](std::byte b) { return b == std::byte{42}; }));
                } else {
                    WALL_ASSERT(lied);
                    good = false;
                }
                break;
            case 4: (void)writer->wait_for_room(); break;
            case 5: (void)reader->wait_for_more(); break;
            case 6: (void)writer->reader_waits(), (void)reader->writer_waits(); break;
            case 7:
                lied = true;
                ((what & 8) != 0 ? other->counters().written : other->counters().read).store(number(input));
                break;
        }
        good = good && !writer->broken();
        WALL_ASSERT(lied || (read <= written && written - read <= wire::RingMemory::kSmallest));
    }
    return 0;
}
