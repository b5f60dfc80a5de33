// SPDX-License-Identifier: MIT
// A scene of the model as a file: JSON that says which machines, nodes and programs there are, what a byte and a vertex
// cost, and which counts (counting_nodes) say what the programs send.
//
//   { "hosts": [HOST, ...], "nodes": [number of a host, ...], "programs": [PROGRAM, ...],
//     "latency": SECONDS, "frames": N, "warm_up": N, "piece": BYTES }
//
//   HOST := { "count": N, "processors": N, "up": BYTES A SECOND, "down": BYTES A SECOND,
//             "runs_on": number of the host whose processors it has }
//   PROGRAM := { "trace": FILE, "skip": N, "last": N,      its frames N + 1 to N; else 2 to the last
//                "hosts": [number of a host, ...],         of each rank
//                "nodes": [number of a node, ...],         which the trace's nodes are here
//                "ahead": N, "pack": SECONDS,
//                "send": {"byte": SECONDS, "message": SECONDS},
//                "draw": {"byte": SECONDS, "vertex": SECONDS, "frame": SECONDS, "piece_share": 0 to 1},
//                "link": {"byte": BYTES, "message": BYTES} }
//
// piece_share: how much of a draw in pieces a node does not leave out. All but "hosts", "nodes", "programs" and a
// program's "trace", "hosts" and "nodes" may be missing: as in model.h then, and what it costs is nothing.
#pragma once

#include <string>

#include "bench/simulate/model.h"

namespace wall::simulate {

/// Traces are looked for beside the file. The error names what is wrong where.
Result<Scene> read_scene(const std::string& file);

}  // namespace wall::simulate
