// SPDX-License-Identifier: MIT
// A secret as it is kept: its SHA-256. Looking one up takes as long for a wrong one that begins right as for any other,
// and it can be written down. Any thread.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace wall::walld {

class SecretDigest {
public:
    static SecretDigest of(std::string_view secret);
    /// Of text(): 43 characters of base64url.
    static Result<SecretDigest> parse(std::string_view text);

    std::string text() const;
    auto operator<=>(const SecretDigest&) const = default;

private:
    std::array<std::uint8_t, 32> value_{};
};

}  // namespace wall::walld
