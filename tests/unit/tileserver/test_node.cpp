// SPDX-License-Identifier: MIT
#include "tests/unit/tileserver/test_node.h"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include "common/base/assert.h"

namespace wall::tileserver::test {

TestNode::TestNode(std::string_view backend, void (*change)(Gl& gl)) : backend_(open_backend(backend)) {
    if (!backend_ || !(*backend_)->make_current()) return;
    Gl gl;
    gl.load([this](const char* name) { return (*backend_)->get_proc_address(name); });
    if (change != nullptr) change(gl);
    driver = std::make_unique<Driver>(gl);
    node = std::make_unique<RenderNode>(*driver);
}

TestNode::~TestNode() = default;

void Seed::add(std::span<const std::byte> payload) {
    const auto batch = wire::split_batch(payload);
    if (!batch || batch->context != ContextId(1)) return;
    opcodes_.insert(opcodes_.begin(), batch->opcodes.begin(), batch->opcodes.end());
    operands_.insert(operands_.end(), batch->operands.begin(), batch->operands.end());
}

Seed::~Seed() {
    const char* folder = std::getenv("WALLGL_SEEDS");
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    if (folder == nullptr || test == nullptr || opcodes_.empty() || opcodes_.size() > 0xffff) return;
    static int number = 0;
    std::ofstream file(std::string(folder) + "/" + test->name() + "-" + std::to_string(++number), std::ios::binary);
    file.put(static_cast<char>(opcodes_.size() & 0xff)).put(static_cast<char>(opcodes_.size() >> 8));
    for (const auto& part : {opcodes_, operands_})
        file.write(reinterpret_cast<const char*>(part.data()), static_cast<std::streamsize>(part.size()));
}

void TestSession::open_surface(int window_width, int window_height, const geom::Rect& rect, ContextId context,
                               bool alpha) {
    Batch batch(context);
    pack::SurfaceCreate(batch.buffer(), SurfaceId(1), 1, alpha ? 8 : 0, 24, 8, 16, 0, 1, 0);
    pack::SurfacePlace(batch.buffer(), SurfaceId(1), 1, static_cast<std::uint32_t>(window_width),
                       static_cast<std::uint32_t>(window_height), rect.x, rect.y,
                       static_cast<std::uint32_t>(rect.width), static_cast<std::uint32_t>(rect.height), 0);
    pack::Bind(batch.buffer(), SurfaceId(1), SurfaceId(1));
    batch.set<el::viewport>({0, 0, static_cast<float>(window_width), static_cast<float>(window_height)});
    batch.set<el::scissor>({0, 0, window_width, window_height});
    const auto done = executor.run_batch(batch.payload());
    EXPECT_TRUE(done) << done.error().message;
}

Pixels TestSession::read(std::uint32_t slot, const geom::Rect& part, ContextId context) {
    Batch batch(context);
    pack::ReadPixels(batch.buffer(), kReadRequest, slot, part.x, part.y, part.width, part.height, GL_RGBA,
                     GL_UNSIGNED_BYTE);
    expect_run(batch);
    const auto& answer = replies[kReadRequest];
    Pixels pixels(answer.size());
    std::memcpy(pixels.data(), answer.data(), answer.size());
    return pixels;
}

}  // namespace wall::tileserver::test
