// SPDX-License-Identifier: MIT
#include "tileserver/execute/query_commands.h"

#include <cstring>
#include <utility>
#include <vector>

#include "tileserver/objects/query.h"

namespace wall::tileserver {

void QueryCommands::QueryResult(RequestId request, ClientName query) {
    const Timed timed(execution_.session.work.render);
    const auto found = execution_.session.objects.look_up<Query>(query);
    if (!found) return execution_.refuse(found.error().message);
    const std::uint64_t samples = *found != nullptr ? (*found)->result() : 0;  // none: nothing was drawn here meanwhile
    std::vector<std::byte> answer(sizeof samples);
    std::memcpy(answer.data(), &samples, sizeof samples);
    execution_.output.reply(request, std::move(answer));
}

}  // namespace wall::tileserver
