// SPDX-License-Identifier: MIT
// The body of an answer for Boost.Beast: a text of its own, or bytes that several answers share. A picture that 200
// people asked for is in memory once.
#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstdint>
#include <memory>
#include <string>

namespace wall::walld {

struct HttpBody {
    struct value_type {
        std::string text;
        std::shared_ptr<const std::string> shared;  ///< instead of the text; null: none

        const std::string& bytes() const { return shared ? *shared : text; }
    };

    static std::uint64_t size(const value_type& body) { return body.bytes().size(); }

    /// As of a text: all of it at once.
    struct writer : boost::beast::http::string_body::writer {
        template <bool is_request, class Fields>
        writer(const boost::beast::http::header<is_request, Fields>& header, const value_type& body)
            : boost::beast::http::string_body::writer(header, body.bytes()) {}
    };
};

}  // namespace wall::walld
