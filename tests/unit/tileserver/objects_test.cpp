// SPDX-License-Identifier: MIT
// Objects of many sessions that all use the same few names: random programs in turns on one driver context draw what
// each draws alone, and leave nothing behind in the driver.
#include <array>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <set>

#include "common/glapi/assembly_format.h"
#include "common/glapi/program_format.h"
#include "common/glstate/vertex_input.h"
#include "common/wire/batch.h"
#include "tests/unit/tileserver/test_node.h"
#include "tileserver/objects/run.h"
#include "tileserver/objects/texture.h"

namespace wall::tileserver::test {
namespace {

constexpr int kWidth = 40, kHeight = 32;
constexpr geom::Rect kWindow{0, 0, kWidth, kHeight};
constexpr std::uint32_t kNames = 3;  // of every kind

/// The n-th name of a kind: ids are unique over kinds.
ClientName name_of(ObjectKind kind, std::uint32_t n) {
    return ClientName(static_cast<std::uint32_t>(kind) * kNames + 1 + n);
}
constexpr std::uint32_t kContexts = 2;

/// The same random numbers with every library.
class Random {
public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_()) % n; }
    ClientName name(ObjectKind kind) { return name_of(kind, below(kNames)); }
    ClientName name_or_none(ObjectKind kind) {
        const std::uint32_t n = below(kNames + 1);
        return n == 0 ? ClientName() : name_of(kind, n - 1);
    }
    float unit() { return static_cast<float>(below(1000)) / 1000.0f; }
    float place() { return unit() * 2 - 1; }
    glstate::Vec4 color() { return {unit(), unit(), unit(), 1}; }

private:
    std::mt19937 engine_;
};

std::vector<std::byte> run_content(const wire::PackBuffer& body) {
    std::vector<std::byte> bytes(wire::padded4(body.commands()) - body.commands());
    bytes.insert(bytes.end(), body.opcodes().begin(), body.opcodes().end());
    bytes.insert(bytes.end(), body.operands().begin(), body.operands().end());
    return bytes;
}

/// A random program: batches that only a correct client would send.
class Script {
public:
    /// `large`: with geometry that takes several slices.
    explicit Script(std::uint32_t seed, int batches, bool large = false) : random_(seed), large_(large) {
        for (std::uint32_t context = 1; context <= kContexts; ++context) {
            Batch first{ContextId(context)};
            pack::Bind(first.buffer(), SurfaceId(1), SurfaceId(1));
            first.set<el::viewport>({0, 0, kWidth, kHeight}).set<el::clear_color>(random_.color());
            first.block(1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT); });
            batches_.push_back(first.payload());
        }
        for (int i = 0; i < batches; ++i) {
            Batch batch(ContextId(1 + random_.below(kContexts)));
            change_objects(batch);
            change_state(batch);
            batch.block(1, [this](auto& b) { draw(b); });
            if (random_.below(3) == 0) count_samples(batch);
            batches_.push_back(batch.payload());
        }
    }
    const std::vector<std::vector<std::byte>>& batches() const { return batches_; }

private:
    void change_objects(Batch& batch) {
        auto& b = batch.buffer();
        for (std::uint32_t i = 0; i < 3; ++i) {
            switch (random_.below(8)) {
                case 0:
                case 1: define_texture(b); break;
                case 2: pack::ObjectDelete(b, random_.name(ObjectKind::texture)); break;
                case 3: define_run(b); break;
                case 4: delete_run(b); break;
                case 5: define_program(b); break;
                case 6: set_uniform(b); break;
                default: define_map(b); break;
            }
        }
    }
    void define_texture(wire::PackBuffer& b) {
        const ClientName name = random_.name_or_none(ObjectKind::texture);  // the default one as well
        std::vector<std::byte> image(8 * 8 * 4);
        for (auto& byte : image) byte = static_cast<std::byte>(random_.below(256));
        pack::TexImage(b, name, GL_TEXTURE_2D, 0, GL_RGBA, 8, 8, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, image);
        pack::TexParameter(b, name, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                           random_.below(2) == 0 ? GL_NEAREST : GL_LINEAR, 0, 0, 0);
    }
    void define_run(wire::PackBuffer& b) {
        const ClientName name = random_.name(ObjectKind::run);
        wire::PackBuffer body;
        triangle(body);
        if (large_ && random_.below(3) == 0) many_triangles(body, 2 * kRunPartVertices / 3);
        pack::RunDefine(b, name, static_cast<std::uint32_t>(body.commands()),
                        static_cast<std::uint32_t>(body.operand_bytes()), run_content(body));
        runs_.insert(name);
    }
    void delete_run(wire::PackBuffer& b) {
        const ClientName name = random_.name(ObjectKind::run);
        pack::ObjectDelete(b, name);
        runs_.erase(name);
    }
    /// Few different sources, so that equal ones meet, too.
    void define_program(wire::PackBuffer& b) {
        const ClientName name = random_.name(ObjectKind::program);
        if (random_.below(4) == 0) {
            pack::ObjectDelete(b, name);
            programs_.erase(name);
            return;
        }
        constexpr std::array kSources = {
            "uniform vec4 tint; void main() { gl_FragColor = tint; }",
            "uniform vec4 tint; void main() { gl_FragColor = tint.bgra; }",
            "uniform vec4 tint; void main() { gl_FragColor = fract(gl_FragCoord.xyxy / 16.0) * tint; }"};
        const glapi::ProgramDefinition definition{
            {{GL_FRAGMENT_SHADER, true, kSources[random_.below(kSources.size())]}}, {}, {{1, "tint"}}};
        pack::ProgramLink(b, RequestId(0), name, encode(definition));
        programs_.insert(name);
        tint(b, name);
    }
    void set_uniform(wire::PackBuffer& b) {
        const ClientName name = random_.name(ObjectKind::program);
        if (programs_.contains(name)) tint(b, name);
    }
    void tint(wire::PackBuffer& b, ClientName program) {
        const glstate::Vec4 color = random_.color();
        pack::Uniform(b, program, 0, GL_FLOAT_VEC4, 1, std::as_bytes(std::span(color)));
    }
    void define_map(wire::PackBuffer& b) {
        std::array<float, 4 * 3> points;
        for (float& p : points) p = random_.place();
        pack::Map1(b, GL_MAP1_VERTEX_3, 0, 1, 4, std::as_bytes(std::span(points)));
        const std::array<float, 2> table = {random_.unit(), random_.unit()};
        pack::PixelMap(b, GL_PIXEL_MAP_R_TO_R, std::as_bytes(std::span(table)));
    }

    void change_state(Batch& batch) {
        batch.set<el::color>(random_.color())
            .set<el::texture_2d_enabled>(random_.below(2))
            .set<el::texture_binding_2d>(random_.name_or_none(ObjectKind::texture).value);
        batch.set<el::blend_enabled>(random_.below(2)).set<el::blend_func>({GL_ONE, GL_ONE, GL_ONE, GL_ZERO});
        batch.set<el::modelview>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, random_.place() / 2, random_.place() / 2, 0, 1});
        batch.set<el::map_color>(random_.below(2))
            .set<el::map1_vertex_3>(random_.below(2))
            .set<el::depth_test>(random_.below(2));
        const ClientName program = random_.name_or_none(ObjectKind::program);
        batch.set<el::current_program>(programs_.contains(program) ? program.value : 0);
    }
    void draw(wire::PackBuffer& b) {
        triangle(b);
        if (large_) many_triangles(b, 400);
        if (!runs_.empty())
            pack::RunCall(b, *std::next(runs_.begin(), random_.below(static_cast<std::uint32_t>(runs_.size()))));
        if (random_.below(4) == 0) pack::EvalMesh1(b, GL_LINE, 0, 8);
        if (random_.below(4) == 0) {
            std::array<std::byte, 4 * 4 * 4> image;
            for (auto& byte : image) byte = static_cast<std::byte>(random_.below(256));
            pack::DrawPixels(b, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE, image);
        }
    }
    void triangle(wire::PackBuffer& b) {
        pack::Begin(b, GL_TRIANGLES);
        for (int corner = 0; corner < 3; ++corner) {
            if (random_.below(2) == 0) pack::Color3f(b, random_.unit(), random_.unit(), random_.unit());
            pack::TexCoord2f(b, random_.unit() * 2, random_.unit() * 2);
            pack::Vertex3f(b, random_.place(), random_.place(), random_.place());
        }
        pack::End(b);
    }
    /// In one glBegin; small ones.
    void many_triangles(wire::PackBuffer& b, std::uint64_t count) {
        pack::Begin(b, random_.below(3) == 0 ? GL_TRIANGLE_STRIP : GL_TRIANGLES);
        for (std::uint64_t i = 0; i < count; ++i) {
            const float x = random_.place(), y = random_.place();
            if (random_.below(4) == 0) pack::Color3f(b, random_.unit(), random_.unit(), random_.unit());
            pack::Vertex3f(b, x, y, random_.place());
            pack::Vertex3f(b, x + 0.1f, y, 0);
            pack::Vertex3f(b, x, y + 0.1f, 0);
        }
        pack::End(b);
    }
    /// Counted, asked for under a new number each time, and now and then deleted.
    void count_samples(Batch& batch) {
        const ClientName query = random_.name(ObjectKind::query);
        batch.set<el::occlusion_query>(query.value);
        batch.block(1, [this](auto& b) { triangle(b); });
        batch.set<el::occlusion_query>(0);
        pack::QueryResult(batch.buffer(), RequestId(++last_request_), query);
        if (random_.below(2) == 0) pack::ObjectDelete(batch.buffer(), query);
    }

    Random random_;
    bool large_;
    std::vector<std::vector<std::byte>> batches_;
    std::set<ClientName> runs_, programs_;
    std::uint32_t last_request_ = 1000;
};

struct Outcome {
    Pixels pixels;
    std::map<RequestId, std::vector<std::byte>> replies;
};

class ObjectsTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        node_.node->tiles = {{0, kWindow}};
    }
    std::unique_ptr<TestSession> open(std::uint32_t id) {
        auto session = std::make_unique<TestSession>(*node_.node, SessionId(id));
        session->open_surface(kWidth, kHeight, kWindow);
        return session;
    }
    static void run(TestSession& session, const std::vector<std::byte>& payload) {
        const auto done = session.executor.run_batch(payload);
        ASSERT_TRUE(done) << done.error().message;
    }
    static Outcome outcome(TestSession& session) {
        Outcome out{session.read(0, kWindow), session.replies};
        out.replies.erase(TestSession::kReadRequest);
        return out;
    }
    Outcome alone(const Script& script) {
        const auto session = open(1);
        for (const auto& batch : script.batches()) run(*session, batch);
        return outcome(*session);
    }
    /// Objects that the driver has, by kind.
    std::map<std::string, int> driver_objects() {
        constexpr GLuint kHighest = 20000;  // Mesa gives the lowest free names
        const Gl& gl = node_.driver->gl();
        std::map<std::string, int> count;
        for (GLuint name = 1; name < kHighest; ++name) {
            count["textures"] += gl.IsTexture(name);
            count["framebuffers"] += gl.IsFramebuffer(name);
            count["lists"] += gl.IsList(name);
            count["programs"] += gl.IsProgram(name);
            count["shaders"] += gl.IsShader(name);
            count["queries"] += gl.IsQuery(name);
            count["buffers"] += gl.IsBuffer(name);
        }
        return count;
    }
    TestNode node_;
};

TEST_F(ObjectsTest, SessionsInTurnsDrawAsEachAlone) {
    constexpr std::uint32_t kSessions = 24;
    constexpr int kBatches = 12;
    const auto before = driver_objects();
    std::vector<Script> scripts;
    std::vector<Outcome> expected;
    for (std::uint32_t i = 0; i < kSessions; ++i) {
        scripts.emplace_back(100 + i, kBatches);
        expected.push_back(alone(scripts.back()));
    }
    EXPECT_EQ(driver_objects(), before) << "after each alone";
    std::vector<std::unique_ptr<TestSession>> sessions;
    std::vector<std::uint32_t> turns;
    for (std::uint32_t i = 0; i < kSessions; ++i) {
        sessions.push_back(open(i + 1));
        turns.insert(turns.end(), scripts[i].batches().size(), i);
    }
    Random random(7);
    for (std::size_t left = turns.size(); left > 1; --left)
        std::swap(turns[left - 1], turns[random.below(static_cast<std::uint32_t>(left))]);
    std::vector<std::size_t> next(kSessions);
    for (const std::uint32_t who : turns) run(*sessions[who], scripts[who].batches()[next[who]++]);
    for (std::uint32_t i = 0; i < kSessions; ++i) {
        const Outcome drawn = outcome(*sessions[i]);
        EXPECT_EQ(count_different(expected[i].pixels, drawn.pixels), 0u) << "session " << i;
        EXPECT_EQ(expected[i].replies, drawn.replies) << "session " << i;
    }
    EXPECT_GT(driver_objects()["textures"], before.at("textures"));
    sessions.clear();
    EXPECT_EQ(driver_objects(), before) << "after all in turns";
}

/// As SessionsInTurnsDrawAsEachAlone, but a turn ends wherever a batch can be left, on one driver context.
TEST_F(ObjectsTest, SessionsInSlicesDrawAsEachAlone) {
    constexpr std::uint32_t kSessions = 8;
    std::vector<Script> scripts;
    std::vector<Outcome> expected;
    for (std::uint32_t i = 0; i < kSessions; ++i) {
        scripts.emplace_back(300 + i, 8, true);
        expected.push_back(alone(scripts.back()));
    }
    struct Turns {
        std::unique_ptr<TestSession> session;
        std::size_t next = 0;
        bool in_batch = false;
    };
    std::vector<Turns> sessions;
    for (std::uint32_t i = 0; i < kSessions; ++i) sessions.push_back({open(i + 1)});
    Random random(11);
    std::size_t slices = 0, batches = 0;
    std::vector<std::uint32_t> left(kSessions);
    for (std::uint32_t i = 0; i < kSessions; ++i) left[i] = i;
    while (!left.empty()) {
        const auto place = left.begin() + random.below(static_cast<std::uint32_t>(left.size()));
        Turns& turns = sessions[*place];
        const auto& all = scripts[*place].batches();
        if (!turns.in_batch) {
            ASSERT_TRUE(turns.session->executor.start_batch(all[turns.next]));
        }
        const auto done = turns.session->executor.run_slice({.until = {}});
        ASSERT_TRUE(done) << done.error().message;
        turns.in_batch = !*done;
        ++slices;
        if (!*done) continue;
        ++batches;
        if (++turns.next == all.size()) left.erase(place);
    }
    EXPECT_GT(slices, 4 * batches);
    for (std::uint32_t i = 0; i < kSessions; ++i) {
        const Outcome drawn = outcome(*sessions[i].session);
        EXPECT_EQ(count_different(expected[i].pixels, drawn.pixels), 0u) << "session " << i;
        EXPECT_EQ(expected[i].replies, drawn.replies) << "session " << i;
    }
}

TEST_F(ObjectsTest, ScriptsAreOfAllKinds) {
    // The property means little if nothing is drawn: different seeds draw different pictures, and queries count
    // something.
    const Outcome a = alone(Script(1, 12)), b = alone(Script(2, 12));
    EXPECT_GT(count_different(a.pixels, b.pixels), static_cast<std::size_t>(kWidth * kHeight / 4));
    std::uint64_t most = 0;
    for (const auto* outcome : {&a, &b})
        for (const auto& [request, answer] : outcome->replies) {
            std::uint64_t samples = 0;
            if (answer.size() == sizeof samples) std::memcpy(&samples, answer.data(), sizeof samples);
            most = std::max(most, samples);
        }
    EXPECT_GT(most, 0u);
}

TEST_F(ObjectsTest, NamesOfASessionReachNoOther) {
    const auto owner = open(1), other = open(2);
    static constexpr ClientName kTexture(1), kRun(2), kProgram(3);
    Batch made;
    const std::vector<std::byte> white(8 * 8 * 4, std::byte{255});
    pack::TexImage(made.buffer(), kTexture, GL_TEXTURE_2D, 0, GL_RGBA, 8, 8, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, white);
    wire::PackBuffer body;
    pack::Begin(body, GL_POINTS);
    pack::End(body);
    pack::RunDefine(made.buffer(), kRun, static_cast<std::uint32_t>(body.commands()),
                    static_cast<std::uint32_t>(body.operand_bytes()), run_content(body));
    const glapi::ProgramDefinition definition{
        {{GL_FRAGMENT_SHADER, true, "uniform vec4 tint; void main() { gl_FragColor = tint; }"}}, {}, {}};
    pack::ProgramLink(made.buffer(), RequestId(0), kProgram, encode(definition));
    owner->expect_run(made);

    EXPECT_EQ(other->session.objects.find<Texture>(kTexture), nullptr);
    const auto refused = [this](auto&& fill) {
        const auto session = open(3);
        Batch batch;
        fill(batch);
        return !session->run(batch);
    };
    EXPECT_TRUE(refused([](Batch& b) { b.block(1, [](auto& p) { pack::RunCall(p, kRun); }); }))
        << "a run of another session";
    const glstate::Vec4 red = {1, 0, 0, 1};
    EXPECT_TRUE(refused([&](Batch& b) {
        pack::Uniform(b.buffer(), kProgram, 0, GL_FLOAT_VEC4, 1, std::as_bytes(std::span(red)));
    })) << "a program of another session";
    // Drawing with and deleting another's names does nothing to them, nor does the driver's own number work as a name.
    const GLuint driver_name = owner->session.objects.find<Texture>(kTexture)->content().name();
    for (const ClientName name : {kTexture, ClientName(driver_name)}) {
        Batch batch;
        batch.set<el::texture_2d_enabled>(1)
            .set<el::texture_binding_2d>(name.value)
            .set<el::color>({0, 0, 1, 1})
            .set<el::current_program>(kProgram.value);
        batch.block(1, [](auto& p) {
            pack::Begin(p, GL_QUADS);
            for (const auto& v :
                 {std::array{-1.f, -1.f}, std::array{1.f, -1.f}, std::array{1.f, 1.f}, std::array{-1.f, 1.f}})
                pack::Vertex2f(p, v[0], v[1]);
            pack::End(p);
        });
        for (const ClientName gone : {name, kRun, kProgram}) pack::ObjectDelete(batch.buffer(), gone);
        other->expect_run(batch);
        EXPECT_EQ(other->read(0, {5, 5, 1, 1}), (Pixels{0, 0, 255, 255})) << name.value;
    }
    EXPECT_NE(owner->session.objects.find<Texture>(kTexture), nullptr);
    EXPECT_TRUE(node_.driver->gl().IsTexture(driver_name));
    Batch use;
    use.block(1, [](auto& p) { pack::RunCall(p, kRun); });
    pack::Uniform(use.buffer(), kProgram, 0, GL_FLOAT_VEC4, 1, std::as_bytes(std::span(red)));
    owner->expect_run(use);
}

/// Mesa cuts strips into other triangles by where a list of its begins.
TEST_F(ObjectsTest, ARunBecomesTheSameListsHoweverShortItsTurnsAre) {
    wire::PackBuffer body;
    for (int i = 0; i < 300; ++i) {
        const float turn = 0.02f * static_cast<float>(i);
        pack::Begin(body, i % 2 == 0 ? GL_QUADS : GL_TRIANGLE_STRIP);
        for (const auto& [x, y] :
             {std::pair(-0.9f, turn - 1), {-0.8f + turn / 4, -0.9f}, {0.9f, 0.8f}, {-0.3f, 0.9f}}) {
            pack::Color3f(body, 0.5f + x / 2, 0.5f, 0.5f + y / 9);
            pack::Vertex2f(body, x, y);
        }
        pack::End(body);
    }
    static constexpr ClientName kRun(7);
    const auto drawn = [&](std::uint32_t number, std::uint64_t turn) {
        const auto session = open(number);
        Batch definition;
        pack::RunDefine(definition.buffer(), kRun, static_cast<std::uint32_t>(body.commands()),
                        static_cast<std::uint32_t>(body.operand_bytes()), run_content(body));
        const auto payload = definition.payload();
        EXPECT_TRUE(session->executor.start_batch(payload));
        Slice slice;
        slice.commands = turn;
        while (!session->executor.run_slice(slice).value()) {
        }
        Batch use;
        use.block(1, [](auto& p) { pack::RunCall(p, kRun); });
        session->expect_run(use);
        return std::pair(session->session.objects.find<tileserver::Run>(kRun)->content()->parts.size(),
                         session->read(0, {0, 0, kWidth, kHeight}));
    };
    const auto at_once = drawn(1, std::numeric_limits<std::uint64_t>::max()), bit_by_bit = drawn(2, 1);
    EXPECT_EQ(at_once.first, 1u);
    EXPECT_EQ(bit_by_bit.first, at_once.first);
    EXPECT_EQ(bit_by_bit.second, at_once.second);
}

/// An id of another kind is refused, and what is there stays.
TEST_F(ObjectsTest, AnIdIsOfOneKind) {
    wire::PackBuffer body;
    pack::Begin(body, GL_POINTS);
    pack::End(body);
    const glapi::ProgramDefinition definition{
        {{GL_FRAGMENT_SHADER, true, "void main() { gl_FragColor = vec4(1); }"}}, {}, {}};
    static constexpr std::array<float, 4> values{};
    using Say = std::function<void(Batch&, ClientName)>;
    static constexpr std::array<std::uint32_t, 3> part{9, 0, 0};
    const std::array<std::pair<ObjectKind, Say>, 13> makes = {{
        {ObjectKind::texture,
         [](Batch& b, ClientName id) {
             pack::TexParameter(b.buffer(), id, GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST, 0, 0, 0);
         }},
        {ObjectKind::program,
         [&](Batch& b, ClientName id) { pack::ProgramLink(b.buffer(), RequestId(0), id, encode(definition)); }},
        {ObjectKind::run,
         [&](Batch& b, ClientName id) {
             pack::RunDefine(b.buffer(), id, static_cast<std::uint32_t>(body.commands()),
                             static_cast<std::uint32_t>(body.operand_bytes()), run_content(body));
         }},
        {ObjectKind::query,
         [](Batch& b, ClientName id) {
             b.set<el::occlusion_query>(id.value);
             b.block(1, [](auto& p) { pack::Clear(p, GL_DEPTH_BUFFER_BIT); });
             b.set<el::occlusion_query>(0);
         }},
        {ObjectKind::buffer, [](Batch& b, ClientName id) { pack::BufferData(b.buffer(), id, 16, GL_STATIC_DRAW); }},
        {ObjectKind::vertex_input,
         [](Batch& b, ClientName id) { pack::VertexInput(b.buffer(), id, encode(glstate::VertexInputDefinition{})); }},
        {ObjectKind::draw_pieces, [](Batch& b, ClientName id) { pack::DrawPieces(b.buffer(), id, 12, 0, {}); }},
        {ObjectKind::renderbuffer,
         [](Batch& b, ClientName id) { pack::Renderbuffer(b.buffer(), id, 0, GL_RGBA8, 4, 4); }},
        {ObjectKind::framebuffer,
         [](Batch& b, ClientName id) { pack::Framebuffer(b.buffer(), id, encode(glstate::FramebufferDefinition{})); }},
        {ObjectKind::sampler,
         [](Batch& b, ClientName id) {
             pack::SamplerParameter(b.buffer(), id, GL_TEXTURE_LOD_BIAS, GL_FLOAT, 0, 0, 0, 0);
         }},
        {ObjectKind::capture,
         [](Batch& b, ClientName id) { pack::Capture(b.buffer(), id, GL_POINTS, std::as_bytes(std::span(part))); }},
        {ObjectKind::pipeline,
         [](Batch& b, ClientName id) {
             static constexpr std::array<std::uint32_t, std::size(glapi::kShaderStages)> kNone{};
             pack::Pipeline(b.buffer(), id, std::as_bytes(std::span(kNone)));
         }},
        {ObjectKind::assembly_program,
         [](Batch& b, ClientName id) {
             pack::AssemblyDefine(b.buffer(), id, GL_VERTEX_PROGRAM_ARB, encode(glapi::AssemblyDefinition{}));
         }},
    }};
    const std::array<Say, 13> uses = {
        makes[0].second,
        [&](Batch& b, ClientName id) {
            pack::Uniform(b.buffer(), id, 0, GL_FLOAT_VEC4, 1, std::as_bytes(std::span(values)));
        },
        [](Batch& b, ClientName id) { b.block(1, [&](auto& p) { pack::RunCall(p, id); }); },
        [](Batch& b, ClientName id) { pack::QueryResult(b.buffer(), RequestId(7), id); },
        [](Batch& b, ClientName id) { pack::BufferSubData(b.buffer(), id, 0, {}); },
        [](Batch& b, ClientName id) { b.block(1, [&](auto& p) { pack::DrawArrays(p, id, {}, GL_POINTS, 0, 1); }); },
        makes[6].second,
        makes[7].second,
        makes[8].second,
        makes[9].second,
        makes[10].second,
        makes[11].second,
        [&](Batch& b, ClientName id) { pack::AssemblyLocals(b.buffer(), id, 0, std::as_bytes(std::span(values))); },
    };
    static_assert(makes.size() == kObjectKinds, "a new kind is tried, too");
    for (std::size_t is = 0; is < kObjectKinds; ++is) {
        for (std::size_t wanted = 0; wanted < kObjectKinds; ++wanted) {
            if (is == wanted) continue;
            for (const Say& say : {makes[wanted].second, uses[wanted]}) {
                const auto session = open(1);
                Batch made, wrong;
                makes[is].second(made, ClientName(9));
                session->expect_run(made);
                say(wrong, ClientName(9));
                EXPECT_FALSE(session->run(wrong)) << kObjectKindNames[is] << " as " << kObjectKindNames[wanted];
                EXPECT_EQ(session->session.objects.size(), 1u);
            }
        }
    }
}

/// Equal contexts of different sessions cost a comparison of values once.
TEST_F(ObjectsTest, EqualValuesGetOneId) {
    const auto first = open(1), second = open(2);
    const auto draw = [](TestSession& session) {
        Batch batch;
        batch.set<el::fog_density>(0.25f).set<el::color>({1, 0, 0, 1}).set<el::light_enabled>(1, 2);
        batch.block(1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); });
        session.expect_run(batch);
    };
    draw(*first);
    draw(*second);
    const auto& a = first->session.context(ContextId(1)).state;
    const auto& b = second->session.context(ContextId(1)).state;
    EXPECT_TRUE(glstate::same_ids<glstate::kSentCategories>(a, b));
    EXPECT_TRUE(glstate::same_ids<glstate::mask_of(glstate::Category::fog)>(a, node_.driver->mirror));
}

}  // namespace
}  // namespace wall::tileserver::test
