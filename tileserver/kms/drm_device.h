// SPDX-License-Identifier: MIT
// What is wanted of the kernel's mode setting, as little as possible, so that tests can stand in for it
// (libdrm_device.h is the real one). Render thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "common/base/result.h"
#include "tileserver/kms/atomic_request.h"
#include "tileserver/kms/card.h"

namespace wall::tileserver {

/// A picture in the card's memory, as who drew it says.
struct BufferLayout {
    static constexpr std::size_t kMostParts = 4;
    static constexpr std::uint64_t kUsualOrder = 0x00ff'ffff'ffff'ffff;  ///< DRM_FORMAT_MOD_INVALID: the driver knows
    std::uint32_t width = 0, height = 0;                                 ///< pixels
    std::uint32_t format = 0;                                            ///< its four characters, such as XR24
    std::uint64_t order = kUsualOrder;                                   ///< of its pixels: a "modifier"
    std::size_t parts = 1;                                               ///< of the arrays that count
    std::array<std::uint32_t, kMostParts> handles{}, pitches{}, offsets{};
};

enum class CommitKind {
    flip,  ///< other pictures: returns at once, and each CRTC tells when it shows its own
    mode,  ///< signals as well: waits until they are set, and each CRTC tells
    dark,  ///< signals are ended: waits, and nobody tells
};

class DrmDevice {
public:
    virtual ~DrmDevice() = default;
    DrmDevice() = default;
    DrmDevice(const DrmDevice&) = delete;
    DrmDevice& operator=(const DrmDevice&) = delete;

    /// Such as /dev/dri/card0.
    virtual const std::string& name() const = 0;
    /// Asks the monitors, which may take a tenth of a second each.
    virtual Result<Card> describe() = 0;
    virtual Result<BlobId> make_blob(std::span<const std::byte> bytes) = 0;
    virtual void free_blob(BlobId blob) = 0;
    virtual Result<FramebufferId> add_framebuffer(const BufferLayout& layout) = 0;
    /// A monitor that shows it goes dark.
    virtual void remove_framebuffer(FramebufferId framebuffer) = 0;
    /// No error: done. device_or_resource_busy: an earlier one is not done yet; invalid_argument: the driver cannot do
    /// it; permission_denied: somebody else shows pictures on the card.
    [[nodiscard]] virtual std::errc commit(const AtomicRequest& request, CommitKind kind) = 0;
    /// The CRTCs that have told since the last call.
    virtual Result<std::vector<CrtcId>> take_flips() = 0;
    /// Since the last call something was plugged in or out.
    virtual bool take_hot_plug() = 0;
};

}  // namespace wall::tileserver
