// SPDX-License-Identifier: MIT
// The body of an answer for Boost.Beast: a text of its own, or bytes that several answers share. A picture that 200
// people asked for is in memory once.
#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/optional.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace wall::walld {

struct HttpBody {
    struct value_type {
        std::string text;
        std::shared_ptr<const std::string> shared;  ///< instead of the text; null: none

        const std::string& bytes() const { return shared ? *shared : text; }
    };

    static std::uint64_t size(const value_type& body) { return body.bytes().size(); }

    /// Beast's BodyWriter: all of it at once.
    class writer {
    public:
        using const_buffers_type = boost::asio::const_buffer;

        template <bool is_request, class Fields>
        writer(const boost::beast::http::header<is_request, Fields>&, const value_type& body) : body_(body) {}
        void init(boost::system::error_code& error) { error = {}; }
        boost::optional<std::pair<const_buffers_type, bool>> get(boost::system::error_code& error) {
            error = {};
            return {{boost::asio::buffer(body_.bytes()), false}};
        }

    private:
        const value_type& body_;
    };
};

}  // namespace wall::walld
