// SPDX-License-Identifier: MIT
#include "tileserver/kms/kms_backend.h"

#include <utility>

#include "tileserver/kms/cards.h"
#include "tileserver/kms/gbm_surfaces.h"
#include "tileserver/kms/kms_screens.h"

namespace wall::tileserver {
namespace {

class KmsBackend final : public GlBackend {
public:
    explicit KmsBackend(std::unique_ptr<LibdrmDevice> device) : device_(std::move(device)) {}
    Result<void> open(const MonitorRequest& request) {
        if (auto master = device_->become_master(); !master) return master;
        auto surfaces = GbmSurfaces::open(*device_, device_->descriptor());
        if (!surfaces) return tl::unexpected(surfaces.error());
        surfaces_ = std::move(*surfaces);
        auto screens = KmsScreens::open(*device_, *surfaces_, request.wishes, request.background);
        if (!screens) return tl::unexpected(screens.error());
        screens_ = std::move(*screens);
        return {};
    }
    /// A monitor's surface has been since open(), so that the context begins with a default framebuffer.
    Result<void> make_current() override { return {}; }
    void* get_proc_address(const char* name) const override { return reinterpret_cast<void*>(eglGetProcAddress(name)); }
    std::string_view name() const override { return "egl"; }
    TileScreens* screens() override { return screens_.get(); }

private:
    std::unique_ptr<LibdrmDevice> device_;  // to the end
    std::unique_ptr<GbmSurfaces> surfaces_;
    std::unique_ptr<KmsScreens> screens_;
};

/// The card, if it can show them. It is asked before anything is changed.
Result<std::unique_ptr<LibdrmDevice>> open_for(const std::string& path, std::span<const MonitorWish> wishes) {
    auto device = LibdrmDevice::open(path);
    if (!device) return device;
    const auto card = (*device)->describe();
    if (!card) return tl::unexpected(card.error());
    if (const auto plans = plan_screens(*card, wishes); !plans) return tl::unexpected(plans.error());
    return device;
}

}  // namespace

Result<std::unique_ptr<GlBackend>> open_kms_backend(const MonitorRequest& request) {
    const auto paths = choose_cards(card_files(), request.gpu);
    if (!paths) return tl::unexpected(paths.error());
    std::string why;
    for (const auto& path : *paths) {
        auto device = open_for(path, request.wishes);
        if (!device) {
            why += (why.empty() ? "" : "; ") + device.error().message;
            continue;
        }
        return open_kms_backend(std::move(*device), request);
    }
    return fail(why);
}

Result<std::unique_ptr<GlBackend>> open_kms_backend(std::unique_ptr<LibdrmDevice> card, const MonitorRequest& request) {
    auto backend = std::make_unique<KmsBackend>(std::move(card));
    if (auto opened = backend->open(request); !opened) return tl::unexpected(opened.error());
    return backend;
}

}  // namespace wall::tileserver
