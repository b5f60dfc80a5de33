// SPDX-License-Identifier: MIT
#include "client_lib/objects/blend_support.h"

#include <algorithm>
#include <iterator>

namespace wall::client {
namespace {

struct AdvancedEquation {
    GLenum equation;
    std::string_view layout;  ///< behind "blend_support_"
};
constexpr AdvancedEquation kEquations[] = {
    {GL_MULTIPLY_KHR, "multiply"},
    {GL_SCREEN_KHR, "screen"},
    {GL_OVERLAY_KHR, "overlay"},
    {GL_DARKEN_KHR, "darken"},
    {GL_LIGHTEN_KHR, "lighten"},
    {GL_COLORDODGE_KHR, "colordodge"},
    {GL_COLORBURN_KHR, "colorburn"},
    {GL_HARDLIGHT_KHR, "hardlight"},
    {GL_SOFTLIGHT_KHR, "softlight"},
    {GL_DIFFERENCE_KHR, "difference"},
    {GL_EXCLUSION_KHR, "exclusion"},
    {GL_HSL_HUE_KHR, "hsl_hue"},
    {GL_HSL_SATURATION_KHR, "hsl_saturation"},
    {GL_HSL_COLOR_KHR, "hsl_color"},
    {GL_HSL_LUMINOSITY_KHR, "hsl_luminosity"},
};
constexpr std::string_view kPrefix = "blend_support_", kAll = "all_equations";
constexpr std::uint32_t kAllBits = (1u << std::size(kEquations)) - 1;

}  // namespace

std::uint32_t advanced_equation_bit(GLenum equation) {
    const auto* found = std::ranges::find(kEquations, equation, &AdvancedEquation::equation);
    return found == std::end(kEquations) ? 0 : 1u << (found - std::begin(kEquations));
}

std::uint32_t blend_support_of(std::string_view source) {
    std::uint32_t bits = 0;
    for (std::size_t at = 0; (at = source.find(kPrefix, at)) != source.npos;) {
        at += kPrefix.size();
        const std::string_view behind = source.substr(at);
        if (behind.starts_with(kAll)) bits = kAllBits;
        for (std::size_t i = 0; i < std::size(kEquations); ++i)
            if (behind.starts_with(kEquations[i].layout)) bits |= 1u << i;
    }
    return bits;
}

}  // namespace wall::client
