// SPDX-License-Identifier: MIT
// An MPCDI file: a ZIP archive of an XML file and the maps that it names, or the XML file alone. It may be anything, so
// sizes are bounded before they are read. One thread.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "common/base/result.h"

struct zip;

namespace wall::mpcdi {

class Archive {
public:
    /// `name`: of the file, for errors.
    static Result<Archive> open(std::string bytes, std::string name);

    /// What the file `path` of it has, of at most `most` bytes.
    Result<std::string> content(const std::string& path, std::size_t most) const;
    /// Of the description, the one .xml file, and what that is called.
    Result<std::string> description() const;
    const std::string& description_name() const { return description_; }
    const std::string& name() const { return name_; }

private:
    struct Close {
        void operator()(zip* archive) const;
    };
    Archive(std::string bytes, std::string name)
        : bytes_(std::make_unique<std::string>(std::move(bytes))), name_(std::move(name)) {}

    std::unique_ptr<std::string> bytes_;  // which stay where they are
    std::unique_ptr<zip, Close> zip_;     // null: it is the description alone
    std::string name_, description_;
};

}  // namespace wall::mpcdi
