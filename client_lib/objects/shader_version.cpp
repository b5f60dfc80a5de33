// SPDX-License-Identifier: MIT
#include "client_lib/objects/shader_version.h"

#include <algorithm>
#include <charconv>

namespace wall::client {
namespace {

constexpr std::string_view kBlanks = " \t\v\f\r";

/// Behind blanks (and ends of lines, if `lines`) and comments.
std::string_view behind_blanks(std::string_view text, bool lines) {
    for (;;) {
        text.remove_prefix(std::min(text.find_first_not_of(lines ? " \t\v\f\r\n" : std::string(kBlanks)), text.size()));
        const bool line = text.starts_with("//"), block = text.starts_with("/*");
        if (!block && !(line && lines)) return text;
        const std::size_t end = line ? text.find('\n') : text.find("*/", 2);
        if (end == text.npos) return {};
        text.remove_prefix(line ? end : end + 2);
    }
}

bool take(std::string_view& text, std::string_view word) {
    if (!text.starts_with(word)) return false;
    text.remove_prefix(word.size());
    return true;
}

/// "1.00 ES, 3.00 ES".
std::string supported(unsigned es_version) {
    std::string text = "1.00 ES";
    for (const unsigned version : {30u, 31u, 32u})
        if (version <= es_version)
            text += ", " + std::to_string(version / 10) + "." + std::to_string(version % 10) + "0 ES";
    return text;
}

std::string as_text(const ShaderVersion& version) {
    const std::string minor = std::to_string(version.number % 100);
    return std::to_string(version.number / 100) + "." + (minor.size() < 2 ? "0" + minor : minor) +
           (version.es ? " ES" : "");
}

bool is_taken(const ShaderVersion& version, unsigned es_version) {
    if (!version.es) return false;
    return version.number == 100 || (version.number >= 300 && version.number <= es_version * 10);
}

}  // namespace

ShaderVersion version_of_shader(std::string_view source) {
    std::string_view text = behind_blanks(source, true);
    if (!take(text, "#")) return {};
    text = behind_blanks(text, false);
    if (!take(text, "version")) return {};
    text = behind_blanks(text, false);
    ShaderVersion version;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), version.number);
    if (error != std::errc()) return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    version.given = true;
    version.es = version.number == 100 || behind_blanks(text, false).starts_with("es");
    return version;
}

EsSource es_source(std::string source, unsigned es_version) {
    const ShaderVersion version = version_of_shader(source);
    if (!version.given) return {"#version 100\n#line 1\n" + std::move(source), {}};
    if (is_taken(version, es_version)) return {std::move(source), {}};
    return {std::move(source), "0:1(10): error: GLSL " + as_text(version) +
                                   " is not supported. Supported versions are: " + supported(es_version) + "\n"};
}

}  // namespace wall::client
