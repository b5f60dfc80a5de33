// SPDX-License-Identifier: MIT
#include "common/base/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/base/unique_fd.h"

namespace wall {
namespace {

tl::unexpected<Error> failed(const std::filesystem::path& path) {
    return fail(path.string() + ": " + std::strerror(errno));
}

bool write_all(int fd, std::string_view text) {
    while (!text.empty()) {
        const auto n = ::write(fd, text.data(), text.size());
        if (n < 0 && errno != EINTR) return false;
        if (n > 0) text.remove_prefix(static_cast<std::size_t>(n));
    }
    return ::fsync(fd) == 0;
}

}  // namespace

Result<void> write_whole(const std::filesystem::path& path, std::string_view text, mode_t mode) {
    const std::filesystem::path next = path.string() + ".new";
    ::unlink(next.c_str());  // one that a crash has left, whatever its mode
    const UniqueFd fd(::open(next.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
    if (!fd || !write_all(fd.get(), text)) return failed(next);
    if (::rename(next.c_str(), path.c_str()) != 0) return failed(path);
    const UniqueFd folder(::open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (::fsync(folder.get()) != 0) return failed(path);
    return {};
}

}  // namespace wall
