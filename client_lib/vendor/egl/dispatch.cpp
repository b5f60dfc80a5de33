// SPDX-License-Identifier: MIT
// The vendor-neutral stubs of EGL's extension functions that GLVND has none for: each finds the vendor that its device
// belongs to, which need not be us, and calls that vendor's implementation through GLVND.
#include <array>
#include <atomic>
#include <cstring>

#include "client_lib/vendor/egl/functions.h"

namespace wall::client::egl {
namespace {

constinit std::atomic<const __EGLapiExports*> glvnd{nullptr};

enum Stub : std::size_t { QueryDeviceAttrib, QueryDeviceString, kStubs };
constinit std::array<std::atomic<int>, kStubs> indices{-1, -1};

/// The vendor's implementation; null, and the error is set, if there is no such device.
template <class F>
F* implementation(EGLDeviceEXT device, Stub stub) {
    const __EGLapiExports& api = *glvnd.load(std::memory_order_relaxed);
    api.threadInit();
    __EGLvendorInfo* const vendor = api.getVendorFromDevice(device);
    auto* const call = vendor ? reinterpret_cast<F*>(api.fetchDispatchEntry(vendor, indices[stub])) : nullptr;
    if (call) api.setLastVendor(vendor);
    else api.setEGLError(EGL_BAD_DEVICE_EXT);
    return call;
}

EGLBoolean query_device_attrib(EGLDeviceEXT device, EGLint name, EGLAttrib* value) {
    auto* call = implementation<EGLBoolean(EGLDeviceEXT, EGLint, EGLAttrib*)>(device, QueryDeviceAttrib);
    return call ? call(device, name, value) : EGL_FALSE;
}

const char* query_device_string(EGLDeviceEXT device, EGLint name) {
    auto* call = implementation<const char*(EGLDeviceEXT, EGLint)>(device, QueryDeviceString);
    return call ? call(device, name) : nullptr;
}

struct Row {
    const char* name;
    void* stub;
};
const std::array<Row, kStubs>& rows() {
    static const std::array<Row, kStubs> table{{
        {"eglQueryDeviceAttribEXT", reinterpret_cast<void*>(query_device_attrib)},
        {"eglQueryDeviceStringEXT", reinterpret_cast<void*>(query_device_string)},
    }};
    return table;
}

}  // namespace

void start_dispatch(const __EGLapiExports& exports) { glvnd = &exports; }

void* dispatch_address(const char* name) {
    for (const Row& row : rows())
        if (std::strcmp(row.name, name) == 0) return row.stub;
    return nullptr;
}

void set_dispatch_index(const char* name, int index) {
    for (std::size_t stub = 0; stub < kStubs; ++stub)
        if (std::strcmp(rows()[stub].name, name) == 0) indices[stub] = index;
}

}  // namespace wall::client::egl
