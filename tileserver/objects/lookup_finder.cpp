// SPDX-License-Identifier: MIT
#include "tileserver/objects/lookup_finder.h"

#include <map>
#include <optional>
#include <set>
#include <utility>

#include "tileserver/objects/shader_tree.h"

namespace wall::tileserver {
namespace {

constexpr std::size_t kMostFragmentBytes = 16 << 10;

class Finder : public glslang::TIntermTraverser {
public:
    explicit Finder(bool any_precision) : any_precision_(any_precision) {}

    bool visitAggregate(glslang::TVisit, glslang::TIntermAggregate* node) override {
        if (node->getOp() == glslang::EOpLinkerObjects) return false;
        if (node->getOp() == glslang::EOpTexture && node->getSequence().size() == 2)
            look_up(*node->getSequence()[0]->getAsTyped(), *node->getSequence()[1]->getAsTyped());
        return true;
    }
    bool visitUnary(glslang::TVisit, glslang::TIntermUnary* node) override {
        compares_ = compares_ || (node->getOp() >= glslang::EOpDPdx && node->getOp() <= glslang::EOpFwidthCoarse);
        return true;
    }
    void visitSymbol(glslang::TIntermSymbol* symbol) override {
        if (symbol->getBasicType() == glslang::EbtSampler) ++samplers_[symbol->getName().c_str()].all;
    }

    /// None of a shader that compares what neighbouring fragments have: those may lie where another node draws.
    std::vector<FoundLookup> found() const {
        std::vector<FoundLookup> out;
        for (const auto& [name, sampler] : samplers_)
            if (!compares_ && sampler.place && sampler.all == sampler.lookups) out.push_back({name, *sampler.place});
        return out;
    }
    std::set<std::string> used() const {
        std::set<std::string> out;
        for (const auto& [name, sampler] : samplers_) out.insert(name);
        return out;
    }

private:
    struct Uses {
        int all = 0, lookups = 0;  ///< these at `place`
        std::optional<HandedOn> place;
    };

    void look_up(glslang::TIntermTyped& from, glslang::TIntermTyped& at) {
        auto* const symbol = from.getAsSymbolNode();
        const auto place = place_of(at);
        if (symbol == nullptr || !place || !is_plain(symbol->getType())) return;
        Uses& sampler = samplers_[symbol->getName().c_str()];
        if (!sampler.place) sampler.place = place;
        if (sampler.place == place) ++sampler.lookups;
    }
    static bool is_plain(const glslang::TType& type) {
        if (type.isArray() || type.getBasicType() != glslang::EbtSampler) return false;
        const glslang::TSampler& sampler = type.getSampler();
        return sampler.dim == glslang::Esd2D && sampler.isCombined() && !sampler.isArrayed() && !sampler.isShadow() &&
               !sampler.isMultiSample() && !sampler.isExternal();
    }
    /// x and y of a variable of the stage before, as it is at a fragment's middle.
    std::optional<HandedOn> place_of(glslang::TIntermTyped& at) const {
        std::vector<glslang::TIntermBinary*> parts;
        glslang::TIntermTyped* node = &at;
        for (auto* part = node->getAsBinaryNode(); part != nullptr; part = node->getAsBinaryNode()) {
            if (!is_part(part->getOp()) || part->getOp() == glslang::EOpIndexIndirect) return std::nullopt;
            parts.push_back(part);
            node = part->getLeft();
        }
        if (node->getAsSymbolNode() == nullptr) return std::nullopt;
        Place place(*node->getAsSymbolNode());
        for (auto part = parts.rbegin(); part != parts.rend(); ++part) place.narrow(**part);
        const auto& qualifier = place.root->getType().getQualifier();
        const bool usual = !qualifier.flat && !qualifier.centroid && !qualifier.sample;
        const bool exact =
            any_precision_ || (!is_low_precision(place.root->getType()) && !is_low_precision(at.getType()));
        if (!usual || !exact || place.components != std::vector<unsigned>{0, 1}) return std::nullopt;
        return HandedOn::of(place, glslang::EvqVaryingIn);
    }

    const bool any_precision_;
    bool compares_ = false;
    std::map<std::string, Uses> samplers_;
};

}  // namespace

std::set<std::string> used_samplers(glslang::TIntermediate& shader) {
    Finder finder(shader.getProfile() != EEsProfile);
    if (shader.getTreeRoot() != nullptr) shader.getTreeRoot()->traverse(&finder);
    return finder.used();
}

std::vector<FoundLookup> find_lookups(const std::vector<const std::string*>& fragment_shaders) {
    std::size_t bytes = 0;
    for (const std::string* source : fragment_shaders) bytes += source->size();
    if (fragment_shaders.empty() || bytes > kMostFragmentBytes) return {};
    const ParsedShaders parsed(EShLangFragment, fragment_shaders);
    if (parsed.tree() == nullptr || parsed.tree()->getTreeRoot() == nullptr) return {};
    Finder finder(parsed.any_precision());
    parsed.tree()->getTreeRoot()->traverse(&finder);
    return finder.found();
}

}  // namespace wall::tileserver
