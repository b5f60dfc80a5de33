// SPDX-License-Identifier: MIT
#include "walld/control/layout_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "common/base/unique_fd.h"
#include "common/json/parse_json.h"

namespace wall::walld {
namespace {

namespace fs = std::filesystem;
constexpr const char* kEnding = ".json";
constexpr std::size_t kMaxName = 64;

bool name_ok(const std::string& name) {
    const auto good = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
               c == '.';
    };
    return !name.empty() && name.size() <= kMaxName && name[0] != '.' && std::ranges::all_of(name, good);
}

tl::unexpected<Refusal> failed(const fs::path& path, const std::string& what) {
    return refuse(RefusalKind::failed, path.string() + ": " + what);
}

Outcome<void> write_all(int fd, const std::string& text, const fs::path& path) {
    for (std::size_t done = 0; done < text.size();) {
        const auto n = ::write(fd, text.data() + done, text.size() - done);
        if (n < 0 && errno != EINTR) return failed(path, std::strerror(errno));
        if (n > 0) done += static_cast<std::size_t>(n);
    }
    if (::fsync(fd) != 0) return failed(path, std::strerror(errno));
    return {};
}

/// After a crash there is the old content or the new, never a part.
Outcome<void> write_whole(const fs::path& path, const std::string& text) {
    const fs::path next = path.string() + ".new";
    const UniqueFd fd(::open(next.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0640));
    if (!fd) return failed(next, std::strerror(errno));
    if (auto written = write_all(fd.get(), text, next); !written) return written;
    if (::rename(next.c_str(), path.c_str()) != 0) return failed(path, std::strerror(errno));
    const UniqueFd folder(::open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (::fsync(folder.get()) != 0) return failed(path, std::strerror(errno));
    return {};
}

}  // namespace

Outcome<fs::path> LayoutStore::path_of(const std::string& name) const {
    if (folder_.empty())
        return refuse(
            RefusalKind::unavailable,
            "layouts cannot be kept: walld has no state directory ('state_directory' in [wall] of wall.toml)");
    if (name_ok(name)) return folder_ / (name + kEnding);
    return refuse(RefusalKind::invalid,
                  "a layout's name has 1 to " + std::to_string(kMaxName) +
                      " letters, digits, dots, dashes and underscores, and does not begin with a dot");
}

Outcome<void> LayoutStore::save(const std::string& name, const Layout& layout) const {
    const auto path = path_of(name);
    if (!path) return tl::unexpected(path.error());
    const auto names = list();
    if (!names) return tl::unexpected(names.error());
    if (names->size() >= kMaxLayouts && !std::ranges::binary_search(*names, name))
        return refuse(RefusalKind::conflict,
                      "there are " + std::to_string(kMaxLayouts) + " layouts already: delete one first");
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) return failed(folder_, error.message());
    return write_whole(*path, to_text(layout));
}

Outcome<Layout> LayoutStore::load(const std::string& name) const {
    const auto path = path_of(name);
    if (!path) return tl::unexpected(path.error());
    std::ifstream file(*path, std::ios::binary);
    if (!file) return refuse(RefusalKind::not_found, "there is no layout '" + name + "'");
    std::error_code error;
    if (fs::file_size(*path, error) > kFileJson.bytes || error)
        return failed(*path, "not a layout: larger than " + std::to_string(kFileJson.bytes) + " bytes, or no file");
    std::ostringstream text;
    text << file.rdbuf();
    auto layout = parse_layout(text.str());
    if (!layout) return failed(*path, layout.error().message);
    return std::move(*layout);
}

Outcome<std::vector<std::string>> LayoutStore::list() const {
    if (const auto usable = path_of("any"); !usable) return tl::unexpected(usable.error());
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
        const auto name = at->path().stem().string();
        if (at->path().extension() == kEnding && name_ok(name)) names.push_back(name);
    }
    if (error && error != std::errc::no_such_file_or_directory) return failed(folder_, error.message());
    std::ranges::sort(names);
    return names;
}

Outcome<void> LayoutStore::remove(const std::string& name) const {
    const auto path = path_of(name);
    if (!path) return tl::unexpected(path.error());
    if (::unlink(path->c_str()) == 0) return {};
    if (errno == ENOENT) return refuse(RefusalKind::not_found, "there is no layout '" + name + "'");
    return failed(*path, std::strerror(errno));
}

}  // namespace wall::walld
