// SPDX-License-Identifier: MIT
// What nodes have said of shaders and programs, kept in files of the user, as drivers keep what they have compiled: a
// program that starts again, or another one with the same shaders, asks nobody. A file is named by the question and the
// wall's driver, and counts only if it is whole. Nothing here fails: what cannot be read is asked, what cannot be
// written is not kept. Any thread, any process.
//
//     file := "wallgla1"  sha256(answer)  answer
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/glapi/content_hash.h"

namespace wall::client {

class AnswerCache {
public:
    static constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 20;  ///< of all files; the oldest go first
    static constexpr std::size_t kMostAnswer = std::size_t{1} << 20;      ///< larger ones are not kept

    /// In this folder, which is made when there is something to keep. Empty: nothing is kept, or known.
    explicit AnswerCache(std::string folder, std::uint64_t most_bytes = kMostBytes)
        : folder_(std::move(folder)), most_bytes_(most_bytes) {}

    /// WALLGL_CACHE, or where a user's caches are; empty if it is `off`, or there is no such place.
    static std::string usual_folder();

    std::optional<std::vector<std::byte>> find(const glapi::ContentKey& question) const;
    void keep(const glapi::ContentKey& question, std::span<const std::byte> answer);

private:
    std::string path_of(const glapi::ContentKey& question) const;
    void make_room() const;

    const std::string folder_;
    const std::uint64_t most_bytes_;
    std::atomic<unsigned> kept_ = 0;
};

}  // namespace wall::client
