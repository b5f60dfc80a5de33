// SPDX-License-Identifier: MIT
// A folder for a test's files, removed with all that is in it.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

namespace wall::test {

class TemporaryFolder {
public:
    TemporaryFolder() { ::mkdtemp(path_.data()); }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    std::string file(const std::string& name) const { return path_ + "/" + name; }

private:
    std::string path_ = "/tmp/wallgl-test-XXXXXX";
};

}  // namespace wall::test
