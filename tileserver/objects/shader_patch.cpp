// SPDX-License-Identifier: MIT
#include "tileserver/objects/shader_patch.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

namespace wall::tileserver {
namespace {

constexpr std::string_view kFragCoord = "gl_FragCoord";
constexpr std::string_view kReplacement = "wallgl_FragCoord";

bool starts_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool in_name(char c) { return starts_name(c) || std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// One pass over the tokens. Notes where gl_FragCoord stands and where the first declaration may go: behind #version
/// and the last #extension, but within no #if, since its branch may be left out.
class Scanner {
public:
    explicit Scanner(std::string_view text) : text_(text) {}

    std::vector<std::size_t> uses;
    std::size_t insertion = 0;
    bool es = false, upper_left = false, whole_centers = false;

    void run() {
        while (at_ < text_.size()) step();
        end_line();
    }

private:
    void step() {
        const char c = text_[at_];
        if (skip_comment()) return;
        if (c == '\\' && at_ + 1 < text_.size() && (text_[at_ + 1] == '\n' || text_[at_ + 1] == '\r')) {
            at_ += text_.substr(at_ + 1, 2) == "\r\n" ? 3 : 2;  // the line goes on
            return;
        }
        if (c == '\n') {
            ++at_;
            end_line();
        } else if (starts_name(c)) {
            take_name();
        } else {
            if (c == '#' && line_is_blank_) in_directive_ = true;
            if (std::isspace(static_cast<unsigned char>(c)) == 0) {
                line_is_blank_ = false;
                previous_ = {};
            }
            if (directive_ == "version" && std::isdigit(static_cast<unsigned char>(c)) != 0) return take_version();
            ++at_;
            if (std::isdigit(static_cast<unsigned char>(c)) != 0)
                while (at_ < text_.size() && in_name(text_[at_])) ++at_;  // 1e5, 0x1f
        }
    }

    bool skip_comment() {
        const std::string_view two = text_.substr(at_, 2);
        if (two == "//") at_ = std::min(text_.find('\n', at_), text_.size());
        else if (two == "/*")
            at_ = text_.find("*/", at_ + 2) == text_.npos ? text_.size() : text_.find("*/", at_ + 2) + 2;
        else return false;
        return true;
    }

    void take_version() {
        const std::size_t start = at_;
        while (at_ < text_.size() && in_name(text_[at_])) ++at_;
        if (text_.substr(start, at_ - start) == "100") es = true;
    }

    void take_name() {
        const std::size_t start = at_;
        while (at_ < text_.size() && in_name(text_[at_])) ++at_;
        const std::string_view name = text_.substr(start, at_ - start);
        line_is_blank_ = false;
        if (in_directive_ && directive_.empty()) directive_ = name;
        else if (directive_ == "version" && name == "es") es = true;
        if (name == "origin_upper_left") upper_left = true;
        if (name == "pixel_center_integer") whole_centers = true;
        if (name == kFragCoord && !is_redeclaration()) uses.push_back(start);
        previous_ = name;
    }

    /// "in vec4 gl_FragCoord;" or "invariant gl_FragCoord;": nothing else has a name right in front of it.
    bool is_redeclaration() const { return previous_ == "vec4" || previous_ == "invariant"; }

    void end_line() {
        line_is_blank_ = true;
        in_directive_ = false;
        const std::string_view directive = directive_;
        directive_ = {};
        if (directive.starts_with("if")) ++depth_;
        if (directive == "endif" && depth_ > 0) --depth_;
        if (directive == "version" || directive == "extension") waiting_ = true;
        if (!waiting_ || depth_ != 0) return;
        insertion = at_;
        waiting_ = false;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    bool line_is_blank_ = true, in_directive_ = false, waiting_ = false;
    std::string_view directive_, previous_;
    int depth_ = 0;
};

std::string declaration(bool es) {
    const std::string name = kWindowUniform, precision = es ? "highp " : "";
    return "\nuniform " + precision + "vec4 " + name + ";\n#define " + std::string(kReplacement) +
           " vec4(gl_FragCoord.xy * " + name + ".xy + " + name + ".zw, gl_FragCoord.zw)\n";
}

}  // namespace

PatchedShader patch_fragment_shader(std::string source) {
    Scanner scanner(source);
    scanner.run();
    PatchedShader out;
    if (scanner.uses.empty()) {
        out.source = std::move(source);
        return out;
    }
    out.reads_window = true;
    out.upper_left = scanner.upper_left;
    out.whole_centers = scanner.whole_centers;
    std::size_t copied = 0;
    const auto copy_to = [&](std::size_t end) {
        out.source.append(source, copied, end - copied);
        copied = end;
    };
    bool declared = false;
    for (const std::size_t use : scanner.uses) {
        if (!declared && use >= scanner.insertion) {
            copy_to(scanner.insertion);
            out.source += declaration(scanner.es);
            declared = true;
        }
        copy_to(use);
        out.source += kReplacement;
        copied += kFragCoord.size();
    }
    if (!declared) {  // only macros in front of the last #extension use it
        copy_to(scanner.insertion);
        out.source += declaration(scanner.es);
    }
    copy_to(source.size());
    return out;
}

}  // namespace wall::tileserver
