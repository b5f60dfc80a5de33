// SPDX-License-Identifier: MIT
// A GLSL program of a session in the driver: the client's locations of uniforms -> the driver's. Render thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/glapi/position_program.h"
#include "common/glapi/program_format.h"
#include "common/glstate/projection.h"
#include "tileserver/driver/driver.h"
#include "tileserver/driver/layer.h"
#include "tileserver/objects/object.h"

namespace wall::tileserver {

class Program final : public ObjectOf<ObjectKind::program> {
public:
    /// One that has not been linked.
    Program(ObjectAccount& account, Driver& driver) : ObjectOf(account), driver_(driver) {}
    ~Program() override { release(); }

    /// Links a definition, and takes the result's place if that works. The encoded ProgramReflection if `reflect`, in
    /// it the position as it was `recognised`; null: it is recognised here. An error: bad bytes, or more memory than a
    /// session may have.
    Result<std::vector<std::byte>> link(std::span<const std::byte> definition, bool reflect,
                                        const glapi::ProgramReflection* recognised = nullptr);
    Result<void> set_uniform(std::uint32_t location, GLenum type, std::uint32_t count,
                             std::span<const std::byte> values);
    /// From now on a block takes its uniforms from what is bound there. An error: no such block, no such place.
    Result<void> bind_block(std::uint32_t block, std::uint32_t binding);
    /// The same of a block of storage.
    Result<void> bind_storage_block(std::uint32_t block, std::uint32_t binding);
    /// Which functions the variables of a stage name from now on: u32 for each location. An error: no such stage, or
    /// not as many as it has locations.
    Result<void> set_subroutines(GLenum stage, std::span<const std::byte> indices);
    /// How it places its vertices; nothing: that is not known.
    std::optional<glstate::Projection> project(const glstate::Projection& fixed_function, const glstate::State& state);
    /// The driver draws with it, in this layer.
    void use(const LayerGeometry& layer) {
        driver_.use_program(name_, attributes_);
        prepare(layer);
    }
    /// The same where it is one of several that the driver draws with.
    void prepare(const LayerGeometry& layer);
    GLuint name() const { return name_; }  ///< the driver's; 0: it was never linked

    /// Where each of the blocks that are active here takes its uniforms from (glstate::el::uniform_buffer).
    const std::vector<std::uint32_t>& block_bindings() const { return block_bindings_; }

    /// Where each of its blocks of storage lies (glstate::el::storage_buffer), and its atomic counters do.
    const std::vector<std::uint32_t>& storage_bindings() const { return storage_bindings_; }
    const std::vector<std::uint32_t>& counter_bindings() const { return counter_bindings_; }
    bool has_images() const { return has_images_; }
    /// The generic vertex attributes that it reads, a bit each.
    std::uint32_t attributes() const { return attributes_; }
    /// It reads or writes memory at places that it addresses.
    bool touches_memory() const { return has_images_ || !storage_bindings_.empty() || !counter_bindings_.empty(); }
    /// What it draws depends on each triangle and its vertices alone, not on how many came before.
    bool draws_in_any_order() const { return in_any_order_ && !touches_memory(); }
    /// How many run in a group of its compute shader; 0: it has none.
    std::uint64_t group_invocations() const { return group_invocations_; }

private:
    std::vector<GLint> map_locations(GLuint program, const std::vector<glapi::UniformName>& names) const;
    void follow_position(glapi::PositionProgram position, const std::vector<glapi::UniformName>& names);
    void find_blocks(const std::vector<std::string>& names);
    void find_storage_blocks(const std::vector<std::string>& names);
    void find_counters();
    void find_images();
    void find_attributes();
    void find_group();
    void find_subroutines();
    void look(const std::optional<geom::EyeView>& view);
    void release();

    Driver& driver_;
    GLuint name_ = 0;               // the driver's; 0: fixed function
    std::vector<GLint> locations_;  // by the client's location; -1: not active here
    std::vector<GLuint> blocks_;    // by the client's index: the driver's; GL_INVALID_INDEX: not active here
    std::vector<std::uint32_t> block_bindings_;                       // by the driver's
    std::vector<GLuint> storage_blocks_;                              // as blocks_
    std::vector<std::uint32_t> storage_bindings_, counter_bindings_;  // by the driver's index
    bool has_images_ = false, computes_ = false, in_any_order_ = false;
    std::uint32_t attributes_ = 0;
    std::uint64_t group_invocations_ = 0;
    /// Functions by the locations of a stage that has such variables.
    struct Subroutines {
        GLenum stage = 0;
        std::size_t locations = 0;
        std::vector<GLuint> indices;  // empty: as the driver chooses
    };
    std::vector<Subroutines> subroutines_;
    GLint window_ = -1;  // location of kWindowUniform
    bool upper_left_ = false, whole_centers_ = false;
    std::array<float, 4> window_value_{};
    std::optional<geom::EyeView> view_;  // that the driver's matrices are for
    bool camera_changed_ = false;        // since then
    glapi::LinkedPosition position_;
};

}  // namespace wall::tileserver
