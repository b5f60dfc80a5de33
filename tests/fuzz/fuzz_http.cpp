// SPDX-License-Identifier: MIT
// What a browser, or anybody, asks walld over HTTP: a command with a JSON object, or a refusal with a status and a
// sentence. Input: method, path, content type, origin, cookies (each with its length) and the body.
#include "common/base/assert.h"
#include "tests/fuzz/input_pieces.h"
#include "walld/http/logins.h"
#include "walld/http/rest.h"
#include "walld/wall/status.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace wall;
    fuzz::InputPieces input(data, size);
    walld::RestRequest request;
    request.host = "wall:7780";
    request.method = input.counted();
    request.path = input.counted();
    request.content_type = input.counted();
    request.origin = input.counted();
    const std::string_view cookies = input.counted();
    request.body = input.bytes(size);
    WALL_ASSERT(walld::cookie_value(cookies, "wallgl").size() <= cookies.size());
    const auto command = walld::rest_command(request);
    if (command) {
        WALL_ASSERT(command->arguments.is_object() && !command->verb.empty());
        const bool changes = request.method != "GET" && request.method != "HEAD";
        WALL_ASSERT(!changes || request.same_site());
    } else {
        WALL_ASSERT(command.error().status >= 400 && command.error().status < 500);
        WALL_ASSERT(!command.error().why.message.empty());
        (void)walld::dump(walld::error_json(command.error().why));
    }
    return 0;
}
