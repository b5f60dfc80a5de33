// SPDX-License-Identifier: MIT
// A graphics card in memory that goes by the kernel's rules of atomic commits, as far as KmsScreens meets them, and
// buffers to draw to that are only numbers.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tileserver/kms/drm_device.h"
#include "tileserver/kms/scanout_surface.h"

namespace wall::tileserver::test {

Mode mode_of(std::int32_t width, std::int32_t height, std::uint32_t millihertz = 60'000, bool preferred = false);

/// A connector with a CRTC and a primary plane, each of which goes with that connector only. Its number is the next.
void add_connector(Card& card, const std::string& name, const std::string& monitor, std::vector<Mode> modes);
/// Without a monitor.
void add_connector(Card& card, const std::string& name);
Connector& connector(Card& card, const std::string& name);
void unplug(Card& card, const std::string& name);
void plug(Card& card, const std::string& name, const std::string& monitor, std::vector<Mode> modes);

/// Two monitors of 1920x1080 and 1280x1024 at DP-1 and DP-2, none at HDMI-A-1.
Card two_monitors();

/// The names of properties; their ids are the same for all objects.
PropertyId id_of(const std::string& property);
std::string name_of(PropertyId property);

class FakeDrm final : public DrmDevice {
public:
    explicit FakeDrm(Card its_card) : card(std::move(its_card)) {}

    const std::string& name() const override { return card.name; }
    Result<Card> describe() override;
    Result<BlobId> make_blob(std::span<const std::byte> bytes) override;
    void free_blob(BlobId blob) override { blobs.erase(blob); }
    Result<FramebufferId> add_framebuffer(const BufferLayout& layout) override;
    void remove_framebuffer(FramebufferId framebuffer) override { framebuffers.erase(framebuffer); }
    [[nodiscard]] std::errc commit(const AtomicRequest& request, CommitKind kind) override {
        return commit(request.changes(), kind);
    }
    [[nodiscard]] std::errc commit(const std::vector<PropertyChange>& changes, CommitKind kind);
    Result<std::vector<CrtcId>> take_flips() override { return std::exchange(told_, {}); }
    bool take_hot_plug() override { return std::exchange(hot_plug, false); }

    /// What the object's property is now.
    std::uint64_t value(std::uint32_t object, const std::string& property) const;
    /// The picture at a connector; none: it is dark.
    FramebufferId shown_at(const std::string& connector_name) const;
    /// All monitors begin their next picture.
    void beat();
    /// One does.
    void beat(CrtcId crtc);

    struct Committed {
        CommitKind kind;
        std::set<std::uint32_t> objects;
    };
    Card card;                         ///< what is plugged in
    bool hot_plug = false;             ///< the kernel says that something was plugged in or out
    std::deque<std::errc> answers;     ///< to the next commits, instead of what the rules say
    bool several = true;               ///< the driver flips several CRTCs in one commit
    std::size_t most_signals = 99;     ///< at once
    std::vector<Committed> committed;  ///< without those that were refused
    std::set<BlobId> blobs;
    std::map<FramebufferId, std::pair<std::uint32_t, std::uint32_t>> framebuffers;  ///< with their sizes

private:
    using Values = std::map<std::pair<std::uint32_t, std::string>, std::uint64_t>;  // by object and property
    std::errc check(const Values& after, const std::set<CrtcId>& touched, CommitKind kind) const;
    std::set<CrtcId> touched_by(const std::vector<PropertyChange>& changes, const Values& after) const;

    Values values_;
    std::uint32_t next_ = 1000;
    std::set<CrtcId> in_flight_;
    std::vector<CrtcId> told_;
};

class FakeSurfaces final : public ScanoutSurfaces {
public:
    explicit FakeSurfaces(DrmDevice& device) : device_(device) {}
    Result<std::unique_ptr<ScanoutSurface>> make(const Mode& mode) override;
    Result<void> select_none() override;
    void clear(std::uint32_t rgb) override { cleared.push_back(rgb); }

    std::vector<std::uint32_t> cleared;
    int alive = 0;  ///< surfaces

private:
    class Surface;
    DrmDevice& device_;
    Surface* selected_ = nullptr;
};

}  // namespace wall::tileserver::test
