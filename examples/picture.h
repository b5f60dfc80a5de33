// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace example {

/// What has been drawn to the window of the current context, before it is swapped, as a PPM file; of a parallel program
/// what all have drawn, so behind a barrier. Says on stderr why it cannot.
void write_picture(const std::string& file, int width, int height);

}  // namespace example
