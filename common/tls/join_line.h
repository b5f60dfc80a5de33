// SPDX-License-Identifier: MIT
// The line that a person carries from walld to a machine that shall join the wall (`wallctl join-token`): where walld
// is, its key's fingerprint, and a secret that is good once and for a short time. Pure. Any thread.
//
//     line    = "wallgl1." HOST ":" PORT "." FINGERPRINT "." SECRET      (the last two in base64url)
#pragma once

#include <string>
#include <string_view>

#include "common/base/address.h"
#include "common/base/result.h"
#include "common/tls/fingerprint.h"

namespace wall::tls {

struct JoinLine {
    static constexpr std::size_t kSecretBytes = 16;

    Address walld;  ///< TCP
    Fingerprint fingerprint;
    std::string secret;  ///< kSecretBytes

    static Result<JoinLine> parse(std::string_view line);
    std::string text() const;
};

}  // namespace wall::tls
