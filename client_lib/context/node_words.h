// SPDX-License-Identifier: MIT
// The extensions that the drivers of all nodes have. One thread at a time.
#pragma once

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "client_lib/link/control_messages.h"

namespace wall::client {

class NodeWords {
public:
    explicit NodeWords(const Caps& caps) {
        std::istringstream words(caps.extensions);
        words_.assign(std::istream_iterator<std::string>(words), {});
    }
    bool have(std::string_view word) const { return std::ranges::find(words_, word) != words_.end(); }

private:
    std::vector<std::string> words_;
};

}  // namespace wall::client
