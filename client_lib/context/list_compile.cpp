// SPDX-License-Identifier: MIT
// glEndList: a recording is taken apart into runs of whole primitives and commands to be replayed (lists.h).
//
// Current values behind primitives that come from arrays. OpenGL leaves them undefined; Mesa decides it for a *group*,
// the primitives between two other commands: a group whose last primitive comes from arrays leaves the current values
// alone, any other leaves its last vertex's. Within a group later primitives see what earlier ones set. Programs rely
// on it, so the context does the same. A node's driver, which knows runs as glBegin .. glEnd only, has the values of
// the last vertex in any case: behind a group that the context forgets, a run ends before a vertex could see the
// difference.
#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <optional>
#include <utility>

#include "client_lib/context/lists.h"
#include "client_lib/geometry/block_walk.h"

namespace wall::client {
namespace {

using glapi::Op;
using glapi::Recorded;

// ---- the recording ----

/// What a recorded command may be part of.
enum class Role : std::uint8_t { other, begin, end, vertex, attribute, array_draw };

constexpr auto kRoles = [] {
    std::array<Role, kCommandCount> roles{};
    const auto role = [&](CommandId command) -> Role& { return roles[static_cast<std::size_t>(command)]; };
    for (const RecordedAttribute& row : kRecordedAttributes) role(row.command) = Role::attribute;
    role(CommandId::Materialfv) = Role::attribute;
    role(CommandId::Begin) = Role::begin;
    role(CommandId::End) = Role::end;
    role(CommandId::DrawArrays) = Role::array_draw;
    for (const CommandId vertex :
         {CommandId::Vertex2f, CommandId::Vertex3f, CommandId::Vertex4f, CommandId::EvalCoord1f, CommandId::EvalCoord2f,
          CommandId::EvalPoint1, CommandId::EvalPoint2})
        role(vertex) = Role::vertex;
    return roles;
}();

/// Whether glVertexAttrib is a vertex within glBegin .. glEnd.
bool is_vertex(const Recorded& r) {
    return static_cast<CommandId>(r.command) == CommandId::VertexAttrib4f &&
           glapi::RecordReader(r.payload).get<std::uint32_t>() == 0;
}

bool valid_begin(const Recorded& r) { return glapi::RecordReader(r.payload).get<GLenum>() <= GL_POLYGON; }

constexpr std::uint64_t kMaterialBit = std::uint64_t{1} << 63;
static_assert(kAttributes < 63);

/// A recorded vertex attribute as a bit; several forms of one attribute have the same.
std::uint64_t attribute_bit(const Recorded& r) {
    const auto* row =
        std::ranges::find(kRecordedAttributes, static_cast<CommandId>(r.command), &RecordedAttribute::command);
    if (row == std::end(kRecordedAttributes)) return kMaterialBit;
    const auto& sets = glstate::attribute_command(row->op);
    const auto index = sets.indexed ? glapi::RecordReader(r.payload).get<std::uint32_t>() % sets.count : 0;
    return std::uint64_t{1} << (sets.place + index);
}
static_assert(GL_TEXTURE0 % kTextureCoords == 0);  // so that a texture unit's word gives its number

/// Follows the groups of a recording, and which attributes the driver would have other values for than the context.
class GroupScan {
public:
    bool inside() const { return inside_; }
    /// Takes the next command; false if it has to begin another run.
    bool take(const Recorded& r, Role role) {
        switch (role) {
            case Role::array_draw: marked_ = glapi::RecordReader(r.payload).get<std::uint32_t>() != 0; break;
            case Role::begin:
                inside_ = true;
                from_arrays_ = std::exchange(marked_, false);
                break;
            case Role::end: inside_ = false; break;
            case Role::vertex: return forgotten_ == 0;
            case Role::attribute:
                if (inside_ && is_vertex(r)) return forgotten_ == 0;
                note(attribute_bit(r));
                break;
            case Role::other: break;
        }
        return true;
    }

private:
    void note(std::uint64_t bit) {
        if (inside_) {
            group_ |= bit;
        } else {
            if (from_arrays_) forgotten_ |= group_;
            group_ = 0;
        }
        if (bit != kMaterialBit) forgotten_ &= ~bit;  // there are many materials: one does not make up for another
    }

    bool inside_ = false, marked_ = false, from_arrays_ = false;
    std::uint64_t group_ = 0;      ///< set within the primitives of this group
    std::uint64_t forgotten_ = 0;  ///< set within an earlier group that ended with arrays, and not since
};

/// Bytes from the start of `stream` that are whole primitives and what may lie between them, and fit into one run.
std::size_t whole_primitives(std::span<const std::byte> stream) {
    std::size_t whole = 0;
    GroupScan groups;
    glapi::for_each_record(stream, [&](const Recorded& r) {
        const Role role = kRoles[r.command];
        const bool starts = role == Role::array_draw || (role == Role::begin && valid_begin(r));
        const bool fits =
            role == Role::attribute || (groups.inside() ? role == Role::vertex || role == Role::end : starts);
        if (!fits || !groups.take(r, role)) return false;
        if (!groups.inside() && role != Role::array_draw)
            whole = static_cast<std::size_t>(r.payload.data() + r.payload.size() - stream.data());
        return true;
    });
    return whole;
}

std::size_t first_record_bytes(std::span<const std::byte> stream) {
    std::size_t bytes = 0;
    glapi::for_each_record(stream, [&](const Recorded& r) {
        bytes = static_cast<std::size_t>(r.payload.data() + r.payload.size() - stream.data());
        return false;
    });
    return bytes;
}

// ---- a run ----

bool makes_vertex(Op op) {
    switch (op) {
        case Op::Vertex2f:
        case Op::Vertex3f:
        case Op::Vertex4f:
        case Op::EvalCoord1f:
        case Op::EvalCoord2f:
        case Op::EvalPoint1:
        case Op::EvalPoint2: return true;
        default: return false;
    }
}

/// Copies packed primitives. What is set behind a primitive's last vertex comes behind its glEnd: it means the same,
/// but Mesa's lists lose what they hold between a last vertex and glEnd.
void copy_primitives(const wire::PackBuffer& from, wire::PackBuffer& to) {
    BlockWalk walk(from, {}, from.mark(), {});
    wire::PackMark copied, vertex;  // behind what was copied; behind the latest vertex or glBegin
    while (walk.next()) {
        const wire::PackMark here = walk.position();
        if (makes_vertex(walk.op()) || walk.op() == Op::Begin) vertex = here;
        if (walk.op() != Op::End) continue;
        to.append(from, copied, vertex);
        glapi::pack::End(to);
        to.append(from, vertex, {here.commands - 1, here.operand_bytes});
        copied = here;
    }
    to.append(from, copied, from.mark());
}

/// Collects effects; a later one takes the place of an earlier one.
class EffectList {
public:
    void add(const BlockWalk& walk, std::uint32_t operand) {
        if (walk.sets_attribute()) last_[place_of(walk.attribute())] = ListRun::Effect{walk.op(), operand};
        if (walk.op() != Op::Material) return;
        MaterialChange material{};
        std::memcpy(&material.face, walk.operand(), 4);
        std::memcpy(&material.pname, walk.operand() + 4, 4);
        std::memcpy(material.value.data(), walk.operand() + 8, sizeof material.value);
        materials_.push_back(material);
    }
    void add(const EffectList& later) {
        for (std::size_t i = 0; i < kAttributes; ++i)
            if (later.last_[i]) last_[i] = later.last_[i];
        materials_.insert(materials_.end(), later.materials_.begin(), later.materials_.end());
    }
    ListRun::Effects take() {
        ListRun::Effects effects;
        for (const auto& effect : last_)
            if (effect) effects.attributes.push_back(*effect);
        effects.materials = std::move(materials_);
        return effects;
    }

private:
    std::array<std::optional<ListRun::Effect>, kAttributes> last_;
    std::vector<MaterialChange> materials_;
};

/// What calling the run leaves behind, in a driver and in the context.
void find_effects(ListRun& run) {
    EffectList driver, context, group;
    bool inside = false, from_arrays = false;
    const auto end_group = [&] {
        if (!from_arrays) context.add(group);
        group = {};
    };
    BlockWalk walk(run.content, {}, run.content.mark(), {});
    while (walk.next()) {
        const auto operand = static_cast<std::uint32_t>(walk.operand() - run.content.operands().data());
        if (walk.op() == Op::Begin) {
            inside = true;
            from_arrays =
                std::binary_search(run.array_draws.begin(), run.array_draws.end(), walk.position().commands - 1);
        } else if (walk.op() == Op::End) {
            inside = false;
        } else if (!makes_vertex(walk.op())) {
            if (!inside) end_group();
            driver.add(walk, operand);
            (inside ? group : context).add(walk, operand);
        }
    }
    end_group();
    run.in_driver = driver.take();
    run.in_context = context.take();
}

/// Attributes that the run sets itself before anything could see their old values.
std::uint32_t spared_by(const wire::PackBuffer& content) {
    Needs needs;
    BlockWalk walk(content, {}, content.mark(), {});
    while (walk.next() && !makes_vertex(walk.op()))
        if (walk.sets_attribute()) needs.spare(walk.attribute());
    return needs.spared;
}

/// Replays recorded geometry into a packer of its own.
class RunPacker {
public:
    explicit RunPacker(Context& context) : context_(context) { scratch_.set_closed(true); }

    /// Null if it draws nothing.
    std::unique_ptr<ListRun> pack(std::span<const std::byte> recorded) {
        {
            const Replaying replaying(*this);
            glapi::for_each_record(
                recorded, [&](const Recorded& r) { return replay_command(context_, r.command, r.payload), true; });
        }
        std::unique_ptr<ListRun> run;
        if (scratch_.has_geometry()) run = take();
        scratch_.reset();
        context_.lists->array_draws.clear();
        return run;
    }

private:
    /// While it lives the context packs into the scratch packer; also where replaying fails.
    class Replaying {
    public:
        explicit Replaying(RunPacker& packer) : packer_(packer) { packer_.swap(), set(true); }
        ~Replaying() { packer_.swap(), set(false); }
        Replaying(const Replaying&) = delete;

    private:
        void set(bool packing) { packer_.context_.lists->packing = packing; }
        RunPacker& packer_;
    };
    /// What the list is drawn with, a program or none, is known when it is called.
    void swap() {
        std::swap(context_.packer, scratch_);
        std::swap(context_.program, program_);
    }
    std::unique_ptr<ListRun> take() {
        auto run = std::make_unique<ListRun>();
        run->content = wire::PackBuffer(scratch_.operand_bytes() + 4);
        copy_primitives(scratch_, run->content);
        run->box = scratch_.block_box();
        run->array_draws = std::move(context_.lists->array_draws);
        find_effects(*run);
        run->spared = spared_by(run->content);
        return run;
    }

    Context& context_;
    Packer scratch_;
    std::shared_ptr<Program> program_;
};

void add_replay(DisplayList& list, std::span<const std::byte> recorded) {
    if (list.items.empty() || list.items.back().run) list.items.emplace_back();
    auto& replay = list.items.back().replay;
    replay.insert(replay.end(), recorded.begin(), recorded.end());
}

}  // namespace

std::shared_ptr<DisplayList> compile_list(Context& context, std::span<const std::byte> recording) {
    auto list = std::make_shared<DisplayList>();
    RunPacker packer(context);
    while (!recording.empty()) {
        std::size_t bytes = whole_primitives(recording);
        auto run = bytes == 0 ? nullptr : packer.pack(recording.first(bytes));
        if (bytes == 0) bytes = first_record_bytes(recording);
        if (run) list->items.push_back({std::move(run), {}});
        else add_replay(*list, recording.first(bytes));
        recording = recording.subspan(bytes);
    }
    return list;
}

bool record_array_draw(Context& c, bool draws) {
    const bool refused = c.packer.inside();
    c.list().record(static_cast<std::uint16_t>(CommandId::DrawArrays), static_cast<std::uint32_t>(draws && !refused));
    if (refused) c.error(GL_INVALID_OPERATION);
    return !refused;
}

void replay_array_draw(Context& c, std::span<const std::byte> payload) {
    const bool draws = glapi::RecordReader(payload).get<std::uint32_t>() != 0;
    if (c.packer.inside()) return c.error(GL_INVALID_OPERATION);
    if (c.lists->packing && draws) c.lists->array_draws.push_back(c.packer.commands());
}

}  // namespace wall::client
