// SPDX-License-Identifier: MIT
// The names that a vertex program declares, and the operands of its instructions, as values (assembly_values.h). The
// driver has found the program right; what is not understood here is not known. Pure.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tileserver/objects/assembly_tokens.h"
#include "tileserver/objects/assembly_values.h"

namespace wall::tileserver {

/// Where an instruction writes to.
struct AssemblyTarget {
    AssemblyVector* variable = nullptr;  ///< null: what the position cannot depend on
    std::vector<unsigned> written;       ///< components
};

class AssemblyOperands {
public:
    /// All of them outlive it.
    AssemblyOperands(AssemblyCursor& at, PositionBuilder& builder, AssemblyValues& values)
        : at_(at), builder_(builder), values_(values) {}

    /// Reads a declaration behind its first word, with its semicolon. False: that word begins none.
    bool declare(std::string_view word);
    AssemblyTarget take_target();
    AssemblyVector take_source();
    /// The same without a sign and a choice of components.
    AssemblyVector take_base();
    const AssemblyVector& position() const { return position_; }
    /// Everything so far was as it is expected; else values may have the wrong names.
    bool understood() const { return understood_; }

private:
    enum class Kind { variable, parameters, position, other };
    struct Name {
        Kind kind = Kind::other;
        std::vector<AssemblyVector> values;  ///< of a variable one; of parameters as many as they are
    };

    void declare_variables(Kind kind);
    void declare_input();
    void declare_parameters();
    void declare_output();
    void declare_alias();
    std::vector<AssemblyVector> take_bindings();
    std::vector<AssemblyVector> take_binding();
    std::vector<AssemblyVector> take_parameters();
    std::vector<AssemblyVector> take_state();
    std::vector<AssemblyVector> take_rows(const PositionValue& matrix);
    PositionValue take_matrix();
    AssemblyVector take_attribute();
    AssemblyVector take_literal();
    std::optional<AssemblyScalar> take_number();
    AssemblyVector take_named(std::string_view name);
    std::vector<unsigned> take_components(std::size_t least);
    void skip_binding();
    bool expect(std::string_view token) {
        understood_ = at_.take(token) && understood_;
        return understood_;
    }
    void name(std::string_view text, Name value) {
        names_[std::string(text)] = std::make_shared<Name>(std::move(value));
    }

    AssemblyCursor& at_;
    PositionBuilder& builder_;
    AssemblyValues& values_;
    std::map<std::string, std::shared_ptr<Name>, std::less<>> names_;  // another name of one shares it
    AssemblyVector position_;
    std::size_t parameters_ = 0;  // so far
    bool understood_ = true;
};

}  // namespace wall::tileserver
