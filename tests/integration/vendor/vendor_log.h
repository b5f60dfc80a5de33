// SPDX-License-Identifier: MIT
// What the fake core has logged (fake_core.cpp), for tests that look at what a vendor asked of it.
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

/// Lines of the log that contain `text`, oldest first. run_vendor_test.py has set WALLGL_LOG=info:FILE.
inline std::vector<std::string> logged(const std::string& text) {
    const std::string setting = std::getenv("WALLGL_LOG");
    std::ifstream file(setting.substr(setting.find(':') + 1));
    std::vector<std::string> found;
    for (std::string line; std::getline(file, line);)
        if (line.find(text) != line.npos) found.push_back(line);
    return found;
}

inline std::string last_logged(const std::string& text) {
    const auto lines = logged(text);
    return lines.empty() ? "" : lines.back();
}
