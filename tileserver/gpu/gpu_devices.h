// SPDX-License-Identifier: MIT
// The graphics cards that EGL can draw on without a window system, and which of them a node uses (`gpu` in wall.toml).
// Any thread.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace wall::tileserver {

/// No software renderer is among them. A GPU's number is its place in EGL's order.
struct GpuDevice {
    void* egl = nullptr;  ///< EGLDeviceEXT
    std::string pci;      ///< such as "0000:65:00.0"; empty: it says no DRM device of it
};
std::vector<GpuDevice> gpu_devices();

/// The number of the one that is wanted: "auto" (the first), a number, or a PCI address, of which the domain "0000:"
/// may be left out. The error says which there are. With no GPU at all any number and "auto" are 0: the software
/// renderer stands for each.
Result<std::size_t> choose_gpu(std::span<const GpuDevice> gpus, std::string_view wanted);

/// Of the device behind a file such as /dev/dri/card0. Empty: it is no PCI device.
std::string pci_address(const std::string& drm_file);

/// A table for people, with what each GPU's driver calls itself.
std::string gpu_table();

}  // namespace wall::tileserver
