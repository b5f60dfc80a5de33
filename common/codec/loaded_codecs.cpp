// SPDX-License-Identifier: MIT
#include "common/codec/loaded_codecs.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "common/codec/packed_codec.h"
#include "common/codec/wallgl_codec.h"

namespace wall::codec {
namespace {

/// Behind what a codec may write: that it has written more is seen there.
constexpr std::size_t kGuard = 64;
constexpr std::byte kUntouched{0xa5};
constexpr std::size_t kMostGrowth = 2, kMostExtra = std::size_t{1} << 20;  // what a bound may sensibly be

bool is_name(std::string_view name) {
    const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; };
    return !name.empty() && name.size() <= kMaxLoadedName && std::ranges::all_of(name, allowed);
}

std::filesystem::path folder() {
    const char* const named = ::secure_getenv("WALLGL_CODECS");
    return named != nullptr && *named != '\0' ? named : WALLGL_CODEC_FOLDER;
}

Compressor compressor_of(const wallgl_codec_functions& of) {
    const auto error = [name = std::string(of.name)](const std::string& what) { return fail(name + ": " + what); };
    return {
        .bound = [&of](std::size_t bytes) { return std::min(of.bound(bytes), kMostGrowth * bytes + kMostExtra); },
        .compress = [&of, error](Bytes from, std::span<std::byte> out) -> Result<std::size_t> {
            std::vector<std::byte> room(out.size() + kGuard, kUntouched);
            const std::size_t written = of.compress(from.data(), from.size(), room.data(), out.size());
            if (!std::ranges::all_of(room.begin() + static_cast<std::ptrdiff_t>(out.size()), room.end(),
                                     [](std::byte b) { return b == kUntouched; }))
                return error("it has written more than it may");
            if (written == 0 && !from.empty()) return error("compression failed");
            if (written > out.size())
                return error("it says that it has written " + std::to_string(written) + " bytes of " +
                             std::to_string(out.size()));
            std::copy_n(room.begin(), written, out.begin());
            return written;
        },
        .restore = [&of, error](Bytes packet, std::span<std::byte> out) -> Result<void> {
            std::vector<std::byte> room(out.size() + kGuard, kUntouched);
            if (of.restore(packet.data(), packet.size(), room.data(), out.size()) == 0)
                return error("packet of " + std::to_string(packet.size()) + " bytes does not become " +
                             std::to_string(out.size()));
            if (!std::ranges::all_of(room.begin() + static_cast<std::ptrdiff_t>(out.size()), room.end(),
                                     [](std::byte b) { return b == kUntouched; }))
                return error("it has written more than it may");
            std::copy_n(room.begin(), out.size(), out.begin());
            return {};
        },
    };
}

/// Stays as long as the process, as its code does.
struct Loaded {
    std::string name, summary;
    Compressor compressor;
    Codec codec;

    explicit Loaded(const wallgl_codec_functions& of)
        : name(of.name), summary(of.summary != nullptr ? of.summary : ""), compressor(compressor_of(of)) {
        codec = packed_codec(name, summary, compressor);
    }
    Loaded(const Loaded&) = delete;
};

Result<const wallgl_codec_functions*> open(const std::filesystem::path& file, std::string_view name) {
    const auto wrong = [&](const std::string& what) { return fail(file.string() + ": " + what); };
    void* const object = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (object == nullptr) return wrong(::dlerror());
    const auto get = reinterpret_cast<const wallgl_codec_functions* (*)()>(::dlsym(object, "wallgl_codec"));
    if (get == nullptr) return wrong("no codec: expected the function wallgl_codec()");
    const wallgl_codec_functions* const found = get();
    if (found == nullptr) return wrong("wallgl_codec() gives none");
    if (found->abi != WALLGL_CODEC_ABI)
        return wrong("made for version " + std::to_string(found->abi) + " of wallgl_codec.h; this is " +
                     std::to_string(WALLGL_CODEC_ABI));
    if (found->name == nullptr || found->name != name)
        return wrong("its codec has another name: expected '" + std::string(name) + "'");
    if (found->bound == nullptr || found->compress == nullptr || found->restore == nullptr)
        return wrong("one of its functions is missing");
    return found;
}

}  // namespace

Result<const Codec*> find_loaded_codec(std::string_view name) {
    if (!is_name(name)) return fail("no codec has such a name");
    static std::mutex mutex;
    static std::map<std::filesystem::path, std::unique_ptr<Loaded>> loaded;
    const auto file = folder() / (std::string(name) + ".so");
    const std::lock_guard lock(mutex);
    if (const auto known = loaded.find(file); known != loaded.end()) return &known->second->codec;
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return fail("there is no " + file.string());
    const auto found = open(file, name);
    if (!found) return tl::unexpected(found.error());
    return &loaded.emplace(file, std::make_unique<Loaded>(**found)).first->second->codec;
}

}  // namespace wall::codec
