// SPDX-License-Identifier: MIT
// The wall's description: wall.toml, which people write, and what operators have said since, which walld keeps in its
// state (FOLDER/nodes/NAME.toml: nodes that were added; FOLDER/drained.json: nodes that are to be left alone). Reads
// and writes files. One thread.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "common/config/wall_config.h"
#include "walld/mpcdi/load_mpcdi.h"
#include "walld/wall/refusal.h"

namespace wall::walld {

/// What walld goes by.
struct Description {
    config::WallConfig config;
    std::string toml;  ///< all of it, as nodes get it
};

class WallFile {
public:
    /// `path`: wall.toml. `state`: walld's folder; empty: nothing can be kept.
    WallFile(std::string path, std::filesystem::path state) : path_(std::move(path)), state_(std::move(state)) {}

    /// As the files are now.
    Outcome<Description> read() const;
    /// With the nodes of this text, [[node]] tables, which are kept. Nothing is when the whole would make no sense.
    Outcome<Description> add(const std::string& nodes) const;
    /// Without a node that was added.
    Outcome<Description> remove(const std::string& node) const;

    Outcome<std::set<std::string>> drained() const;
    Outcome<void> set_drained(const std::set<std::string>& nodes) const;

private:
    Outcome<std::string> text() const;
    Outcome<Description> described(std::string toml, const std::string& name) const;
    std::filesystem::path folder() const { return state_ / "nodes"; }
    Outcome<std::filesystem::path> file_of(const std::string& node) const;

    std::string path_;
    std::filesystem::path state_;
    mutable mpcdi::DescribedFiles files_;  // that it names
};

}  // namespace wall::walld
