// SPDX-License-Identifier: MIT
#include "tileserver/kms/atomic_request.h"

namespace wall::tileserver {
namespace {

constexpr std::uint64_t kLinkGood = 0, kUpright = 1;  // values of "link-status" and of "rotation"
constexpr unsigned kFixedPoint = 16;                  // places in a picture have so many bits behind the point

}  // namespace

void AtomicRequest::set(const Object& object, std::string_view property, std::uint64_t value) {
    const auto found = object.properties.find(property);
    if (found != object.properties.end()) changes_.push_back({object.number, found->second.id, value});
    else if (!error_)
        error_ = Error{std::string(object.kind) + " " + std::to_string(object.number) + " has no property " +
                       std::string(property)};
}

void AtomicRequest::reset(const Object& object, std::string_view property, std::uint64_t value) {
    const auto found = object.properties.find(property);
    if (found != object.properties.end() && found->second.value != value) set(object, property, value);
}

void AtomicRequest::set_mode(const ScreenPlan& plan, BlobId timing) {
    const auto connector = of(plan.connector), crtc = of(plan.crtc);
    set(connector, "CRTC_ID", plan.crtc.id.value);
    reset(connector, "link-status", kLinkGood);
    set(crtc, "MODE_ID", timing.value);
    set(crtc, "ACTIVE", 1);
    // What an X server or a compositor has left behind.
    for (const auto* property : {"GAMMA_LUT", "DEGAMMA_LUT", "CTM", "VRR_ENABLED"}) reset(crtc, property, 0);
}

void AtomicRequest::set_place(const ScreenPlan& plan, const Mode& mode) {
    const auto plane = of(plan.plane);
    const auto width = static_cast<std::uint64_t>(mode.width), height = static_cast<std::uint64_t>(mode.height);
    set(plane, "CRTC_ID", plan.crtc.id.value);
    set(plane, "SRC_X", 0);
    set(plane, "SRC_Y", 0);
    set(plane, "SRC_W", width << kFixedPoint);
    set(plane, "SRC_H", height << kFixedPoint);
    set(plane, "CRTC_X", 0);
    set(plane, "CRTC_Y", 0);
    set(plane, "CRTC_W", width);
    set(plane, "CRTC_H", height);
    reset(plane, "rotation", kUpright);
}

void AtomicRequest::set_picture(const ScreenPlan& plan, FramebufferId picture) {
    set(of(plan.plane), "FB_ID", picture.value);
}

void AtomicRequest::set_dark(const ScreenPlan& plan) {
    set(of(plan.plane), "FB_ID", 0);
    set(of(plan.plane), "CRTC_ID", 0);
    set(of(plan.connector), "CRTC_ID", 0);
    set(of(plan.crtc), "ACTIVE", 0);
    set(of(plan.crtc), "MODE_ID", 0);
}

void AtomicRequest::set_all_dark(const Card& card) {
    for (const Plane& plane : card.planes) {
        reset(of(plane), "FB_ID", 0);
        reset(of(plane), "CRTC_ID", 0);
    }
    for (const Connector& connector : card.connectors) reset(of(connector), "CRTC_ID", 0);
    for (const Crtc& crtc : card.crtcs) {
        reset(of(crtc), "ACTIVE", 0);
        reset(of(crtc), "MODE_ID", 0);
    }
}

}  // namespace wall::tileserver
