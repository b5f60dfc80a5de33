// SPDX-License-Identifier: MIT
#include "tileserver/execute/pipeline_commands.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "tileserver/objects/pipeline.h"

namespace wall::tileserver {

void PipelineCommands::Pipeline(ClientName name, std::span<const std::byte> programs) {
    std::array<std::uint32_t, tileserver::Pipeline::kStages> words{};
    if (programs.size() != sizeof words) return execution_.refuse("not a program for each stage");
    std::memcpy(words.data(), programs.data(), sizeof words);
    const auto made = execution_.session.objects.make<tileserver::Pipeline>(name, execution_.node.driver);
    if (!made) return execution_.refuse(made.error().message);
    std::array<ClientName, tileserver::Pipeline::kStages> names;
    std::ranges::transform(words, names.begin(), [](std::uint32_t word) { return ClientName(word); });
    (*made)->define(names);
}

}  // namespace wall::tileserver
