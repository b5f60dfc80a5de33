// SPDX-License-Identifier: MIT
// Monitors of one graphics card that show tiles without a window system: all pictures of a moment in one atomic commit,
// monitors that go and come again. Render thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tileserver/gpu/tile_screens.h"
#include "tileserver/kms/drm_device.h"
#include "tileserver/kms/flip_track.h"
#include "tileserver/kms/scanout_surface.h"
#include "tileserver/kms/screen_plan.h"

namespace wall::tileserver {

class KmsScreens final : public TileScreens {
public:
    /// Sets the monitors' modes and shows `background` (0xRRGGBB) on all that are there; what else the card shows goes
    /// dark. One of them is selected then. `device` and `surfaces` outlive it.
    static Result<std::unique_ptr<KmsScreens>> open(DrmDevice& device, ScanoutSurfaces& surfaces,
                                                    std::span<const MonitorWish> wishes, std::uint32_t background);
    /// Monitors go dark when their pictures are freed.
    ~KmsScreens() override;

    std::size_t count() const override { return screens_.size(); }
    TileScreen& at(std::size_t i) const override;
    std::chrono::nanoseconds refresh_period() const override;
    /// Hears of pictures that have arrived and of monitors that were plugged in or out; sends what waits. An error: the
    /// card is somebody else's, or has not answered for kFlightLimit.
    Result<void> take_events() override;
    bool busy() const override { return flips_.busy(); }
    Result<void> select(std::size_t i) override;
    Result<void> swap(std::size_t i) override;
    Result<void> show() override { return send(); }
    std::vector<MonitorNews> take_news() override;

    static constexpr std::chrono::seconds kFlightLimit{5};

private:
    class Screen;
    KmsScreens(DrmDevice& device, ScanoutSurfaces& surfaces, std::size_t count);

    Result<void> begin(const Card& card, std::uint32_t background);
    /// Hears which pictures have arrived.
    Result<void> hear_flips();
    /// Compares the monitors with those that there were.
    Result<void> look_again();
    /// Gets ready to show something on what is plugged in now.
    Result<void> light(Screen& screen);
    void darken(std::size_t i, const std::string& why);
    Result<void> send();
    Result<void> send(const FlipTrack::Group& group);
    /// Does without what the driver refuses, if that is possible: the rest waits for the next send().
    Result<void> refused(const FlipTrack::Group& group, std::errc error);
    void tell(const Screen& screen, const std::string& note = {});
    Error commit_error(const std::string& what, std::errc error) const;

    DrmDevice& device_;
    ScanoutSurfaces& surfaces_;
    std::vector<std::unique_ptr<Screen>> screens_;
    FlipTrack flips_;
    std::vector<MonitorNews> news_;
    std::size_t current_ = ~std::size_t{};  // index; beyond the end: none
};

}  // namespace wall::tileserver
