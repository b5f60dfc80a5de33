// SPDX-License-Identifier: MIT
// A graphics card of this machine by the kernel's atomic mode setting (libdrm). Render thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/unique_fd.h"
#include "tileserver/kms/drm_device.h"
#include "tileserver/kms/uevents.h"

namespace wall::tileserver {

class LibdrmDevice final : public DrmDevice {
public:
    /// `path`: such as /dev/dri/card0. It can be described then. The error says what the card or the driver lacks.
    static Result<std::unique_ptr<LibdrmDevice>> open(const std::string& path);
    /// It may show pictures then, until it is closed. The error: somebody else does.
    Result<void> become_master();
    /// Whoever wants to show pictures may; it can be described only.
    void give_up_master();

    /// As long as this lives.
    int descriptor() const { return file_.get(); }
    const std::string& name() const override { return path_; }
    Result<Card> describe() override;
    Result<BlobId> make_blob(std::span<const std::byte> bytes) override;
    void free_blob(BlobId blob) override;
    Result<FramebufferId> add_framebuffer(const BufferLayout& layout) override;
    void remove_framebuffer(FramebufferId framebuffer) override;
    [[nodiscard]] std::errc commit(const AtomicRequest& request, CommitKind kind) override;
    Result<std::vector<CrtcId>> take_flips() override;
    bool take_hot_plug() override;

private:
    LibdrmDevice(std::string path, UniqueFd file) : path_(std::move(path)), file_(std::move(file)) {}
    Error error(const std::string& what) const;

    std::string path_;
    UniqueFd file_;
    bool orders_ = false;  // of pixels can be said with a framebuffer
    std::optional<Uevents> uevents_;
};

}  // namespace wall::tileserver
