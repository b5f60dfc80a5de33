// SPDX-License-Identifier: MIT
// What programs see when the library has no memory, or fails in another way: an error, a context that goes on or goes
// dark, never an exception. This program's operator new fails when it is told to.
#include "client_lib/process/guard.h"

#include <cstdlib>
#include <new>

#include "client_lib/context/core.h"
#include "client_lib/context/lists.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace {

constexpr int kNever = -1;
int allocations_left = kNever;  ///< until one fails, and all behind it
bool fail_otherwise = false;    ///< with something else than std::bad_alloc

struct NotOfTheStandardLibrary {};

void* allocate(std::size_t size) {
    if (allocations_left == 0) {
        if (fail_otherwise) throw NotOfTheStandardLibrary();
        throw std::bad_alloc();
    }
    if (allocations_left > 0) --allocations_left;
    void* memory = std::malloc(size ? size : 1);
    if (!memory) throw std::bad_alloc();
    return memory;
}

}  // namespace

void* operator new(std::size_t size, std::align_val_t alignment) {
    std::free(allocate(size));  // or it fails
    const auto unit = static_cast<std::size_t>(alignment);
    void* memory = std::aligned_alloc(unit, (size + unit - 1) / unit * unit);
    if (!memory) throw std::bad_alloc();
    return memory;
}
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace wall::client {
namespace {

template <class Function>
Function* entry(const char* name) {
    return reinterpret_cast<Function*>(gl_proc_address(name));
}

class GuardTest : public ContextTest {
protected:
    void SetUp() override {
        go_dark();  // as a thread is before its first context
        ContextTest::SetUp();
    }
    void TearDown() override {
        allocations_left = kNever;
        fail_otherwise = false;
        ContextTest::TearDown();
    }
    /// Runs `body` with no more than `count` allocations.
    template <class Body>
    void with_allocations(int count, Body&& body) {
        allocations_left = count;
        body();
        allocations_left = kNever;
    }
    GLenum gl_error() { return entry<GLenum()>("glGetError")(); }

    using TexImage2D = void(GLenum, GLint, GLint, GLsizei, GLsizei, GLint, GLenum, GLenum, const void*);
    TexImage2D* tex_image = entry<TexImage2D>("glTexImage2D");
    void (*begin)(GLenum) = entry<void(GLenum)>("glBegin");
    void (*end)() = entry<void()>("glEnd");
    void (*vertex)(GLfloat, GLfloat) = entry<void(GLfloat, GLfloat)>("glVertex2f");
    void (*vertex_d)(GLdouble, GLdouble) = entry<void(GLdouble, GLdouble)>("glVertex2d");
    void (*new_list)(GLuint, GLenum) = entry<void(GLuint, GLenum)>("glNewList");
    void (*end_list)() = entry<void()>("glEndList");
    void (*buffer_data)(GLenum, GLsizeiptr, const void*,
                        GLenum) = entry<void(GLenum, GLsizeiptr, const void*, GLenum)>("glBufferData");
    void give_image() { tex_image(GL_TEXTURE_2D, 0, GL_RGBA, 64, 64, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data()); }
    void bind_buffer() {
        GLuint name = 0;
        entry<void(GLsizei, GLuint*)>("glGenBuffers")(1, &name);
        entry<void(GLenum, GLuint)>("glBindBuffer")(GL_ARRAY_BUFFER, name);
    }
    std::vector<std::byte> pixels = std::vector<std::byte>(64 * 64 * 4);
};

TEST_F(GuardTest, AnImageWithoutMemoryIsAnError) {
    new_list(1, GL_COMPILE);  // at once it would need a wall
    with_allocations(0, [&] { give_image(); });
    EXPECT_EQ(gl_error(), GLenum{GL_OUT_OF_MEMORY});
    EXPECT_EQ(gl_error(), GLenum{GL_NO_ERROR});
    give_image();  // the context goes on
    end_list();
    EXPECT_EQ(gl_error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(share->lists.find(1)->items.size(), 1u);
}

// AddressSanitizer ends a process that asks for more than there can be, instead of throwing.
#if defined(__has_feature)
constexpr bool kSizesEndTheProcess = __has_feature(address_sanitizer);
#else
constexpr bool kSizesEndTheProcess = false;
#endif

TEST_F(GuardTest, ABufferWithoutMemoryIsAnErrorAndStaysAsItWas) {
    bind_buffer();
    buffer_data(GL_ARRAY_BUFFER, 100, pixels.data(), GL_STATIC_DRAW);
    with_allocations(0, [&] { buffer_data(GL_ARRAY_BUFFER, 16000, pixels.data(), GL_STATIC_DRAW); });
    EXPECT_EQ(gl_error(), GLenum{GL_OUT_OF_MEMORY});
    if (!kSizesEndTheProcess) {
        buffer_data(GL_ARRAY_BUFFER, PTRDIFF_MAX, nullptr, GL_STATIC_DRAW);  // more than any vector can hold
        EXPECT_EQ(gl_error(), GLenum{GL_OUT_OF_MEMORY});
    }
    GLint size = 0;
    entry<void(GLenum, GLenum, GLint*)>("glGetBufferParameteriv")(GL_ARRAY_BUFFER, GL_BUFFER_SIZE, &size);
    EXPECT_EQ(size, 100);
}

TEST_F(GuardTest, AllThatFailsForMemoryIsReportedWhereverItHappens) {
    const auto program = [&] {
        begin(GL_TRIANGLE_STRIP);
        for (int i = 0; i < 100; ++i) vertex(static_cast<float>(i), 0), vertex_d(0, 1);
        end();
        c.packer.reset();  // there is no wall to send it to
        new_list(1, GL_COMPILE);
        begin(GL_POINTS);
        vertex(1, 2);
        end();
        entry<void(GLenum)>("glEnable")(GL_FOG);
        give_image();
        end_list();
        bind_buffer();
        buffer_data(GL_ARRAY_BUFFER, 100, pixels.data(), GL_STATIC_DRAW);
        entry<void(GLbitfield)>("glPushAttrib")(GL_ALL_ATTRIB_BITS);
        entry<void()>("glPopAttrib")();
    };
    for (int count = 0; count < 40; ++count) {
        SCOPED_TRACE(count);
        with_allocations(count, program);
        while (gl_error() != GL_NO_ERROR) continue;
        if (c.lists->name != 0) end_list();
        while (gl_error() != GL_NO_ERROR) continue;
        ASSERT_FALSE(c.packer.inside());
        ASSERT_FALSE(c.lost());
    }
    program();
    EXPECT_EQ(gl_error(), GLenum{GL_NO_ERROR});
}

TEST_F(GuardTest, APackerThatCannotGrowSaysSoAndIsStillAtOneWithTheProgramAboutItsEnd) {
    begin(GL_POINTS);
    with_allocations(0, [&] {
        for (int i = 0; i < 60000; ++i) vertex(1, 2);  // more than a packer has place for at first
        c.packer.end();
    });
    EXPECT_EQ(error(), GLenum{GL_OUT_OF_MEMORY});
    EXPECT_FALSE(c.packer.inside());
    EXPECT_EQ(c.packer.primitives().size(), 1u);
    c.packer.reset();
}

TEST_F(GuardTest, AnyOtherFailureMakesTheContextDark) {
    bind_buffer();
    fail_otherwise = true;
    with_allocations(0, [&] { buffer_data(GL_ARRAY_BUFFER, 100, pixels.data(), GL_STATIC_DRAW); });
    EXPECT_TRUE(c.lost());
    EXPECT_EQ(tls_context, nullptr);
    begin(GL_POINTS);
    vertex(1, 2);
    end();
    EXPECT_TRUE(c.packer.empty());
    EXPECT_EQ(gl_error(), GLenum{GL_NO_ERROR});
}

TEST_F(GuardTest, AContextThatCouldNotBeMadeCurrentIsNobodys) {
    ::setenv("WALLGL_WALLD", "unix:/nowhere", 1);
    const auto context = create_context({});
    int failed = 0;
    for (int count = 0; count < 5; ++count) {
        try {
            with_allocations(count, [&] { make_current(context, nullptr, nullptr); });
        } catch (const std::bad_alloc&) {  // which vendor/guarded.h catches
            allocations_left = kNever;
            ++failed;
        }
        EXPECT_FALSE(context->in_use);
    }
    EXPECT_GT(failed, 0);
}

}  // namespace
}  // namespace wall::client
