// SPDX-License-Identifier: MIT
#include "tileserver/objects/assembly_patch.h"

#include <string_view>
#include <utility>
#include <vector>

#include "tileserver/objects/assembly_tokens.h"

namespace wall::tileserver {
namespace {

constexpr std::string_view kPosition = "wallgl_FragCoord";

/// What stands in the source from `at` to `behind`, and what comes instead.
struct Change {
    std::size_t at, behind;
    std::string text;
};

std::string declaration(unsigned first) {
    const std::string name(kPosition);
    return "\nTEMP " + name + ";\nMAD " + name + ", fragment.position, program.env[" + std::to_string(first) +
           "], program.env[" + std::to_string(first + 1) + "];\n";
}

/// Of each "fragment.position". A name that is declared for it is one of the temporary then.
std::vector<Change> find_changes(const std::vector<AssemblyToken>& tokens, std::size_t from) {
    std::vector<Change> out;
    const AssemblyToken* statement = nullptr;  // its first token
    for (std::size_t i = from; i < tokens.size(); ++i) {
        if (statement == nullptr) statement = &tokens[i];
        if (tokens[i].text == ";") statement = nullptr;
        const bool found = tokens[i].text == "fragment" && i + 2 < tokens.size() && tokens[i + 1].text == "." &&
                           tokens[i + 2].text == "position";
        if (!found) continue;
        if (statement->text == "ATTRIB") out.push_back({statement->at, statement->behind(), "ALIAS"});
        out.push_back({tokens[i].at, tokens[i + 2].behind(), std::string(kPosition)});
        i += 2;
    }
    return out;
}

}  // namespace

PatchedAssembly patch_fragment_program(std::string source, unsigned first) {
    PatchedAssembly out;
    const auto tokens = assembly_tokens(source);
    AssemblyCursor cursor(tokens);
    cursor.take();
    cursor.take_options([&](std::string_view option) {
        out.upper_left |= option == "ARB_fragment_coord_origin_upper_left";
        out.whole_centers |= option == "ARB_fragment_coord_pixel_center_integer";
    });
    const std::size_t begin = cursor.place();
    auto changes = find_changes(tokens, begin);
    if (changes.empty()) {
        out.source = std::move(source);
        return out;
    }
    out.reads_window = true;
    const std::size_t declared = tokens[begin - 1].behind();
    changes.insert(changes.begin(), Change{declared, declared, declaration(first)});
    std::size_t copied = 0;
    for (const Change& change : changes) {
        out.source.append(source, copied, change.at - copied);
        out.source += change.text;
        copied = change.behind;
    }
    out.source.append(source, copied);
    return out;
}

}  // namespace wall::tileserver
