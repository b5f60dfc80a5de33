// SPDX-License-Identifier: MIT
// Layouts on disk: FOLDER/layouts/NAME.json, written whole or not at all. One thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "walld/wall/layout.h"

namespace wall::walld {

class LayoutStore {
public:
    static constexpr std::size_t kMaxLayouts = 1000;

    /// `state`: the daemon's state directory; empty: nothing can be kept.
    explicit LayoutStore(const std::string& state)
        : folder_(state.empty() ? std::filesystem::path() : std::filesystem::path(state) / "layouts") {}

    /// Replaces one of that name.
    Outcome<void> save(const std::string& name, const Layout& layout) const;
    Outcome<Layout> load(const std::string& name) const;
    /// Names, sorted.
    Outcome<std::vector<std::string>> list() const;
    Outcome<void> remove(const std::string& name) const;

private:
    Outcome<std::filesystem::path> path_of(const std::string& name) const;
    std::filesystem::path folder_;
};

}  // namespace wall::walld
