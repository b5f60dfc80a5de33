// SPDX-License-Identifier: MIT
// All objects of one session by the client's ids, which are unique over kinds. A lookup says which kind it wants; an id
// of another kind is never taken for it. Render thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"
#include "tileserver/objects/object.h"

namespace wall::tileserver {

/// What an object is found by: the client's id, or for id 0 a default object, of which a kind may have several.
class ObjectKey {
public:
    ObjectKey(ClientName name) : value_(name.value) {}
    static ObjectKey default_object(ObjectKind kind, std::uint32_t which) {
        ObjectKey key{ClientName{}};
        key.value_ = (std::uint64_t{1} + static_cast<std::uint64_t>(kind)) << 32 | which;
        return key;
    }
    explicit operator bool() const { return value_ != 0; }
    bool is_default() const { return value_ >> 32 != 0; }
    bool operator==(const ObjectKey&) const = default;
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_;
};

class ObjectTable {
public:
    ObjectTable() = default;
    ObjectTable(const ObjectTable&) = delete;

    /// Null: there is none, or it is of another kind.
    template <class T>
    T* find(ObjectKey key) const {
        if (key.is_default() && !has_defaults_) return nullptr;
        ObjectReplica* const found = find_any(key);
        return found != nullptr && found->kind() == T::kKind ? static_cast<T*>(found) : nullptr;
    }
    /// Null: there is none. An error: it is of another kind.
    template <class T>
    Result<T*> look_up(ObjectKey key) const {
        if (T* found = find<T>(key)) return found;
        if (objects_.contains(key)) return another_kind(key, T::kKind);
        return nullptr;
    }
    /// An error: there is none, or it is of another kind.
    template <class T>
    Result<T*> get(ObjectKey key) const {
        auto found = look_up<T>(key);
        return !found || *found != nullptr ? found : none(key, T::kKind);
    }
    /// Makes one of `arguments` if there is none. An error: it is of another kind, or the session may have no more.
    template <class T, class... Arguments>
    Result<T*> make(ObjectKey key, Arguments&&... arguments) {
        auto known = look_up<T>(key);
        if (!known || *known != nullptr) return known;
        if (auto room = has_room_for(key); !room) return tl::unexpected(std::move(room).error());
        auto made = std::make_unique<T>(account_, std::forward<Arguments>(arguments)...);
        has_defaults_ |= key.is_default();
        return static_cast<T*>(objects_.emplace(key, std::move(made)).first->second.get());
    }
    /// Of whatever kind, if there is one.
    void erase(ClientName name) {
        if (!name) return;
        place_of(name) = {};
        objects_.erase(name);
    }

    void clear() {
        places_.assign(kPlaces, {});
        objects_.clear();
        has_defaults_ = false;
    }

    /// As long as it stays the same, all lookups of a kind find objects of the same driver names.
    std::uint64_t version(ObjectKind kind) const { return account_.versions[static_cast<std::size_t>(kind)]; }
    std::uint64_t bytes() const { return account_.bytes; }
    /// Instead of kMaxObjectBytes and kMaxObjects, for what is made from now on.
    void set_limits(std::uint64_t most_bytes, std::uint64_t most_objects) {
        account_.most_bytes = most_bytes;
        most_objects_ = most_objects;
    }
    bool affords(std::uint64_t bytes) const { return account_.affords(bytes); }
    std::size_t size() const { return objects_.size(); }

private:
    struct Hash {
        std::size_t operator()(ObjectKey key) const { return std::hash<std::uint64_t>{}(key.value()); }
    };
    /// What was found lately: a client's ids grow by one, so the objects that it draws with one after the other have a
    /// place each.
    struct Place {
        std::uint64_t key = 0;  ///< 0: none
        ObjectReplica* object = nullptr;
    };
    static constexpr std::size_t kPlaces = 2048;
    Place& place_of(ObjectKey key) const { return places_[key.value() % kPlaces]; }
    ObjectReplica* find_any(ObjectKey key) const {
        Place& place = place_of(key);
        if (place.key == key.value() && place.object != nullptr) return place.object;
        const auto at = objects_.find(key);
        if (at == objects_.end()) return nullptr;
        place = {key.value(), at->second.get()};
        return place.object;
    }
    Result<void> has_room_for(ObjectKey key) const;
    tl::unexpected<Error> another_kind(ObjectKey key, ObjectKind wanted) const;
    static tl::unexpected<Error> none(ObjectKey key, ObjectKind wanted);

    std::uint64_t most_objects_ = kMaxObjects;
    bool has_defaults_ = false;  // few sessions have any, and most names in a state are 0
    ObjectAccount account_;      // before the objects, which use it to the end
    std::unordered_map<ObjectKey, std::unique_ptr<ObjectReplica>, Hash> objects_;
    mutable std::vector<Place> places_ = std::vector<Place>(kPlaces);
};

}  // namespace wall::tileserver
