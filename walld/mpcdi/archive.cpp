// SPDX-License-Identifier: MIT
#include "walld/mpcdi/archive.h"

#include <zip.h>

#include <algorithm>
#include <utility>

namespace wall::mpcdi {
namespace {

constexpr std::size_t kMostDescription = std::size_t{4} << 20;  // bytes
constexpr std::string_view kEnding = ".xml";

std::string text_of(zip_error_t& error) {
    std::string out = zip_error_strerror(&error);
    zip_error_fini(&error);
    return out;
}

}  // namespace

void Archive::Close::operator()(zip* archive) const { zip_discard(archive); }

Result<Archive> Archive::open(std::string bytes, std::string name) {
    Archive out(std::move(bytes), std::move(name));
    const auto& content = *out.bytes_;
    if (content.starts_with("<") || content.starts_with("\xef\xbb\xbf<")) {
        out.description_ = out.name_;
        return out;
    }
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source = zip_source_buffer_create(content.data(), content.size(), 0, &error);
    zip_t* opened = source != nullptr ? zip_open_from_source(source, ZIP_RDONLY, &error) : nullptr;
    if (opened == nullptr) {
        zip_source_free(source);
        return fail(out.name_ + ": expected an MPCDI file, a ZIP archive with a description in XML: " + text_of(error));
    }
    out.zip_.reset(opened);
    for (zip_int64_t i = 0; i < zip_get_num_entries(opened, 0); ++i) {
        const char* entry = zip_get_name(opened, static_cast<zip_uint64_t>(i), 0);
        if (entry == nullptr || !std::string_view(entry).ends_with(kEnding)) continue;
        if (!out.description_.empty())
            return fail(out.name_ + ": '" + out.description_ + "' and '" + entry + "': expected one description");
        out.description_ = entry;
    }
    if (out.description_.empty()) return fail(out.name_ + ": expected a description in it, mpcdi.xml");
    return out;
}

Result<std::string> Archive::description() const {
    if (zip_) return content(description_, kMostDescription);
    if (bytes_->size() <= kMostDescription) return *bytes_;
    return fail(name_ + ": expected a description of at most 4 MiB");
}

Result<std::string> Archive::content(const std::string& path, std::size_t most) const {
    const std::string where = name_ + ": '" + path + "'";
    if (!zip_) return fail(where + " is not there: the file is a description alone, without maps");
    zip_stat_t stat;
    zip_stat_init(&stat);
    if (zip_stat(zip_.get(), path.c_str(), 0, &stat) != 0 || (stat.valid & ZIP_STAT_SIZE) == 0)
        return fail(where + " is not in the archive");
    if (stat.size > most)
        return fail(where + " has " + std::to_string(stat.size) + " bytes: expected at most " + std::to_string(most));
    zip_file_t* file = zip_fopen_index(zip_.get(), stat.index, 0);
    if (file == nullptr) return fail(where + ": " + zip_strerror(zip_.get()));
    std::string out(stat.size, '\0');
    const auto read = zip_fread(file, out.data(), out.size());
    const int closed = zip_fclose(file);  // which also looks at the checksum
    if (read < 0 || static_cast<std::size_t>(read) != out.size() || closed != 0)
        return fail(where + " is damaged: expected " + std::to_string(out.size()) + " bytes");
    return out;
}

}  // namespace wall::mpcdi
