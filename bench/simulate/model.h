// SPDX-License-Identifier: MIT
// A wall as queues: programs that pack, links that carry, nodes that draw (A7.4). What each of them has to do in each
// frame is measured (counting_wall.h) or known; the model says how long it takes when all of it runs at once. Events
// in order of time; the same input gives the same answer. Pure; one thread.
//
// A machine's processors are shared evenly by what wants to run there. A link sends in the order in which it gets
// things, one at a time, at its rate; the switch between them holds nothing up, and starts to pass on a piece before it
// has come whole. A node draws in the order in which pieces come. A program packs frame n when frame n - ahead is drawn
// by all of its nodes (client_lib/link/pacing.h).
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "common/base/id_vector.h"
#include "common/base/ids.h"
#include "common/base/result.h"

namespace wall::simulate {

/// Seconds, of time or of work of one processor.
using Seconds = double;
/// Bytes a second.
using Rate = double;
inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

struct Host {
    double processors = 1;
    Rate up = kUnlimited, down = kUnlimited;  ///< to and from the switch; what stays on the host takes no time
    std::optional<std::uint32_t> runs_on;     ///< the processors are that one's: several hosts on one machine
};

/// What a frame brings to one node.
struct Message {
    NodeIndex node;      ///< in Scene::nodes
    double bytes = 0;    ///< on the link, with what goes around them
    Seconds draw = 0;    ///< of the node
    Seconds finish = 0;  ///< of the node, once all that the frame brings it has come
};

struct Frame {
    Seconds pack = 0;  ///< of the program's own thread
    Seconds send = 0;  ///< of the thread that writes to the links, for all messages together; spread by their bytes
    std::vector<Message> messages;
};

/// One process of a program.
struct Member {
    std::uint32_t host = 0;
    std::vector<Frame> frames;  ///< again from the first after the last
};

struct Program {
    std::vector<Member> members;  ///< several: a parallel program, whose frame is drawn when all of it is
    std::uint32_t ahead = 2;      ///< frames that are on their way at once
};

struct Scene {
    std::vector<Host> hosts;
    IdVector<NodeIndex, std::uint32_t> nodes;  ///< the host of each
    std::vector<Program> programs;
    Seconds latency = 0;        ///< from one host to another, on top of the bytes
    double piece = 256 << 10;   ///< bytes of a message that are sent as soon as they are packed
    std::uint32_t frames = 64;  ///< of each program, after which it stops
    std::uint32_t warm_up = 8;  ///< of these, not in the figures
};

struct ProgramFigures {
    double frames_per_second = 0;
    Seconds longest = 0;         ///< between two frames
    Seconds delay = 0;           ///< from the first packed byte to the last drawn one, on average
    double bytes_per_frame = 0;  ///< to all nodes
};

struct HostFigures {
    double processors = 0, up = 0, down = 0;  ///< shares of what there is, 0 to 1, over the whole time. Processors of
                                              ///< another host count there
};

struct Figures {
    std::vector<ProgramFigures> programs;
    std::vector<HostFigures> hosts;
    Seconds time = 0;  ///< that passed in the model
    std::uint64_t events = 0;
};

/// The error names what in the scene is out of its range.
Result<Figures> simulate(const Scene& scene);

}  // namespace wall::simulate
