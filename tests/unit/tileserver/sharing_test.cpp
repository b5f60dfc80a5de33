// SPDX-License-Identifier: MIT
// Equal content of several sessions is one object of the driver, and nobody can see it: not in the picture when another
// one changes it, not by lying about a name.
#include <array>
#include <deque>
#include <functional>
#include <random>

#include "client_lib/objects/texture.h"
#include "common/glapi/image.h"
#include "tests/unit/tileserver/test_node.h"
#include "tileserver/objects/content_store.h"

namespace wall::tileserver::test {
namespace {

using namespace std::chrono_literals;

glapi::ContentKey key_of(int n) {
    glapi::ContentKey key{};
    std::memcpy(key.data(), &n, sizeof n);
    return key;
}

// ---- the store ----

using Store = ContentStore<int>;
constexpr ContentAsker kA{1}, kB{2}, kC{3};

TEST(ContentStoreTest, TheFirstSendsTheOthersWait) {
    Store store;
    const Store::Clock::time_point now{};
    EXPECT_TRUE(store.ask(key_of(1), kA, now).send);
    const auto waits = store.ask(key_of(1), kB, now);
    EXPECT_FALSE(waits.send || waits.have);
    EXPECT_TRUE(store.ask(key_of(2), kB, now).send) << "other content";
    const auto held = store.store(key_of(1), std::make_shared<int>(7));
    EXPECT_EQ(store.ask(key_of(1), kB, now).have, held);
}

TEST(ContentStoreTest, ABrokenPromiseIsTakenOver) {
    Store store;
    const Store::Clock::time_point start{};
    EXPECT_TRUE(store.ask(key_of(1), kA, start).send);
    store.heard(key_of(1), kA, start + 900ms);
    EXPECT_FALSE(store.ask(key_of(1), kB, start + 1800ms).send) << "it is still coming";
    EXPECT_TRUE(store.ask(key_of(1), kB, start + 1901ms).send);
    EXPECT_FALSE(store.ask(key_of(1), kC, start + 1902ms).send);
    store.leave(kB);
    EXPECT_TRUE(store.ask(key_of(1), kC, start + 1903ms).send);
}

TEST(ContentStoreTest, KeepsNothingAlive) {
    Store store;
    for (int i = 0; i < 20000; ++i) {
        glapi::ContentKey key{};
        std::memcpy(key.data(), &i, sizeof i);
        const auto held = store.store(key, std::make_shared<int>(i));
        EXPECT_EQ(store.ask(key, kA, {}).have, held);
    }
    EXPECT_LE(store.size(), 512u);
}

TEST(ContentStoreTest, AnAskerHasOnePromise) {
    Store store;
    for (int i = 0; i < 20000; ++i) {
        glapi::ContentKey key{};
        std::memcpy(key.data(), &i, sizeof i);
        EXPECT_TRUE(store.ask(key, kA, {}).send);
    }
    EXPECT_EQ(store.size(), 1u);
    EXPECT_TRUE(store.ask(key_of(7), kB, {}).send) << "it was promised before the last one";
    store.leave(kA);
    EXPECT_EQ(store.size(), 1u) << "the other's";
}

TEST(ContentStoreTest, WhoComesSecondUsesWhatIsThere) {
    Store store;
    const auto first = store.store(key_of(1), std::make_shared<int>(1));
    EXPECT_EQ(store.store(key_of(1), std::make_shared<int>(2)), first);
    store.forget(key_of(1), int{});
    EXPECT_EQ(store.ask(key_of(1), kA, {}).have, first) << "it was another's";
    store.forget(key_of(1), *first);
    EXPECT_TRUE(store.ask(key_of(1), kA, {}).send);
}

TEST(ContentStoreTest, APromiseDoesNotLastForEver) {
    Store store;
    const Store::Clock::time_point start{};
    EXPECT_TRUE(store.ask(key_of(1), kA, start).send);
    auto now = start;
    for (; now < start + Store::kWholePromiseLimit; now += 500ms) {
        EXPECT_FALSE(store.ask(key_of(1), kB, now).send);
        store.heard(key_of(1), kA, now);
    }
    EXPECT_TRUE(store.ask(key_of(1), kB, now).send) << "it sends a little now and then, and never ends";
    EXPECT_FALSE(store.ask(key_of(1), kC, now).send);
}

TEST(ContentStoreTest, ANodeKnowsALimitedNumberOfNames) {
    constexpr int kMost = 100;
    Store store(kMost);
    std::vector<std::shared_ptr<int>> held;
    for (int i = 0; i < kMost - 1; ++i) held.push_back(store.store(key_of(i), std::make_shared<int>(i)));
    EXPECT_TRUE(store.ask(key_of(200), kA, {}).send) << "the last name is promised";
    const auto beyond = std::make_shared<int>(7);
    EXPECT_TRUE(store.ask(key_of(201), kB, {}).send);
    EXPECT_TRUE(store.ask(key_of(201), kC, {}).send) << "it is not promised, so nobody waits for it";
    EXPECT_EQ(store.store(key_of(201), beyond), beyond);
    EXPECT_EQ(store.size(), static_cast<std::size_t>(kMost));
    EXPECT_EQ(store.ask(key_of(3), kB, {}).have, held[3]) << "what is known is shared as before";
    EXPECT_FALSE(store.ask(key_of(200), kB, {}).send) << "and waited for";
    held.clear();
    for (int i = 0; i < 2000; ++i) (void)store.ask(key_of(201), kC, {});
    EXPECT_FALSE(store.ask(key_of(201), kB, {}).send) << "room again";
}

// ---- sessions on a driver ----

constexpr int kWidth = 40, kHeight = 32;
constexpr geom::Rect kWindow{0, 0, kWidth, kHeight};

/// A texture as a client keeps it.
class Content {
public:
    explicit Content(TextureTarget target = TextureTarget::t2d)
        : texture_(std::make_shared<client::Texture>(ClientName(1), 1, target)) {}
    Content& level(GLint number, GLint internal_format, int size, GLenum format, GLenum type, std::uint32_t seed,
                   unsigned face = 0) {
        client::TextureLevel& level = texture_->level_at(face, number);
        const bool compressed = format == 0;
        level.internal_format = internal_format;
        level.width = level.height = size;
        level.depth = texture_->info.images == 3 ? size : 1;
        level.format = level.data_format = format;
        level.type = level.data_type = type;
        level.compressed = compressed;
        level.content = client::LevelContent::stored;
        const std::size_t bytes = compressed ? static_cast<std::size_t>(size / 4 * (size / 4)) * 8
                                             : glapi::image_bytes(format, type, size, size, level.depth).value();
        level.pixels.resize(bytes);
        std::mt19937 random(seed);
        for (auto& byte : level.pixels) byte = static_cast<std::byte>(random() & (type == GL_FLOAT ? 0x3f : 0xff));
        level.stamp = texture_->stamp = client::next_stamp();
        return *this;
    }
    Content& parameter(GLenum filter) {
        texture_->parameters.min_filter = filter;
        texture_->parameter_changed(GL_TEXTURE_MIN_FILTER);
        return *this;
    }
    Content& mipmaps() {
        texture_->mipmaps_generated();
        return *this;
    }
    Content& global() {
        texture_->global = true;
        return *this;
    }
    GLenum target() const { return texture_->info.target; }
    std::uint32_t is_global() const { return texture_->global; }
    glapi::ContentKey key() const { return client::content_key(*texture_); }
    void define(wire::PackBuffer& buffer) const { texture_->pack_changes(0, buffer, client::no_limit); }

private:
    std::shared_ptr<client::Texture> texture_;  // number 1 on the wire
};

class SharingTest : public ::testing::Test {
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
    enum class Said { nothing, send, have };
    static Said ask(TestSession& session, const Content& content) {
        Batch batch;
        session.replies.erase(RequestId(5));
        pack::ShareTexture(batch.buffer(), RequestId(5), ClientName(1), content.target(), content.is_global(),
                           content.key());
        session.expect_run(batch);
        return said(session);
    }
    static Said said(TestSession& session) {
        EXPECT_TRUE(session.executor.pursue_question());
        const auto answer = session.replies.find(RequestId(5));
        if (answer == session.replies.end()) return Said::nothing;
        return answer->second == std::vector{std::byte{1}} ? Said::have : Said::send;
    }
    static void send(TestSession& session, const Content& content) {
        Batch batch;
        content.define(batch.buffer());
        pack::TexShared(batch.buffer(), ClientName(1));
        session.expect_run(batch);
    }
    static void define(TestSession& session, const Content& content) {
        const Said answer = ask(session, content);
        ASSERT_NE(answer, Said::nothing);
        if (answer == Said::send) send(session, content);
    }
    static GLuint driver_name(TestSession& session, TextureTarget target = TextureTarget::t2d) {
        return session.session.objects.find<Texture>(Texture::key(ClientName(1), target))->content().name();
    }
    /// The texture over the whole window, some of it minified.
    static Pixels picture(TestSession& session, GLenum target = GL_TEXTURE_2D) {
        Batch batch;
        batch.set<el::color>({1, 1, 1, 1}).set<el::depth_test>(0).set<el::tex_env_mode>(GL_REPLACE);
        batch.set<el::texture_2d_enabled>(target == GL_TEXTURE_2D).set<el::texture_3d_enabled>(target == GL_TEXTURE_3D);
        batch.set<el::texture_cube_map_enabled>(target == GL_TEXTURE_CUBE_MAP);
        batch.set<el::texture_binding_2d>(target == GL_TEXTURE_2D).set<el::texture_binding_3d>(target == GL_TEXTURE_3D);
        batch.set<el::texture_binding_cube_map>(target == GL_TEXTURE_CUBE_MAP);
        batch.block(1, [&](auto& b) {
            pack::Clear(b, GL_COLOR_BUFFER_BIT);
            pack::Begin(b, GL_QUADS);
            for (const auto& v :
                 {std::array{-1.f, -1.f}, std::array{1.f, -1.f}, std::array{1.f, 1.f}, std::array{-1.f, 1.f}}) {
                pack::TexCoord3f(b, v[0] * 1.5f, v[1] * 1.5f, target == GL_TEXTURE_CUBE_MAP ? 1.0f : v[0] / 2);
                pack::Vertex2f(b, v[0], v[1]);
            }
            pack::End(b);
        });
        session.expect_run(batch);
        return session.read(0, kWindow);
    }
    Pixels alone(const Content& content) {
        const auto session = open(77);
        Batch batch;
        content.define(batch.buffer());
        session->expect_run(batch);
        return picture(*session, content.target());
    }
    TestNode node_;
};

Content plain(std::uint32_t seed) {
    return Content().level(0, GL_RGBA, 16, GL_RGBA, GL_UNSIGNED_BYTE, seed).parameter(GL_NEAREST);
}

TEST_F(SharingTest, EqualContentIsOneObject) {
    const auto a = open(1), b = open(2), c = open(3);
    define(*a, plain(1));
    EXPECT_EQ(ask(*b, plain(1)), Said::have);
    EXPECT_EQ(driver_name(*a), driver_name(*b));
    define(*c, plain(2));
    EXPECT_NE(driver_name(*a), driver_name(*c));
    EXPECT_EQ(count_different(picture(*b), alone(plain(1))), 0u);
    EXPECT_EQ(count_different(picture(*c), alone(plain(2))), 0u);
    EXPECT_EQ(a->session.objects.bytes(), b->session.objects.bytes()) << "everybody pays";
}

TEST_F(SharingTest, ParametersBelongToTheContent) {
    const auto a = open(1), b = open(2);
    define(*a, plain(1));
    EXPECT_EQ(ask(*b, plain(1).parameter(GL_LINEAR)), Said::send);
}

TEST_F(SharingTest, OutlivesWhoSentIt) {
    auto a = open(1);
    const auto b = open(2), c = open(3);
    define(*a, plain(1));
    define(*b, plain(1));
    a.reset();
    EXPECT_EQ(count_different(picture(*b), alone(plain(1))), 0u);
    EXPECT_EQ(ask(*c, plain(1)), Said::have);
    Batch gone;
    pack::ObjectDelete(gone.buffer(), ClientName(1));
    b->expect_run(gone);
    EXPECT_EQ(count_different(picture(*c), alone(plain(1))), 0u);
    c->expect_run(gone);
    EXPECT_EQ(ask(*b, plain(1)), Said::send) << "nobody has it any more";
}

struct Case {
    const char* name;
    Content content;
};

// Every format that decides on the driver's storage, and every way to be incomplete.
TEST_F(SharingTest, AChangeIsOnlyOnesOwn) {
    std::vector<Case> cases;
    cases.push_back({"RGBA8", plain(3)});
    cases.push_back(
        {"GL_RGB of bytes", Content().level(0, GL_RGB, 16, GL_RGB, GL_UNSIGNED_BYTE, 4).parameter(GL_LINEAR)});
    cases.push_back(
        {"BGRA", Content().level(0, GL_RGBA8, 16, GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV, 5).parameter(GL_LINEAR)});
    cases.push_back({"565", Content().level(0, GL_RGB, 16, GL_RGB, GL_UNSIGNED_SHORT_5_6_5, 6).parameter(GL_NEAREST)});
    cases.push_back(
        {"luminance alpha",
         Content().level(0, GL_LUMINANCE_ALPHA, 16, GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE, 7).parameter(GL_NEAREST)});
    cases.push_back(
        {"intensity", Content().level(0, GL_INTENSITY8, 16, GL_LUMINANCE, GL_UNSIGNED_BYTE, 8).parameter(GL_NEAREST)});
    cases.push_back({"one number", Content().level(0, 1, 16, GL_RED, GL_UNSIGNED_BYTE, 9).parameter(GL_NEAREST)});
    cases.push_back({"float", Content().level(0, GL_RGBA32F, 16, GL_RGBA, GL_FLOAT, 10).parameter(GL_NEAREST)});
    cases.push_back({"S3TC", Content().level(0, GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 16, 0, 0, 11).parameter(GL_NEAREST)});
    cases.push_back({"all levels", Content()
                                       .level(0, GL_RGBA, 8, GL_RGBA, GL_UNSIGNED_BYTE, 12)
                                       .level(1, GL_RGBA, 4, GL_RGBA, GL_UNSIGNED_BYTE, 13)
                                       .level(2, GL_RGBA, 2, GL_RGBA, GL_UNSIGNED_BYTE, 14)
                                       .level(3, GL_RGBA, 1, GL_RGBA, GL_UNSIGNED_BYTE, 15)
                                       .parameter(GL_NEAREST_MIPMAP_NEAREST)});
    cases.push_back({"incomplete", Content()
                                       .level(0, GL_RGBA, 16, GL_RGBA, GL_UNSIGNED_BYTE, 16)
                                       .level(3, GL_RGBA, 7, GL_RGBA, GL_UNSIGNED_BYTE, 17)});
    cases.push_back(
        {"generated",
         Content().level(0, GL_RGBA, 64, GL_RGBA, GL_UNSIGNED_BYTE, 18).parameter(GL_LINEAR_MIPMAP_LINEAR).mipmaps()});
    cases.push_back(
        {"3D", Content(TextureTarget::t3d).level(0, GL_RGBA, 8, GL_RGBA, GL_UNSIGNED_BYTE, 19).parameter(GL_LINEAR)});
    Content cube(TextureTarget::cube_map);
    for (unsigned face = 0; face < 6; ++face) cube.level(0, GL_RGB, 8, GL_RGB, GL_UNSIGNED_BYTE, 20 + face, face);
    cases.push_back({"cube", cube.parameter(GL_LINEAR)});
    for (const auto& [name, content] : cases) {
        SCOPED_TRACE(name);
        const auto target = texture_target(content.target()).value();
        const auto a = open(1), b = open(2), c = open(3);
        define(*a, content);
        define(*b, content);
        define(*c, content);
        const Pixels before = picture(*a, content.target());
        EXPECT_EQ(count_different(before, alone(content)), 0u);
        // Another parameter, and back to what it was: the copy is all of the texture.
        Batch there, back;
        pack::TexParameter(there.buffer(), ClientName(1), content.target(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE, 0, 0,
                           0);
        pack::TexParameter(back.buffer(), ClientName(1), content.target(), GL_TEXTURE_WRAP_S, GL_REPEAT, 0, 0, 0);
        b->expect_run(there);
        EXPECT_NE(driver_name(*a, target), driver_name(*b, target));
        EXPECT_EQ(driver_name(*a, target), driver_name(*c, target));
        b->expect_run(back);
        const Pixels copied = picture(*b, content.target());
        EXPECT_EQ(count_different(copied, before), 0u) << "the copy";
        EXPECT_EQ(count_different(picture(*a, content.target()), before), 0u) << "the others";
        EXPECT_EQ(a->session.work.gl_errors + b->session.work.gl_errors, 0u);
        if (content.target() != GL_TEXTURE_2D) continue;
        Batch overwrite;
        const std::vector<std::byte> red(8 * 8 * 4, std::byte{0x7f});
        pack::TexImage(overwrite.buffer(), ClientName(1), GL_TEXTURE_2D, 0, GL_RGBA, 8, 8, 1, 0, GL_RGBA,
                       GL_UNSIGNED_BYTE, red);
        c->expect_run(overwrite);
        EXPECT_EQ(count_different(picture(*a), before), 0u) << "another one's new image";
    }
}

TEST_F(SharingTest, TheOnlyOneChangesItInPlace) {
    const auto a = open(1), b = open(2);
    define(*a, plain(1));
    const GLuint name = driver_name(*a);
    Batch change;
    pack::TexSubImage(change.buffer(), ClientName(1), GL_TEXTURE_2D, 0, 3, 3, 0, 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                      std::array<std::byte, 4>{});
    a->expect_run(change);
    EXPECT_EQ(driver_name(*a), name);
    EXPECT_EQ(ask(*b, plain(1)), Said::send) << "it is not that content any more";
}

TEST_F(SharingTest, OthersWaitForWhatIsBeingSent) {
    auto a = open(1);
    const auto b = open(2), c = open(3);
    EXPECT_EQ(ask(*a, plain(1)), Said::send);
    EXPECT_EQ(ask(*b, plain(1)), Said::nothing);
    EXPECT_EQ(ask(*c, plain(1)), Said::nothing);
    send(*a, plain(1));
    EXPECT_EQ(said(*b), Said::have);
    EXPECT_EQ(said(*c), Said::have);
    EXPECT_EQ(ask(*a, plain(2)), Said::send);
    EXPECT_EQ(ask(*b, plain(2)), Said::nothing);
    a.reset();  // and never sends it
    EXPECT_EQ(said(*b), Said::send);
    send(*b, plain(2));
    EXPECT_EQ(count_different(picture(*b), alone(plain(2))), 0u);
}

TEST_F(SharingTest, WhoDoesNotWaitForTheAnswerIsRight) {
    const auto a = open(1), b = open(2);
    define(*a, plain(1));
    EXPECT_EQ(ask(*b, plain(1)), Said::have);
    send(*b, plain(1));  // as if the answer had come too late
    EXPECT_EQ(count_different(picture(*b), alone(plain(1))), 0u);
}

TEST_F(SharingTest, ALieEndsOnlyTheLiar) {
    auto liar = open(1);
    const auto victim = open(2);
    EXPECT_EQ(ask(*liar, plain(1)), Said::send);
    Batch other;
    plain(2).define(other.buffer());
    pack::TexShared(other.buffer(), ClientName(1));
    const auto done = liar->run(other);
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message.find("not what its name says"), std::string::npos) << done.error().message;
    EXPECT_EQ(ask(*victim, plain(1)), Said::nothing) << "the liar's session has not ended yet";
    liar.reset();
    EXPECT_EQ(said(*victim), Said::send);
}

TEST_F(SharingTest, AGlobalTextureIsItsNameWithinASession) {
    const auto a = open(1), member = open(1), stranger = open(2);
    define(*a, plain(1).global());
    EXPECT_EQ(ask(*member, plain(2).global()), Said::have) << "the pixels are not looked at";
    EXPECT_EQ(count_different(picture(*member), alone(plain(1))), 0u);
    EXPECT_EQ(ask(*member, plain(2).global().parameter(GL_LINEAR)), Said::send) << "other parameters";
    EXPECT_EQ(ask(*stranger, plain(1).global()), Said::send) << "another program";
    EXPECT_EQ(ask(*open(3), plain(1)), Said::send) << "not named by its content";
}

TEST_F(SharingTest, BadQuestionsAreRefused) {
    const auto refused = [this](auto&& fill) {
        const auto session = open(9);
        Batch batch;
        fill(batch.buffer());
        return !session->run(batch);
    };
    const std::array<std::byte, 31> brief{};
    const std::array<std::byte, 32> whole{};
    EXPECT_TRUE(refused([&](auto& b) { pack::ShareTexture(b, RequestId(1), ClientName(1), GL_TEXTURE_2D, 0, brief); }));
    EXPECT_TRUE(refused([&](auto& b) { pack::ShareTexture(b, RequestId(1), ClientName(1), 0x1234, 0, whole); }));
    const auto a = open(1);
    EXPECT_EQ(ask(*a, plain(1)), Said::send);
    EXPECT_TRUE(refused([&](auto& b) {
        pack::ShareTexture(b, RequestId(1), ClientName(1), GL_TEXTURE_2D, 0,
                           plain(1).key());  // waits for the other session
        pack::ShareTexture(b, RequestId(2), ClientName(2), GL_TEXTURE_2D, 0, whole);
    }));
}

TEST_F(SharingTest, RunsAreShared) {
    const auto a = open(1), b = open(2);
    wire::PackBuffer body;
    pack::Color3f(body, 0, 1, 0);
    pack::Begin(body, GL_QUADS);
    for (const auto& v : {std::array{-1.f, -1.f}, std::array{1.f, -1.f}, std::array{1.f, 1.f}, std::array{-1.f, 1.f}})
        pack::Vertex2f(body, v[0], v[1]);
    pack::End(body);
    std::vector<std::byte> content(wire::padded4(body.commands()) - body.commands());
    content.insert(content.end(), body.opcodes().begin(), body.opcodes().end());
    content.insert(content.end(), body.operands().begin(), body.operands().end());
    const auto commands = static_cast<std::uint32_t>(body.commands()),
               bytes = static_cast<std::uint32_t>(body.operand_bytes());
    glapi::ContentHash hash;
    hash.RunDefine(commands, bytes, content);
    const auto key = hash.finish();

    Batch first;
    pack::ShareRun(first.buffer(), RequestId(5), ClientName(8), key);
    a->expect_run(first);
    EXPECT_EQ(said(*a), Said::send);
    Batch definition;
    pack::RunDefine(definition.buffer(), ClientName(8), commands, bytes, content);
    a->expect_run(definition);
    Batch second;
    pack::ShareRun(second.buffer(), RequestId(5), ClientName(3), key);
    b->expect_run(second);
    EXPECT_EQ(said(*b), Said::have);
    EXPECT_EQ(a->session.objects.find<tileserver::Run>(ClientName(8))->content(),
              b->session.objects.find<tileserver::Run>(ClientName(3))->content());
    Batch gone;
    pack::ObjectDelete(gone.buffer(), ClientName(8));
    a->expect_run(gone);
    Batch use;
    use.block(1, [](auto& p) { pack::RunCall(p, ClientName(3)); });
    b->expect_run(use);
    EXPECT_EQ(b->read(0, {5, 5, 1, 1}), (Pixels{0, 255, 0, 255}));
    EXPECT_EQ(a->session.objects.bytes(), 0u);
    EXPECT_EQ(b->session.objects.bytes(), kLeastObjectBytes + content.size());
}

/// Random sessions over few contents, in random turns: each draws what it draws alone.
TEST_F(SharingTest, SessionsInTurnsDrawAsEachAlone) {
    constexpr std::uint32_t kSessions = 12;
    std::mt19937 engine(5);
    const auto random = [&engine](std::uint32_t n) { return static_cast<std::uint32_t>(engine()) % n; };
    struct Act {
        enum { share, change, recolor, remove } what;
        std::uint32_t seed;
    };
    const auto perform = [](TestSession& session, const Act& act) {
        Batch batch;
        if (act.what == Act::change) {
            const std::vector<std::byte> part(16, static_cast<std::byte>(act.seed * 40));
            pack::TexSubImage(batch.buffer(), ClientName(1), GL_TEXTURE_2D, 0, static_cast<int>(act.seed % 12), 2, 0, 2,
                              2, 1, GL_RGBA, GL_UNSIGNED_BYTE, part);
        } else if (act.what == Act::recolor) {
            pack::TexParameter(batch.buffer(), ClientName(1), GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER,
                               act.seed % 2 != 0 ? GL_NEAREST : GL_LINEAR, 0, 0, 0);
        } else {
            pack::ObjectDelete(batch.buffer(), ClientName(1));
        }
        session.expect_run(batch);
    };
    std::vector<std::deque<Act>> scripts(kSessions);
    for (auto& script : scripts) {
        script.push_back({Act::share, random(3)});
        for (int i = 0; i < 10; ++i) {
            const auto what = static_cast<decltype(Act::what)>(random(3));
            if (what == Act::share) script.push_back({Act::remove, 0});
            script.push_back({what, random(3)});
        }
    }
    std::vector<Pixels> expected;
    for (const auto& script : scripts) {
        const auto session = open(99);
        for (const Act& act : script) {
            if (act.what != Act::share) {
                perform(*session, act);
                continue;
            }
            Batch batch;
            plain(act.seed).define(batch.buffer());
            session->expect_run(batch);
        }
        expected.push_back(picture(*session));
    }
    std::vector<std::unique_ptr<TestSession>> sessions;
    for (std::uint32_t i = 0; i < kSessions; ++i) sessions.push_back(open(i + 1));
    std::vector<std::optional<Content>> sending(kSessions), asked(kSessions);
    int held = 0, waited = 0;
    for (;;) {
        const std::uint32_t i = random(kSessions);
        if (std::all_of(scripts.begin(), scripts.end(), [](const auto& s) { return s.empty(); }) &&
            std::none_of(sending.begin(), sending.end(), [](const auto& s) { return s.has_value(); }) &&
            std::none_of(asked.begin(), asked.end(), [](const auto& s) { return s.has_value(); }))
            break;
        TestSession& session = *sessions[i];
        if (sending[i]) {
            send(session, *sending[i]);
            sending[i].reset();
        } else if (asked[i]) {
            const Said answer = said(session);
            if (answer == Said::nothing) {
                ++waited;
                continue;
            }
            held += answer == Said::have;
            if (answer == Said::send) sending[i].emplace(*asked[i]);
            asked[i].reset();
        } else if (!scripts[i].empty()) {
            const Act act = scripts[i].front();
            scripts[i].pop_front();
            if (act.what == Act::share) {
                asked[i].emplace(plain(act.seed));
                ask(session, *asked[i]);
            } else {
                perform(session, act);
            }
        }
    }
    EXPECT_GT(held, 10);
    EXPECT_GT(waited, 0);
    for (std::uint32_t i = 0; i < kSessions; ++i)
        EXPECT_EQ(count_different(picture(*sessions[i]), expected[i]), 0u) << "session " << i;
}

}  // namespace
}  // namespace wall::tileserver::test
