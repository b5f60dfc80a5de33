// SPDX-License-Identifier: MIT
// Shaders and programs as the application defined them, and what linking told about them. A node compiles and links;
// one of them is asked, once for each glCompileShader and glLinkProgram whose outcome matters, and everything else
// (locations, types, uniform values) is answered from here. Uniforms are this program's own state: every value has a
// stamp, and a node is sent what changed since it last drew with the program (DESIGN, section 1).
// Guarded by the share group's mutex.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "client_lib/objects/object.h"
#include "common/glapi/position_program.h"
#include "common/glapi/program_format.h"
#include "common/wire/pack_buffer.h"

namespace wall::client {

/// Shaders and programs share one space of names (OpenGL 2.1, 2.15.1).
struct GlslObject : Object {
    enum class Kind : std::uint8_t { shader, program };
    GlslObject(Kind own_kind, ClientName own_id, GLuint own_name) : Object(own_id, own_name), kind(own_kind) {}
    const Kind kind;
    bool deleted = false;  ///< by glDelete*, while something still uses it
    unsigned users = 0;    ///< programs that have the shader; contexts that draw with the program
};

struct Shader : GlslObject {
    Shader(ClientName own_id, GLuint own_name, GLenum own_type)
        : GlslObject(Kind::shader, own_id, own_name), type(own_type) {}
    // No node holds it for itself: a program that is linked brings its shaders along.
    std::uint64_t latest() const override { return 0; }
    void pack_changes(std::uint64_t, wire::PackBuffer&, const std::function<void()>&) const override {}
    const GLenum type;
    std::string source;
    enum class State : std::uint8_t { not_compiled, unknown, compiled, failed };
    State state = State::not_compiled;  ///< unknown: nobody has asked yet how it went
    std::string compiled_source;        ///< as of the last glCompileShader
    std::string log;
};

/// One active uniform. Its elements have the locations `location` ... `location + size - 1`.
struct Uniform {
    std::string name;  ///< without "[0]"
    const glapi::UniformType* type = nullptr;
    GLint size = 1;
    GLint location = -1;  ///< -1: built into GLSL, or in a block
    bool array = false;
    GLint counter_buffer = -1;  ///< of an atomic counter: index in Executable::counter_buffers
    glapi::BlockPlace place = {};
    std::uint32_t stages = 0;  ///< that it is active in, a bit for each of glapi::kShaderStages
    std::size_t first = 0;     ///< of its words in Executable::words
    std::uint64_t stamp = 0;   ///< of the latest change; 0: as the shader says
    std::string full_name() const { return array ? name + "[0]" : name; }
};

struct UniformPlace {
    static constexpr std::uint32_t kNone = ~0u;
    std::uint32_t uniform = kNone;  ///< index in Executable::uniforms; kNone: there is none at this location
    std::uint32_t element = 0;
};

/// A block of uniforms, which takes their values from a part of a buffer.
struct UniformBlock : glapi::ActiveBlock {
    std::uint64_t stamp = 0;  ///< of the latest glUniformBlockBinding; 0: as the shader says
};

/// A block of variables in a part of a buffer that shaders may write.
struct StorageBlock : glapi::ActiveStorageBlock {
    std::uint64_t stamp = 0;  ///< of the latest glShaderStorageBlockBinding; 0: as the shader says
};

struct Program;

/// Functions that variables name, of one stage.
struct Subroutines : glapi::SubroutineStage {
    std::vector<std::uint32_t> chosen;  ///< by location: the function's index
    std::uint64_t stamp = 0;            ///< of the latest change; 0: as when a program comes into use
};

/// A program that was linked, with its uniforms' values.
class Executable {
public:
    /// Nothing if the answer contradicts itself.
    static std::unique_ptr<Executable> make(glapi::ProgramDefinition definition, glapi::ProgramReflection reflection);

    /// Location of "name", "name[3]"; -1: no such uniform.
    GLint location_of(std::string_view name) const;
    GLint attribute_location_of(std::string_view name) const;
    /// The same of taken().
    GLint input_location_of(std::string_view name) const;
    /// Index of a uniform ("name" or "name[0]") or block; nothing: there is no such one.
    std::optional<GLuint> uniform_index_of(std::string_view name) const;
    std::optional<GLuint> block_index_of(std::string_view name) const;
    /// What the last stage gives away by that name ("name", "name[3]"); null: there is no such one. `element` is added
    /// to its location.
    const glapi::ActiveOutput* output_of(std::string_view name, GLint& element) const;
    /// Null: no such location.
    const UniformPlace* place_of(GLint location) const;
    /// Whether a shader gives the location to a uniform that is not active: setting it does nothing.
    bool ignores(GLint location) const;
    /// What the first stage takes: vertex attributes or, where the program has no vertex shader, another stage's
    /// inputs.
    const std::vector<glapi::ActiveAttribute>& taken() const { return inputs.empty() ? attributes : inputs; }

    /// False if these are the values that it has. `words` is a whole number of elements, from element `first` on.
    bool holds(const Uniform& uniform, std::uint32_t first, std::span<const std::uint32_t> words) const;
    void store(Uniform& uniform, std::uint32_t first, std::span<const std::uint32_t> words);
    std::span<const std::uint32_t> words_of(const Uniform& uniform) const;

    /// The block takes its uniforms from another place from now on.
    void bind_block(UniformBlock& block, std::uint32_t binding);
    void bind_block(StorageBlock& block, std::uint32_t binding);
    /// Null: that stage has none.
    Subroutines* subroutines_of(GLenum stage);
    void choose(Subroutines& stage, std::span<const std::uint32_t> indices);
    /// All as when a program comes into use: the first function that may be named.
    void reset_subroutines();
    /// Whether it counts vertices or primitives by itself (gl_VertexID, gl_PrimitiveID), so that they must be drawn
    /// with their own numbers.
    bool reads_numbers() const { return reads_numbers_; }
    /// The generic attributes that its vertex shader takes as doubles, a bit for each.
    std::uint32_t double_attributes() const { return double_attributes_; }
    /// The location of the attribute that the position is a function of; -1: that is not known. 0 is also gl_Vertex.
    GLint position_attribute() const { return position_attribute_; }
    /// How the position is made of it.
    glapi::LinkedPosition& position() { return position_; }
    /// A sampler that the program looks up at one place only, which is a function of an attribute; of one program, not
    /// of several.
    struct Lookup {
        std::size_t uniform;  ///< the sampler: index in `uniforms`
        glapi::LinkedPosition coordinates;
    };
    std::vector<Lookup>& lookups() { return lookups_; }

    /// Texture units that the samplers name, with the texture target of each.
    template <class Use>
    void for_each_sampler(Use&& use) const {
        for_each_part([&](const Executable& part) {
            for (const Uniform& uniform : part.uniforms)
                if (uniform.type->base == glapi::UniformBase::sampler)
                    for (const std::uint32_t unit : part.words_of(uniform)) use(unit, uniform.type->texture_target);
        });
    }

    /// Image units that it names.
    template <class Use>
    void for_each_image_unit(Use&& use) const {
        for_each_part([&](const Executable& part) {
            for (const Uniform& uniform : part.uniforms)
                if (uniform.type->base == glapi::UniformBase::image)
                    for (const std::uint32_t unit : part.words_of(uniform)) use(unit);
        });
    }
    /// Whether it reads or writes memory at places that it addresses.
    bool touches_memory() const;
    /// It has a compute shader.
    bool computes() const { return group_size[0] != 0; }

    /// Whether drawing takes values from buffers, by blocks of uniforms or by textures.
    bool reads_buffers() const;
    /// Samplers of different targets name one unit: nothing may be drawn (OpenGL 2.1, 2.15.4).
    bool samplers_conflict() const { return parts.empty() ? samplers_conflict_ : parts_conflict(); }

    // ---- of several programs that are drawn with together (program_pipeline.h) ----
    /// One made of them, a stage or more each; it has no uniforms and no blocks of its own.
    static std::unique_ptr<Executable> combine(const std::vector<std::shared_ptr<Program>>& parts);
    /// Calls `use(executable)` with itself, or with each of its parts.
    template <class Use>
    void for_each_part(Use&& use) const {
        if (parts.empty()) return use(*this);
        for_each_combined(use);
    }
    std::vector<std::shared_ptr<Program>> parts;
    std::uint32_t stages = 0;         ///< that it has, a bit for each of glapi::kShaderStages
    std::uint32_t blend_support = 0;  ///< of its fragment shader (blend_support.h)

    std::uint64_t stamp = 0;        ///< of linking
    std::uint64_t last_change = 0;  ///< of a uniform, or `stamp`
    std::vector<std::byte> definition;
    std::vector<Uniform> uniforms;
    std::vector<UniformBlock> blocks;
    std::vector<StorageBlock> storage_blocks;
    std::vector<glapi::ActiveCounterBuffer> counter_buffers;
    std::array<std::uint32_t, 3> group_size{};       ///< of the compute shader; 0 throughout: there is none
    std::vector<glapi::ActiveAttribute> attributes;  ///< of vertices
    std::vector<glapi::ActiveAttribute> inputs;      ///< of the first stage, where that is another one
    std::vector<glapi::ActiveOutput> outputs;        ///< of the last stage
    std::vector<glapi::BufferVariable> buffer_variables;
    std::vector<glapi::CapturedVarying> captured;  ///< by transform feedback
    std::vector<glapi::CaptureBuffer> capture_buffers;
    GLenum capture_mode = GL_INTERLEAVED_ATTRIBS;
    glapi::GeometryStage geometry;
    glapi::TessellationStage tessellation;
    std::vector<Subroutines> subroutines;  ///< of the stages that have any

private:
    void check_samplers();
    bool parts_conflict() const;
    /// Whether the program has set that word of a sampler. Which elements of an array its shaders read is not known
    /// here; those that it never set are taken for unused, as drivers find them to be.
    bool was_given(std::size_t word) const { return word < given_.size() && given_[word]; }
    void for_each_combined(const std::function<void(const Executable&)>& use) const;
    /// A program for positions or coordinates with the values that the uniforms have; nothing: it takes a uniform that
    /// is not active.
    std::optional<glapi::LinkedPosition> link(glapi::PositionProgram position) const;
    void follow_position(glapi::PositionProgram position);
    void follow_lookups(std::vector<glapi::TextureLookup> lookups);

    std::vector<std::uint32_t> words_;
    std::vector<bool> given_;  ///< which of them are samplers that the program has set; shorter: the rest are not
    std::vector<UniformPlace> places_;  ///< by location
    std::vector<std::uint32_t> unused_locations_;
    bool samplers_conflict_ = false;
    bool samples_buffers_ = false, has_images_ = false;
    bool reads_numbers_ = false;
    std::uint32_t double_attributes_ = 0;
    glapi::LinkedPosition position_;
    GLint position_attribute_ = -1;
    std::vector<Lookup> lookups_;
};

struct Program : GlslObject {
    Program(ClientName own_id, GLuint own_name) : GlslObject(Kind::program, own_id, own_name) {}
    std::vector<std::shared_ptr<Shader>> shaders;
    std::map<std::string, GLuint> attribute_bindings;
    std::vector<glapi::OutputBinding> output_bindings;
    glapi::FeedbackDefinition feedback;
    std::optional<glapi::ProgramDefinition> to_link;  ///< glLinkProgram was called, nobody has asked yet how it went
    bool separable = false;                           ///< GL_PROGRAM_SEPARABLE, for the next glLinkProgram
    bool linked_separable = false;                    ///< the same as of the last one that succeeded
    bool linked = false;                              ///< GL_LINK_STATUS
    bool validated = false;                           ///< GL_VALIDATE_STATUS
    /// GL_PROGRAM_BINARY_RETRIEVABLE_HINT, of which nothing follows: as told for the next linking, and by the last one.
    bool next_binary_hint = false, binary_hint = false;
    std::string log;
    /// Of the last glLinkProgram that succeeded.
    std::unique_ptr<Executable> executable;

    glapi::ProgramDefinition definition() const;

    std::uint64_t latest() const override { return executable ? executable->last_change : 0; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;
    std::uint64_t defined() const override { return executable ? executable->stamp : 0; }
    void pack_values(std::uint64_t known, wire::PackBuffer& buffer) const override;
};

}  // namespace wall::client
