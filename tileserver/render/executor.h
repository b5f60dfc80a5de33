// SPDX-License-Identifier: MIT
// Executes one session's stream: the handler of glapi::decode. State commands change soft contexts; before a block
// draws in a tile, the driver is brought from what it holds to the soft context (lazily, by diff) and the tile's layer
// is bound. A command that a correct client cannot send is refused, and with it the stream. Render thread.
//
// Within a block the driver's current attributes run ahead of the soft context: `trail_` notes what the commands leave
// behind. Each tile of the block starts from the soft context's values; the soft context takes the trail at the end.
//
// A batch is executed in slices, so that no stream keeps the driver for as long as it likes (executor_slices.cpp).
#pragma once

#include <bit>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/glapi/decoder.h"
#include "tileserver/render/render_modes.h"
#include "tileserver/render/render_node.h"
#include "tileserver/render/session.h"
#include "tileserver/render/session_output.h"

namespace wall::tileserver {

using glstate::Attribute;

class Executor : public glapi::Handler {
public:
    Executor(RenderNode& node, SessionReplica& session, SessionOutput& output);
    ~Executor();

    using Clock = std::chrono::steady_clock;

    /// Begins one batch frame's payload, which must stay until it has been executed; nothing of it runs yet.
    Result<void> start_batch(std::span<const std::byte> payload);
    /// Executes what is left of it until about `until`. True: all of it is done. Behind it the driver is in the
    /// middle of nothing, and others may draw.
    Result<bool> run_slice(Clock::time_point until);
    /// Both, to the end.
    Result<void> run_batch(std::span<const std::byte> payload);
    void present(SurfaceId surface, std::uint32_t frame);
    /// False: the session waits for content that another one is sending; nothing of it may run.
    Result<bool> pursue_question();

    // ---- the decoder's interface ----
    glapi::Pause should_pause();
    std::uint32_t state_bytes(std::uint32_t id) const;
    bool State(std::uint32_t id, std::span<const std::byte> value);
    void StateSmall(std::uint32_t word);
    void StateRecall(std::uint32_t word);
    std::uint64_t begin_block(std::uint64_t tiles, std::size_t bytes);
    void begin_tile(unsigned slot);
    void end_block();

    // ---- geometry ----
    void Begin(GLenum mode) {
        if (in_begin_) return refuse("inside Begin and End");
        in_begin_ = true;
        begin_ = {mode, vertices_, true};
        if (draws_) gl_.Begin(mode);
    }
    void End() {
        if (!in_begin_) return refuse("without Begin");
        in_begin_ = false;
        if (draws_) gl_.End();
    }
    void Vertex2f(float x, float y) {
        ++vertices_;
        if (draws_) gl_.Vertex2f(x, y);
    }
    void Vertex3f(float x, float y, float z) {
        ++vertices_;
        if (draws_) gl_.Vertex3f(x, y, z);
    }
    void Vertex4f(float x, float y, float z, float w) {
        ++vertices_;
        if (draws_) gl_.Vertex4f(x, y, z, w);
    }
    void Normal3f(float x, float y, float z) {
        trail_.set(Attribute::normal, x, y, z);
        if (draws_) gl_.Normal3f(x, y, z);
    }
    void Color3f(float r, float g, float b) {
        trail_.set(Attribute::color, r, g, b);
        if (draws_) gl_.Color3f(r, g, b);
    }
    void Color4f(float r, float g, float b, float a) {
        trail_.set(Attribute::color, r, g, b, a);
        if (draws_) gl_.Color4f(r, g, b, a);
    }
    void Color4ub(std::uint32_t rgba) {
        const auto byte = [rgba](unsigned shift) { return static_cast<float>(rgba >> shift & 0xff) / 255.0f; };
        trail_.set(Attribute::color, byte(0), byte(8), byte(16), byte(24));
        if (draws_) gl_.Color4ubv(reinterpret_cast<const GLubyte*>(&rgba));
    }
    void SecondaryColor3f(float r, float g, float b) {
        trail_.set(Attribute::secondary_color, r, g, b);
        if (draws_) gl_.SecondaryColor3f(r, g, b);
    }
    void TexCoord1f(float s) {
        trail_.set(Attribute::texcoord, s);
        if (draws_) gl_.TexCoord1f(s);
    }
    void TexCoord2f(float s, float t) {
        trail_.set(Attribute::texcoord, s, t);
        if (draws_) gl_.TexCoord2f(s, t);
    }
    void TexCoord3f(float s, float t, float r) {
        trail_.set(Attribute::texcoord, s, t, r);
        if (draws_) gl_.TexCoord3f(s, t, r);
    }
    void TexCoord4f(float s, float t, float r, float q) {
        trail_.set(Attribute::texcoord, s, t, r, q);
        if (draws_) gl_.TexCoord4f(s, t, r, q);
    }
    void MultiTexCoord4f(std::uint32_t unit, float s, float t, float r, float q) {
        if (unit >= kTextureUnits) return refuse("no such texture unit");
        trail_.set(Attribute::texcoord + unit, s, t, r, q);
        if (draws_) gl_.MultiTexCoord4f(GL_TEXTURE0 + unit, s, t, r, q);
    }
    void FogCoordf(float coord) {
        trail_.set(Attribute::fog_coord, coord);
        if (draws_) gl_.FogCoordf(coord);
    }
    void EdgeFlag(std::uint32_t flag) {
        trail_.set(Attribute::edge_flag, flag != 0 ? 1.0f : 0.0f);
        if (draws_) gl_.EdgeFlag(flag != 0 ? GL_TRUE : GL_FALSE);
    }
    void Indexf(float c) {
        trail_.set(Attribute::color_index, c);
        if (draws_) gl_.Indexf(c);
    }
    void VertexAttrib4f(std::uint32_t index, float x, float y, float z, float w) {
        if (index >= glstate::el::vertex_attrib::count) return refuse("no such attribute");
        if (index != 0) trail_.set(Attribute::vertex_attrib + index, x, y, z, w);
        else begin_.countable = false;
        if (draws_) gl_.VertexAttrib4f(index, x, y, z, w);
    }
    void Material(GLenum face, GLenum pname, float p0, float p1, float p2, float p3);
    void EvalCoord1f(float u) {
        begin_.countable = false;
        if (draws_) gl_.EvalCoord1f(u);
    }
    void EvalCoord2f(float u, float v) {
        begin_.countable = false;
        if (draws_) gl_.EvalCoord2f(u, v);
    }
    void EvalPoint1(std::int32_t i) {
        begin_.countable = false;
        if (draws_) gl_.EvalPoint1(i);
    }
    void EvalPoint2(std::int32_t i, std::int32_t j) {
        begin_.countable = false;
        if (draws_) gl_.EvalPoint2(i, j);
    }

    // ---- drawing (executor_draw.cpp) ----
    void EvalMesh1(GLenum mode, std::int32_t i1, std::int32_t i2);
    void EvalMesh2(GLenum mode, std::int32_t i1, std::int32_t i2, std::int32_t j1, std::int32_t j2);
    void Clear(std::uint32_t mask);
    void Accum(GLenum op, float value);
    void DrawPixels(std::int32_t width, std::int32_t height, GLenum format, GLenum type,
                    std::span<const std::byte> pixels);
    void Bitmap(std::int32_t width, std::int32_t height, float xorig, float yorig, float xmove, float ymove,
                std::span<const std::byte> bits);
    void RunCall(ClientName run);
    void InitNames();
    void LoadName(std::uint32_t name);
    void PushName(std::uint32_t name);
    void PopName();
    void PassThrough(float token);

    // ---- surfaces (executor_surface.cpp) ----
    void Block(std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t) {
        refuse("misplaced");
    }  // the decoder's own
    void Sync(RequestId request);
    void SurfaceCreate(SurfaceId surface, std::uint32_t double_buffered, std::uint32_t alpha_bits,
                       std::uint32_t depth_bits, std::uint32_t stencil_bits, std::uint32_t accum_bits,
                       std::uint32_t samples);
    void SurfacePlace(SurfaceId surface, std::uint32_t layout_version, std::uint32_t window_width,
                      std::uint32_t window_height, std::int32_t x, std::int32_t y, std::uint32_t width,
                      std::uint32_t height, std::uint32_t offscreen);
    void SwapOffscreen(SurfaceId window);
    void SurfaceDestroy(SurfaceId surface);
    void Bind(SurfaceId draw_surface, SurfaceId read_surface);
    void ContextDestroy(ContextId context);
    void Swap(SurfaceId surface, std::uint32_t frame);

    // ---- parallel programs (executor_sync.cpp) ----
    void Join();
    void Leave();
    void BarrierCreate(std::uint32_t barrier, std::uint32_t count);
    void BarrierDestroy(std::uint32_t barrier);
    void BarrierExec(std::uint32_t barrier);
    void SemaphoreCreate(std::uint32_t semaphore, std::uint32_t count, std::int32_t moved);
    void SemaphoreDestroy(std::uint32_t semaphore);
    void SemaphoreP(std::uint32_t semaphore);
    void SemaphoreV(std::uint32_t semaphore);

    // ---- answers (executor_read.cpp) ----
    void ReadPixels(RequestId request, std::uint32_t slot, std::int32_t x, std::int32_t y, std::int32_t width,
                    std::int32_t height, GLenum format, GLenum type);
    void RenderMode(RequestId request, GLenum mode, GLenum feedback_type, std::uint32_t buffer_entries);

    // ---- objects (executor_objects.cpp) ----
    void TexImage(ClientName texture, GLenum target, std::int32_t level, GLenum internal_format, std::int32_t width,
                  std::int32_t height, std::int32_t depth, std::int32_t border, GLenum format, GLenum type,
                  std::span<const std::byte> pixels);
    void TexSubImage(ClientName texture, GLenum target, std::int32_t level, std::int32_t x, std::int32_t y,
                     std::int32_t z, std::int32_t width, std::int32_t height, std::int32_t depth, GLenum format,
                     GLenum type, std::span<const std::byte> pixels);
    void TexCompressed(ClientName texture, GLenum target, std::int32_t level, GLenum internal_format,
                       std::int32_t width, std::int32_t height, std::span<const std::byte> blocks);
    void Compress(RequestId request, GLenum internal_format, std::int32_t width, std::int32_t height, GLenum format,
                  GLenum type, std::span<const std::byte> pixels);
    void TexParameter(ClientName texture, GLenum target, GLenum pname, float p0, float p1, float p2, float p3);
    void TexDelete(ClientName texture);
    void ShareTexture(RequestId request, ClientName texture, GLenum target, std::uint32_t own_name,
                      std::span<const std::byte> key);
    void TexShared(ClientName texture);
    void ShareRun(RequestId request, ClientName run, std::span<const std::byte> key);
    void ShaderCompile(RequestId request, GLenum type, std::span<const std::byte> source);
    void ProgramLink(RequestId request, ClientName program, std::span<const std::byte> definition);
    void ProgramDelete(ClientName program);
    void QueryResult(RequestId request, ClientName query);
    void QueryDelete(ClientName query);
    void Uniform(ClientName program, std::uint32_t location, GLenum type, std::uint32_t count,
                 std::span<const std::byte> values);
    void RunDefine(ClientName run, std::uint32_t commands, std::uint32_t operand_bytes,
                   std::span<const std::byte> content);
    void RunDelete(ClientName run);
    void Map1(GLenum target, float u1, float u2, std::int32_t order, std::span<const std::byte> points);
    void Map2(GLenum target, float u1, float u2, std::int32_t uorder, float v1, float v2, std::int32_t vorder,
              std::span<const std::byte> points);
    void PixelMap(GLenum map, std::span<const std::byte> values);

private:
    // ---- slices ----
    Result<bool> go_on();
    void finish_batch();
    void pause();
    void resume();
    void look_up_surfaces();
    bool out_of_time() const { return Clock::now() >= until_; }
    /// Between two commands the open glBegin, if there is one, can be ended and begun anew without a difference.
    bool divisible() const;

    void go_on_compiling();
    void compile_part();
    void finish_run();
    void go_on_with_run();
    bool keep_run(ClientName id, std::shared_ptr<const Run> run);
    void finish_tile();
    /// Whether occlusion queries count what is drawn there: of a window partly off the wall, its tiles' samples.
    bool counts_samples(unsigned slot) const;
    bool outside_begin();
    SurfaceReplica* known_surface(SurfaceId id);
    bool holds_early(std::span<const std::byte> opcodes) const;
    /// `say(GroupSync&, Rank)` gives a Result; its error refuses the stream.
    template <class Say>
    void say_to_group(Say&& say) {
        ParallelGroup* group = session_.group();
        if (group == nullptr) return refuse("not of a parallel program");
        if (const Result<void> done = say(group->sync, session_.rank()); !done) refuse(done.error().message);
    }
    /// Asks the node's store; false: not answered yet.
    bool answer_question();
    void ask(RequestId request, ClientName object, GLenum target, bool own_name, std::span<const std::byte> key);
    /// The texture to change: its own, bound for the driver's work on the object; null after a refusal.
    Texture* bind_for_upload(ClientName name, GLenum target);
    bool check_image(GLenum format, GLenum type, std::int32_t width, std::int32_t height, std::int32_t depth,
                     std::span<const std::byte> pixels);
    /// `define` calls the driver for an image of the bound texture; what the driver then has is noted.
    template <class Define>
    void define_image(Texture& texture, GLenum target, std::int32_t level, const TextureContent::ImageFormat& format,
                      Define&& define);
    template <class Draw>
    void at_raster_position(Draw&& draw);

    RenderNode& node_;
    SessionReplica& session_;
    SessionOutput& output_;
    const Gl& gl_;

    // Of the batch.
    std::optional<glapi::BatchRun> batch_;
    std::size_t batch_commands_ = 0, batch_bytes_ = 0;
    std::uint64_t counted_before_ = 0;  // bytes of state and geometry
    Clock::time_point until_;           // of the slice
    bool paused_ = false, closely_ = false;
    SoftContext* context_ = nullptr;
    ContextId context_id_;
    SurfaceReplica *draw_surface_ = nullptr, *read_surface_ = nullptr;  // of the batch's context
    bool surfaces_known_ = false;

    // Within a block.
    bool draws_ = false;  // false: only the effects on the soft context count
    bool in_begin_ = false;
    /// The last Begin.
    struct {
        GLenum mode = 0;
        std::uint64_t vertices = 0;  ///< `vertices_` there
        bool countable = true;       ///< every vertex since then is counted
    } begin_;
    std::uint64_t vertices_ = 0;  // so far
    bool in_block_ = false;
    bool tile_open_ = false;
    unsigned tile_slot_ = 0;
    Layer* layer_ = nullptr;
    AttributeTrail trail_;
    glstate::Vec4 raster_{};  // position as the block's bitmaps move it

    /// Does the node have this content? The client waits for the answer.
    struct Question {
        RequestId request;
        ClientName object;
        GLenum target = 0;  ///< of a texture; 0: it is a run
        bool own_name = false;
        glapi::ContentKey key;
    };
    std::optional<Question> question_;
    std::optional<std::pair<ClientName, glapi::ContentKey>> promised_run_;

    /// A run that is being defined.
    struct Compiling {
        ClientName id;
        std::optional<glapi::ContentKey> promised;
        std::shared_ptr<Run> run;
        glapi::DrawingRun content;
        std::uint64_t list_start = 0;  ///< `vertices_` where the list began
    };
    std::optional<Compiling> compiling_;
    /// A run that is being called.
    struct {
        std::shared_ptr<const Run> run;
        std::size_t next = 0;  ///< of its parts
    } call_;

    RenderModes modes_;
};

}  // namespace wall::tileserver
