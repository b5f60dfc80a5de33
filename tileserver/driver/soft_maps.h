// SPDX-License-Identifier: MIT
// Evaluator maps and pixel maps of a soft context, and what of them the driver holds. They are told as whole objects,
// so each has a value id: equal ids mean equal content. Render thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tileserver/driver/driver.h"

namespace wall::tileserver {

inline constexpr std::size_t kEvaluatorMaps = 9, kPixelMaps = 10;
inline constexpr std::int32_t kMaxEvalOrder = 30;      ///< Mesa's
inline constexpr std::size_t kMaxPixelMapTable = 256;  ///< Mesa's

struct EvaluatorMap {
    std::uint64_t id = 0;  ///< 0: the initial map
    float u1 = 0, u2 = 1, v1 = 0, v2 = 1;
    std::int32_t u_order = 1, v_order = 1;
    std::vector<float> points;  ///< u-major, tight
};
struct PixelMap {
    std::uint64_t id = 0;  ///< 0: the initial map
    std::vector<float> values;
};

struct SoftMaps {
    std::array<EvaluatorMap, kEvaluatorMaps> map1, map2;
    std::array<PixelMap, kPixelMaps> pixel;
    bool any_evaluator = false, any_pixel = false;  ///< something differs from the initial maps
};

/// Which maps the driver holds.
class MapMirror {
public:
    void sync_evaluators(Driver& driver, const SoftMaps& maps) {
        if (!has_initial_evaluators(maps)) tell_evaluators(driver, maps);
    }
    /// The driver's and these.
    bool has_initial_evaluators(const SoftMaps& maps) const { return !maps.any_evaluator && evaluators_initial_; }
    void sync_pixel_maps(const Gl& gl, const SoftMaps& maps);

private:
    void tell_evaluators(Driver& driver, const SoftMaps& maps);
    std::array<std::uint64_t, kEvaluatorMaps> map1_{}, map2_{};
    std::array<std::uint64_t, kPixelMaps> pixel_{};
    bool evaluators_initial_ = true, pixel_initial_ = true;
};

/// Index in the arrays, or the array's size if the target is none.
std::size_t evaluator_index(GLenum target, bool two_dimensional);
/// Components of a control point.
std::size_t evaluator_components(std::size_t index);
std::size_t pixel_map_index(GLenum map);

}  // namespace wall::tileserver
