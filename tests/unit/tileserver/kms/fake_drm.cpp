// SPDX-License-Identifier: MIT
#include "tests/unit/tileserver/kms/fake_drm.h"

#include <algorithm>
#include <array>

#include "common/base/assert.h"

namespace wall::tileserver::test {
namespace {

constexpr std::array kConnectorProperties = {"CRTC_ID", "link-status", "EDID"};
constexpr std::array kCrtcProperties = {"MODE_ID", "ACTIVE", "GAMMA_LUT"};
constexpr std::array kPlaneProperties = {"FB_ID",  "CRTC_ID", "SRC_X",  "SRC_Y",  "SRC_W", "SRC_H",
                                         "CRTC_X", "CRTC_Y",  "CRTC_W", "CRTC_H", "type"};
constexpr std::size_t kBuffers = 3;  // of a surface
constexpr unsigned kFixedPoint = 16;

std::vector<std::string>& property_names() {
    static std::vector<std::string> names;
    return names;
}

template <class Names>
Properties properties_of(const Names& names) {
    Properties out;
    for (const char* name : names) out[name] = {id_of(name), 0};
    return out;
}

}  // namespace

Mode mode_of(std::int32_t width, std::int32_t height, std::uint32_t millihertz, bool preferred) {
    return {width, height, millihertz, preferred, false, {std::byte(width % 251), std::byte(height % 251)}};
}

PropertyId id_of(const std::string& property) {
    auto& names = property_names();
    auto found = std::ranges::find(names, property);
    if (found == names.end()) found = names.insert(names.end(), property);
    return PropertyId(static_cast<std::uint32_t>(found - names.begin()) + 1);
}

std::string name_of(PropertyId property) { return property_names().at(property.value - 1); }

void add_connector(Card& card, const std::string& name) {
    const auto number = static_cast<std::uint32_t>(card.connectors.size());
    const CrtcId crtc(200 + number);
    Connector added{ConnectorId(100 + number), name};
    added.crtcs = {crtc};
    added.properties = properties_of(kConnectorProperties);
    card.connectors.push_back(added);
    card.crtcs.push_back({crtc, properties_of(kCrtcProperties)});
    card.planes.push_back({PlaneId(300 + number), true, true, {crtc}, properties_of(kPlaneProperties)});
}

void add_connector(Card& card, const std::string& name, const std::string& monitor, std::vector<Mode> modes) {
    add_connector(card, name);
    plug(card, name, monitor, std::move(modes));
}

Connector& connector(Card& card, const std::string& name) {
    const auto found = std::ranges::find(card.connectors, name, &Connector::name);
    WALL_ASSERT(found != card.connectors.end());
    return *found;
}

void unplug(Card& card, const std::string& name) { plug(card, name, "", {}); }

void plug(Card& card, const std::string& name, const std::string& monitor, std::vector<Mode> modes) {
    Connector& at = connector(card, name);
    at.connected = !modes.empty();
    at.monitor = monitor;
    at.modes = std::move(modes);
}

Card two_monitors() {
    Card card{"/dev/dri/card0", {}, {}, {}};
    add_connector(card, "DP-1", "DELL U2720Q",
                  {mode_of(1920, 1080, 60'000, true), mode_of(1920, 1080, 74'973), mode_of(640, 480)});
    add_connector(card, "DP-2", "EIZO L985", {mode_of(1280, 1024, 60'020, true)});
    add_connector(card, "HDMI-A-1");
    return card;
}

Result<Card> FakeDrm::describe() {
    Card out = card;
    const auto fill = [this](std::uint32_t object, Properties& properties) {
        for (auto& [name, property] : properties) property.value = value(object, name);
    };
    for (auto& at : out.connectors) fill(at.id.value, at.properties);
    for (auto& at : out.crtcs) fill(at.id.value, at.properties);
    for (auto& at : out.planes) fill(at.id.value, at.properties);
    for (auto& at : out.connectors) at.properties["link-status"].value = at.link_bad ? 1 : 0;
    return out;
}

Result<BlobId> FakeDrm::make_blob(std::span<const std::byte>) { return *blobs.insert(BlobId(next_++)).first; }

Result<FramebufferId> FakeDrm::add_framebuffer(const BufferLayout& layout) {
    const FramebufferId out(next_++);
    framebuffers[out] = {layout.width, layout.height};
    return out;
}

std::uint64_t FakeDrm::value(std::uint32_t object, const std::string& property) const {
    const auto found = values_.find({object, property});
    return found == values_.end() ? 0 : found->second;
}

FramebufferId FakeDrm::shown_at(const std::string& connector_name) const {
    const auto* at = card.find(connector_name);
    const auto crtc = value(at->id.value, "CRTC_ID");
    if (crtc == 0 || value(static_cast<std::uint32_t>(crtc), "ACTIVE") == 0) return {};
    for (const Plane& plane : card.planes)
        if (value(plane.id.value, "CRTC_ID") == crtc)
            return FramebufferId(static_cast<std::uint32_t>(value(plane.id.value, "FB_ID")));
    return {};
}

std::set<CrtcId> FakeDrm::touched_by(const std::vector<PropertyChange>& changes, const Values& after) const {
    std::set<CrtcId> out;
    const auto add = [&](std::uint64_t crtc) {
        if (crtc != 0) out.insert(CrtcId(static_cast<std::uint32_t>(crtc)));
    };
    for (const auto& change : changes) {
        if (std::ranges::count(card.crtcs, CrtcId(change.object), &Crtc::id) > 0) add(change.object);
        add(value(change.object, "CRTC_ID"));
        const auto now = after.find({change.object, "CRTC_ID"});
        if (now != after.end()) add(now->second);
    }
    return out;
}

/// drm_atomic_check_only() and what drivers add to it.
std::errc FakeDrm::check(const Values& after, const std::set<CrtcId>& touched, CommitKind kind) const {
    const auto at = [&](std::uint32_t object, const std::string& property) {
        const auto found = after.find({object, property});
        return found == after.end() ? 0 : found->second;
    };
    std::size_t signals = 0;
    for (const Crtc& crtc : card.crtcs) {
        const bool active = at(crtc.id.value, "ACTIVE") != 0, has_mode = at(crtc.id.value, "MODE_ID") != 0;
        const auto connectors = std::ranges::count_if(
            card.connectors, [&](const Connector& c) { return at(c.id.value, "CRTC_ID") == crtc.id.value; });
        if (active && (!has_mode || connectors == 0)) return std::errc::invalid_argument;
        if (has_mode && !blobs.contains(BlobId(static_cast<std::uint32_t>(at(crtc.id.value, "MODE_ID")))))
            return std::errc::invalid_argument;
        if (!has_mode && connectors != 0) return std::errc::invalid_argument;
        signals += active ? 1 : 0;
        if (!touched.contains(crtc.id)) continue;
        if (kind == CommitKind::flip && in_flight_.contains(crtc.id)) return std::errc::device_or_resource_busy;
        if (kind == CommitKind::flip && value(crtc.id.value, "MODE_ID") != at(crtc.id.value, "MODE_ID"))
            return std::errc::invalid_argument;
        if (kind != CommitKind::dark && !active && value(crtc.id.value, "ACTIVE") == 0)
            return std::errc::invalid_argument;
    }
    for (const Plane& plane : card.planes) {
        const FramebufferId picture(static_cast<std::uint32_t>(at(plane.id.value, "FB_ID")));
        if (bool(picture) != (at(plane.id.value, "CRTC_ID") != 0)) return std::errc::invalid_argument;
        const auto found = framebuffers.find(picture);
        if (!picture) continue;
        if (found == framebuffers.end()) return std::errc::no_such_file_or_directory;
        if (at(plane.id.value, "SRC_W") >> kFixedPoint != found->second.first ||
            at(plane.id.value, "SRC_H") >> kFixedPoint != found->second.second)
            return std::errc::invalid_argument;
    }
    const bool too_many = kind == CommitKind::flip && !several && touched.size() > 1;
    return too_many || signals > most_signals ? std::errc::invalid_argument : std::errc{};
}

std::errc FakeDrm::commit(const std::vector<PropertyChange>& changes, CommitKind kind) {
    Values after = values_;
    Committed made{kind, {}};
    for (const auto& change : changes) {
        after[{change.object, name_of(change.property)}] = change.value;
        made.objects.insert(change.object);
    }
    const auto touched = touched_by(changes, after);
    auto answer = check(after, touched, kind);
    if (!answers.empty()) {
        answer = answers.front();
        answers.pop_front();
    }
    if (answer != std::errc{}) return answer;
    // Whoever waits for a signal waits for the flips before, too.
    if (kind != CommitKind::flip)
        for (const CrtcId crtc : touched) beat(crtc);
    values_ = after;
    if (kind != CommitKind::dark) in_flight_.insert(touched.begin(), touched.end());
    committed.push_back(made);
    return {};
}

void FakeDrm::beat() {
    for (const CrtcId crtc : std::set(in_flight_)) beat(crtc);
}

void FakeDrm::beat(CrtcId crtc) {
    if (in_flight_.erase(crtc) != 0) told_.push_back(crtc);
}

class FakeSurfaces::Surface final : public ScanoutSurface {
public:
    Surface(FakeSurfaces& all, const Mode& mode) : all_(all) {
        ++all_.alive;
        BufferLayout layout;
        layout.width = static_cast<std::uint32_t>(mode.width);
        layout.height = static_cast<std::uint32_t>(mode.height);
        for (std::size_t i = 0; i < kBuffers; ++i) free_.push_back(*all_.device_.add_framebuffer(layout));
    }
    ~Surface() override {
        WALL_ASSERT(all_.selected_ != this);
        for (const auto picture : free_) all_.device_.remove_framebuffer(picture);
        for (const auto picture : locked_) all_.device_.remove_framebuffer(picture);
        --all_.alive;
    }
    Result<void> select() override {
        all_.selected_ = this;
        return {};
    }
    Result<FramebufferId> swap() override {
        if (all_.selected_ != this) return fail("it is not selected");
        if (free_.empty()) return fail("no buffer is free");
        const auto out = free_.front();
        free_.pop_front();
        locked_.insert(out);
        return out;
    }
    void release(FramebufferId picture) override {
        if (locked_.erase(picture) != 0) free_.push_back(picture);
    }

private:
    FakeSurfaces& all_;
    std::deque<FramebufferId> free_;
    std::set<FramebufferId> locked_;
};

Result<std::unique_ptr<ScanoutSurface>> FakeSurfaces::make(const Mode& mode) {
    return std::make_unique<Surface>(*this, mode);
}

Result<void> FakeSurfaces::select_none() {
    selected_ = nullptr;
    return {};
}

}  // namespace wall::tileserver::test
