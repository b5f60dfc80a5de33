// SPDX-License-Identifier: MIT
#include "client_lib/link/control_messages.h"

#include <protozero/pbf_message.hpp>
#include <protozero/pbf_writer.hpp>

#include "common/wire/limits.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {
namespace {

using protozero::pbf_reader;
using protozero::pbf_writer;

// Field numbers of Envelope (proto/control.proto).
namespace envelope {
constexpr protozero::pbf_tag_type client_hello = 1, surface_open = 2, surface_resize = 3, surface_close = 4,
                                  surface_adopted = 5, close_refused = 6, client_stats = 7, placement_noted = 8,
                                  member_leaves = 9, client_welcome = 10, refused = 11, placement = 12, node_up = 13,
                                  node_down = 14, close_request = 15, adoption_noted = 16, tiles_changed = 17,
                                  placement_agreed = 18, move_answer = 19, move_request = 27, ping = 50,
                                  surface_note = 52;
}

void put_string(pbf_writer& out, protozero::pbf_tag_type tag, std::string_view text) {
    if (!text.empty()) out.add_string(tag, text.data(), text.size());
}

void put_rect(pbf_writer& parent, protozero::pbf_tag_type tag, const geom::Rect& rect) {
    pbf_writer out(parent, tag);
    out.add_sint32(1, rect.x);
    out.add_sint32(2, rect.y);
    out.add_uint32(3, static_cast<std::uint32_t>(rect.width));
    out.add_uint32(4, static_cast<std::uint32_t>(rect.height));
}

void put_stereo(pbf_writer& parent, protozero::pbf_tag_type tag, const Stereo& stereo) {
    pbf_writer out(parent, tag);
    out.add_float(1, stereo.separation);
    out.add_float(2, stereo.screen);
}

void put_resume(pbf_writer& parent, protozero::pbf_tag_type tag, const Resume& resume) {
    pbf_writer out(parent, tag);
    out.add_uint32(1, resume.session.value);
    for (const auto& [node, ticket] : resume.tickets) {
        pbf_writer row(out, 2);
        row.add_uint32(1, node.value);
        row.add_bytes(2, ticket.data(), ticket.size());
    }
    out.add_uint32(3, resume.windows);
}

void put_restore(pbf_writer& parent, protozero::pbf_tag_type tag, const Restore& restore) {
    pbf_writer out(parent, tag);
    put_rect(out, 1, restore.drawn);
    put_rect(out, 2, restore.wanted);
    out.add_bytes(3, restore.note.data(), restore.note.size());
    for (const auto& placement : restore.agreed) {
        pbf_writer row(out, 4);
        row.add_uint32(1, placement.surface.value);
        row.add_uint32(2, placement.layout_version);
        put_rect(row, 3, placement.rect);
        row.add_uint32(4, placement.from_frame);
        row.add_uint32(5, placement.width);
        row.add_uint32(6, placement.height);
    }
    out.add_uint32(5, restore.wanted_version);
}

template <class Fill>
std::string in_envelope(protozero::pbf_tag_type tag, Fill&& fill) {
    std::string bytes;
    pbf_writer outer(bytes);
    {
        pbf_writer inner(outer, tag);
        fill(inner);
    }
    return bytes;
}

// A sender of a wrong type for a field is refused rather than skipped: the numbers are a contract.
[[noreturn]] void wrong_field() { throw protozero::unknown_pbf_wire_type_exception(); }

std::uint32_t read_u32(pbf_reader& in) {
    if (in.wire_type() != protozero::pbf_wire_type::varint) wrong_field();
    return in.get_uint32();
}

float read_float(pbf_reader& in) {
    if (in.wire_type() == protozero::pbf_wire_type::fixed32) return in.get_float();
    in.skip();
    return 0;
}

std::string read_string(pbf_reader& in) {
    if (in.wire_type() != protozero::pbf_wire_type::length_delimited) wrong_field();
    return in.get_string();
}

pbf_reader read_message(pbf_reader& in) {
    if (in.wire_type() != protozero::pbf_wire_type::length_delimited) wrong_field();
    return in.get_message();
}

geom::Rect read_rect(pbf_reader in) {
    geom::Rect rect;
    while (in.next()) {
        if (in.wire_type() != protozero::pbf_wire_type::varint) wrong_field();
        switch (in.tag()) {
            case 1: rect.x = in.get_sint32(); break;
            case 2: rect.y = in.get_sint32(); break;
            case 3: rect.width = static_cast<std::int32_t>(in.get_uint32()); break;
            case 4: rect.height = static_cast<std::int32_t>(in.get_uint32()); break;
            default: in.skip();
        }
    }
    return rect;
}

void read_limit(pbf_reader in, Caps& caps) {
    std::uint32_t name = 0;
    std::vector<double> values;
    while (in.next()) {
        if (in.tag() == 1) {
            name = read_u32(in);
        } else if (in.tag() == 2 && in.wire_type() == protozero::pbf_wire_type::length_delimited) {
            const auto packed = in.get_packed_double();
            values.insert(values.end(), packed.begin(), packed.end());
        } else if (in.tag() == 2 && in.wire_type() == protozero::pbf_wire_type::fixed64) {
            values.push_back(in.get_double());
        } else {
            in.skip();
        }
    }
    caps.limits[name] = std::move(values);
}

Caps read_caps(pbf_reader in) {
    Caps caps;
    while (in.next()) {
        switch (in.tag()) {
            case 1: caps.vendor = read_string(in); break;
            case 2: caps.renderer = read_string(in); break;
            case 3: caps.version = read_string(in); break;
            case 4: caps.shading_language_version = read_string(in); break;
            case 5: caps.extensions = read_string(in); break;
            case 6: read_limit(read_message(in), caps); break;
            default: in.skip();
        }
    }
    return caps;
}

/// Nothing: it is none.
std::optional<geom::View> read_view(pbf_reader in) {
    std::vector<float> values;
    while (in.next()) {
        if (in.tag() == 1 && in.wire_type() == protozero::pbf_wire_type::length_delimited) {
            const auto packed = in.get_packed_float();
            values.insert(values.end(), packed.begin(), packed.end());
        } else {
            in.skip();
        }
    }
    const auto view = geom::view_of_values(values);
    return view && geom::wrong_with(*view) == nullptr ? view : std::nullopt;
}

geom::Eye read_eye(pbf_reader& in) {
    const auto eye = read_u32(in);
    return eye <= static_cast<std::uint32_t>(geom::Eye::right) ? static_cast<geom::Eye>(eye) : geom::Eye::both;
}

/// Nothing: it cannot be.
std::optional<Stereo> read_stereo(pbf_reader in) {
    Stereo out;
    while (in.next()) {
        switch (in.tag()) {
            case 1: out.separation = read_float(in); break;
            case 2: out.screen = read_float(in); break;
            default: in.skip();
        }
    }
    return is_sound(out) ? std::optional(out) : std::nullopt;
}

TileInfo read_tile(pbf_reader in) {
    TileInfo tile;
    while (in.next()) {
        switch (in.tag()) {
            case 1: tile.node = NodeIndex(read_u32(in)); break;
            case 2: tile.slot = read_u32(in); break;
            case 3: tile.rect = read_rect(read_message(in)); break;
            case 4: tile.name = read_string(in); break;
            case 5: tile.view = read_view(read_message(in)); break;
            case 6: tile.eye = read_eye(in); break;
            default: in.skip();
        }
    }
    return tile;
}

NodeInfo read_node(pbf_reader in, bool up) {
    NodeInfo node;
    node.up = up;
    while (in.next()) {
        switch (in.tag()) {
            case 1: node.node = NodeIndex(read_u32(in)); break;
            case 2: node.address = read_string(in); break;
            case 3: node.ticket = read_string(in); break;
            case 4: node.incarnation = read_u32(in); break;
            case 6: node.records = read_u32(in) != 0; break;
            case 7: node.renders = read_u32(in) != 0; break;
            case 8: node.hands_on = read_u32(in) != 0; break;
            case 9: node.composes = read_u32(in) != 0; break;
            default: in.skip();
        }
    }
    return node;
}

Welcome read_welcome(pbf_reader in) {
    Welcome welcome;
    while (in.next()) {
        switch (in.tag()) {
            case 1: welcome.session = SessionId(read_u32(in)); break;
            case 2: welcome.canvas_width = read_u32(in); break;
            case 3: welcome.canvas_height = read_u32(in); break;
            case 4: welcome.tiles.push_back(read_tile(read_message(in))); break;
            case 5: welcome.nodes.push_back(read_node(read_message(in), true)); break;
            case 6: welcome.caps = read_caps(read_message(in)); break;
            case 7: welcome.swap_timeout_ms = read_u32(in); break;
            case 8: welcome.lossy_pixels = read_float(in); break;
            case 9: welcome.sort_last_measured = read_u32(in) != 0; break;
            default: in.skip();
        }
    }
    return welcome;
}

Placement read_placement(pbf_reader in) {
    Placement placement;
    while (in.next()) {
        switch (in.tag()) {
            case 1: placement.surface = SurfaceId(read_u32(in)); break;
            case 2: placement.layout_version = read_u32(in); break;
            case 3: placement.rect = read_rect(read_message(in)); break;
            case 4: placement.from_frame = read_u32(in); break;
            case 5: placement.width = read_u32(in); break;
            case 6: placement.height = read_u32(in); break;
            case 7: placement.nodes.push_back(read_node(read_message(in), true)); break;
            case 8: placement.agreed = read_u32(in) != 0; break;
            case 9: placement.stereo = read_stereo(read_message(in)); break;
            default: in.skip();
        }
    }
    return placement;
}

Refused read_refused(pbf_reader in) {
    Refused refused;
    while (in.next()) {
        switch (in.tag()) {
            case 1: refused.reason = read_string(in); break;
            case 2: refused.over = read_u32(in) != 0; break;
            default: in.skip();
        }
    }
    return refused;
}

CloseRequest read_close(pbf_reader in) {
    CloseRequest close;
    while (in.next()) {
        switch (in.tag()) {
            case 1: close.surface = SurfaceId(read_u32(in)); break;
            case 2: close.reason = read_string(in); break;
            default: in.skip();
        }
    }
    return close;
}

MoveRequest read_move(pbf_reader in) {
    MoveRequest move;
    while (in.next()) {
        if (in.tag() == 1) move.address = read_string(in);
        else in.skip();
    }
    return move;
}

/// AdoptionNoted and PlacementAgreed: a surface and a version.
template <class Message>
Message read_version(pbf_reader in) {
    Message message;
    while (in.next()) {
        switch (in.tag()) {
            case 1: message.surface = SurfaceId(read_u32(in)); break;
            case 2: message.layout_version = read_u32(in); break;
            default: in.skip();
        }
    }
    return message;
}

SurfaceNote read_note(pbf_reader in) {
    SurfaceNote note;
    while (in.next()) {
        switch (in.tag()) {
            case 1: note.surface = SurfaceId(read_u32(in)); break;
            case 2: note.note = read_string(in); break;
            default: in.skip();
        }
    }
    return note;
}

TilesChanged read_tiles(pbf_reader in) {
    TilesChanged changed;
    while (in.next()) {
        if (in.tag() == 1) changed.tiles.push_back(read_tile(read_message(in)));
        else in.skip();
    }
    return changed;
}

FromWalld read_envelope(pbf_reader in) {
    FromWalld message;
    while (in.next()) {
        switch (in.tag()) {
            case envelope::client_welcome: message = read_welcome(read_message(in)); break;
            case envelope::refused: message = read_refused(read_message(in)); break;
            case envelope::placement: message = read_placement(read_message(in)); break;
            case envelope::node_up: message = read_node(read_message(in), true); break;
            case envelope::node_down: message = read_node(read_message(in), false); break;
            case envelope::close_request: message = read_close(read_message(in)); break;
            case envelope::move_request: message = read_move(read_message(in)); break;
            case envelope::adoption_noted: message = read_version<AdoptionNoted>(read_message(in)); break;
            case envelope::surface_note: message = read_note(read_message(in)); break;
            case envelope::tiles_changed: message = read_tiles(read_message(in)); break;
            case envelope::placement_agreed: message = read_version<PlacementAgreed>(read_message(in)); break;
            default: in.skip();
        }
    }
    return message;
}

}  // namespace

std::string encode(const Hello& hello) {
    return in_envelope(envelope::client_hello, [&](pbf_writer& out) {
        out.add_uint32(1, wire::kProtocolVersion);
        out.add_uint32(2, hello.pid);
        put_string(out, 3, hello.program);
        put_string(out, 4, hello.name);
        if (hello.rect) put_rect(out, 5, *hello.rect);
        if (hello.fullscreen) out.add_bool(6, true);
        if (hello.hold) out.add_bool(7, true);
        put_string(out, 8, hello.token);
        if (hello.resume) put_resume(out, 10, *hello.resume);
        if (hello.stereo) put_stereo(out, 11, *hello.stereo);
        if (hello.sort_last) out.add_bool(12, true);
        if (hello.lossy_pixels) out.add_float(13, *hello.lossy_pixels);
        if (!hello.group) return;
        pbf_writer group(out, 9);
        put_string(group, 1, hello.group->group);
        group.add_uint32(2, hello.group->rank);
        group.add_uint32(3, hello.group->members);
    });
}

std::string encode_surface_open(SurfaceId id, const OpenWindow& window, const std::optional<Restore>& restore) {
    return in_envelope(envelope::surface_open, [&](pbf_writer& out) {
        out.add_uint32(1, id.value);
        out.add_uint32(2, window.width);
        out.add_uint32(3, window.height);
        put_string(out, 4, window.title);
        if (restore) put_restore(out, 5, *restore);
        if (!window.native) return;
        pbf_writer native(out, 6);
        put_string(native, 1, window.native->display);
        native.add_uint64(2, window.native->number);
    });
}

std::string encode_ping() {
    std::string bytes;
    pbf_writer(bytes).add_message(envelope::ping, "", 0);
    return bytes;
}

std::string encode_surface_resize(SurfaceId id, std::uint32_t width, std::uint32_t height) {
    return in_envelope(envelope::surface_resize, [&](pbf_writer& out) {
        out.add_uint32(1, id.value);
        out.add_uint32(2, width);
        out.add_uint32(3, height);
    });
}

std::string encode_surface_close(SurfaceId id) {
    return in_envelope(envelope::surface_close, [&](pbf_writer& out) { out.add_uint32(1, id.value); });
}

std::string encode_surface_adopted(SurfaceId id, std::uint32_t layout_version, std::uint32_t frame) {
    return in_envelope(envelope::surface_adopted, [&](pbf_writer& out) {
        out.add_uint32(1, id.value);
        out.add_uint32(2, layout_version);
        out.add_uint32(3, frame);
    });
}

std::string encode_close_refused(SurfaceId id) {
    return in_envelope(envelope::close_refused, [&](pbf_writer& out) { out.add_uint32(1, id.value); });
}

std::string encode_move_answer(std::string_view refused) {
    std::string answer, bytes;
    pbf_writer out(answer);
    put_string(out, 1, refused);
    pbf_writer(bytes).add_message(envelope::move_answer, answer);  // also an empty one
    return bytes;
}

std::string encode(const Traffic& traffic) {
    return in_envelope(envelope::client_stats, [&](pbf_writer& out) {
        out.add_uint64(1, traffic.frames);
        out.add_uint64(2, traffic.round_trips);
        out.add_uint64(3, static_cast<std::uint64_t>(traffic.diff_time.count()));
        for (const auto& node : traffic.nodes) {
            pbf_writer row(out, 4);
            row.add_uint32(1, node.node.value);
            row.add_uint64(2, node.state_bytes);
            row.add_uint64(3, node.object_bytes);
            row.add_uint64(4, node.geometry_bytes);
            row.add_uint64(5, node.link_bytes);
        }
        for (const SurfaceId surface : traffic.seen) out.add_uint32(5, surface.value);
        for (const SurfaceId surface : traffic.flat) out.add_uint32(6, surface.value);
        out.add_uint64(7, traffic.lossy_vertices);
    });
}

std::string encode_placement_noted(SurfaceId id, std::uint32_t layout_version, std::uint32_t begun) {
    return in_envelope(envelope::placement_noted, [&](pbf_writer& out) {
        out.add_uint32(1, id.value);
        out.add_uint32(2, layout_version);
        out.add_uint32(3, begun);
    });
}

std::string encode_member_leaves(std::uint32_t rank) {
    return in_envelope(envelope::member_leaves,
                       [&](pbf_writer& out) { out.add_uint32(1, rank); });  // an empty message would not be written
}

std::string encode_data_hello(SessionId session, std::string_view ticket, std::uint32_t rank) {
    std::string bytes;
    pbf_writer out(bytes);
    out.add_uint32(1, glapi::kStreamVersion);
    out.add_uint32(2, session.value);
    out.add_bytes(3, ticket.data(), ticket.size());
    out.add_uint32(4, rank);
    return bytes;
}

std::string encode_resume(std::uint32_t stream, std::uint64_t received, std::uint64_t attempt) {
    std::string bytes;
    pbf_writer hello(bytes);
    pbf_writer out(hello, 5);
    out.add_uint32(1, stream);
    out.add_uint64(2, received);
    out.add_uint64(3, attempt);
    return bytes;
}

Result<FromWalld> decode_from_walld(std::string_view bytes) {
    try {
        return read_envelope(pbf_reader(bytes.data(), bytes.size()));
    } catch (const protozero::exception& e) {
        return fail(std::string("malformed message from walld: ") + e.what());
    }
}

}  // namespace wall::client
