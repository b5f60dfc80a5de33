// SPDX-License-Identifier: MIT
#include "tileserver/objects/shader_variables.h"

#include <string_view>
#include <utility>

namespace wall::tileserver {

// ---- places ----

namespace {

bool is_position(const glslang::TType& type) { return type.getQualifier().builtIn == glslang::EbvPosition; }

}  // namespace

Place::Place(const glslang::TIntermSymbol& symbol)
    : variable(is_position(symbol.getType()) ? kPosition : std::to_string(symbol.getId())),
      path(symbol.getName().c_str()),
      root(&symbol) {
    set_type(symbol.getType());
}

void Place::set_type(const glslang::TType& of) {
    type = &of;
    components.resize(unknown_of(of, WhyUnknown::not_written).size());
    for (unsigned i = 0; i < components.size(); ++i) components[i] = i;
}

void Place::narrow(glslang::TIntermBinary& part) {
    if (!clear) return;
    if (is_plain_float(part.getLeft()->getType())) select(part);
    else enter(part);
}

void Place::select(glslang::TIntermBinary& part) {
    const auto which = selected(part);
    clear = which.has_value();
    if (!clear) return;
    std::vector<unsigned> narrower;
    for (const unsigned i : *which) narrower.push_back(components[i]);
    components = std::move(narrower);
}

/// An element of an array, or a member of a structure or block.
void Place::enter(glslang::TIntermBinary& part) {
    const auto index = part.getOp() == glslang::EOpIndexIndirect ? std::nullopt : constant_index(part.getRight());
    clear = index.has_value();
    if (!clear) return;
    if (indexed) path += "[" + std::to_string(element) + "]";
    variable += "." + std::to_string(*index);
    indexed = part.getOp() == glslang::EOpIndexDirect;
    element = indexed ? *index : 0;
    const auto* members = indexed ? nullptr : part.getLeft()->getType().getStruct();
    if (members && *index < members->size()) {
        const glslang::TType& member = *(*members)[*index].type;
        path += std::string(".") + member.getFieldName().c_str();
        if (is_position(member)) variable = kPosition;
    }
    set_type(part.getType());
}

std::optional<HandedOn> HandedOn::of(const Place& place, glslang::TStorageQualifier storage) {
    const glslang::TType& root = place.root->getType();
    const auto& qualifier = root.getQualifier();
    if (!place.clear || qualifier.storage != storage || root.getBasicType() == glslang::EbtBlock) return std::nullopt;
    HandedOn out{place.full_path()};
    if (qualifier.hasLocation()) out.location = qualifier.layoutLocation;
    return qualifier.hasComponent() ? std::nullopt : std::optional(out);
}

// ---- reading ----

PositionValue ShaderVariables::handed_on(const HandedOn& which) const {
    const auto found = handed_on_.find(which);
    const auto value = found == handed_on_.end() ? values_.end() : values_.find(found->second);
    return value == values_.end() ? PositionValue() : value->second;
}

PositionValue ShaderVariables::position() const {
    const auto found = values_.find(kPosition);
    return found == values_.end() ? PositionValue(1, 4, WhyUnknown::not_written) : found->second;
}

PositionValue ShaderVariables::read(const Place& place, const glslang::TType& type) {
    if (!place.clear) return unknown_of(type, WhyUnknown::not_affine);
    return part_of(read_whole(place), place.components, type);
}

PositionValue ShaderVariables::part_of(const PositionValue& whole, const std::vector<unsigned>& components,
                                       const glslang::TType& type) {
    PositionValue out = unknown_of(type, WhyUnknown::not_a_float);
    if (out.size() != components.size()) return out;
    for (unsigned i = 0; i < out.size(); ++i)
        if (components[i] < whole.size()) out[i] = whole[components[i]];
    return out;
}

PositionValue ShaderVariables::read_whole(const Place& place) {
    const glslang::TType& type = *place.type;
    if (!is_plain_float(type)) return {};
    if (!any_precision_ && is_low_precision(type)) return unknown_of(type, WhyUnknown::not_a_float);
    if (const auto found = values_.find(place.variable); found != values_.end()) return found->second;
    const PositionValue unknown = unknown_of(type, WhyUnknown::not_written);
    const glslang::TType& root = place.root->getType();
    const auto storage = root.getQualifier().storage;
    if (storage == glslang::EvqUniform) return uniform(place, unknown);
    const bool whole = place.path == place.root->getName().c_str() && !place.indexed;
    if (storage != glslang::EvqVaryingIn || !whole || root.getQualifier().hasComponent()) return unknown;
    return type.isMatrix() ? unknown_of(type, WhyUnknown::not_affine) : builder_.attribute(place.path, unknown.rows());
}

namespace {

struct BuiltInName {
    std::string_view name;
    glapi::BuiltInMatrix matrix;
};
constexpr BuiltInName kBuiltInNames[] = {
    {"gl_ModelViewMatrix", glapi::BuiltInMatrix::modelview},
    {"gl_ProjectionMatrix", glapi::BuiltInMatrix::projection},
    {"gl_ModelViewProjectionMatrix", glapi::BuiltInMatrix::modelview_projection},
};

}  // namespace

PositionValue ShaderVariables::uniform(const Place& place, const PositionValue& unknown) {
    const auto because = [&](WhyUnknown why) { return PositionValue(unknown.columns(), unknown.rows(), why); };
    if (place.root->getType().getBasicType() == glslang::EbtBlock) return because(WhyUnknown::in_a_block);
    if (!place.path.starts_with("gl_"))
        return builder_.uniform(place.path, place.element, unknown.columns(), unknown.rows());
    for (const BuiltInName& known : kBuiltInNames) {
        if (!place.path.starts_with(known.name)) continue;
        const std::string_view variant = std::string_view(place.path).substr(known.name.size());
        const PositionValue matrix = builder_.built_in(known.matrix);
        if (variant.empty()) return matrix;
        if (variant == "Transpose") return PositionBuilder::transpose(matrix);
        if (variant == "Inverse") return builder_.inverse(matrix);
        if (variant == "InverseTranspose") return PositionBuilder::transpose(builder_.inverse(matrix));
    }
    return because(WhyUnknown::other_state);
}

// ---- writing ----

void ShaderVariables::erase_parts(const std::string& whole) {
    const std::string begin = whole + ".";
    auto at = values_.lower_bound(begin);
    while (at != values_.end() && at->first.starts_with(begin)) at = values_.erase(at);
}

void ShaderVariables::forget(Place place) {
    place.clear = false;
    write(place, {});
}

void ShaderVariables::write(const Place& place, const PositionValue& value) {
    if (place.type->isStruct() || place.type->isArray()) erase_parts(place.variable);
    if (!is_plain_float(*place.type)) return;
    if (const auto varying = HandedOn::of(place, glslang::EvqVaryingOut)) handed_on_[*varying] = place.variable;
    PositionValue whole = unknown_of(*place.type, WhyUnknown::depends_on_flow);
    if (place.clear) {
        const auto found = values_.find(place.variable);
        const bool known = found != values_.end() && found->second.same_shape(whole);
        whole = known ? found->second : unknown_of(*place.type, WhyUnknown::not_written);
        const PositionValue::Component unknown{-1, static_cast<std::uint8_t>(WhyUnknown::not_a_float)};
        for (unsigned i = 0; i < place.components.size(); ++i)
            whole[place.components[i]] = i < value.size() ? value[i] : unknown;
    }
    values_[place.variable] = whole;
}

PositionValue ShaderVariables::merged(const PositionValue& a, const PositionValue& b) {
    if (!a.same_shape(b)) return {};
    PositionValue out = a;
    for (unsigned i = 0; i < out.size(); ++i)
        if (!(a[i] == b[i])) out[i] = {-1, static_cast<std::uint8_t>(WhyUnknown::depends_on_flow)};
    return out;
}

void ShaderVariables::merge(const Values& other) {
    for (auto& [name, value] : values_) {
        const auto found = other.find(name);
        value = found == other.end() ? PositionValue() : merged(found->second, value);
    }
    for (const auto& [name, value] : other) values_.try_emplace(name);
}

}  // namespace wall::tileserver
