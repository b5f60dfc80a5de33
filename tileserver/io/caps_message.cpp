// SPDX-License-Identifier: MIT
#include "tileserver/io/caps_message.h"

namespace wall::tileserver {

void fill_caps(const GlCaps& caps, proto::GlCaps& out) {
    out.set_vendor(caps.vendor);
    out.set_renderer(caps.renderer);
    out.set_version(caps.version);
    out.set_shading_language_version(caps.shading_language_version);
    out.set_extensions(caps.extensions);
    for (const auto& limit : caps.limits) {
        auto& row = *out.add_limits();
        row.set_name(limit.name);
        for (const double value : limit.values) row.add_values(value);
    }
}

}  // namespace wall::tileserver
