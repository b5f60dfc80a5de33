// SPDX-License-Identifier: MIT
#include "walld/control/layout_store.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "common/base/whole_file.h"
#include "common/json/parse_json.h"
#include "walld/control/names.h"

namespace wall::walld {
namespace {

namespace fs = std::filesystem;
constexpr const char* kEnding = ".json";

tl::unexpected<Refusal> failed(const fs::path& path, const std::string& what) {
    return refuse(RefusalKind::failed, path.string() + ": " + what);
}

}  // namespace

Outcome<fs::path> LayoutStore::path_of(const std::string& name) const {
    if (folder_.empty())
        return refuse(
            RefusalKind::unavailable,
            "layouts cannot be kept: walld has no state directory ('state_directory' in [wall] of wall.toml)");
    if (may_name_file(name)) return folder_ / (name + kEnding);
    return refuse(RefusalKind::invalid, "a layout's name has " + file_name_rule());
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
    if (auto written = write_whole(*path, to_text(layout), 0640); !written)
        return refuse(RefusalKind::failed, written.error().message);
    return {};
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
        if (at->path().extension() == kEnding && may_name_file(name)) names.push_back(name);
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
