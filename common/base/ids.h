// SPDX-License-Identifier: MIT
// Identifiers as types that do not convert into each other: a session id cannot be passed where a surface id is meant.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>

namespace wall {

template <class Tag, class Value = std::uint32_t>
struct Id {
    Value value{};
    constexpr Id() = default;
    constexpr explicit Id(Value v) : value(v) {}
    constexpr explicit operator bool() const { return value != Value{}; }
    auto operator<=>(const Id&) const = default;
};

using SessionId = Id<struct SessionTag>;      ///< given by walld, unique while walld runs; 0 = none
using SurfaceId = Id<struct SurfaceTag>;      ///< given by the client, unique in its session; 0 = none
using ContextId = Id<struct ContextTag>;      ///< given by the client, unique in its session; 0 = none
using ClientName = Id<struct ClientNameTag>;  ///< an object of a session: unique over kinds, contexts and share groups
using RequestId = Id<struct RequestTag>;      ///< of a question on a client's stream; 0: nobody waits for an answer
using PictureId = Id<struct PictureTag>;  ///< given by walld: of one picture that a node is asked for, or of a stream
using NodeIndex = Id<struct NodeTag>;     ///< in the order of walld's configuration, from 0
using DriverName = Id<struct DriverNameTag>;  ///< the driver's own name of an object

}  // namespace wall

template <class Tag, class Value>
struct std::hash<wall::Id<Tag, Value>> {
    std::size_t operator()(wall::Id<Tag, Value> id) const noexcept { return std::hash<Value>{}(id.value); }
};
