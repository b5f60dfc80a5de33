// SPDX-License-Identifier: MIT
#include "tileserver/kms/libdrm_device.h"

#include <drm_fourcc.h>
#include <fcntl.h>
#include <poll.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "tileserver/kms/libdrm_describe.h"

namespace wall::tileserver {
namespace {

std::uint32_t flags_of(CommitKind kind) {
    switch (kind) {
        case CommitKind::flip: return DRM_MODE_ATOMIC_NONBLOCK | DRM_MODE_PAGE_FLIP_EVENT;
        case CommitKind::mode: return DRM_MODE_ATOMIC_ALLOW_MODESET | DRM_MODE_PAGE_FLIP_EVENT;
        case CommitKind::dark: return DRM_MODE_ATOMIC_ALLOW_MODESET;
    }
    return 0;
}

/// "video" is Debian's group of /dev/dri/card*.
std::string open_error(const std::string& path) {
    const std::string why = std::strerror(errno);
    return path + " cannot be opened: " + why + (errno == EACCES ? " (is the user in the group \"video\"?)" : "");
}

}  // namespace

Result<std::unique_ptr<LibdrmDevice>> LibdrmDevice::open(const std::string& path) {
    UniqueFd file(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK));
    if (!file) return fail(open_error(path));
    std::unique_ptr<LibdrmDevice> out(new LibdrmDevice(path, std::move(file)));
    const int fd = out->descriptor();
    if (drmIsKMS(fd) == 0) return fail(path + " has no connectors for monitors");
    if (drmSetClientCap(fd, DRM_CLIENT_CAP_UNIVERSAL_PLANES, 1) != 0 ||
        drmSetClientCap(fd, DRM_CLIENT_CAP_ATOMIC, 1) != 0) {
        drmVersion* version = drmGetVersion(fd);
        const std::string driver = version != nullptr ? std::string(version->name, version->name_len) : "its driver";
        drmFreeVersion(version);
        return fail(path + ": " + driver +
                    " has no atomic mode setting: expected output = \"window\", with an X server, for its tiles");
    }
    std::uint64_t value = 0;
    out->orders_ = drmGetCap(fd, DRM_CAP_ADDFB2_MODIFIERS, &value) == 0 && value != 0;
    return out;
}

Result<void> LibdrmDevice::become_master() {
    // Who opens a card that is nobody's has it already; kernels before 5.8 let only root ask for it.
    if (drmIsMaster(file_.get()) == 0 && drmSetMaster(file_.get()) != 0)
        return fail("somebody else shows pictures on " + path_ +
                    ": end the X server, the Wayland compositor or the other tileserver that does");
    auto uevents = Uevents::open(std::filesystem::path(path_).lexically_relative("/dev"));
    if (!uevents) return tl::unexpected(uevents.error());
    uevents_ = std::move(*uevents);
    return {};
}

void LibdrmDevice::give_up_master() { drmDropMaster(file_.get()); }

Result<Card> LibdrmDevice::describe() { return describe_card(file_.get(), path_); }

Error LibdrmDevice::error(const std::string& what) const { return {path_ + ": " + what + ": " + std::strerror(errno)}; }

Result<BlobId> LibdrmDevice::make_blob(std::span<const std::byte> bytes) {
    std::uint32_t out = 0;
    if (drmModeCreatePropertyBlob(file_.get(), bytes.data(), bytes.size(), &out) != 0)
        return tl::unexpected(error("no mode can be made"));
    return BlobId(out);
}

void LibdrmDevice::free_blob(BlobId blob) { drmModeDestroyPropertyBlob(file_.get(), blob.value); }

Result<FramebufferId> LibdrmDevice::add_framebuffer(const BufferLayout& layout) {
    std::uint32_t out = 0;
    std::array<std::uint64_t, BufferLayout::kMostParts> orders{};
    for (std::size_t part = 0; part < layout.parts; ++part) orders[part] = layout.order;
    const bool with_order = orders_ && layout.order != BufferLayout::kUsualOrder;
    const int failed =
        with_order ? drmModeAddFB2WithModifiers(file_.get(), layout.width, layout.height, layout.format,
                                                layout.handles.data(), layout.pitches.data(), layout.offsets.data(),
                                                orders.data(), &out, DRM_MODE_FB_MODIFIERS)
                   : drmModeAddFB2(file_.get(), layout.width, layout.height, layout.format, layout.handles.data(),
                                   layout.pitches.data(), layout.offsets.data(), &out, 0);
    if (failed != 0) return tl::unexpected(error("a picture cannot be shown"));
    return FramebufferId(out);
}

void LibdrmDevice::remove_framebuffer(FramebufferId framebuffer) { drmModeRmFB(file_.get(), framebuffer.value); }

std::errc LibdrmDevice::commit(const AtomicRequest& request, CommitKind kind) {
    const std::unique_ptr<drmModeAtomicReq, decltype(&drmModeAtomicFree)> all(drmModeAtomicAlloc(), drmModeAtomicFree);
    for (const auto& [object, property, value] : request.changes())
        if (drmModeAtomicAddProperty(all.get(), object, property.value, value) < 0) return std::errc::not_enough_memory;
    const int failed = drmModeAtomicCommit(file_.get(), all.get(), flags_of(kind), nullptr);
    return failed == 0 ? std::errc{} : static_cast<std::errc>(-failed);
}

Result<std::vector<CrtcId>> LibdrmDevice::take_flips() {
    // drmHandleEvent() has room for a pointer with each commit only, so it speaks to this thread.
    thread_local std::vector<CrtcId> arrived;
    arrived.clear();
    drmEventContext handlers{};
    handlers.version = 3;  // the first with page_flip_handler2
    handlers.page_flip_handler2 = [](int, unsigned, unsigned, unsigned, unsigned crtc, void*) {
        arrived.emplace_back(crtc);
    };
    pollfd what{file_.get(), POLLIN, 0};
    while (::poll(&what, 1, 0) > 0) {
        if (what.revents != POLLIN) return fail(path_ + " is gone");
        if (drmHandleEvent(file_.get(), &handlers) != 0) return tl::unexpected(error("its events cannot be read"));
    }
    return arrived;
}

bool LibdrmDevice::take_hot_plug() { return uevents_ && uevents_->take(); }

}  // namespace wall::tileserver
