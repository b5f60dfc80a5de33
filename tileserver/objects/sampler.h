// SPDX-License-Identifier: MIT
// A sampler of a session: how textures of the units that have it are looked up. Render thread.
#pragma once

#include "tileserver/driver/driver.h"
#include "tileserver/objects/object.h"

namespace wall::tileserver {

class Sampler final : public ObjectOf<ObjectKind::sampler> {
public:
    Sampler(ObjectAccount& account, Driver& driver) : ObjectOf(account), driver_(driver) {
        driver_.gl().CreateSamplers(1, &name_);
    }
    ~Sampler() override { driver_.delete_sampler(name_); }

    GLuint name() const { return name_; }  ///< the driver's; the same for life

private:
    Driver& driver_;
    GLuint name_ = 0;
};

}  // namespace wall::tileserver
