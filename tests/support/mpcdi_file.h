// SPDX-License-Identifier: MIT
// Writes MPCDI files for tests.
#pragma once

#include <zip.h>

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "walld/mpcdi/maps.h"

namespace wall::test {

struct MpcdiEntry {
    std::string name, content;
};

/// A ZIP archive, deflated.
inline std::string zip_of(const std::vector<MpcdiEntry>& entries) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* memory = zip_source_buffer_create(nullptr, 0, 0, &error);
    zip_source_keep(memory);
    zip_t* archive = zip_open_from_source(memory, ZIP_TRUNCATE, &error);
    for (const auto& [name, content] : entries)
        zip_file_add(archive, name.c_str(), zip_source_buffer(archive, content.data(), content.size(), 0), 0);
    zip_close(archive);
    zip_source_open(memory);
    zip_source_seek(memory, 0, SEEK_END);
    std::string out(static_cast<std::size_t>(zip_source_tell(memory)), '\0');
    zip_source_seek(memory, 0, SEEK_SET);
    zip_source_read(memory, out.data(), out.size());
    zip_source_close(memory);
    zip_source_free(memory);
    return out;
}

/// `place` gives the numbers of the place whose middle is at these fractions of the output.
inline mpcdi::Field field_of(std::uint32_t width, std::uint32_t height,
                             const std::function<mpcdi::Field::Value(double, double)>& place) {
    mpcdi::Field out{width, height, {}};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) out.values.push_back(place((x + 0.5) / width, (y + 0.5) / height));
    return out;
}

inline std::string pfm_of(const mpcdi::Field& field, bool big_endian = false) {
    std::string out = "PF\n" + std::to_string(field.width) + " " + std::to_string(field.height) + "\n" +
                      (big_endian ? "1.0" : "-1.0") + "\n";
    for (const auto& value : field.values)
        for (const float each : value) {
            std::uint32_t bits = 0;
            std::memcpy(&bits, &each, sizeof bits);
            if (big_endian) bits = __builtin_bswap32(bits);
            out.append(reinterpret_cast<const char*>(&bits), sizeof bits);
        }
    return out;
}

/// A description with one region "left" of a projector of 8x6 pixels.
struct MpcdiText {
    std::string profile = "2d", version = "1.0";
    std::string region =
        "<region id=\"left\" Xresolution=\"8\" Yresolution=\"6\" x=\"0\" y=\"0\" xsize=\"1\" ysize=\"1\">";
    std::string in_region;
    std::string files;
    std::string text() const {
        return "<?xml version=\"1.0\"?>\n<MPCDI profile=\"" + profile + "\" version=\"" + version +
               "\">\n<display>\n<buffer "
               "id=\"b\">\n" +
               region + "\n" + in_region + "\n</region>\n</buffer>\n</display>\n<files>\n" + files +
               "\n</files>\n</MPCDI>\n";
    }
};

inline const std::string kMpcdiFrustum =
    "<frustum><yaw>30</yaw><pitch>-10</pitch><roll>5</roll><rightAngle>20</rightAngle><leftAngle>-25</leftAngle>"
    "<upAngle>15</upAngle><downAngle>-12</downAngle></frustum>";

inline std::string mpcdi_fileset(const std::string& warp, const std::string& more = {},
                                 const std::string& unit = "mm") {
    return "<fileset region=\"left\"><geometryWarpFile><path>" + warp +
           "</path><interpolation>linear</interpolation>"
           "<geometricUnit>" +
           unit + "</geometricUnit></geometryWarpFile>" + more + "</fileset>";
}

}  // namespace wall::test
