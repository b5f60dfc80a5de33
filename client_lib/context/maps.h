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
#include "common/base/ids.h"
#include "common/wire/pack_buffer.h"

namespace wall::client {

struct Node;

inline constexpr unsigned kEvaluatorMaps = 9;  ///< GL_MAP1_COLOR_4 to GL_MAP1_VERTEX_4
inline constexpr GLint kMaxEvaluatorOrder = 30;
inline constexpr GLsizei kMaxPixelMapTable = 256;

struct EvaluatorMap {
    ClientName id;
    std::uint64_t stamp = 0;  ///< 0: as at the start
    GLint u_order = 1, v_order = 1;
    float u1 = 0, u2 = 1, v1 = 0, v2 = 1;
    std::vector<float> points;
};

struct ContextMaps {
    ContextMaps();
    std::array<EvaluatorMap, kEvaluatorMaps> map1, map2;
    PixelMapTables pixel;
    std::array<ClientName, PixelMapTables::kMaps> pixel_ids;
    std::array<std::uint64_t, PixelMapTables::kMaps> pixel_stamps{};
    std::uint64_t stamp = 0;  ///< of the latest change

    /// What glTexImage of a proxy target would make, by target and level; never sent.
    std::map<std::pair<GLenum, GLint>, TextureLevel> proxies;

    /// Null if the word names no map of this kind.
    EvaluatorMap* find1(GLenum target) {
        return target - GL_MAP1_COLOR_4 < kEvaluatorMaps ? &map1[target - GL_MAP1_COLOR_4] : nullptr;
    }
    EvaluatorMap* find2(GLenum target) {
        return target - GL_MAP2_COLOR_4 < kEvaluatorMaps ? &map2[target - GL_MAP2_COLOR_4] : nullptr;
    }

    /// The session's mutex is held.
    void bring_up_to_date(Node& node, wire::PackBuffer& buffer) const;
};

/// Values of a control point, by place among the maps.
unsigned evaluator_components(unsigned map);

}  // namespace wall::client
