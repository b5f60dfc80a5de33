// SPDX-License-Identifier: MIT
// toml++ gives the tree; TreeReader walks it with a sticky first error, so that the reading code is one line a key. Any
// thread.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

// toml++ 3.3 asserts of foreign text what it refuses itself just after (a table without a name), and with NDEBUG lets
// the compiler assume it. Neither must be, in any build.
#define TOML_ASSERT(expression) static_assert(true)
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_UNRELEASED_FEATURES 0
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

#include "common/base/result.h"
#include "common/config/toml_guard.h"
#include "common/geom/rect.h"
#include "common/net/address.h"
#include "common/wire/limits.h"

namespace wall::config {

inline constexpr std::int64_t kMaxCanvas = wire::kMaxSurfaceExtent;  ///< pixels a side: a surface may cover all of it

class TreeReader {
public:
    explicit TreeReader(std::string_view file) : file_(file) {}

    const std::optional<Error>& error() const { return error_; }

    void refuse(const toml::source_region& where, std::string_view what) {
        if (!error_)
            error_ =
                Error{file_ + ":" + std::to_string(std::max(1u, where.begin.line)) + ": " + from_private_use(what)};
    }

    /// Every key of `table` must be one of `known`.
    void only(const toml::table& table, std::string_view name, std::initializer_list<std::string_view> known) {
        for (const auto& [key, value] : table) {
            if (std::ranges::find(known, key.str()) != known.end()) continue;
            std::string list;
            for (const auto k : known) list += (list.empty() ? "" : ", ") + std::string(k);
            refuse(key.source(), "unknown key '" + std::string(key.str()) + "' in " + std::string(name) +
                                     ": expected one of " + list);
        }
    }

    std::string text(const toml::table& table, std::string_view key, std::optional<std::string> otherwise = {}) {
        const auto* node = need(table, key, "a string", otherwise.has_value());
        if (!node) return otherwise.value_or("");
        if (const auto* value = node->as_string()) {
            if (value->get().empty()) refuse(node->source(), quoted(key) + " is empty: expected a string");
            return from_private_use(value->get());
        }
        refuse(node->source(), quoted(key) + ": expected a string");
        return {};
    }

    std::int64_t integer(const toml::table& table, std::string_view key, std::int64_t least, std::int64_t most,
                         std::int64_t otherwise) {
        const auto* node = table.get(key);
        if (!node) return otherwise;
        return integer(*node, quoted(key), least, most);
    }
    std::int64_t integer(const toml::node& node, const std::string& what, std::int64_t least, std::int64_t most) {
        const auto* value = node.as_integer();
        if (value && value->get() >= least && value->get() <= most) return value->get();
        refuse(node.source(),
               what + ": expected an integer from " + std::to_string(least) + " to " + std::to_string(most));
        return least;
    }

    /// Integers are numbers, too.
    double number(const toml::node& node, const std::string& what, double least, double most) {
        const auto value = node.is_number() ? node.value<double>() : std::nullopt;
        if (value && *value >= least && *value <= most) return *value;  // which no NaN is
        std::ostringstream text;
        text << what << ": expected a number from " << least << " to " << most;
        refuse(node.source(), text.str());
        return least;
    }
    double number(const toml::table& table, std::string_view key, double least, double most, double otherwise) {
        const auto* node = table.get(key);
        return node ? number(*node, quoted(key), least, most) : otherwise;
    }
    /// An array of `fewest` to `most_of_them` numbers; `expected`: of it, for people.
    std::vector<float> numbers(const toml::node& node, const std::string& what, std::string_view expected,
                               std::size_t fewest, std::size_t most_of_them, double least, double most) {
        const auto* array = node.as_array();
        if (!array || array->size() < fewest || array->size() > most_of_them) {
            refuse(node.source(), what + ": expected " + std::string(expected));
            return std::vector<float>(fewest);
        }
        std::vector<float> out;
        out.reserve(array->size());
        for (const toml::node& value : *array) out.push_back(static_cast<float>(number(value, what, least, most)));
        return out;
    }

    net::Address address(const toml::node& node, const std::string& what) {
        const auto* value = node.as_string();
        auto parsed = value ? net::Address::parse(from_private_use(value->get()))
                            : fail("expected a string, unix:PATH or HOST:PORT");
        if (parsed) return *parsed;
        refuse(node.source(), what + ": " + parsed.error().message);
        return {};
    }

    geom::Rect rect(const toml::table& table, std::string_view key) {
        constexpr std::string_view expected =
            ": expected [x, y, width, height] in pixels, none negative, width and height at least 1, nothing beyond "
            "32768";
        const auto* node = need(table, key, "[x, y, width, height]", false);
        if (!node) return {};
        const auto* array = node->as_array();
        std::array<std::int64_t, 4> v{};
        bool good = array && array->size() == v.size();
        for (std::size_t i = 0; good && i < v.size(); ++i) {
            const auto* value = array->get(i)->as_integer();
            good = value && value->get() >= (i < 2 ? 0 : 1) && value->get() <= kMaxCanvas;
            if (good) v[i] = value->get();
        }
        good = good && v[0] + v[2] <= kMaxCanvas && v[1] + v[3] <= kMaxCanvas;
        if (!good) refuse(node->source(), quoted(key) + std::string(expected));
        return {int(v[0]), int(v[1]), int(v[2]), int(v[3])};
    }

    /// Absent: (0, 0).
    std::array<std::int32_t, 2> position(const toml::table& table, std::string_view key, std::int64_t most) {
        const auto* node = table.get(key);
        if (!node) return {};
        const auto* array = node->as_array();
        std::array<std::int32_t, 2> out{};
        bool good = array && array->size() == out.size();
        for (std::size_t i = 0; good && i < out.size(); ++i) {
            const auto* value = array->get(i)->as_integer();
            good = value && value->get() >= 0 && value->get() <= most;
            if (good) out[i] = static_cast<std::int32_t>(value->get());
        }
        if (!good)
            refuse(node->source(), quoted(key) + ": expected [x, y] in pixels, each from 0 to " + std::to_string(most));
        return out;
    }

    /// The tables of `[[key]]`.
    std::vector<const toml::table*> tables(const toml::table& parent, std::string_view key, std::string_view name) {
        const auto* node = need(parent, key, "at least one " + std::string(name), false);
        std::vector<const toml::table*> out;
        const auto* array = node ? node->as_array() : nullptr;
        for (std::size_t i = 0; array && i < array->size(); ++i) {
            if (const auto* table = array->get(i)->as_table()) out.push_back(table);
        }
        if (node && (out.empty() || out.size() != array->size()))
            refuse(node->source(), quoted(key) + ": expected " + std::string(name) + " tables");
        return out;
    }

    /// A table that may be absent; empty then.
    const toml::table& section(const toml::table& parent, std::string_view key) {
        static const toml::table nothing;
        const auto* node = parent.get(key);
        if (!node) return nothing;
        if (const auto* table = node->as_table()) return *table;
        refuse(node->source(), quoted(key) + ": expected a [" + std::string(key) + "] table");
        return nothing;
    }

    static std::string quoted(std::string_view key) { return "'" + std::string(key) + "'"; }

private:
    const toml::node* need(const toml::table& table, std::string_view key, std::string_view expected, bool optional) {
        const auto* node = table.get(key);
        if (!node && !optional) refuse(table.source(), quoted(key) + " is missing: expected " + std::string(expected));
        return node;
    }

    std::string file_;
    std::optional<Error> error_;
};

}  // namespace wall::config
