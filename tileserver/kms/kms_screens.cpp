// SPDX-License-Identifier: MIT
#include "tileserver/kms/kms_screens.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace wall::tileserver {
namespace {

constexpr std::uint32_t kUsualRate = 60'000;  // millihertz
constexpr auto kNone = ~std::size_t{};

}  // namespace

class KmsScreens::Screen final : public TileScreen {
public:
    Screen(const MonitorWish& wish, ScreenPlan its_plan)
        : TileScreen(wish.slot, wish.tile), mode_wish(wish.mode), plan(std::move(its_plan)) {}

    /// It has a monitor, and a mode that that is to have.
    bool lit() const { return surface != nullptr; }
    void begin(Mode chosen, BlobId its_timing, std::unique_ptr<ScanoutSurface> its_surface) {
        mode = std::move(chosen);
        timing = its_timing;
        surface = std::move(its_surface);
        mode_is_set = false;
        resize(mode.width, mode.height);
    }
    void end() {
        surface.reset();
        resize(0, 0);
    }
    bool shows() const { return lit() && mode_is_set; }
    /// The monitor waits for its mode to be set again.
    void set_again() {
        mode_is_set = false;
        expose();
    }

    const std::optional<ModeWish> mode_wish;
    ScreenPlan plan;
    Mode mode;
    BlobId timing;
    std::unique_ptr<ScanoutSurface> surface;
    bool mode_is_set = false;
};

KmsScreens::KmsScreens(DrmDevice& device, ScanoutSurfaces& surfaces, std::size_t count)
    : device_(device), surfaces_(surfaces), flips_(count) {}

Result<std::unique_ptr<KmsScreens>> KmsScreens::open(DrmDevice& device, ScanoutSurfaces& surfaces,
                                                     std::span<const MonitorWish> wishes, std::uint32_t background) {
    const auto card = device.describe();
    if (!card) return tl::unexpected(card.error());
    auto plans = plan_screens(*card, wishes);
    if (!plans) return tl::unexpected(plans.error());
    std::unique_ptr<KmsScreens> out(new KmsScreens(device, surfaces, wishes.size()));
    for (std::size_t i = 0; i < wishes.size(); ++i)
        out->screens_.push_back(std::make_unique<Screen>(wishes[i], std::move((*plans)[i])));
    if (auto begun = out->begin(*card, background); !begun) return tl::unexpected(begun.error());
    return out;
}

KmsScreens::~KmsScreens() {
    static_cast<void>(surfaces_.select_none());
    for (const auto& screen : screens_) {
        screen->end();
        if (screen->timing) device_.free_blob(screen->timing);
    }
}

Result<void> KmsScreens::begin(const Card& card, std::uint32_t background) {
    AtomicRequest dark;
    dark.set_all_dark(card);
    if (!dark.changes().empty())
        if (const auto error = device_.commit(dark, CommitKind::dark); error != std::errc{})
            return tl::unexpected(commit_error("to end what was shown before", error));
    for (std::size_t i = 0; i < screens_.size(); ++i) {
        Screen& screen = *screens_[i];
        if (!screen.plan.connector.connected) {
            tell(screen, "no monitor at " + screen.plan.connector.name + ": " + connected_monitors(card));
            continue;
        }
        if (auto lit = light(screen); !lit) return lit;
        if (auto selected = select(i); !selected) return selected;
        surfaces_.clear(background);
        if (auto swapped = swap(i); !swapped) return swapped;
    }
    return send();
}

TileScreen& KmsScreens::at(std::size_t i) const { return *screens_[i]; }

std::chrono::nanoseconds KmsScreens::refresh_period() const {
    std::uint32_t fastest = 0;
    for (const auto& screen : screens_)
        if (screen->lit()) fastest = std::max(fastest, screen->mode.millihertz);
    return std::chrono::nanoseconds(std::llround(1e12 / (fastest >= 1000 ? fastest : kUsualRate)));
}

std::vector<MonitorNews> KmsScreens::take_news() { return std::exchange(news_, {}); }

Result<void> KmsScreens::take_events() {
    if (auto heard = hear_flips(); !heard) return heard;
    if (device_.take_hot_plug())
        if (auto looked = look_again(); !looked) return looked;
    if (flips_.longest_flight(FlipTrack::Clock::now()) > kFlightLimit)
        return fail(device_.name() + " has not said for " + std::to_string(kFlightLimit.count()) +
                    " s that a picture is shown");
    return send();
}

Result<void> KmsScreens::hear_flips() {
    const auto flips = device_.take_flips();
    if (!flips) return tl::unexpected(flips.error());
    for (const CrtcId crtc : *flips)
        for (std::size_t i = 0; i < screens_.size(); ++i) {
            Screen& screen = *screens_[i];
            if (screen.plan.crtc.id != crtc) continue;
            if (const auto free = flips_.arrived(i); free && screen.lit()) screen.surface->release(*free);
        }
    return {};
}

Result<void> KmsScreens::look_again() {
    const auto card = device_.describe();
    if (!card) return tl::unexpected(card.error());
    for (std::size_t i = 0; i < screens_.size(); ++i) {
        Screen& screen = *screens_[i];
        const Connector* now = card->find(screen.plan.connector.name);  // it may be another one under that name
        const bool connected = now != nullptr && now->connected;
        const bool other =
            connected && (now->id != screen.plan.connector.id || std::ranges::count(now->modes, screen.mode) == 0 ||
                          now->monitor != screen.plan.connector.monitor);
        if (screen.lit() && !connected) darken(i, "the monitor was unplugged");
        if (screen.lit() && other) darken(i, "another monitor was plugged in");
        if (now != nullptr) screen.plan.connector = *now;
        if (!connected) continue;
        if (screen.lit() && now->link_bad) screen.set_again();
        if (screen.lit()) continue;
        if (auto lit = light(screen); !lit) tell(screen, lit.error().message);
    }
    return {};
}

Result<void> KmsScreens::light(Screen& screen) {
    auto mode = choose_mode(screen.plan.connector, screen.mode_wish);
    if (!mode) return tl::unexpected(mode.error());
    const auto timing = device_.make_blob(mode->timing);
    if (!timing) return tl::unexpected(timing.error());
    auto surface = surfaces_.make(*mode);
    if (!surface) {
        device_.free_blob(*timing);
        return tl::unexpected(surface.error());
    }
    screen.begin(std::move(*mode), *timing, std::move(*surface));
    return {};
}

void KmsScreens::darken(std::size_t i, const std::string& why) {
    Screen& screen = *screens_[i];
    AtomicRequest dark;
    dark.set_dark(screen.plan);
    // Where the driver refuses it, the signal ends with the picture.
    static_cast<void>(device_.commit(dark, CommitKind::dark));
    static_cast<void>(hear_flips());  // so that what it had in flight is not mistaken for what comes
    if (current_ == i) {
        static_cast<void>(surfaces_.select_none());
        current_ = kNone;
    }
    flips_.drop(i);
    screen.end();
    device_.free_blob(std::exchange(screen.timing, {}));
    tell(screen, why);
}

Result<void> KmsScreens::select(std::size_t i) {
    if (current_ == i) return {};
    if (auto selected = screens_[i]->surface->select(); !selected) return selected;
    current_ = i;
    return {};
}

Result<void> KmsScreens::swap(std::size_t i) {
    const auto picture = screens_[i]->surface->swap();
    if (!picture) return fail("tile '" + screens_[i]->tile() + "': " + picture.error().message);
    flips_.take(i, *picture);
    return {};
}

Result<void> KmsScreens::send() {
    for (const auto& group : flips_.due())
        if (auto sent = send(group); !sent) return sent;
    return {};
}

Result<void> KmsScreens::send(const FlipTrack::Group& group) {
    AtomicRequest request;
    auto kind = CommitKind::flip;
    for (const std::size_t i : group) {
        const Screen& screen = *screens_[i];
        if (!screen.mode_is_set) {
            kind = CommitKind::mode;
            request.set_mode(screen.plan, screen.timing);
            request.set_place(screen.plan, screen.mode);
        }
        request.set_picture(screen.plan, *flips_.waiting(i));
    }
    if (request.error()) return fail(device_.name() + ": " + request.error()->message);
    if (const auto error = device_.commit(request, kind); error != std::errc{}) return refused(group, error);
    flips_.sent(group, FlipTrack::Clock::now());
    for (const std::size_t i : group) {
        Screen& screen = *screens_[i];
        if (!std::exchange(screen.mode_is_set, true)) tell(screen);
    }
    return {};
}

Result<void> KmsScreens::refused(const FlipTrack::Group& group, std::errc error) {
    if (error == std::errc::device_or_resource_busy) return {};
    const auto is_new = [this](std::size_t i) { return !screens_[i]->mode_is_set; };
    const bool others = std::ranges::any_of(screens_, [](const auto& screen) { return screen->shows(); });
    if (error == std::errc::invalid_argument && others && std::ranges::any_of(group, is_new)) {
        for (const std::size_t i : group)
            if (is_new(i)) darken(i, "the driver refuses " + text_of(screens_[i]->mode) + " beside the other monitors");
        return {};
    }
    if (error == std::errc::invalid_argument && group.size() > 1 && others) {
        flips_.go_apart();
        for (const std::size_t i : group) tell(*screens_[i], "the driver does not flip several monitors together");
        return {};
    }
    std::string what = "a picture of tile";
    for (const std::size_t i : group) what += " '" + screens_[i]->tile() + "' at " + text_of(screens_[i]->mode);
    return tl::unexpected(commit_error(what, error));
}

void KmsScreens::tell(const Screen& screen, const std::string& note) {
    const Connector& connector = screen.plan.connector;
    news_.push_back({screen.tile(), connector.name, connector.monitor, screen.lit() ? text_of(screen.mode) : "", note});
}

Error KmsScreens::commit_error(const std::string& what, std::errc error) const {
    if (error == std::errc::permission_denied)
        return {"somebody else shows pictures on " + device_.name() +
                ": an X server, a Wayland compositor or another tileserver"};
    return {device_.name() + " refuses " + what + ": " + std::make_error_code(error).message()};
}

}  // namespace wall::tileserver
