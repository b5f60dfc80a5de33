// SPDX-License-Identifier: MIT
// A context's evaluator maps (OpenGL 1.2.1, 5.1) and pixel maps (3.6.3): tables that are too large for state elements.
// Each has an id and a stamp like an object and is sent to a node that lacks it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "client_lib/objects/pixel_convert.h"
#include "client_lib/objects/texture.h"
#include "common/wire/pack_buffer.h"

namespace wall::client {

inline constexpr unsigned kEvaluatorMaps = 9;  ///< GL_MAP1_COLOR_4 to GL_MAP1_VERTEX_4
inline constexpr GLint kMaxEvaluatorOrder = 30;
inline constexpr GLsizei kMaxPixelMapTable = 256;

struct EvaluatorMap : Object {
    EvaluatorMap() : Object(next_object_id()) {}
    std::uint64_t latest() const override { return stamp; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;

    GLenum target = 0;        ///< from GL_MAP1_COLOR_4 or GL_MAP2_COLOR_4 on
    std::uint64_t stamp = 0;  ///< 0: as at the start
    GLint u_order = 1, v_order = 1;
    float u1 = 0, u2 = 1, v1 = 0, v2 = 1;
    std::vector<float> points;
};

/// One of the tables of pixel transfer.
struct PixelMap : Object {
    PixelMap() : Object(next_object_id()) {}
    std::uint64_t latest() const override { return stamp; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;

    GLenum map = 0;  ///< from GL_PIXEL_MAP_I_TO_I on
    const std::vector<float>* values = nullptr;
    std::uint64_t stamp = 0;  ///< 0: as at the start
};

struct ContextMaps {
    ContextMaps();
    std::array<EvaluatorMap, kEvaluatorMaps> map1, map2;
    PixelMapTables pixel;
    std::array<PixelMap, PixelMapTables::kMaps> pixel_maps;  ///< of the tables of `pixel`
    std::uint64_t stamp = 0;                                 ///< of the latest change

    /// What glTexImage of a proxy target would make, by target and level; never sent.
    std::map<std::pair<GLenum, GLint>, TextureLevel> proxies;

    /// Null if the word names no map of this kind.
    EvaluatorMap* find1(GLenum target) {
        return target - GL_MAP1_COLOR_4 < kEvaluatorMaps ? &map1[target - GL_MAP1_COLOR_4] : nullptr;
    }
    EvaluatorMap* find2(GLenum target) {
        return target - GL_MAP2_COLOR_4 < kEvaluatorMaps ? &map2[target - GL_MAP2_COLOR_4] : nullptr;
    }

    template <class Use>
    void for_each(Use&& use) const {
        if (stamp == 0) return;
        for (const auto* maps : {&map1, &map2})
            for (const EvaluatorMap& map : *maps) use(map);
        for (const PixelMap& map : pixel_maps) use(map);
    }
};

/// Values of a control point, by place among the maps.
unsigned evaluator_components(unsigned map);

}  // namespace wall::client
