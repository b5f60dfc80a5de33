// SPDX-License-Identifier: MIT
#include "walld/mpcdi/setup.h"

#include <strings.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>
#include <set>
#include <utility>

namespace wall::mpcdi {
namespace {

using pugi::xml_node;

constexpr double kMostExtent = 16384;  // pixels
constexpr double kMostAngle = 89.5;    // of a frustum's edge from its middle
constexpr double kMostTurn = 360;
constexpr double kLeastGamma = 0.1, kMostGamma = 10;
constexpr double kAlmostUnit = 1e-2;  // what a unit vector's length may be off
constexpr std::array<std::pair<const char*, Profile>, 4> kProfiles{
    {{"2d", Profile::media}, {"3d", Profile::simulation}, {"a3", Profile::surface}, {"sl", Profile::lamps}}};
constexpr std::array<std::pair<const char*, double>, 8> kUnits{{{"mm", 0.001},
                                                                {"cm", 0.01},
                                                                {"dm", 0.1},
                                                                {"m", 1},
                                                                {"in", 0.0254},
                                                                {"ft", 0.3048},
                                                                {"yd", 0.9144},
                                                                {"unknown", 1}}};

bool same(const char* a, const char* b) { return ::strcasecmp(a, b) == 0; }

/// With a sticky first error, as TreeReader.
class Reader {
public:
    Reader(std::string_view xml, const std::string& name) : xml_(xml), name_(name) {}
    const std::optional<Error>& error() const { return error_; }

    void refuse(std::ptrdiff_t offset, const std::string& what) {
        if (error_) return;
        const auto until = xml_.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
        error_ = Error{name_ + ":" + std::to_string(1 + std::ranges::count(until, '\n')) + ": " + what};
    }
    void refuse(const xml_node& node, const std::string& what) { refuse(node.offset_debug(), what); }

    /// Files write Xresolution and xResolution, bitDepth and bitdepth.
    static const char* attribute(const xml_node& node, const char* name) {
        for (const auto& each : node.attributes())
            if (same(each.name(), name)) return each.value();
        return nullptr;
    }
    static xml_node child(const xml_node& node, const char* name) {
        for (const auto& each : node.children())
            if (same(each.name(), name)) return each;
        return {};
    }
    double number(const xml_node& of, const std::string& what, const char* text, double least, double most) {
        const std::string_view given = text != nullptr ? text : "";
        const auto begin = std::min(given.find_first_not_of(" \t\r\n+"), given.size());
        const auto end = given.find_last_not_of(" \t\r\n");
        const auto word = end == given.npos ? "" : given.substr(begin, end + 1 - begin);
        double out = least;
        const auto [rest, bad] = std::from_chars(word.data(), word.data() + word.size(), out);
        if (word.empty() || bad != std::errc() || rest != word.data() + word.size() || !(out >= least && out <= most)) {
            std::array<char, 64> range{};
            std::snprintf(range.data(), range.size(), "%g to %g", least, most);
            refuse(of, what + ": expected a number from " + range.data());
            return least;
        }
        return out;
    }
    double in_child(const xml_node& node, const char* name, double least, double most) {
        const auto found = child(node, name);
        const auto what = std::string("<") + name + "> of <" + node.name() + ">";
        if (!found) refuse(node, what + " is missing");
        return number(found ? found : node, what, found.child_value(), least, most);
    }

private:
    std::string_view xml_;
    std::string name_;
    std::optional<Error> error_;
};

std::string text_in(const xml_node& node, const char* name) {
    std::string out = Reader::child(node, name).child_value();
    out.erase(0, std::min(out.find_first_not_of(" \t\r\n"), out.size()));
    out.erase(out.find_last_not_of(" \t\r\n") + 1);
    return out;
}

Frustum read_frustum(Reader& read, const xml_node& node) {
    Frustum out;
    for (const auto& [name, value] : {std::pair("yaw", &out.yaw), {"pitch", &out.pitch}, {"roll", &out.roll}})
        *value = read.in_child(node, name, -kMostTurn, kMostTurn);
    for (const auto& [name, value] : {std::pair("leftAngle", &out.left),
                                      {"rightAngle", &out.right},
                                      {"downAngle", &out.down},
                                      {"upAngle", &out.up}})
        *value = read.in_child(node, name, -kMostAngle, kMostAngle);
    if (!read.error() && !(out.left < out.right && out.down < out.up))
        read.refuse(node,
                    "<frustum>: expected 'leftAngle' less than 'rightAngle', and 'downAngle' less than 'upAngle'");
    return out;
}

double dot(const geom::Vec3& a, const geom::Vec3& b) {
    return double{a[0]} * b[0] + double{a[1]} * b[1] + double{a[2]} * b[2];
}

Axes read_axes(Reader& read, const xml_node& node) {
    Axes out;
    for (const auto& [name, axis] : {std::pair("yaw", &out.yaw), {"pitch", &out.pitch}, {"roll", &out.roll}})
        for (std::size_t i = 0; i < 3; ++i)
            (*axis)[i] = static_cast<float>(read.in_child(node, (std::string(name) + "xyz"[i]).c_str(), -1, 1));
    const auto unit = [](const geom::Vec3& v) { return std::abs(dot(v, v) - 1) < kAlmostUnit; };
    const auto upright = [](const geom::Vec3& a, const geom::Vec3& b) { return std::abs(dot(a, b)) < kAlmostUnit; };
    if (!read.error() && !(unit(out.yaw) && unit(out.pitch) && unit(out.roll) && upright(out.yaw, out.pitch) &&
                           upright(out.yaw, out.roll) && upright(out.pitch, out.roll)))
        read.refuse(node, "<coordinateFrame>: expected unit vectors at right angles for yaw, pitch and roll");
    return out;
}

Region read_region(Reader& read, const xml_node& node, Profile profile) {
    Region out;
    const char* id = Reader::attribute(node, "id");
    if (id == nullptr || *id == '\0') read.refuse(node, "<region>: expected an 'id'");
    else out.id = id;
    const auto extent = [&](const char* name) {
        const double value = read.number(node, "'" + std::string(name) + "' of region '" + out.id + "'",
                                         Reader::attribute(node, name), 1, kMostExtent);
        return static_cast<std::int32_t>(value);
    };
    out.width = extent("Xresolution");
    out.height = extent("Yresolution");
    const auto frustum = Reader::child(node, "frustum"), frame = Reader::child(node, "coordinateFrame");
    if (profile == Profile::simulation && !frustum)
        read.refuse(node, "region '" + out.id + "' has no <frustum>: expected one in profile \"3d\"");
    if (frustum && profile == Profile::simulation) out.frustum = read_frustum(read, frustum);
    if (frame) out.axes = read_axes(read, frame);
    return out;
}

std::optional<LightFile> read_light(Reader& read, const xml_node& node) {
    LightFile out{text_in(node, "path"), 1};
    if (out.path.empty()) return std::nullopt;
    if (Reader::child(node, "gammaEmbedded")) out.gamma = read.in_child(node, "gammaEmbedded", kLeastGamma, kMostGamma);
    return out;
}

void read_files(Reader& read, const xml_node& set, Setup& setup) {
    const char* of = Reader::attribute(set, "region");
    const auto region = std::ranges::find(setup.regions, of != nullptr ? of : "", &Region::id);
    if (region == setup.regions.end())
        return read.refuse(set, "<fileset>: there is no region '" + std::string(of != nullptr ? of : "") + "'");
    if (const auto warp = Reader::child(set, "geometryWarpFile")) {
        region->warp = text_in(warp, "path");
        auto unit = text_in(warp, "geometricUnit");
        if (unit.empty()) unit = "unknown";
        const auto known = std::ranges::find_if(kUnits, [&](const auto& u) { return same(u.first, unit.c_str()); });
        if (known != kUnits.end()) region->metres = known->second;
        else if (setup.profile == Profile::surface || setup.profile == Profile::lamps)
            read.refuse(warp, "<geometricUnit> '" + unit + "': expected mm, cm, dm, m, in, ft, yd or unknown");
    }
    if (const auto alpha = Reader::child(set, "alphaMap")) region->alpha = read_light(read, alpha);
    if (const auto beta = Reader::child(set, "betaMap")) region->beta = read_light(read, beta);
    const auto distortion = Reader::child(set, "distortionMap");
    if (distortion && !text_in(distortion, "path").empty())
        read.refuse(distortion,
                    "<distortionMap>: expected what the lens does to be in the geometryWarpFile, which says "
                    "where each pixel looks");
}

Setup read_setup(Reader& read, const xml_node& root) {
    Setup out;
    const char* profile = Reader::attribute(root, "profile");
    const auto known =
        std::ranges::find_if(kProfiles, [&](const auto& p) { return profile != nullptr && same(p.first, profile); });
    if (known == kProfiles.end())
        read.refuse(root,
                    "profile '" + std::string(profile != nullptr ? profile : "") + "': expected 2d, 3d, a3 or sl");
    else out.profile = known->second;
    const char* version = Reader::attribute(root, "version");
    const std::string_view given = version != nullptr ? version : "";
    if (!given.starts_with("1.") && !given.starts_with("2."))
        read.refuse(root, "version '" + std::string(given) + "': expected 1.0 or 2.0");
    const auto display = Reader::child(root, "display");
    if (!display) read.refuse(root, "expected <display> in <MPCDI>");
    std::set<std::string> ids;
    for (const auto& buffer : display.children("buffer"))
        for (const auto& region : buffer.children("region")) {
            out.regions.push_back(read_region(read, region, out.profile));
            if (!ids.insert(out.regions.back().id).second)
                read.refuse(region, "region '" + out.regions.back().id + "' appears twice: expected unique ids");
        }
    if (out.regions.empty()) read.refuse(display ? display : root, "expected a <region> in a <buffer>");
    // They stand in <files>, and some programs put them behind it.
    for (const auto& parent : {Reader::child(root, "files"), root})
        for (const auto& set : parent.children("fileset")) read_files(read, set, out);
    return out;
}

}  // namespace

const char* name_of(Profile profile) {
    return std::ranges::find(kProfiles, profile, &std::pair<const char*, Profile>::second)->first;
}

Result<Setup> parse_setup(std::string_view xml, const std::string& name) {
    Reader read(xml, name);
    pugi::xml_document document;
    const auto parsed = document.load_buffer(xml.data(), xml.size());
    if (!parsed) {
        read.refuse(parsed.offset, std::string("expected XML: ") + parsed.description());
        return tl::unexpected(*read.error());
    }
    const auto root = Reader::child(document, "MPCDI");
    if (!root) {
        read.refuse(0, "expected <MPCDI>");
        return tl::unexpected(*read.error());
    }
    auto out = read_setup(read, root);
    if (read.error()) return tl::unexpected(*read.error());
    return out;
}

}  // namespace wall::mpcdi
