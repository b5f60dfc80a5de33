// SPDX-License-Identifier: MIT
#include "common/glapi/program_format.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/glapi/format_stream.h"

namespace wall::glapi {
namespace {

class Writer : public FormatWriter {
public:
    using FormatWriter::put;

    void put(const FeedbackDefinition& feedback) {
        put(feedback.mode);
        list(feedback.names, [&](const std::string& name) { put(name); });
    }
    void put(const BlockPlace& place) {
        for (const std::int32_t value : {place.block, place.offset, place.array_stride, place.matrix_stride})
            put(value);
        put(place.row_major);
    }
    void put(const BufferVariable& variable) {
        put(variable.type);
        put(variable.size);
        put(variable.array);
        put(variable.name);
        put(variable.place);
        put(variable.top_size);
        put(variable.top_stride);
        put(variable.stages);
    }
    void put(const GeometryStage& stage) {
        for (const std::uint32_t value : {stage.input, stage.output, stage.vertices, stage.invocations}) put(value);
    }
    void put(const TessellationStage& stage) {
        for (const std::uint32_t value : {stage.vertices, stage.mode, stage.spacing, stage.order, stage.point_mode})
            put(value);
    }
    void put(const SubroutineUniform& uniform) {
        put(uniform.name);
        put(uniform.size);
        put(uniform.array);
        put(uniform.location);
        put(uniform.compatible);
    }
    void put(const SubroutineStage& stage) {
        put(stage.stage);
        list(stage.functions, [&](const std::string& name) { put(name); });
        list(stage.uniforms, [&](const SubroutineUniform& uniform) { put(uniform); });
        put(stage.locations);
        put(stage.indices);
    }
};

class Reader : public FormatReader {
public:
    using FormatReader::FormatReader;

    FeedbackDefinition feedback() {
        FeedbackDefinition out{word(), {}};
        list(out.names, [&] { return text(); });
        return out;
    }
    BlockPlace place() { return {number(), number(), number(), number(), flag()}; }
    GeometryStage geometry() { return {word(), word(), word(), word()}; }
    TessellationStage tessellation() { return {word(), word(), word(), word(), word()}; }
    SubroutineStage subroutine_stage() {
        SubroutineStage out{word(), {}, {}, 0, {}};
        list(out.functions, [&] { return text(); });
        list(out.uniforms, [&] { return SubroutineUniform{text(), word(), flag(), number(), words()}; });
        out.locations = word();
        out.indices = words();
        if (!out.indices.empty() && out.indices.size() != out.functions.size()) fail();
        return out;
    }
};

constexpr auto kReal = UniformBase::real;
constexpr auto kInteger = UniformBase::integer;
constexpr auto kUnsigned = UniformBase::unsigned_integer;
constexpr auto kBoolean = UniformBase::boolean;
constexpr auto kSampler = UniformBase::sampler;
constexpr auto kDouble = UniformBase::double_real;

constexpr auto kNumberTypes = std::to_array<UniformType>({
    {GL_FLOAT, kReal, 1, 1, {}},
    {GL_FLOAT_VEC2, kReal, 1, 2, {}},
    {GL_FLOAT_VEC3, kReal, 1, 3, {}},
    {GL_FLOAT_VEC4, kReal, 1, 4, {}},
    {GL_INT, kInteger, 1, 1, {}},
    {GL_INT_VEC2, kInteger, 1, 2, {}},
    {GL_INT_VEC3, kInteger, 1, 3, {}},
    {GL_INT_VEC4, kInteger, 1, 4, {}},
    {GL_UNSIGNED_INT, kUnsigned, 1, 1, {}},
    {GL_UNSIGNED_INT_VEC2, kUnsigned, 1, 2, {}},
    {GL_UNSIGNED_INT_VEC3, kUnsigned, 1, 3, {}},
    {GL_UNSIGNED_INT_VEC4, kUnsigned, 1, 4, {}},
    {GL_BOOL, kBoolean, 1, 1, {}},
    {GL_BOOL_VEC2, kBoolean, 1, 2, {}},
    {GL_BOOL_VEC3, kBoolean, 1, 3, {}},
    {GL_BOOL_VEC4, kBoolean, 1, 4, {}},
    {GL_FLOAT_MAT2, kReal, 2, 2, {}},
    {GL_FLOAT_MAT3, kReal, 3, 3, {}},
    {GL_FLOAT_MAT4, kReal, 4, 4, {}},
    {GL_FLOAT_MAT2x3, kReal, 2, 3, {}},
    {GL_FLOAT_MAT2x4, kReal, 2, 4, {}},
    {GL_FLOAT_MAT3x2, kReal, 3, 2, {}},
    {GL_FLOAT_MAT3x4, kReal, 3, 4, {}},
    {GL_FLOAT_MAT4x2, kReal, 4, 2, {}},
    {GL_FLOAT_MAT4x3, kReal, 4, 3, {}},
    {GL_DOUBLE, kDouble, 1, 1, {}},
    {GL_DOUBLE_VEC2, kDouble, 1, 2, {}},
    {GL_DOUBLE_VEC3, kDouble, 1, 3, {}},
    {GL_DOUBLE_VEC4, kDouble, 1, 4, {}},
    {GL_DOUBLE_MAT2, kDouble, 2, 2, {}},
    {GL_DOUBLE_MAT3, kDouble, 3, 3, {}},
    {GL_DOUBLE_MAT4, kDouble, 4, 4, {}},
    {GL_DOUBLE_MAT2x3, kDouble, 2, 3, {}},
    {GL_DOUBLE_MAT2x4, kDouble, 2, 4, {}},
    {GL_DOUBLE_MAT3x2, kDouble, 3, 2, {}},
    {GL_DOUBLE_MAT3x4, kDouble, 3, 4, {}},
    {GL_DOUBLE_MAT4x2, kDouble, 4, 2, {}},
    {GL_DOUBLE_MAT4x3, kDouble, 4, 3, {}},
});

constexpr auto kUniformTypes = [] {
    std::array<UniformType, kNumberTypes.size() + kSamplerTypes.size() + kImageTypes.size() + 1> all{};
    const auto as = [](UniformBase base) {
        return [base](const SamplerType& s) { return UniformType{s.type, base, 1, 1, s.target}; };
    };
    auto next = std::ranges::copy(kNumberTypes, all.begin()).out;
    next = std::ranges::transform(kSamplerTypes, next, as(kSampler)).out;
    next = std::ranges::transform(kImageTypes, next, as(UniformBase::image)).out;
    *next = {GL_UNSIGNED_INT_ATOMIC_COUNTER, UniformBase::counter, 1, 1, {}};
    return all;
}();

}  // namespace

std::vector<std::byte> encode(const ProgramDefinition& definition) {
    Writer to;
    to.list(definition.shaders, [&](const ShaderSource& s) { to.put(s.type), to.put(s.compiled), to.put(s.source); });
    to.list(definition.attributes, [&](const AttributeBinding& a) { to.put(a.index), to.put(a.name); });
    to.list(definition.uniforms, [&](const UniformName& u) { to.put(u.size), to.put(u.name), to.put(u.location); });
    to.list(definition.blocks, [&](const std::string& name) { to.put(name); });
    to.list(definition.outputs, [&](const OutputBinding& o) { to.put(o.color), to.put(o.index), to.put(o.name); });
    to.put(definition.feedback);
    to.put(definition.position);
    to.put(definition.separable);
    to.list(definition.storage_blocks, [&](const std::string& name) { to.put(name); });
    to.list(definition.cameras, [&](const std::string& name) { to.put(name); });
    return std::move(to.out);
}

std::optional<ProgramDefinition> decode_definition(std::span<const std::byte> bytes) {
    Reader from(bytes);
    ProgramDefinition out;
    from.list(out.shaders, [&] { return ShaderSource{from.word(), from.flag(), from.text()}; });
    from.list(out.attributes, [&] { return AttributeBinding{from.word(), from.text()}; });
    from.list(out.uniforms, [&] { return UniformName{from.word(), from.text(), from.word()}; });
    from.list(out.blocks, [&] { return from.text(); });
    from.list(out.outputs, [&] { return OutputBinding{from.word(), from.word(), from.text()}; });
    out.feedback = from.feedback();
    out.position = from.position();
    out.separable = from.flag();
    from.list(out.storage_blocks, [&] { return from.text(); });
    from.list(out.cameras, [&] { return from.text(); });
    return if_complete(from, std::move(out));
}

std::vector<std::byte> encode(const ProgramReflection& reflection) {
    Writer to;
    to.put(reflection.linked);
    to.put(reflection.log);
    to.list(reflection.uniforms, [&](const ActiveUniform& u) {
        to.put(u.type), to.put(u.size), to.put(u.built_in), to.put(u.array), to.put(u.name), to.put(u.initial),
            to.put(u.place), to.put(u.counter_buffer), to.put(u.location), to.put(u.stages);
    });
    to.list(reflection.attributes, [&](const ActiveAttribute& a) {
        to.put(a.type), to.put(a.size), to.put(a.location), to.put(a.name), to.put(a.stages), to.put(a.patch),
            to.put(a.component);
    });
    to.list(reflection.blocks,
            [&](const ActiveBlock& b) { to.put(b.name), to.put(b.bytes), to.put(b.binding), to.put(b.stages); });
    to.list(reflection.outputs, [&](const ActiveOutput& o) {
        to.put(o.location), to.put(o.index), to.put(o.size), to.put(o.array), to.put(o.name), to.put(o.type),
            to.put(o.stages), to.put(o.patch), to.put(o.component);
    });
    to.list(reflection.captured, [&](const CapturedVarying& v) {
        to.put(v.type), to.put(v.size), to.put(v.name), to.put(v.offset), to.put(v.buffer);
    });
    to.put(reflection.geometry);
    to.put(reflection.tessellation);
    to.list(reflection.subroutines, [&](const SubroutineStage& stage) { to.put(stage); });
    to.put(reflection.position);
    to.list(reflection.lookups, [&](const TextureLookup& l) { to.put(l.sampler), to.put(l.coordinates); });
    to.list(reflection.storage_blocks, [&](const ActiveStorageBlock& b) {
        to.put(b.name), to.put(b.bytes), to.put(b.binding), to.put(b.stages), to.put(b.written);
    });
    to.list(reflection.counter_buffers,
            [&](const ActiveCounterBuffer& b) { to.put(b.binding), to.put(b.bytes), to.put(b.stages); });
    for (const std::uint32_t size : reflection.group_size) to.put(size);
    to.list(reflection.buffer_variables, [&](const BufferVariable& v) { to.put(v); });
    to.list(reflection.capture_buffers, [&](const CaptureBuffer& b) { to.put(b.binding), to.put(b.stride); });
    to.put(reflection.unused_locations);
    return std::move(to.out);
}

std::optional<ProgramReflection> decode_reflection(std::span<const std::byte> bytes) {
    Reader from(bytes);
    ProgramReflection out;
    out.linked = from.flag();
    out.log = from.text();
    from.list(out.uniforms, [&] {
        return ActiveUniform{from.word(),  from.word(),  from.flag(),   from.flag(),   from.text(),
                             from.words(), from.place(), from.number(), from.number(), from.word()};
    });
    from.list(out.attributes, [&] {
        return ActiveAttribute{from.word(), from.word(), from.number(), from.text(),
                               from.word(), from.flag(), from.word()};
    });
    from.list(out.blocks, [&] { return ActiveBlock{from.text(), from.word(), from.word(), from.word()}; });
    from.list(out.outputs, [&] {
        return ActiveOutput{from.number(), from.number(), from.word(), from.flag(), from.text(),
                            from.word(),   from.word(),   from.flag(), from.word()};
    });
    from.list(out.captured, [&] {
        return CapturedVarying{from.word(), from.word(), from.text(), from.word(), from.number()};
    });
    out.geometry = from.geometry();
    out.tessellation = from.tessellation();
    from.list(out.subroutines, [&] { return from.subroutine_stage(); });
    out.position = from.position();
    from.list(out.lookups, [&] { return TextureLookup{from.text(), from.position()}; });
    from.list(out.storage_blocks, [&] {
        return ActiveStorageBlock{{from.text(), from.word(), from.word(), from.word()}, from.flag()};
    });
    from.list(out.counter_buffers, [&] { return ActiveCounterBuffer{from.word(), from.word(), from.word()}; });
    for (std::uint32_t& size : out.group_size) size = from.word();
    from.list(out.buffer_variables, [&] {
        return BufferVariable{from.word(),  from.word(), from.flag(), from.text(),
                              from.place(), from.word(), from.word(), from.word()};
    });
    from.list(out.capture_buffers, [&] { return CaptureBuffer{from.word(), from.word()}; });
    out.unused_locations = from.words();
    return if_complete(from, std::move(out));
}

std::optional<std::vector<UniformName>> number_uniforms(const std::vector<ActiveUniform>& uniforms) {
    std::vector<UniformName> out;
    std::vector<bool> taken;
    const auto take = [&](std::uint64_t location, std::uint64_t size) {
        if (location + size > kMostUniformLocations) return false;
        taken.resize(std::max<std::size_t>(taken.size(), location + size));
        for (std::uint64_t at = location; at < location + size; ++at) {
            if (taken[at]) return false;
            taken[at] = true;
        }
        return true;
    };
    const auto has_one = [](const ActiveUniform& u) { return u.has_location() && u.location >= 0; };
    for (const ActiveUniform& u : uniforms)
        if (has_one(u) && !take(static_cast<std::uint64_t>(u.location), u.size)) return std::nullopt;
    for (const ActiveUniform& u : uniforms) {
        if (!u.has_location()) continue;
        const std::size_t location = u.location >= 0 ? static_cast<std::size_t>(u.location) : taken.size();
        if (u.location < 0 && !take(location, u.size)) return std::nullopt;
        out.push_back({u.size, u.name, static_cast<std::uint32_t>(location)});
    }
    return out;
}

std::vector<std::byte> encode(const CompileResult& result) {
    Writer to;
    to.put(result.compiled);
    to.put(result.log);
    return std::move(to.out);
}

std::optional<CompileResult> decode_compile_result(std::span<const std::byte> bytes) {
    Reader from(bytes);
    CompileResult out{from.flag(), from.text()};
    return if_complete(from, std::move(out));
}

const UniformType* find_uniform_type(GLenum type) {
    const auto* found = std::find_if(std::begin(kUniformTypes), std::end(kUniformTypes),
                                     [type](const UniformType& t) { return t.type == type; });
    return found == std::end(kUniformTypes) ? nullptr : found;
}

}  // namespace wall::glapi
