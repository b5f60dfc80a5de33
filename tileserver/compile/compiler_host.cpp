// SPDX-License-Identifier: MIT
#include "tileserver/compile/compiler_host.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "common/base/descriptor_message.h"
#include "common/glapi/assembly_format.h"
#include "tileserver/compile/compiler_messages.h"
#include "tileserver/gpu/backend.h"
#include "tileserver/gpu/gl.h"
#include "tileserver/objects/assembly_build.h"
#include "tileserver/objects/position_recogniser.h"
#include "tileserver/objects/program_build.h"

namespace wall::tileserver {
namespace {

// ---- a socket sent through a socket ----

bool send_descriptor(int socket, int descriptor) {
    constexpr std::byte nothing{};
    ssize_t sent = 0;
    do sent = send_with_descriptor(socket, {&nothing, 1}, descriptor);
    while (sent < 0 && errno == EINTR);
    return sent == 1;
}

/// None: the other end is gone.
UniqueFd receive_descriptor(int socket) {
    std::byte nothing{};
    UniqueFd descriptor;
    ssize_t received = 0;
    do received = receive_with_descriptor(socket, {&nothing, 1}, descriptor);
    while (received < 0 && errno == EINTR);
    return descriptor;
}

// ---- the compiler's process ----

void limit(int resource, rlim_t value) {
    rlimit now{};
    ::getrlimit(resource, &now);
    now.rlim_cur = std::min(value, now.rlim_max);
    ::setrlimit(resource, &now);
}

/// From now on, until allow_time() is called again.
void allow_time(const CompilerLimits& limits) {
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    const auto begun = static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec + 1);
    limit(RLIMIT_CPU, begun + static_cast<rlim_t>(limits.processor_time.count()));  // SIGXCPU ends the process
    ::alarm(static_cast<unsigned>(limits.time.count()));                            // as does SIGALRM
}

std::vector<std::byte> link(const Gl& gl, const glapi::ProgramDefinition& definition) {
    GLint linked = 0;  // asked for, so that no driver puts its work off
    const GLuint program = build_program(gl, definition).driver;
    gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
    gl.DeleteProgram(program);
    glapi::ProgramReflection found{.linked = linked != 0};
    if (found.linked) {
        RecognisedPosition recognised = recognise_position(definition);
        found.position = std::move(recognised.program);
        found.lookups = std::move(recognised.lookups);
    }
    return encode(found);
}

std::vector<std::byte> answer(const Gl& gl, const CompilerQuestion& question) {
    if (const auto stage = glapi::assembly_stage(question.shader_type))
        return compile_assembly(gl, *stage, question.bytes);
    if (question.shader_type != 0) {
        auto compiled = compile_shader(gl, question.shader_type, question.bytes);
        return compiled ? *std::move(compiled) : std::vector<std::byte>();
    }
    const auto definition = read_definition(question.bytes);
    return definition ? link(gl, *definition) : std::vector<std::byte>();
}

void compile(int socket, const BackendChoice& choice, const CompilerLimits& limits) {
    ::setenv("LP_NUM_THREADS", "0", 1);  // nothing is drawn
    limit(RLIMIT_CORE, 0);
    if (limits.memory != 0) limit(RLIMIT_DATA, limits.memory);
    const auto backend = open_backend(choice);
    if (!backend || !(*backend)->make_current()) return;
    Gl gl;
    gl.load([&](const char* function) { return (*backend)->get_proc_address(function); });
    if (!send_message(socket, 0, {})) return;
    while (const auto question = receive_message(socket)) {
        allow_time(limits);
        const auto given = answer(gl, *question);
        ::alarm(0);
        if (!send_message(socket, 0, given)) return;
    }
}

void end_with_parent(pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(0);
}

/// Forks a compiler for each socket that comes.
void serve(int socket, const BackendChoice& backend, const CompilerLimits& limits) {
    ::signal(SIGCHLD, SIG_IGN);  // nobody asks how they ended
    ::prctl(PR_SET_NAME, "wallgl-compiler");
    const pid_t self = ::getpid();
    while (const UniqueFd compiler = receive_descriptor(socket)) {
        if (::fork() != 0) continue;
        ::close(socket);
        end_with_parent(self);
        compile(compiler.get(), backend, limits);
        ::_exit(0);
    }
}

}  // namespace

Result<std::unique_ptr<CompilerHost>> CompilerHost::start(BackendChoice backend, const CompilerLimits& limits) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
        return fail(std::string("socketpair: ") + std::strerror(errno));
    UniqueFd mine(ends[0]), its(ends[1]);
    const pid_t self = ::getpid(), process = ::fork();
    if (process < 0) return fail(std::string("fork: ") + std::strerror(errno));
    if (process == 0) {
        mine.reset();
        end_with_parent(self);
        serve(its.get(), backend, limits);
        ::_exit(0);
    }
    return std::unique_ptr<CompilerHost>(new CompilerHost(std::move(mine), process, limits));
}

CompilerHost::~CompilerHost() {
    socket_.reset();
    ::kill(process_, SIGKILL);  // and with it the compilers
    ::waitpid(process_, nullptr, 0);
}

Result<UniqueFd> CompilerHost::open() const {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        return fail(std::string("socketpair: ") + std::strerror(errno));
    UniqueFd mine(ends[0]), its(ends[1]);
    if (!send_descriptor(socket_.get(), its.get())) return fail("the process that starts compilers is gone");
    return mine;
}

}  // namespace wall::tileserver
