// SPDX-License-Identifier: MIT
#include "client_lib/context/answer_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "common/base/unique_fd.h"

namespace wall::client {
namespace {

namespace fs = std::filesystem;

constexpr std::array<char, 8> kMagic = {'w', 'a', 'l', 'l', 'g', 'l', 'a', '1'};
constexpr unsigned kKeptBeforeRoomIsMade = 64;
constexpr std::size_t kHead = kMagic.size() + sizeof(glapi::ContentKey);

glapi::ContentKey checksum(std::span<const std::byte> answer) {
    glapi::ContentHash hash;
    hash.ProgramLink(answer);
    return hash.finish();
}

bool read_all(int fd, std::span<std::byte> to) {
    while (!to.empty()) {
        const ssize_t got = ::read(fd, to.data(), to.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        to = to.subspan(static_cast<std::size_t>(got));
    }
    return true;
}

bool write_all(int fd, std::span<const std::byte> from) {
    while (!from.empty()) {
        const ssize_t sent = ::write(fd, from.data(), from.size());
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        from = from.subspan(static_cast<std::size_t>(sent));
    }
    return true;
}

}  // namespace

std::string AnswerCache::usual_folder() {
    if (const char* given = secure_getenv("WALLGL_CACHE"); given != nullptr && *given != '\0')
        return std::strcmp(given, "off") == 0 ? std::string() : std::string(given);
    if (const char* caches = secure_getenv("XDG_CACHE_HOME"); caches != nullptr && *caches == '/')
        return std::string(caches) + "/wallgl";
    if (const char* home = secure_getenv("HOME"); home != nullptr && *home == '/')
        return std::string(home) + "/.cache/wallgl";
    return {};
}

std::string AnswerCache::path_of(const glapi::ContentKey& question) const {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string path = folder_ + '/';
    for (const std::byte b : question) {
        path += kDigits[std::to_integer<unsigned>(b) >> 4];
        path += kDigits[std::to_integer<unsigned>(b) & 15];
    }
    return path;
}

std::optional<std::vector<std::byte>> AnswerCache::find(const glapi::ContentKey& question) const {
    if (folder_.empty()) return std::nullopt;
    const UniqueFd fd(::open(path_of(question).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    struct stat about {};
    if (!fd || ::fstat(fd.get(), &about) != 0 || !S_ISREG(about.st_mode) || about.st_uid != ::geteuid()) return {};
    const auto size = static_cast<std::uint64_t>(about.st_size);
    if (size < kHead || size > kHead + kMostAnswer) return std::nullopt;
    std::array<char, kMagic.size()> magic{};
    glapi::ContentKey sum{};
    std::vector<std::byte> answer(size - kHead);
    if (!read_all(fd.get(), std::as_writable_bytes(std::span(magic))) || magic != kMagic || !read_all(fd.get(), sum) ||
        !read_all(fd.get(), answer) || checksum(answer) != sum)
        return std::nullopt;
    ::futimens(fd.get(), nullptr);  // so that what is used stays
    return answer;
}

/// Under another name first: who reads finds all of it or nothing. write_whole() would wait for the disk twice, and
/// several processes keep the same at once.
void AnswerCache::keep(const glapi::ContentKey& question, std::span<const std::byte> answer) {
    if (folder_.empty() || answer.size() > kMostAnswer) return;
    std::error_code error;
    if (!fs::exists(folder_, error)) {
        fs::create_directories(folder_, error);
        ::chmod(folder_.c_str(), S_IRWXU);
    }
    if (kept_++ % kKeptBeforeRoomIsMade == 0) make_room();
    const std::string path = path_of(question);
    std::string temporary = path + ".XXXXXX";
    const UniqueFd fd(::mkostemp(temporary.data(), O_CLOEXEC));
    if (!fd) return;
    const auto sum = checksum(answer);
    const bool whole = write_all(fd.get(), std::as_bytes(std::span(kMagic))) && write_all(fd.get(), sum) &&
                       write_all(fd.get(), answer);
    if (!whole || ::rename(temporary.c_str(), path.c_str()) != 0) ::unlink(temporary.c_str());
}

/// Some at once, so that it is seldom done.
void AnswerCache::make_room() const {
    struct File {
        fs::file_time_type used;
        std::uint64_t bytes;
        fs::path path;
    };
    std::vector<File> files;
    std::uint64_t bytes = 0;
    std::error_code error;
    for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
        std::error_code gone;  // somebody else may be making room, too
        const File file{at->last_write_time(gone), at->file_size(gone), at->path()};
        if (gone) continue;
        bytes += file.bytes;
        files.push_back(file);
    }
    if (bytes < most_bytes_) return;
    std::ranges::sort(files, {}, &File::used);
    for (const File& file : files) {
        if (bytes <= most_bytes_ / 4 * 3) return;
        fs::remove(file.path, error);
        bytes -= file.bytes;
    }
}

}  // namespace wall::client
