// SPDX-License-Identifier: MIT
// Programs of a session that are drawn with together, each for some stages (OpenGL 4.1, 2.14.4). Which of the driver's
// they are is looked up when it is drawn with. Render thread.
#pragma once

#include <array>
#include <cstddef>
#include <iterator>

#include "common/glapi/program_format.h"
#include "tileserver/driver/driver.h"
#include "tileserver/driver/layer.h"
#include "tileserver/objects/object_table.h"
#include "tileserver/objects/program.h"

namespace wall::tileserver {

class Pipeline final : public ObjectOf<ObjectKind::pipeline> {
public:
    static constexpr std::size_t kStages = std::size(glapi::kShaderStages);

    Pipeline(ObjectAccount& account, Driver& driver);
    ~Pipeline() override;

    /// The session's programs, in the order of glapi::kShaderStages; 0: none.
    void define(const std::array<ClientName, kStages>& programs) { programs_ = programs; }
    /// The driver draws with it, in this layer. Calls `each(program)` with every program of it.
    template <class Each>
    void use(const ObjectTable& objects, const LayerGeometry& layer, Each&& each) {
        find_programs(objects);
        const auto program_of = [&](std::size_t i) {
            return programs_[i] ? objects.find<Program>(programs_[i]) : nullptr;
        };
        static_assert(glapi::kShaderStages[0] == GL_VERTEX_SHADER);
        const Program* vertices = program_of(0);
        driver_.use_pipeline(name_, vertices != nullptr ? vertices->attributes() : 0);
        for (std::size_t i = 0; i < kStages; ++i) {
            Program* program = program_of(i);
            if (program == nullptr) continue;
            program->prepare(layer);
            each(*program);
        }
    }

    /// Calls `each(program)` with every program of it.
    template <class Each>
    void for_each_program(const ObjectTable& objects, Each&& each) const {
        for (const ClientName name : programs_)
            if (const Program* program = name ? objects.find<Program>(name) : nullptr) each(*program);
    }

private:
    void find_programs(const ObjectTable& objects);

    Driver& driver_;
    GLuint name_ = 0;  // the driver's
    std::array<ClientName, kStages> programs_{};
    std::array<GLuint, kStages> in_driver_{};  // that the driver's has
};

}  // namespace wall::tileserver
