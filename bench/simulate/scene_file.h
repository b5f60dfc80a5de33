// SPDX-License-Identifier: MIT
// A scene of the model as a file: JSON that says which machines, nodes and programs there are, what a byte and a vertex
// cost, and which counts (counting_nodes) say what the programs send.
//
//   { "hosts": [{"count": 1, "processors": 2, "up": 125e6, "down": 125e6}, ...],     no rate: any
//     "nodes": [HOST, ...],
//     "latency": SECONDS, "frames": N, "warm_up": N, "piece": BYTES,                 each as in model.h if it is
//     missing "programs": [{"trace": FILE, "hosts": [HOST, ...],                             a host for each rank
//                   "nodes": [NODE, ...],                                            which the trace's nodes are here
//                   "ahead": N, "skip": N,                                           of the trace's frames: 1 if
//                   missing "pack": SECONDS, "send": {"byte": S, "message": S}, "draw": {"byte": S, "vertex": S,
//                   "frame": S}, "link": {"byte": FACTOR, "message": BYTES}}, ...] }
#pragma once

#include <string>

#include "bench/simulate/model.h"

namespace wall::simulate {

/// Traces are looked for beside the file. The error names what is wrong where.
Result<Scene> read_scene(const std::string& file);

}  // namespace wall::simulate
