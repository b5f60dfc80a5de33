// SPDX-License-Identifier: MIT
#include "tileserver/kms/libdrm_describe.h"

#include <drm_fourcc.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <span>

#include "tileserver/kms/edid.h"

namespace wall::tileserver {
namespace {

template <class T, void (*kFree)(T*)>
struct Freed {
    void operator()(T* data) const { kFree(data); }
};
template <class T, void (*kFree)(T*)>
using Owned = std::unique_ptr<T, Freed<T, kFree>>;

using Resources = Owned<drmModeRes, drmModeFreeResources>;

/// libdrm's arrays are null where they are empty.
template <class T, class Count>
std::span<T> span_of(T* first, Count count) {
    return first == nullptr ? std::span<T>() : std::span<T>(first, static_cast<std::size_t>(std::max<Count>(count, 0)));
}

/// CRTCs as bits, in the order of the card's.
std::vector<CrtcId> crtcs_of(std::uint32_t bits, const drmModeRes& resources) {
    std::vector<CrtcId> out;
    const auto all = span_of(resources.crtcs, resources.count_crtcs);
    for (std::size_t i = 0; i < std::min<std::size_t>(all.size(), 32); ++i)
        if ((bits >> i & 1) != 0) out.emplace_back(all[i]);
    return out;
}

Properties properties_of(int file, std::uint32_t object, std::uint32_t type) {
    Properties out;
    const Owned<drmModeObjectProperties, drmModeFreeObjectProperties> all(
        drmModeObjectGetProperties(file, object, type));
    if (all == nullptr) return out;
    for (std::size_t i = 0; i < all->count_props; ++i) {
        const Owned<drmModePropertyRes, drmModeFreeProperty> property(drmModeGetProperty(file, all->props[i]));
        if (property == nullptr) continue;
        const std::string name(property->name, ::strnlen(property->name, sizeof property->name));
        out[name] = {PropertyId(property->prop_id), all->prop_values[i]};
    }
    return out;
}

std::uint64_t value_of(const Properties& properties, std::string_view name) {
    const auto found = properties.find(name);
    return found == properties.end() ? 0 : found->second.value;
}

std::string monitor_at(int file, const Properties& properties) {
    const auto number = static_cast<std::uint32_t>(value_of(properties, "EDID"));
    if (number == 0) return {};
    const Owned<drmModePropertyBlobRes, drmModeFreePropertyBlob> blob(drmModeGetPropertyBlob(file, number));
    return blob == nullptr ? "" : monitor_name({static_cast<const std::byte*>(blob->data), blob->length});
}

/// The kernel's clock is in kHz.
std::uint32_t rate_of(const drmModeModeInfo& mode) {
    const std::uint64_t dots = std::uint64_t{mode.htotal} * mode.vtotal * std::max<std::uint64_t>(mode.vscan, 1) *
                               ((mode.flags & DRM_MODE_FLAG_DBLSCAN) != 0 ? 2 : 1);
    return dots == 0 ? 0 : static_cast<std::uint32_t>(std::uint64_t{mode.clock} * 1'000'000 / dots);
}

Mode mode_of(const drmModeModeInfo& mode) {
    const auto timing = std::as_bytes(std::span(&mode, 1));
    return {mode.hdisplay,
            mode.vdisplay,
            rate_of(mode),
            (mode.type & DRM_MODE_TYPE_PREFERRED) != 0,
            (mode.flags & DRM_MODE_FLAG_INTERLACE) != 0,
            {timing.begin(), timing.end()}};
}

std::string name_of(const drmModeConnector& connector) {
    const char* type = drmModeGetConnectorTypeName(connector.connector_type);
    return (type != nullptr ? type : "Unknown") + ("-" + std::to_string(connector.connector_type_id));
}

Connector connector_of(int file, const drmModeConnector& found, const drmModeRes& resources) {
    Connector out{ConnectorId(found.connector_id), name_of(found), found.connection == DRM_MODE_CONNECTED};
    for (const auto& mode : span_of(found.modes, found.count_modes)) out.modes.push_back(mode_of(mode));
    out.crtcs = crtcs_of(drmModeConnectorGetPossibleCrtcs(file, &found), resources);
    out.properties = properties_of(file, found.connector_id, DRM_MODE_OBJECT_CONNECTOR);
    out.desktop = value_of(out.properties, "non-desktop") == 0;
    out.link_bad = value_of(out.properties, "link-status") == DRM_MODE_LINK_STATUS_BAD;
    if (out.connected) out.monitor = monitor_at(file, out.properties);
    return out;
}

Plane plane_of(int file, const drmModePlane& found, const drmModeRes& resources) {
    Plane out{PlaneId(found.plane_id)};
    out.properties = properties_of(file, found.plane_id, DRM_MODE_OBJECT_PLANE);
    out.primary = value_of(out.properties, "type") == DRM_PLANE_TYPE_PRIMARY && out.properties.contains("type");
    out.plain = std::ranges::count(span_of(found.formats, found.count_formats), std::uint32_t{DRM_FORMAT_XRGB8888}) > 0;
    out.crtcs = crtcs_of(found.possible_crtcs, resources);
    return out;
}

}  // namespace

Result<Card> describe_card(int file, const std::string& name) {
    const Resources resources(drmModeGetResources(file));
    const Owned<drmModePlaneRes, drmModeFreePlaneResources> planes(drmModeGetPlaneResources(file));
    if (resources == nullptr || planes == nullptr)
        return fail(name + " does not say what it has: " + std::strerror(errno));
    Card out{name, {}, {}, {}};
    for (const std::uint32_t number : span_of(resources->connectors, resources->count_connectors)) {
        const Owned<drmModeConnector, drmModeFreeConnector> connector(drmModeGetConnector(file, number));
        if (connector != nullptr) out.connectors.push_back(connector_of(file, *connector, *resources));
    }
    for (const std::uint32_t number : span_of(resources->crtcs, resources->count_crtcs))
        out.crtcs.push_back({CrtcId(number), properties_of(file, number, DRM_MODE_OBJECT_CRTC)});
    for (const std::uint32_t number : span_of(planes->planes, planes->count_planes)) {
        const Owned<drmModePlane, drmModeFreePlane> plane(drmModeGetPlane(file, number));
        if (plane != nullptr) out.planes.push_back(plane_of(file, *plane, *resources));
    }
    return out;
}

}  // namespace wall::tileserver
