// SPDX-License-Identifier: MIT
// FakeDrm behind the kernel's own interface: ioctl() and mmap() of this process are answered for one file, so that
// libdrm, GBM and EGL work as on a card that is nothing but memory (what Mesa then draws with is llvmpipe, as on vkms).
// The file is a pseudoterminal, since that is a character device with something to read. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "common/base/unique_fd.h"
#include "tests/unit/tileserver/kms/fake_drm.h"

namespace wall::tileserver::test {

class FakeKernel {
public:
    /// One at a time. `drm` outlives it.
    explicit FakeKernel(FakeDrm& drm);
    ~FakeKernel();
    FakeKernel(const FakeKernel&) = delete;

    /// To be opened as a card.
    const std::string& path() const { return path_; }
    /// All monitors show what was committed, and the card's events say so.
    void beat();
    /// The colour of a pixel that a connector's monitor shows, 0xRRGGBB, from the top left.
    std::uint32_t pixel_at(const std::string& connector, std::uint32_t x, std::uint32_t y) const;
    std::size_t buffers() const;

    bool atomic = true, nobody_is_master = true;

    // ---- of the process's calls ----
    static FakeKernel* of(int file);
    /// 0, or what errno is to be.
    int answer(unsigned long request, void* argument);
    void* map(std::size_t size, int protection, std::int64_t offset) const;

private:
    struct Buffer {
        std::uint32_t pitch;
        std::uint64_t offset;  // in memory_
    };
    using Answer = int (FakeKernel::*)(void* argument);
    static const std::map<unsigned long, Answer>& answers();

    int done(void*) { return 0; }
    int version(void* argument);
    int capability(void* argument);
    int client_capability(void* argument);
    int authorize(void* argument);
    int set_master(void* argument);
    int resources(void* argument);
    int connector(void* argument);
    int encoder(void* argument);
    int plane_resources(void* argument);
    int plane(void* argument);
    int properties(void* argument);
    int property(void* argument);
    int blob(void* argument);
    int make_blob(void* argument);
    int free_blob(void* argument);
    int add_framebuffer(void* argument);
    int remove_framebuffer(void* argument);
    int commit(void* argument);
    int make_buffer(void* argument);
    int map_buffer(void* argument);
    int free_buffer(void* argument);
    const Properties* properties_of(std::uint32_t object) const;
    std::uint64_t value_of(std::uint32_t object, const std::string& name) const;

    mutable std::mutex mutex_;  // guards all but what is constant
    FakeDrm& drm_;
    UniqueFd terminal_, memory_;
    std::string path_;
    std::map<std::uint32_t, Buffer> buffers_;              // by handle
    std::map<FramebufferId, std::uint32_t> framebuffers_;  // their buffers
    std::uint32_t next_handle_ = 1;
    std::uint64_t memory_size_ = 0;
};

}  // namespace wall::tileserver::test
