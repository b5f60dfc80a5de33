// SPDX-License-Identifier: MIT
// What one atomic commit changes: properties of the card's objects. All of it happens, or nothing. Pure; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "tileserver/kms/card.h"
#include "tileserver/kms/screen_plan.h"

namespace wall::tileserver {

struct PropertyChange {
    std::uint32_t object = 0;  ///< the number of a connector, CRTC or plane
    PropertyId property;
    std::uint64_t value = 0;
    bool operator==(const PropertyChange&) const = default;
};

class AtomicRequest {
public:
    /// The monitor's signal. `timing`: a blob of the mode's.
    void set_mode(const ScreenPlan& plan, BlobId timing);
    /// All of the plane and all of the signal, of the mode's size.
    void set_place(const ScreenPlan& plan, const Mode& mode);
    /// Another picture, of the size of the one before.
    void set_picture(const ScreenPlan& plan, FramebufferId picture);
    /// No signal.
    void set_dark(const ScreenPlan& plan);
    /// No signal anywhere, whoever has set one.
    void set_all_dark(const Card& card);

    const std::vector<PropertyChange>& changes() const { return changes_; }
    /// A property that was to be set does not exist: the driver cannot do it.
    const std::optional<Error>& error() const { return error_; }

private:
    struct Object {
        std::uint32_t number;
        const char* kind;
        const Properties& properties;
    };
    static Object of(const Connector& connector) { return {connector.id.value, "connector", connector.properties}; }
    static Object of(const Crtc& crtc) { return {crtc.id.value, "CRTC", crtc.properties}; }
    static Object of(const Plane& plane) { return {plane.id.value, "plane", plane.properties}; }
    void set(const Object& object, std::string_view property, std::uint64_t value);
    /// Where there is such a property, and it may be something else.
    void reset(const Object& object, std::string_view property, std::uint64_t value);

    std::vector<PropertyChange> changes_;
    std::optional<Error> error_;
};

}  // namespace wall::tileserver
