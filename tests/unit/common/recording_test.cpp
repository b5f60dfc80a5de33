// SPDX-License-Identifier: MIT
// A recording is read as it was written, from each of its segments; what is damaged or cut short is said with its
// place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>

#include "common/glstate/command_walk.h"
#include "common/recording/reader.h"
#include "common/recording/stream_watch.h"
#include "common/recording/writer.h"
#include "common/wire/batch.h"
#include "gen/glapi/wire.gen.h"
#include "tests/support/temporary_folder.h"

namespace wall::recording {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

using Bytes = std::vector<std::byte>;

Bytes payload_of(const wire::PackBuffer& buffer) {
    Bytes out;
    wire::append_batch(out, {ContextId(1), buffer.opcodes(), buffer.operands()});
    return out;
}

/// A frame of a window, with content of its own.
Bytes frame(std::uint32_t number, bool last_of_segment = false) {
    wire::PackBuffer buffer;
    if (number == 1) {
        glapi::pack::SurfaceCreate(buffer, SurfaceId(1), 1, 0, 24, 8, 0, 0, 0, 0);
        glapi::pack::SurfacePlace(buffer, SurfaceId(1), 1, 64, 48, 0, 0, 64, 48, 0);
    }
    glapi::pack::Block(buffer, 1, 0, 1, 12);
    glapi::pack::Vertex3f(buffer, static_cast<float>(number), 2, 3);
    glapi::pack::Swap(buffer, SurfaceId(1), number);
    if (last_of_segment) glapi::pack::BeginAgain(buffer);
    return payload_of(buffer);
}

class ARecording : public testing::Test {
protected:
    std::string path() const { return folder_.file("recording"); }
    /// Segments of three frames each.
    Bytes write(std::size_t segments, bool finished = true) {
        auto writer = Writer::create(path(), {.stream = 7, .started = 5s, .program = "clock", .creator = "this test"});
        EXPECT_TRUE(writer);
        StreamWatch watch;
        for (std::size_t segment = 0; segment < segments; ++segment) {
            EXPECT_TRUE(writer->begin_segment(segment * 1s, watch.frames()));
            for (std::uint32_t i = 1; i <= 3; ++i) {
                const Bytes batch = frame(static_cast<std::uint32_t>(watch.frames()) + 1, i == 3);
                EXPECT_TRUE(watch.look(batch));
                EXPECT_TRUE(writer->add_batch(batch, segment * 1s + i * 100ms));
            }
        }
        if (!finished) return content();
        EXPECT_TRUE(writer->finish({.frames = watch.frames(), .segments = {}, .windows = watch.windows()}));
        return content();
    }
    Bytes content() const {
        std::ifstream file(path(), std::ios::binary);
        const std::string text((std::istreambuf_iterator<char>(file)), {});
        const auto bytes = std::as_bytes(std::span(text));
        return {bytes.begin(), bytes.end()};
    }
    /// What comes from there on; the error, if that ends it.
    static std::pair<std::vector<Bytes>, std::string> read(Reader& reader, std::size_t segment = 0) {
        reader.seek(segment);
        std::vector<Bytes> out;
        for (;;) {
            auto record = reader.next();
            if (!record) return {out, record.error().message};
            if (!*record) return {out, ""};
            if ((*record)->kind == RecordKind::batch)
                out.emplace_back((*record)->payload.begin(), (*record)->payload.end());
        }
    }

private:
    test::TemporaryFolder folder_;
};

TEST_F(ARecording, IsReadAsItWasWrittenFromEachSegment) {
    const Bytes file = write(3);
    auto reader = Reader::open(Source::of(file));
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ(reader->header().stream, 7u);
    EXPECT_EQ(reader->header().program, "clock");
    EXPECT_EQ(reader->header().creator, "this test");
    EXPECT_FALSE(reader->recovered());
    const Index& index = reader->index();
    EXPECT_EQ(index.frames, 9u);
    EXPECT_EQ(index.duration, 2300ms);
    EXPECT_THAT(index.windows, testing::ElementsAre(Window{SurfaceId(1), 64, 48}));
    ASSERT_EQ(index.segments.size(), 3u);
    for (std::size_t segment = 0; segment < 3; ++segment) {
        EXPECT_EQ(index.segments[segment].frame, 3 * segment);
        EXPECT_EQ(index.segments[segment].time, segment * 1s);
        const auto [batches, error] = read(*reader, segment);
        EXPECT_EQ(error, "");
        ASSERT_EQ(batches.size(), 9 - 3 * segment);
        EXPECT_EQ(batches.front(), frame(static_cast<std::uint32_t>(3 * segment + 1), false));
    }
}

TEST_F(ARecording, OfARecorderThatWasKilledHasAllThatIsWhole) {
    const Bytes file = write(2, false);
    auto reader = Reader::open(Source::of(file));
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_THAT(reader->recovered().value_or(""), HasSubstr("not finished"));
    EXPECT_EQ(reader->index().frames, 6u);
    EXPECT_EQ(reader->index().segments.size(), 2u);
    EXPECT_EQ(reader->index().segments[1].frame, 3u);
    EXPECT_THAT(reader->index().windows, testing::ElementsAre(Window{SurfaceId(1), 64, 48}));
    EXPECT_EQ(read(*reader).first.size(), 6u);
}

TEST_F(ARecording, CutShortAnywhereIsReadAsFarAsItGoes) {
    const Bytes file = write(2);
    std::size_t most = 0;
    for (std::size_t length = 0; length < file.size(); ++length) {
        auto reader = Reader::open(Source::of(std::span(file).first(length)));
        if (!reader) {
            EXPECT_NE(reader.error().message, "");
            EXPECT_EQ(most, 0u) << "at " << length;
            continue;
        }
        EXPECT_TRUE(reader->recovered()) << "at " << length;
        const auto [batches, error] = read(*reader);
        EXPECT_EQ(error, "") << "at " << length;
        EXPECT_GE(batches.size(), most) << "at " << length;
        most = batches.size();
        for (std::size_t i = 0; i < batches.size(); ++i)
            EXPECT_EQ(batches[i], frame(static_cast<std::uint32_t>(i + 1), i % 3 == 2)) << "at " << length;
    }
    EXPECT_EQ(most, 6u);
}

TEST_F(ARecording, SaysWhereItIsDamagedAndGoesOnBehind) {
    Bytes file = write(2);
    const auto whole = Reader::open(Source::of(file));
    ASSERT_TRUE(whole);
    const auto offset = whole->index().segments[0].offset + kRecordHeadBytes + sizeof(std::uint64_t) + kRecordHeadBytes;
    file[offset + 2] ^= std::byte{1};
    auto reader = Reader::open(Source::of(file));
    ASSERT_TRUE(reader) << reader.error().message;
    const auto [batches, error] = read(*reader);
    EXPECT_TRUE(batches.empty());
    EXPECT_THAT(error, HasSubstr("at byte " + std::to_string(offset - kRecordHeadBytes)));
    EXPECT_THAT(error, HasSubstr("damaged"));
    EXPECT_EQ(read(*reader, 1).first.size(), 3u);
}

TEST_F(ARecording, NoBitOfItCanChangeWithoutBeingNoticed) {
    const Bytes file = write(1);
    auto whole = Reader::open(Source::of(file));
    ASSERT_TRUE(whole);
    const auto expected = read(*whole).first;
    for (std::size_t at = 0; at < file.size(); ++at) {
        Bytes damaged = file;
        damaged[at] ^= std::byte{0x10};
        auto reader = Reader::open(Source::of(damaged));
        if (!reader || reader->recovered()) continue;
        const auto [batches, error] = read(*reader);
        EXPECT_NE(error, "") << "at " << at;
        for (std::size_t i = 0; i < batches.size(); ++i) EXPECT_EQ(batches[i], expected[i]) << "at " << at;
    }
}

TEST_F(ARecording, OfAnotherFormatOrOfNoneIsRefusedWithTheReason) {
    Bytes file = write(1);
    const Bytes text(40, std::byte{'x'});
    auto none = Reader::open(Source::of(text));
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message, HasSubstr("no recording of commands"));
    file[kMagic.size()] = std::byte{kFormat + 1};
    auto later = Reader::open(Source::of(file));
    ASSERT_FALSE(later);
    EXPECT_THAT(later.error().message, HasSubstr("format 2; this WallGL reads format 1"));
}

TEST_F(ARecording, LargeBatchesComeInParts) {
    std::mt19937_64 random(1);
    wire::PackBuffer buffer;
    Bytes noise(2 * kMostPlain + 1000);
    for (std::size_t at = 0; at + sizeof(std::uint64_t) <= noise.size(); at += sizeof(std::uint64_t)) {
        const std::uint64_t word = random();
        std::memcpy(noise.data() + at, &word, sizeof word);
    }
    glapi::pack::BufferSubData(buffer, ClientName(1), 0, noise);
    const Bytes batch = payload_of(buffer);
    {
        auto writer = Writer::create(path(), {});
        ASSERT_TRUE(writer);
        ASSERT_TRUE(writer->begin_segment({}, 0));
        ASSERT_TRUE(writer->add_batch(batch, {}));
        ASSERT_TRUE(writer->finish({}));
    }
    const Bytes file = content();
    auto reader = Reader::open(Source::of(file));
    ASSERT_TRUE(reader) << reader.error().message;
    const auto [batches, error] = read(*reader);
    EXPECT_EQ(error, "");
    ASSERT_EQ(batches.size(), 1u);
    EXPECT_EQ(batches[0], batch);
}

TEST_F(ARecording, WithoutASegmentIsNone) {
    const Bytes file = write(0);
    auto reader = Reader::open(Source::of(file));
    ASSERT_FALSE(reader);
    EXPECT_THAT(reader.error().message, HasSubstr("nothing in it"));
}

// ---- the stream as it goes by ----

TEST(CommandWalk, GivesEachCommandWithItsOperands) {
    wire::PackBuffer buffer;
    const glstate::Vec4 value{1, 0, 0, 1};
    const std::array<std::byte, 5> pixels{};
    glapi::pack::Sync(buffer, RequestId(9));
    glapi::pack_state(buffer, glstate::el::clear_color::id, &value, sizeof value);
    glapi::pack::Block(buffer, 3, 0, 2, 12);
    glapi::pack::Vertex3f(buffer, 1, 2, 3);
    glapi::pack::End(buffer);
    glapi::pack::TexSubImage(buffer, ClientName(2), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, pixels);
    glstate::CommandWalk walk(buffer.opcodes(), buffer.operands());
    const auto next = [&] {
        auto command = walk.next();
        EXPECT_TRUE(command && *command);
        return **command;
    };
    EXPECT_EQ(next().word(0), 9u);
    EXPECT_EQ(next().op, glapi::Op::State);
    const auto block = next();
    EXPECT_EQ(block.op, glapi::Op::Block);
    EXPECT_EQ(block.block_opcodes.size(), 2u);
    EXPECT_EQ(block.block_operands.size(), 12u);
    const auto image = next();
    EXPECT_EQ(image.op, glapi::Op::TexSubImage);
    EXPECT_EQ(image.operands.size(), glapi::kOpFixedBytes[static_cast<std::size_t>(image.op)] + 8) << "padded";
    const auto end = walk.next();
    EXPECT_TRUE(end && !*end);
}

TEST(CommandWalk, RefusesWhatEndsEarly) {
    wire::PackBuffer buffer;
    glapi::pack::Block(buffer, 3, 0, 1, 12);
    glapi::pack::Vertex3f(buffer, 1, 2, 3);
    for (std::size_t bytes = 0; bytes < buffer.operand_bytes(); bytes += 4) {
        glstate::CommandWalk walk(buffer.opcodes(), buffer.operands().first(bytes));
        EXPECT_FALSE(walk.next()) << bytes;
    }
    glstate::CommandWalk few(buffer.opcodes().last(1), buffer.operands());
    EXPECT_FALSE(few.next()) << "the block's command is not there";
}

TEST(StreamWatch, SeesFramesAndWhereTheStreamBeginsAgain) {
    StreamWatch watch;
    const auto first = watch.look(frame(1));
    ASSERT_TRUE(first);
    EXPECT_FALSE(first->begins_again);
    ASSERT_EQ(first->swaps.size(), 1u);
    EXPECT_EQ(first->swaps[0].frame, 1u);
    const auto second = watch.look(frame(2, true));
    ASSERT_TRUE(second);
    EXPECT_TRUE(second->begins_again);
    EXPECT_EQ(watch.frames(), 2u);
    EXPECT_FALSE(watch.look(Bytes(7)));
}

}  // namespace
}  // namespace wall::recording
